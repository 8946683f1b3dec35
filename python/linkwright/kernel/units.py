"""Units stop here: a number or a text with a unit comes in, an SI float comes out.

A field of a description is marked with the quantity that it holds, ``radius: Length``. It then accepts a bare
number (SI) or a text such as ``"200 mm"``, and stores the SI float. Fields with several values are marked
``Lengths``, ``Torques`` and accept a list of such values, or one text ``"0, 100, 200 mm"`` with one unit.

An angle is kept apart from a plain number: a speed in ``1/min`` or ``Hz`` is refused, because books differ on
whether that counts turns or radians. `COMMON` holds the usual spellings, so that most files are read without
loading pint, which costs more than everything else together; any other spelling goes to pint.

Every kind has a range of sizes, from far below the smallest instrument to far above the largest plant, so
that products of a dozen numbers neither overflow nor vanish. It is declared here with the kind, held by every
reader, and printed in `docs/units.md`. Specks below the smallest size are what arithmetic leaves of zero: a
quantity with a sign keeps them, one that may be zero is zero there, and one that may not is refused.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from numbers import Real
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from linkwright.kernel.errors import Problem, UnitError, plain

if TYPE_CHECKING:
    import pint
    from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler


class Dimension(NamedTuple):
    """Exponents of metre, kilogram, second, radian and kelvin."""

    m: int = 0
    kg: int = 0
    s: int = 0
    rad: int = 0
    K: int = 0


@dataclass(frozen=True, slots=True)
class Kind:
    """A physical quantity: its word, its SI unit, and an example for messages.

    Attributes
    ----------
    word : str
        What it is called, with its article: "a length".
    unit : str
        The coherent SI unit in a spelling that `parse` reads.
    unit_word : str
        The same in words, in the plural.
    example : str
        A text that is valid for it.
    dimension : Dimension
        Of the SI unit.
    least, most : float
        Smallest size that counts, and largest [SI unit].
    angle_free : bool
        The radian may be written or left out: N·m/rad and N·m are the same torque per angle.
    """

    word: str
    unit: str
    unit_word: str
    example: str
    dimension: Dimension
    least: float
    most: float
    angle_free: bool = False

    @property
    def noun(self) -> str:
        """The word without its article."""
        return self.word.split(" ", 1)[1]

    @property
    def expected(self) -> str:
        """What belongs into a field of this kind."""
        return f"{self.word} {self.forms}"

    @property
    def forms(self) -> str:
        """How a value of this kind may be written."""
        if self is COUNT:
            return f"such as {self.example}"
        if not self.unit:
            return f'as a plain number or a text such as "{self.example}"'
        return f'such as "{self.example}" or a number in {self.unit_word}'


_PER_SECOND = Dimension(s=-1)
_M_RAD = Dimension(m=1, rad=-1)
_M_RAD2 = Dimension(m=1, rad=-2)
_M_RAD3 = Dimension(m=1, rad=-3)
_PER_RAD = Dimension(rad=-1)
_PER_RAD2 = Dimension(rad=-2)
_M = Dimension(m=1)
_KG = Dimension(kg=1)
_S = Dimension(s=1)
_RAD = Dimension(rad=1)
_RAD_S = Dimension(s=-1, rad=1)
_RAD_S2 = Dimension(s=-2, rad=1)
_M_S = Dimension(m=1, s=-1)
_M_S2 = Dimension(m=1, s=-2)
_N = Dimension(m=1, kg=1, s=-2)
_N_M = Dimension(m=2, kg=1, s=-2)
_N_M_RAD = Dimension(m=2, kg=1, s=-2, rad=-1)
_KG_M2 = Dimension(m=2, kg=1)
_KG_M = Dimension(m=-1, kg=1)
_N_PER_M = Dimension(kg=1, s=-2)
_KG_M3 = Dimension(m=-3, kg=1)
_M3 = Dimension(m=3)
_PA = Dimension(m=-1, kg=1, s=-2)
_N_S_M = Dimension(kg=1, s=-1)
_N_M_S = Dimension(m=2, kg=1, s=-1)
_N_M_S_RAD = Dimension(m=2, kg=1, s=-1, rad=-1)
_W = Dimension(m=2, kg=1, s=-3)
_K = Dimension(K=1)
_ONE = Dimension()

LENGTH = Kind("a length", "m", "metres", "0.2 m", _M, 1e-9, 1e6)
ANGLE = Kind("an angle", "rad", "radians", "30 deg", _RAD, 1e-9, 1e7)
MASS = Kind("a mass", "kg", "kilograms", "1000 kg", _KG, 1e-12, 1e12)
TIME = Kind("a time", "s", "seconds", "0.5 s", _S, 1e-9, 1e9)
SPEED = Kind("an angular speed", "rad/s", "radians per second", "1000 rpm", _RAD_S, 1e-9, 1e6)
ANGULAR_ACCELERATION = Kind(
    "an angular acceleration", "rad/s^2", "radians per second squared", "10 rad/s^2", _RAD_S2, 1e-9, 1e12
)
VELOCITY = Kind("a velocity", "m/s", "metres per second", "1.5 m/s", _M_S, 1e-9, 1e6)
ACCELERATION = Kind("an acceleration", "m/s^2", "metres per second squared", "9.81 m/s^2", _M_S2, 1e-9, 1e12)
FORCE = Kind("a force", "N", "newtons", "3.5 kN", _N, 1e-12, 1e12)
TORQUE = Kind("a torque", "N m", "newton metres", "120 N m", _N_M, 1e-15, 1e12, angle_free=True)
ENERGY = Kind("an energy", "J", "joules", "500 J", _N_M, 1e-15, 1e15)
POWER = Kind("a power", "W", "watts", "5.5 kW", _W, 1e-15, 1e12)
INERTIA = Kind(
    "a moment of inertia",
    "kg m^2",
    "kilogram metres squared",
    "0.14 kg m^2",
    _KG_M2,
    1e-18,
    1e15,
    angle_free=True,
)
MASS_PER_LENGTH = Kind("a mass per length", "kg/m", "kilograms per metre", "80 kg/m", _KG_M, 1e-12, 1e9)
SECTION_MODULUS = Kind("a section modulus", "m^3", "cubic metres", "25 cm^3", _M3, 1e-18, 1e6)
DENSITY = Kind("a density", "kg/m^3", "kilograms per cubic metre", "7850 kg/m^3", _KG_M3, 1e-3, 1e6)
PRESSURE = Kind("a pressure", "Pa", "pascals", "210 GPa", _PA, 1e-3, 1e15)
STIFFNESS = Kind("a stiffness", "N/m", "newtons per metre", "2000 N/m", _N_PER_M, 1e-15, 1e15)
TORSIONAL_STIFFNESS = Kind(
    "a torsional stiffness",
    "N m/rad",
    "newton metres per radian",
    "5e4 N m/rad",
    _N_M_RAD,
    1e-12,
    1e18,
    angle_free=True,
)
DAMPING = Kind("a damping", "N s/m", "newton seconds per metre", "300 N s/m", _N_S_M, 1e-12, 1e15)
TORSIONAL_DAMPING = Kind(
    "a torsional damping",
    "N m s/rad",
    "newton metre seconds per radian",
    "4 N m s/rad",
    _N_M_S_RAD,
    1e-15,
    1e15,
    angle_free=True,
)
# Of vibration, counted in cycles; of a shaft it would leave open whether turns or radians are meant.
FREQUENCY = Kind("a frequency", "Hz", "hertz", "50 Hz", _PER_SECOND, 1e-9, 1e6)
TEMPERATURE = Kind("an absolute temperature", "K", "kelvins", "330 K", _K, 1e-3, 1e6)
RATIO = Kind("a ratio", "", "", "90 %", _ONE, 1e-9, 1e9)
# What is counted, such as teeth, or set by its author, such as an exponent: no share of anything.
COUNT = Kind("a number", "", "", "4", _ONE, 1e-9, 1e9)
# Derivatives of a follower's lift, or of its swing, by the angle of the cam.
LIFT_D1 = Kind("a length per cam angle", "m/rad", "metres per radian", "20 mm/rad", _M_RAD, 1e-9, 1e6)
LIFT_D2 = Kind(
    "a length per cam angle squared",
    "m/rad^2",
    "metres per radian squared",
    "50 mm/rad^2",
    _M_RAD2,
    1e-9,
    1e9,
)
LIFT_D3 = Kind(
    "a length per cam angle cubed", "m/rad^3", "metres per radian cubed", "90 mm/rad^3", _M_RAD3, 1e-9, 1e12
)
SWING_D2 = Kind("a number per angle", "1/rad", "per radian", "0.5 1/rad", _PER_RAD, 1e-9, 1e6)
SWING_D3 = Kind(
    "a number per angle squared", "1/rad^2", "per radian squared", "0.9 1/rad^2", _PER_RAD2, 1e-9, 1e9
)
# A number in whatever unit, such as a constant of a formula.
_OF_ANY_KIND = Kind("a number", "", "", "90 %", _ONE, 1e-18, 1e18)

KINDS = (
    LENGTH,
    ANGLE,
    MASS,
    TIME,
    SPEED,
    ANGULAR_ACCELERATION,
    VELOCITY,
    ACCELERATION,
    FORCE,
    TORQUE,
    ENERGY,
    POWER,
    INERTIA,
    MASS_PER_LENGTH,
    SECTION_MODULUS,
    DENSITY,
    PRESSURE,
    STIFFNESS,
    TORSIONAL_STIFFNESS,
    DAMPING,
    TORSIONAL_DAMPING,
    FREQUENCY,
    TEMPERATURE,
    RATIO,
    LIFT_D1,
    LIFT_D2,
    LIFT_D3,
    SWING_D2,
    SWING_D3,
)

_TURN = 2 * math.pi
_DEGREE = math.pi / 180

# Spellings as `_normal` writes them. A test holds every entry against pint.
COMMON: dict[Dimension, dict[str, float]] = {
    _M: {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "dm": 1e-1, "km": 1e3, "um": 1e-6, "in": 0.0254, "ft": 0.3048},
    _RAD: {"rad": 1.0, "mrad": 1e-3, "deg": _DEGREE, "rev": _TURN, "turn": _TURN},
    _KG: {"kg": 1.0, "g": 1e-3, "t": 1e3, "lb": 0.45359237},
    _S: {"s": 1.0, "ms": 1e-3, "min": 60.0, "h": 3600.0},
    _RAD_S: {
        "rad/s": 1.0,
        "rad s^-1": 1.0,
        "deg/s": _DEGREE,
        "rpm": _TURN / 60,
        "rev/min": _TURN / 60,
        "turn/min": _TURN / 60,
        "rev/s": _TURN,
        "turn/s": _TURN,
    },
    _RAD_S2: {"rad/s^2": 1.0, "rad s^-2": 1.0, "deg/s^2": _DEGREE},
    _M_S: {"m/s": 1.0, "mm/s": 1e-3, "m/min": 1 / 60, "km/h": 1 / 3.6, "m s^-1": 1.0},
    _M_S2: {"m/s^2": 1.0, "mm/s^2": 1e-3, "m s^-2": 1.0},
    _N: {"N": 1.0, "kN": 1e3, "MN": 1e6, "mN": 1e-3, "kgf": 9.80665, "kg m/s^2": 1.0},
    _N_M: {
        "N m": 1.0,
        "kN m": 1e3,
        "MN m": 1e6,
        "mN m": 1e-3,
        "N mm": 1e-3,
        "N cm": 1e-2,
        "kgf m": 9.80665,
        "J": 1.0,
        "kJ": 1e3,
        "MJ": 1e6,
        "W s": 1.0,
        "kW h": 3.6e6,
    },
    _N_M_RAD: {"N m/rad": 1.0, "kN m/rad": 1e3, "MN m/rad": 1e6, "N m/deg": 1 / _DEGREE},
    _KG_M2: {"kg m^2": 1.0, "kg cm^2": 1e-4, "kg mm^2": 1e-6, "g cm^2": 1e-7, "g mm^2": 1e-9, "t m^2": 1e3},
    _KG_M: {"kg/m": 1.0, "g/m": 1e-3, "kg/mm": 1e3, "g/mm": 1.0, "t/m": 1e3},
    _M3: {"m^3": 1.0, "dm^3": 1e-3, "cm^3": 1e-6, "mm^3": 1e-9},
    _KG_M3: {"kg/m^3": 1.0, "kg/dm^3": 1e3, "g/cm^3": 1e3, "t/m^3": 1e3},
    _PA: {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "bar": 1e5, "N/mm^2": 1e6, "N/m^2": 1.0},
    _N_PER_M: {"N/m": 1.0, "kN/m": 1e3, "MN/m": 1e6, "N/mm": 1e3, "kN/mm": 1e6},
    _N_S_M: {"N s/m": 1.0, "kN s/m": 1e3, "N s/mm": 1e3, "kg/s": 1.0},
    _N_M_S: {"N m s": 1.0, "kN m s": 1e3},
    _N_M_S_RAD: {"N m s/rad": 1.0, "kN m s/rad": 1e3},
    _W: {"W": 1.0, "kW": 1e3, "MW": 1e6, "hp": 745.6998715822701, "N m/s": 1.0, "J/s": 1.0},
    _PER_SECOND: {"Hz": 1.0, "1/s": 1.0, "s^-1": 1.0, "1/min": 1 / 60, "min^-1": 1 / 60},
    _K: {"K": 1.0},
    _ONE: {"": 1.0, "%": 1e-2},
    _M_RAD: {"m/rad": 1.0, "mm/rad": 1e-3, "mm/deg": 1e-3 / _DEGREE},
    _M_RAD2: {"m/rad^2": 1.0, "mm/rad^2": 1e-3, "mm/deg^2": 1e-3 / _DEGREE**2},
    _M_RAD3: {"m/rad^3": 1.0, "mm/rad^3": 1e-3},
    _PER_RAD: {"1/rad": 1.0, "rad^-1": 1.0, "1/deg": 1 / _DEGREE},
    _PER_RAD2: {"1/rad^2": 1.0, "rad^-2": 1.0},
}

_FACTORS = {text: (factor, dimension) for dimension, row in COMMON.items() for text, factor in row.items()}

_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
# A number without a unit: digits, a point, an exponent.
NUMBER = re.compile(_NUMBER, re.ASCII)
_VALUE = re.compile(rf"({_NUMBER})\s*(.*)", re.DOTALL)
_VALUES = re.compile(rf"({_NUMBER}(?:[\s,;]+{_NUMBER})*)\s*(.*)", re.DOTALL)
_DECIMAL_COMMA = re.compile(r"[+-]?\d+,\d+\s*[^\d\s,]*")
# Longer texts are no unit; the limit keeps pint's parser away from them.
_UNIT = re.compile(r"[A-Za-z_%0-9^/() .-]{1,60}")
# "N/m s": is the second inside the denominator? Readers, and programs, disagree.
_TWO_READINGS = re.compile(r"/\s*[^\s/()]+\s+[^\s/]")
# A power belongs to a unit and is a digit or two, once: pint would work out 9^9^9, and with it a day.
_POWERS = re.compile(r"(?:[^^]|[A-Za-z_%)] ?\^ ?\(?-?\d{1,2}\)?(?![\d^.(]))*")
_BARE_POWER = re.compile(r"[A-Za-z]\d")
# Scales of temperature with a zero of their own.
_OTHER_ZERO = re.compile(r"(deg ?)?[CF]|celsius|fahrenheit|degree_[a-z]+", re.IGNORECASE)

# How Python writes exponents, 1e-09 and 1e+06.
_ZEROS = re.compile(r"e\+?(-?)0*")

# A value is shown on one line of a terminal, together with a few words.
_SHOWN = 80

# Longer whole numbers are told by their length.
_WHOLE_BITS = 256

_MULTIPLY = str.maketrans({"·": " ", "⋅": " ", "∙": " ", "*": " ", "µ": "u", "μ": "u", "°": "deg", "−": "-"})
_SUPERSCRIPTS = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")
_SUPERSCRIPT_RUN = re.compile(r"[⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+")


def parse(value: object, kind: Kind) -> float:
    """Read a number (SI) or a text with a unit as a quantity of one kind.

    Parameters
    ----------
    value : object
        A real number, taken as SI, or a text such as ``"0.2 m"``.
    kind : Kind
        The quantity that is asked for.

    Returns
    -------
    float
        The value in the SI unit of ``kind``, finite.

    Raises
    ------
    UnitError
        The value is no such quantity: wrong type or dimension, unknown unit, beyond the range of the kind.

    Examples
    --------
    >>> parse("0.5 kN", FORCE), parse(3, FORCE)
    (500.0, 3.0)
    """
    if isinstance(value, str):
        number, unit = _split(value, kind)
        return _in_range(float(number) * _factor(unit, kind, value), value, kind)
    if isinstance(value, bool) or not isinstance(value, Real):
        raise _wrong(value, kind)
    try:
        return _in_range(float(value), value, kind)
    except OverflowError:
        raise _wrong(value, kind, range_words(kind)) from None


def parse_any(value: object) -> float:
    """Read a number, or a text with a unit of whatever quantity.

    Parameters
    ----------
    value : object
        A real number, taken as SI, or a text such as ``"200 N/m"``.

    Returns
    -------
    float
        The value in the coherent SI unit of its quantity, finite.

    Raises
    ------
    UnitError
        The value is no number, or its unit is not known.

    Examples
    --------
    >>> parse_any("2 kN/m"), parse_any(3)
    (2000.0, 3.0)
    """
    if not isinstance(value, str):
        return parse(value, _OF_ANY_KIND)
    number, unit = _split(value, _OF_ANY_KIND)
    text = _normal(unit)
    known = _FACTORS.get(text) or _from_pint(text)
    if known is None:
        raise _wrong(value, _OF_ANY_KIND, _unknown_unit(unit, text))
    return _in_range(float(number) * known[0], value, _OF_ANY_KIND)


def parse_list(value: object, kind: Kind) -> list[float]:
    """Read a list of numbers and texts, or one text with one unit, as quantities of one kind.

    Parameters
    ----------
    value : object
        ``[0, 0.1]``, ``["0 m", "10 cm"]`` or ``"0, 10 cm"``; an array of numbers too.
    kind : Kind
        The quantity that is asked for.

    Returns
    -------
    list of float
        The values in the SI unit of ``kind``.

    Raises
    ------
    UnitError
        One of the values is no such quantity.

    Examples
    --------
    >>> parse_list("0, 10, 25 cm", LENGTH)
    [0.0, 0.1, 0.25]
    """
    return [parse(item, kind) for item in _items(value, kind)]


def to_text(value: float, kind: Kind) -> str:
    """Write an SI value with its unit, so that `parse` gives back the very same float.

    Parameters
    ----------
    value : float
        The value in the SI unit of ``kind``.
    kind : Kind
        The quantity that it is.

    Returns
    -------
    str
        Such as ``"0.2 m"``.

    Examples
    --------
    >>> to_text(0.2, LENGTH)
    '0.2 m'
    """
    return f"{float(value)!r} {kind.unit}".removesuffix(" ").replace(".0 ", " ")


def worded(value: float, kind: Kind) -> str:
    """Write an SI value for a message, with its unit: angles in degrees, all else in SI.

    Parameters
    ----------
    value : float
        The value in the SI unit of ``kind``.
    kind : Kind
        The quantity that it is.

    Returns
    -------
    str
        With six digits, such as ``"30 deg"``.
    """
    if kind is ANGLE:
        return f"{math.degrees(value):.6g} deg"
    return f"{value:.6g} {kind.unit}".removesuffix(" ")


def _split(text: str, kind: Kind) -> tuple[str, str]:
    """The number and the unit of a text."""
    plain = text.strip().replace("−", "-")
    match = _VALUE.fullmatch(plain)
    if _DECIMAL_COMMA.fullmatch(plain):
        raise _wrong(text, kind, "write the decimal point as a point, not as a comma")
    if match is None:
        raise _wrong(text, kind)
    if not match[2] and kind.unit:
        raise _wrong(text, kind, f'add the unit ("{plain} {kind.unit}"), or remove the quotes')
    return match[1], match[2]


def _items(value: object, kind: Kind) -> Sequence[object]:
    """The separate values of a list, of an array, or of one text with one unit."""
    if isinstance(value, str):
        match = _VALUES.fullmatch(value.strip().replace("−", "-"))
        if match is None:
            raise _wrong(value, kind, many=True)
        return [f"{number} {match[2]}" for number in re.split(r"[\s,;]+", match[1])]
    listed = value.tolist() if hasattr(value, "tolist") else value
    if not isinstance(listed, list | tuple):
        raise _wrong(value, kind, many=True)
    return listed


def _factor(unit: str, kind: Kind, found: object) -> float:
    """What a value in this unit is multiplied by to be in SI."""
    text = _normal(unit)
    known = _FACTORS.get(text) or _from_pint(text)
    if known is None:
        raise _wrong(found, kind, _unknown_unit(unit, text))
    factor, dimension = known
    if not _fits(dimension, kind):
        raise _wrong(found, kind, _other_quantity(unit, dimension, kind))
    return factor


def _normal(unit: str) -> str:
    """One spelling for the many ways to write a product and a power."""
    text = _SUPERSCRIPT_RUN.sub(lambda run: "^" + run[0].translate(_SUPERSCRIPTS), unit)
    text = text.replace("**", "^").translate(_MULTIPLY)
    return re.sub(r"\s*([/^])\s*", r"\1", " ".join(text.split()))


def _fits(dimension: Dimension, kind: Kind) -> bool:
    """Whether a unit of this dimension can measure the quantity."""
    if kind.angle_free:
        return dimension._replace(rad=0) == kind.dimension._replace(rad=0) and dimension.rad <= 0
    return dimension == kind.dimension


@cache
def _from_pint(text: str) -> tuple[float, Dimension] | None:
    """Factor and dimension of a less common unit; None if pint does not know it either."""
    if not _UNIT.fullmatch(text) or _TWO_READINGS.search(text) or not _POWERS.fullmatch(text):
        return None
    registry = _registry()
    try:
        unit = registry.parse_units(text.replace("%", "percent"))
        if registry.Quantity(0.0, unit).to_base_units().magnitude != 0.0:
            return None
        found: tuple[Any, Any] = registry.get_base_units(unit)
    except Exception:  # whatever pint's tokenizer and its arithmetic meet in a text that is no unit
        return None
    factor, base = found
    powers: dict[str, Any] = dict(base._units)
    names = ("meter", "kilogram", "second", "radian", "kelvin")
    dimension = [powers.pop(name, 0) for name in names]
    return None if powers else (float(factor), Dimension(*dimension))


@cache
def _registry() -> pint.UnitRegistry[Any]:
    """Pint's table of units, loaded at the first spelling that needs it."""
    import pint

    registry: pint.UnitRegistry[Any] = pint.UnitRegistry()
    registry.define("@alias turn = rev")
    return registry


