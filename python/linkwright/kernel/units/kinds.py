"""Physical quantities as a machine file holds them: word, SI unit, dimension, and the range of sizes.

An angle is kept apart from a plain number: a speed in ``1/min`` or ``Hz`` is refused, because books differ on
whether that counts revolutions or radians.

Every kind has a range of sizes, from far below the smallest instrument to far above the largest plant, so
that products of a dozen numbers neither overflow nor vanish. It is declared here with the kind, held by every
reader, and printed in `docs/units.md`.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

# How Python writes exponents, 1e-09 and 1e+06.
_ZEROS = re.compile(r"e\+?(-?)0*")


class Dimension(NamedTuple):
    """Exponents of metre, kilogram, second, radian, kelvin and ampere."""

    m: int = 0
    kg: int = 0
    s: int = 0
    rad: int = 0
    K: int = 0
    A: int = 0

    @classmethod
    def of(cls, unit: str) -> Dimension:
        """Of a coherent SI unit such as "N m s/rad": symbols and their powers, one stroke."""
        above, _, below = unit.partition("/")
        total = [0] * len(cls._fields)
        for text, sign in ((above, 1), (below, -1)):
            for factor in text.split():
                symbol, _, power = factor.partition("^")
                exponents = _SYMBOLS[symbol]
                total = [t + sign * int(power or 1) * e for t, e in zip(total, exponents, strict=True)]
        return cls(*total)


_SYMBOLS = {
    "1": Dimension(),
    "m": Dimension(m=1),
    "kg": Dimension(kg=1),
    "s": Dimension(s=1),
    "rad": Dimension(rad=1),
    "K": Dimension(K=1),
    "A": Dimension(A=1),
    "N": Dimension(m=1, kg=1, s=-2),
    "Pa": Dimension(m=-1, kg=1, s=-2),
    "J": Dimension(m=2, kg=1, s=-2),
    "W": Dimension(m=2, kg=1, s=-3),
    "Hz": Dimension(s=-1),
}


@dataclass(frozen=True)
class Kind:
    """A physical quantity: its word, its SI unit, and an example for messages."""

    word: str  # what it is called, with its article: "a length"
    unit: str  # the coherent SI unit in a spelling that `parse` reads
    unit_word: str  # the same in words, in the plural
    example: str  # a text that is valid for it
    # Smallest size that counts, and largest [SI unit].
    least: float
    most: float
    # The radian may be written or left out: N·m/rad and N·m are the same torque per angle.
    angle_free: bool = False

    @cached_property
    def dimension(self) -> Dimension:
        """Of the SI unit."""
        return Dimension.of(self.unit)

    @property
    def noun(self) -> str:
        """The word without its article."""
        return self.word.split(" ", 1)[1]

    @property
    def plural(self) -> str:
        """The noun of several: velocities, moments of inertia."""
        words = re.split(r"(?= of | per )", self.noun, maxsplit=1)
        words[0] = re.sub("y$", "ie", words[0]) + ("es" if words[0].endswith("s") else "s")
        return "".join(words)

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


LENGTH = Kind("a length", "m", "metres", "0.2 m", 1e-9, 1e6)
ANGLE = Kind("an angle", "rad", "radians", "30 deg", 1e-9, 1e7)
MASS = Kind("a mass", "kg", "kilograms", "1000 kg", 1e-12, 1e12)
TIME = Kind("a time", "s", "seconds", "0.5 s", 1e-9, 1e9)
SPEED = Kind("an angular speed", "rad/s", "radians per second", "1000 rpm", 1e-9, 1e6)
ANGULAR_ACCELERATION = Kind(
    "an angular acceleration", "rad/s^2", "radians per second squared", "10 rad/s^2", 1e-9, 1e12
)
VELOCITY = Kind("a velocity", "m/s", "metres per second", "1.5 m/s", 1e-9, 1e6)
ACCELERATION = Kind("an acceleration", "m/s^2", "metres per second squared", "9.81 m/s^2", 1e-9, 1e12)
FORCE = Kind("a force", "N", "newtons", "3.5 kN", 1e-12, 1e12)
TORQUE = Kind("a torque", "N m", "newton metres", "120 N m", 1e-15, 1e12, angle_free=True)
ENERGY = Kind("an energy", "J", "joules", "500 J", 1e-15, 1e15)
POWER = Kind("a power", "W", "watts", "5.5 kW", 1e-15, 1e12)
INERTIA = Kind(
    "a moment of inertia",
    "kg m^2",
    "kilogram metres squared",
    "0.14 kg m^2",
    1e-18,
    1e15,
    angle_free=True,
)
MASS_PER_LENGTH = Kind("a mass per length", "kg/m", "kilograms per metre", "80 kg/m", 1e-12, 1e9)
AREA = Kind("an area", "m^2", "square metres", "12 cm^2", 1e-18, 1e9)
AREA_MOMENT = Kind("a second moment of area", "m^4", "metres to the fourth power", "340 cm^4", 1e-30, 1e12)
SECTION_MODULUS = Kind("a section modulus", "m^3", "cubic metres", "25 cm^3", 1e-18, 1e6)
DENSITY = Kind("a density", "kg/m^3", "kilograms per cubic metre", "7850 kg/m^3", 1e-3, 1e6)
PRESSURE = Kind("a pressure", "Pa", "pascals", "210 GPa", 1e-3, 1e15)
VOLUME_FLOW = Kind("a volume flow", "m^3/s", "cubic metres per second", "40 l/min", 1e-12, 1e6)
STIFFNESS = Kind("a stiffness", "N/m", "newtons per metre", "2000 N/m", 1e-15, 1e15)
TORSIONAL_STIFFNESS = Kind(
    "a torsional stiffness",
    "N m/rad",
    "newton metres per radian",
    "5e4 N m/rad",
    1e-12,
    1e18,
    angle_free=True,
)
DAMPING = Kind("a damping", "N s/m", "newton seconds per metre", "300 N s/m", 1e-12, 1e15)
TORSIONAL_DAMPING = Kind(
    "a torsional damping",
    "N m s/rad",
    "newton metre seconds per radian",
    "4 N m s/rad",
    1e-15,
    1e15,
    angle_free=True,
)
# Of vibration, counted in cycles; of a shaft it would leave open whether turns or radians are meant.
FREQUENCY = Kind("a frequency", "Hz", "hertz", "50 Hz", 1e-9, 1e6)
TEMPERATURE = Kind("an absolute temperature", "K", "kelvins", "330 K", 1e-3, 1e6)
# Of a motor that was measured; no machine file has one.
CURRENT = Kind("a current", "A", "amperes", "12 A", 1e-12, 1e9)
RATIO = Kind("a ratio", "", "", "90 %", 1e-9, 1e9)
# What is counted, such as teeth, or set by its author, such as an exponent: no share of anything.
COUNT = Kind("a number", "", "", "4", 1e-9, 1e9)
# Derivatives of a follower's lift, or of its swing, by the angle of the cam.
LIFT_D1 = Kind("a length per cam angle", "m/rad", "metres per radian", "20 mm/rad", 1e-9, 1e6)
LIFT_D2 = Kind(
    "a length per cam angle squared",
    "m/rad^2",
    "metres per radian squared",
    "50 mm/rad^2",
    1e-9,
    1e9,
)
LIFT_D3 = Kind(
    "a length per cam angle cubed", "m/rad^3", "metres per radian cubed", "90 mm/rad^3", 1e-9, 1e12
)
SWING_D2 = Kind("a number per angle", "1/rad", "per radian", "0.5 1/rad", 1e-9, 1e6)
SWING_D3 = Kind("a number per angle squared", "1/rad^2", "per radian squared", "0.9 1/rad^2", 1e-9, 1e9)
# A number in whatever unit, such as a constant of a formula.
OF_ANY_KIND = Kind("a number", "", "", "90 %", 1e-18, 1e18)

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
    AREA,
    AREA_MOMENT,
    SECTION_MODULUS,
    DENSITY,
    PRESSURE,
    VOLUME_FLOW,
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


def range_words(kind: Kind) -> str:
    """The range of a kind, such as ``"a length is between 1e-9 and 1e6 m in size"``."""
    least, most = size_words(kind)
    return f"{kind.word} is between {least} and {most} {kind.unit}".rstrip() + " in size"


def size_words(kind: Kind) -> tuple[str, str]:
    """The smallest and the largest size of a kind, as written by hand: ``("1e-9", "1e6")``."""
    least, most = (_ZEROS.sub(r"e\1", f"{size:.0e}") for size in (kind.least, kind.most))
    return least, most
