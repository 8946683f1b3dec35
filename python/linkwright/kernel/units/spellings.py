"""Units as people write them: one spelling for each product, and its factor to SI.

`COMMON` holds the usual spellings, so that most files are read without loading pint, which costs more than
everything else together; any other spelling goes to pint. A text is brought into one form first: products are
written with spaces, powers with ``^``, and what is often run together (``Nm``, ``kgm²``) is taken apart.
"""

from __future__ import annotations

import math
import re
from functools import cache
from typing import TYPE_CHECKING, Any

from linkwright.kernel.errors import show
from linkwright.kernel.units.kinds import FREQUENCY, KINDS, MASS, MASS_PER_LENGTH, SPEED, Dimension, Kind

if TYPE_CHECKING:
    import pint

_TURN = 2 * math.pi
_DEGREE = math.pi / 180

# SI unit → spellings as `normal` writes them. A test holds every entry against pint.
COMMON: dict[str, dict[str, float]] = {
    "m": {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "dm": 1e-1, "km": 1e3, "um": 1e-6, "in": 0.0254, "ft": 0.3048},
    "rad": {"rad": 1.0, "mrad": 1e-3, "deg": _DEGREE, "rev": _TURN, "turn": _TURN},
    "kg": {"kg": 1.0, "g": 1e-3, "t": 1e3, "lb": 0.45359237},
    "s": {"s": 1.0, "ms": 1e-3, "min": 60.0, "h": 3600.0},
    "rad/s": {
        "rad/s": 1.0,
        "rad s^-1": 1.0,
        "deg/s": _DEGREE,
        "rpm": _TURN / 60,
        "rev/min": _TURN / 60,
        "turn/min": _TURN / 60,
        "rev/s": _TURN,
        "turn/s": _TURN,
    },
    "rad/s^2": {"rad/s^2": 1.0, "rad s^-2": 1.0, "deg/s^2": _DEGREE},
    "m/s": {"m/s": 1.0, "mm/s": 1e-3, "m/min": 1 / 60, "km/h": 1 / 3.6, "m s^-1": 1.0},
    "m/s^2": {"m/s^2": 1.0, "mm/s^2": 1e-3, "m s^-2": 1.0},
    "N": {
        "N": 1.0,
        "kN": 1e3,
        "MN": 1e6,
        "mN": 1e-3,
        "kgf": 9.80665,
        "lbf": 4.4482216152605,
        "kg m/s^2": 1.0,
    },
    "N m": {
        "N m": 1.0,
        "kN m": 1e3,
        "MN m": 1e6,
        "mN m": 1e-3,
        "N mm": 1e-3,
        "N cm": 1e-2,
        "kgf m": 9.80665,
        "ft lbf": 1.3558179483314004,
        "in lbf": 0.1129848290276167,
        "J": 1.0,
        "kJ": 1e3,
        "MJ": 1e6,
        "W s": 1.0,
        "kW h": 3.6e6,
    },
    "N m/rad": {"N m/rad": 1.0, "kN m/rad": 1e3, "MN m/rad": 1e6, "N m/deg": 1 / _DEGREE, "N mm/rad": 1e-3},
    "kg m^2": {"kg m^2": 1.0, "kg cm^2": 1e-4, "kg mm^2": 1e-6, "g cm^2": 1e-7, "g mm^2": 1e-9, "t m^2": 1e3},
    "kg/m": {"kg/m": 1.0, "g/m": 1e-3, "kg/mm": 1e3, "g/mm": 1.0, "t/m": 1e3},
    "m^3": {"m^3": 1.0, "dm^3": 1e-3, "cm^3": 1e-6, "mm^3": 1e-9},
    "m^3/s": {
        "m^3/s": 1.0,
        "l/min": 1e-3 / 60,
        "l/s": 1e-3,
        "cm^3/s": 1e-6,
        "m^3/h": 1 / 3600,
        "m^3/d": 1 / 86_400,
        "bbl/d": 0.158987294928 / 86_400,
    },
    "kg/m^3": {"kg/m^3": 1.0, "kg/dm^3": 1e3, "g/cm^3": 1e3, "t/m^3": 1e3},
    "Pa": {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "bar": 1e5, "N/mm^2": 1e6, "N/m^2": 1.0},
    "N/m": {"N/m": 1.0, "kN/m": 1e3, "MN/m": 1e6, "N/mm": 1e3, "kN/mm": 1e6},
    "N s/m": {"N s/m": 1.0, "kN s/m": 1e3, "N s/mm": 1e3, "kg/s": 1.0},
    "N m s": {"N m s": 1.0, "kN m s": 1e3},
    "N m s/rad": {"N m s/rad": 1.0, "kN m s/rad": 1e3},
    "W": {"W": 1.0, "kW": 1e3, "MW": 1e6, "hp": 745.6998715822701, "N m/s": 1.0, "J/s": 1.0},
    "Hz": {"Hz": 1.0, "1/s": 1.0, "s^-1": 1.0, "1/min": 1 / 60, "min^-1": 1 / 60},
    "K": {"K": 1.0},
    "": {"": 1.0, "%": 1e-2},
    "m/rad": {"m/rad": 1.0, "mm/rad": 1e-3, "mm/deg": 1e-3 / _DEGREE},
    "m/rad^2": {"m/rad^2": 1.0, "mm/rad^2": 1e-3, "mm/deg^2": 1e-3 / _DEGREE**2},
    "m/rad^3": {"m/rad^3": 1.0, "mm/rad^3": 1e-3},
    "1/rad": {"1/rad": 1.0, "rad^-1": 1.0, "1/deg": 1 / _DEGREE},
    "1/rad^2": {"1/rad^2": 1.0, "rad^-2": 1.0},
}