def _unknown_unit(unit: str, text: str) -> str:
    """What to change in a unit that nobody knows."""
    if _OTHER_ZERO.fullmatch(text):
        return (
            f"{show(unit)} does not count from absolute zero: write kelvins, 273.15 more than degrees Celsius"
        )
    if _TWO_READINGS.search(text):
        return f'{show(unit)} can be read in two ways: put one "/" last, or use parentheses, as in N/(m s)'
    if not _POWERS.fullmatch(text):
        return f"{show(unit)}: a power is one whole number after a unit, as in m^2"
    if _BARE_POWER.search(text):
        return f"{show(unit)} is not a unit: write powers as m^2 or m²"
    return f"{show(unit)} is not a known unit"


def _other_quantity(unit: str, dimension: Dimension, kind: Kind) -> str:
    """What the unit measures instead."""
    if kind is SPEED and dimension == _PER_SECOND:
        return f'"{unit}" does not say whether it counts turns or radians: write rpm, rev/s or rad/s'
    other = next((known.noun for known in KINDS if known.dimension == dimension), "")
    return f'"{unit}" is a unit of {other}' if other else f'"{unit}" measures something else'


def _in_range(number: float, found: object, kind: Kind) -> float:
    """The number itself, unless it is larger than any of its kind, infinite, or not a number."""
    if not math.isfinite(number):
        raise _wrong(found, kind, "the number must be finite")
    if abs(number) > kind.most:
        raise _wrong(found, kind, range_words(kind))
    return number


