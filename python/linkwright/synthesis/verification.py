"""What a synthesis returns, analysed again: requirements, transmission angle, travel through positions.

Source: H. Alt, Der Übertragungswinkel und seine Bedeutung für das Konstruieren periodischer Getriebe,
Werkstattstechnik 26 (1932) 61–64; VDI 2127, VDI 2130: 40° at least, 30° at low speed and load.

A linkage that meets some positions need not move from one to the next: they may lie on different sides of the
joint (branches), in ranges of the crank with a gap between them (circuits), or be met in another order.

Source: Erdman, Sandor, Mechanism Design: Analysis and Synthesis: branch, circuit and order defects.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import ClassVar

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import SynthesisError
from linkwright.kernel.numerics.turn_fit import turn_curve
from linkwright.kernel.result import Result
from linkwright.linkages.cycle import ElementMotion, linkage
from linkwright.machine.machine import Machine

# Minimum transmission angles [rad]: of a linkage that runs fast or under load; of one that does not; and
# where it is near its dead centre, as friction of the joints alone asks for some ten degrees.
_GOOD = np.radians(40.0)
_FAIR = np.radians(30.0)
_NEAR_LOCK = np.radians(15.0)

# Angles that differ by less are equal: an optimum at a limit lies on either side of it by rounding [rad].
_SAME = 1e-6


def transmission_warning(angle: float, remedy: str = "") -> tuple[str, ...]:
    """Warning of a small minimum transmission angle [rad]; empty where it is good."""
    if angle >= _GOOD - _SAME:
        return ()
    found = f"the transmission angle falls to {np.degrees(angle):.3g}°"
    if angle < _NEAR_LOCK:
        meaning = "the linkage nearly locks there: friction may stop it, and joint clearance moves its output"
    elif angle < _FAIR:
        meaning = "handbooks require at least 40°, 30° at low speed and load; joint forces and wear are high"
    else:
        meaning = "sufficient at low speed and load; otherwise handbooks require 40°"
    return (f"{found}: {meaning}" + (f"; {remedy}" if remedy else ""),)


def least_transmission(of: Callable[[Floats], Floats], start: float, end: float) -> float:
    """Minimum transmission angle while the crank turns from one angle to another, exactly [rad].

    `of`: transmission angle at crank angles [rad]; `start`, `end`: crank angles [rad]. Returns: at an end, or
    where crank and frame are in line.
    """
    turn = turn_curve(lambda phi: of(phi)[None], np.sort([start, end]), "transmission angle")
    return turn.extreme(-1)[0]


class TransmissionResult(Result):
    """A result with a minimum transmission angle, and a warning where that is small."""

    transmission_angle_min: float
    # What raises the transmission angle.
    remedy: ClassVar[str] = "raise transmission_angle_min"

    @property
    def warnings(self) -> tuple[str, ...]:
        """What to know of the linkage."""
        return transmission_warning(self.transmission_angle_min, self.remedy)


# Share by which a linkage may miss what was asked for. Lengths and places are good to some 1e-16 of the
# longest link; a crank of a ten-thousandth of it, with dead centres among such numbers, keeps seven digits.
MET = 1e-6


def require_met(
    what: str, wanted: float, value: float | None, unit: str = "", size: float | None = None
) -> None:
    """Raise unless a linkage has what was asked for.

    `wanted`, `value`: what was asked for, and what the analysis of the machine finds; None if it has no such
    thing; `unit`: unit of both, for the message; angles in ``"rad"`` are reported in degrees; `size`: what
    the difference is compared with, instead of the wanted value.
    """
    size = abs(wanted) if size is None else size
    # "not less or equal" holds for NaN too.
    if value is None or not abs(value - wanted) <= MET * size:
        factor, unit = (180 / np.pi, "°") if unit == "rad" else (1.0, f" {unit}".rstrip())
        has = "none" if value is None else f"{factor * value:.9g}{unit}"
        raise SynthesisError(
            f"the linkage made for {what} of {factor * wanted:.9g}{unit} has {has} when it is analysed "
            "again: its link lengths differ too much; choose a less extreme task"
        )


def element_of(machine: Machine, output: str) -> ElementMotion:
    """The motion of one output of a machine, by its analysis. `output`: name of the link or slide."""
    return next(element for element in linkage(machine).elements if element.output == output)


def require_transmission(wanted: float, motion: ElementMotion) -> None:
    """Raise unless the minimum transmission angle over a revolution is the one that is returned.

    `wanted`: the one that is returned [rad]; `motion`: by the analysis of the machine.
    """
    low, high = motion.transmission_angle_min, motion.transmission_angle_max
    least = None if low is None or high is None else min(low, np.pi - high)
    require_met("a minimum transmission angle", wanted, least, "rad", size=1.0)


# Angles examined between the first position and the last; a gap narrower than a quarter of a degree is found
# by the analysis that meets it.
_STEPS = 1441

# A radicand above this share of its maximum, and negative, is rounding at a position with the links in line.
_ZERO = 1e-10


def travel(
    gap: Callable[[Floats], Floats], angles: Sequence[float], turn: float | None = None
) -> Floats | None:
    """The crank angles, counted on in the direction in which the linkage can be driven through them.

    `gap`: radicand of the closure at crank angles [rad]; negative where the linkage does not close; `angles`:
    crank angles of the positions in their order [rad], each up to whole revolutions; `turn`: an angle with
    the sign of the direction that is wanted; without it the shorter way is tried first. Returns: (n,)
    increasing or decreasing within one revolution [rad]; None if neither direction passes all positions.
    """
    ways = [_unrolled(np.asarray(angles, dtype=float), sign) for sign in (1.0, -1.0)]
    if turn is not None:
        ways = ways[:1] if turn > 0 else ways[1:]
    for unrolled in sorted(ways, key=lambda angle: abs(angle[-1] - angle[0])):
        if abs(unrolled[-1] - unrolled[0]) > 2 * np.pi:
            continue
        spare = gap(np.linspace(unrolled[0], unrolled[-1], _STEPS))
        if (spare >= -_ZERO * np.abs(spare).max()).all():
            return unrolled
    return None


def _unrolled(angles: Floats, sign: float) -> Floats:
    steps = np.mod(sign * np.diff(angles), 2 * np.pi)
    return np.asarray(angles[0] + sign * np.concatenate([[0.0], np.cumsum(steps)]))


def way(angles: Floats) -> str:
    """In which direction the crank turns through the angles."""
    return "counter-clockwise" if angles[-1] >= angles[0] else "clockwise"


def listed(angles: Sequence[float] | Floats) -> str:
    """Angles in degrees, for messages."""
    return ", ".join(f"{float(np.degrees(angle)):.2f}°" for angle in angles)