# What is often run together, word by word. Where two readings exist (N m s, N ms) there is no entry.
_TOGETHER = {
    "Nm": "N m",
    "kNm": "kN m",
    "MNm": "MN m",
    "mNm": "mN m",
    "Nmm": "N mm",
    "Ncm": "N cm",
    "Ns": "N s",
    "kNs": "kN s",
    "kgm": "kg m",
    "kgcm": "kg cm",
    "kgmm": "kg mm",
    "gcm": "g cm",
    "gmm": "g mm",
    "tm": "t m",
    "daNm": "daN m",
    "kgfm": "kgf m",
    "kpm": "kgf m",
    "kp": "kgf",
    "ftlb": "ft lb",
    "lbft": "lb ft",
    "inlb": "in lb",
    "lbin": "lb in",
    "ftlbf": "ft lbf",
    "inlbf": "in lbf",
    "lbm": "lb",
    "Ws": "W s",
    "Wh": "W h",
    "kWh": "kW h",
    "RPM": "rpm",
}

# Whole units in other hands' spelling. A pound in a torque is a pound of force; newton seconds per radian
# would be no damping of anything that turns, so the metre is certain.
_OTHERWISE = {
    "r/min": "rev/min",
    "r/s": "rev/s",
    "U/min": "rev/min",
    "r.p.m.": "rpm",
    "oz in": "ozf in",
    "in oz": "ozf in",
    "PS": "metric_horsepower",
    "bbl": "oil_bbl",
    "ft lb": "ft lbf",
    "lb ft": "ft lbf",
    "lbf ft": "ft lbf",
    "in lb": "in lbf",
    "lb in": "in lbf",
    "lbf in": "in lbf",
    "Nms/rad": "N m s/rad",
    "kNms/rad": "kN m s/rad",
}

_FACTORS = {
    text: (factor, Dimension.of(unit)) for unit, row in COMMON.items() for text, factor in row.items()
}

# Longer texts are no unit; the limit keeps pint's parser away from them.
_UNIT_LETTERS = 60
_UNIT = re.compile(rf"[A-Za-z_%0-9^/() .-]{{1,{_UNIT_LETTERS}}}")
# "N/m s": is the second inside the denominator? Readers, and programs, disagree.
_TWO_READINGS = re.compile(r"/\s*[^\s/()]+\s+[^\s/]")
# A power belongs to a unit and is a digit or two, once: pint would work out 9^9^9, and with it a day.
_POWERS = re.compile(r"(?:[^^]|[A-Za-z_%)] ?\^ ?\(?-?\d{1,2}\)?(?![\d^.(]))*")
# m2, s-1: a power without its sign, behind a unit and before no further letter (which H2O has).
_BARE_POWER = re.compile(r"(?<=[A-Za-z])([2-4]|-[1-4])(?![\dA-Za-z.])")
# Scales of temperature with a zero of their own.
_OTHER_ZERO = re.compile(r"(deg ?)?[CF]|celsius|fahrenheit|degree_[a-z]+", re.IGNORECASE)

_MULTIPLY = str.maketrans({"·": " ", "⋅": " ", "∙": " ", "*": " ", "µ": "u", "μ": "u", "°": "deg", "−": "-"})
_SUPERSCRIPTS = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")
_SUPERSCRIPT_RUN = re.compile(r"[⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+")
_WORD = re.compile(r"[A-Za-z]+")
_POUND = re.compile(r"\blb\b")
# Limits about a size, or a class of ISO 286 behind it.
_TOLERANCE = re.compile(r"±|^[Hh]\d{1,2}$")
# Newton metre seconds, or newton milliseconds?
_NMS = re.compile(r"\bk?Nms\b")
_HYPHEN = re.compile(r"(?<=[A-Za-z])-(?=[A-Za-z])")