def range_words(kind: Kind) -> str:
    """The range of a kind, in words.

    Parameters
    ----------
    kind : Kind
        The quantity.

    Returns
    -------
    str
        Such as ``"a length is between 1e-9 and 1e6 m in size"``.
    """
    least, most = size_words(kind)
    return f"{kind.word} is between {least} and {most} {kind.unit}".rstrip() + " in size"


def size_words(kind: Kind) -> tuple[str, str]:
    """The smallest and the largest size of a kind, as written by hand: ``("1e-9", "1e6")``.

    Parameters
    ----------
    kind : Kind
        The quantity.
    """
    least, most = (_ZEROS.sub(r"e\1", f"{size:.0e}") for size in (kind.least, kind.most))
    return least, most


def show(value: object) -> str:
    """Write a value as the user may have written it, shortened to fit in a line."""
    if isinstance(value, list | tuple | dict):
        return "a table" if isinstance(value, dict) else "a list"
    if isinstance(value, int) and value.bit_length() > _WHOLE_BITS:
        # Python refuses to write numbers of thousands of digits.
        return f"a whole number of about {int(value.bit_length() * math.log10(2)) + 1} digits"
    # What lies beyond the part that is shown costs nothing.
    text = f'"{value[: 4 * _SHOWN]}"' if isinstance(value, str) else str(value)
    text = " ".join(text.lower().split() if isinstance(value, bool) else text.split())
    text = plain(text)
    return text if len(text) <= _SHOWN else text[: _SHOWN - 3] + "..."