def normal(unit: str) -> str:
    """One spelling for the many ways to write a product and a power."""
    text = _SUPERSCRIPT_RUN.sub(lambda run: "^" + run[0].translate(_SUPERSCRIPTS), unit)
    text = _HYPHEN.sub(" ", _in_latin(text).replace("**", "^").translate(_MULTIPLY))
    text = _BARE_POWER.sub(r"^\1", text)
    text = re.sub(r"\s*([/^])\s*", r"\1", " ".join(text.split()))
    text = _WORD.sub(lambda word: _TOGETHER.get(word[0], word[0]), text)
    return _OTHERWISE.get(text, text)


# Words of Ukrainian letters, of which its units are.
_CYRILLIC = re.compile(r"[А-Яа-яІіЇїЄєҐґ]+")


def _in_latin(text: str) -> str:
    """A unit in Ukrainian letters as SI writes it: кг м², кН·м, Нм, об/хв."""
    if not _CYRILLIC.search(text):
        return text
    symbols = _ukrainian()
    for written, symbol in symbols.items():
        if "/" in written:
            text = text.replace(written, symbol)
    return _CYRILLIC.sub(lambda word: _product(word[0], symbols), text)


@cache
def _ukrainian() -> dict[str, str]:
    """Symbols of units by how Ukrainian reports write them."""
    from linkwright.kernel.reader.language import language

    return {written: symbol for symbol, written in language("uk").units.items() if symbol != "per"}


def _product(word: str, symbols: dict[str, str]) -> str:
    """A word as one symbol, or as two that are run together; as it is if it is neither."""
    if word in symbols:
        return symbols[word]
    for at in range(1, len(word)):
        first, second = symbols.get(word[:at]), symbols.get(word[at:])
        if first and second:
            return f"{first} {second}"
    return word


def factor_of(unit: str) -> tuple[float, Dimension] | None:
    """Factor to SI and dimension of a unit; None if nobody knows it."""
    if len(unit) > _UNIT_LETTERS:
        return None
    text = normal(unit)
    return _FACTORS.get(text) or _from_pint(text)


# Energies: joules, watts over a time, and what chemists and physicists use.
_ENERGY = re.compile(r"J|W|cal|Btu|eV")


def is_energy(unit: str) -> bool:
    """Whether a unit of the dimension of torques is one of energies by its spelling: kJ and kW h are."""
    return _ENERGY.search(normal(unit)) is not None


def fits(dimension: Dimension, kind: Kind) -> bool:
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
        reduced: tuple[Any, Any] = registry.get_base_units(unit)
    except Exception:  # whatever pint's tokenizer and its arithmetic meet in a text that is no unit
        # silent: a text that pint does not know is reported with the units that are known
        return None
    factor, base = reduced
    powers: dict[str, Any] = dict(base._units)
    names = ("meter", "kilogram", "second", "radian", "kelvin", "ampere")
    dimension = [powers.pop(name, 0) for name in names]
    return None if powers else (float(factor), Dimension(*dimension))


@cache
def _registry() -> pint.UnitRegistry[Any]:
    """Pint's table of units, loaded at the first spelling that needs it."""
    import pint

    registry: pint.UnitRegistry[Any] = pint.UnitRegistry()
    registry.define("@alias turn = rev")
    return registry


def unknown(unit: str) -> str:
    """What to change in a unit that nobody knows."""
    if _TOLERANCE.search(unit):
        return (
            "a tolerance belongs behind the value of an entry of the machine file, "
            '"0.2 m ± 0.2 mm" or "200 H7", or into [study.variables.NAME]'
        )
    if len(unit) > _UNIT_LETTERS:
        return f"{show(unit)} is not a known unit"
    text = normal(unit)
    if _OTHER_ZERO.fullmatch(text):
        return (
            f"{show(unit)} does not count from absolute zero: write kelvins, 273.15 more than degrees Celsius"
        )
    if _TWO_READINGS.search(text):
        return f'{show(unit)} can be read in two ways: put one "/" last, or use parentheses, as in N/(m s)'
    if _NMS.search(text):
        return f"{show(unit)} can be read in two ways: write N m s, with spaces"
    if not _POWERS.fullmatch(text):
        return f"{show(unit)}: a power is one whole number after a unit, as in m^2"
    letters = text.replace(" ", "").casefold()
    alike = [known for known in _FACTORS if known.replace(" ", "").casefold() == letters]
    asked = f"; did you mean {' or '.join(alike)}?" if alike else ""
    return f"{show(unit)} is not a known unit{asked}"


def other_quantity(unit: str, dimension: Dimension, kind: Kind) -> str:
    """What the unit measures instead."""
    if kind is SPEED and dimension == FREQUENCY.dimension:
        return (
            f"{show(unit)} does not say whether it counts revolutions or radians: write rpm, rev/s or rad/s"
        )
    if _POUND.search(unit) and dimension in (MASS.dimension, MASS_PER_LENGTH.dimension):
        return f"{show(unit)} counts pounds of mass: a pound of force is lbf"
    other = next((known.noun for known in KINDS if known.dimension == dimension), "")
    return f"{show(unit)} is a unit of {other}" if other else f"{show(unit)} measures something else"