def _wrong(value: object, kind: Kind, remedy: str = "", *, many: bool = False) -> UnitError:
    """The error that says what was found and what a quantity of this kind looks like."""
    expected = QuantityList(kind).expected if many else kind.expected
    return UnitError(Problem(found=show(value), expected=expected, remedy=remedy))


def _reported(problem: Problem, expected: str) -> PydanticCustomError:
    """The same problem in the form that pydantic collects with all others."""
    context = {"found": problem.found, "expected": expected, "remedy": problem.remedy}
    return PydanticCustomError("problem", "found {found}, expected {expected}", context)


@dataclass(frozen=True, slots=True, eq=False)
class Bound:
    """Limits of a quantity: in words, as JSON Schema keywords, and as a test of an SI value."""

    words: str
    schema: Mapping[str, float]
    holds: Callable[[float], bool]


ANY = Bound("", {}, lambda value: True)
POSITIVE = Bound(" greater than 0,", {"exclusiveMinimum": 0}, lambda value: value > 0)
NOT_NEGATIVE = Bound(" of 0 or more,", {"minimum": 0}, lambda value: value >= 0)
FRACTION = Bound(" above 0 and up to 1,", {"exclusiveMinimum": 0, "maximum": 1}, lambda value: 0 < value <= 1)
INSIDE_ONE = Bound(
    " between 0 and 1,", {"exclusiveMinimum": 0, "exclusiveMaximum": 1}, lambda value: 0 < value < 1
)
ACUTE = Bound(
    " between -90 and 90 deg,",
    {"exclusiveMinimum": -math.pi / 2, "exclusiveMaximum": math.pi / 2},
    lambda value: -math.pi / 2 < value < math.pi / 2,
)


@dataclass(frozen=True, slots=True)
class Quantity:
    """Mark of a field that holds one quantity: accepts a number or a text with a unit, stores SI."""

    kind: Kind
    bound: Bound = ANY

    @property
    def expected(self) -> str:
        """What belongs into the field."""
        return f"{self.kind.word}{self.bound.words} {self.kind.forms}"

    def read(self, value: object) -> float:
        """Read one value, for pydantic."""
        try:
            number = parse(value, self.kind)
        except UnitError as error:
            raise _reported(error.problem, self.expected) from None
        if not self.holds(number):
            raise _reported(Problem(found=show(value), remedy=self.remedy(number)), self.expected)
        return 0.0 if self._is_speck(number) else number

    def holds(self, number: float) -> bool:
        """Whether an SI value is such a quantity: finite, within its bound and the range of its kind."""
        in_bound = math.isfinite(number) and self.bound.holds(number)
        return in_bound and abs(number) <= self.kind.most and not self._is_nothing(number)

    def remedy(self, number: float) -> str:
        """The range of the kind, if that is what an SI value is beyond; empty if its bound says it all."""
        if not math.isfinite(number):
            return "the number must be finite"
        beyond = abs(number) > self.kind.most or self._is_nothing(number)
        return range_words(self.kind) if beyond else ""

    def _is_speck(self, number: float) -> bool:
        """Whether a size that cannot be negative is too small to count."""
        return 0 < number < self.kind.least and not self.bound.holds(-number)

    def _is_nothing(self, number: float) -> bool:
        """Whether it is so where zero is no answer either."""
        return self._is_speck(number) and not self.bound.holds(0.0)

    def steps(self) -> CoreSchema:
        """The steps of validation: our reader, then a float."""
        return core_schema.no_info_before_validator_function(self.read, core_schema.float_schema())

    def json_schema(self) -> dict[str, Any]:
        """What an editor may offer for the value."""
        noun, unit = self.kind.noun, self.kind.unit_word
        limits = {"minimum": -self.kind.most, "maximum": self.kind.most, **self.bound.schema}
        number = {"type": "number", "description": f"{noun} in {unit}" if unit else noun, **limits}
        text = {"type": "string", "description": f"{noun} with its unit", "examples": [self.kind.example]}
        return {"anyOf": [number, text]}

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return self.steps()

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        return self.json_schema()


def positive(kind: Kind) -> Quantity:
    """Mark of a field that holds one quantity greater than zero."""
    return Quantity(kind, POSITIVE)


def not_negative(kind: Kind) -> Quantity:
    """Mark of a field that holds one quantity of zero or more."""
    return Quantity(kind, NOT_NEGATIVE)


@dataclass(frozen=True, slots=True)
class QuantityList:
    """Mark of a field that holds several values of one quantity, stored as a tuple of SI floats."""

    kind: Kind

    @property
    def expected(self) -> str:
        """What belongs into the field."""
        return f"a list; each entry {self.kind.expected}"

    def read(self, value: object) -> Sequence[object]:
        """Take a list, or a text with several numbers, apart, for pydantic."""
        try:
            return _items(value, self.kind)
        except UnitError as error:
            raise _reported(error.problem, error.problem.expected) from None

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        entries = core_schema.tuple_variable_schema(Quantity(self.kind).steps())
        return core_schema.no_info_before_validator_function(self.read, entries)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        many = {"type": "array", "items": Quantity(self.kind).json_schema()}
        return {
            "anyOf": [
                many,
                {"type": "string", "description": f'several values and one unit: "0, 1 {self.kind.unit}"'},
            ]
        }


@dataclass(frozen=True, slots=True)
class AnyQuantity:
    """Mark of a field that holds a number of whatever quantity: accepts it in any unit, stores SI."""

    @property
    def expected(self) -> str:
        """What belongs into the field."""
        return 'a number, or a text with any unit, such as "200 N/m"'

    def read(self, value: object) -> float:
        """Read one value, for pydantic."""
        try:
            return parse_any(value)
        except UnitError as error:
            raise _reported(error.problem, self.expected) from None

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_before_validator_function(self.read, core_schema.float_schema())

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        text = {"type": "string", "description": "a number with its unit", "examples": ["200 N/m"]}
        return {"anyOf": [{"type": "number", "description": "a number in SI units"}, text]}


Length = Annotated[float, Quantity(LENGTH)]
Angle = Annotated[float, Quantity(ANGLE)]
Mass = Annotated[float, Quantity(MASS)]
Time = Annotated[float, Quantity(TIME)]
Speed = Annotated[float, Quantity(SPEED)]
AngularAcceleration = Annotated[float, Quantity(ANGULAR_ACCELERATION)]
Velocity = Annotated[float, Quantity(VELOCITY)]
Acceleration = Annotated[float, Quantity(ACCELERATION)]
Force = Annotated[float, Quantity(FORCE)]
Torque = Annotated[float, Quantity(TORQUE)]
Energy = Annotated[float, Quantity(ENERGY)]
Power = Annotated[float, Quantity(POWER)]
Inertia = Annotated[float, Quantity(INERTIA)]
MassPerLength = Annotated[float, Quantity(MASS_PER_LENGTH)]
Stiffness = Annotated[float, Quantity(STIFFNESS)]
TorsionalStiffness = Annotated[float, Quantity(TORSIONAL_STIFFNESS)]
Damping = Annotated[float, Quantity(DAMPING)]
TorsionalDamping = Annotated[float, Quantity(TORSIONAL_DAMPING)]
Ratio = Annotated[float, Quantity(RATIO)]

Lengths = Annotated[tuple[float, ...], QuantityList(LENGTH)]
Angles = Annotated[tuple[float, ...], QuantityList(ANGLE)]
Speeds = Annotated[tuple[float, ...], QuantityList(SPEED)]
Velocities = Annotated[tuple[float, ...], QuantityList(VELOCITY)]
Forces = Annotated[tuple[float, ...], QuantityList(FORCE)]
Pressures = Annotated[tuple[float, ...], QuantityList(PRESSURE)]
Torques = Annotated[tuple[float, ...], QuantityList(TORQUE)]
