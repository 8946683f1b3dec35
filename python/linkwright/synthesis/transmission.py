"""The transmission angle that a linkage should keep, and what to say where it does not.

Source: H. Alt, Der Übertragungswinkel und seine Bedeutung für das Konstruieren periodischer Getriebe,
Werkstattstechnik 26 (1932) 61–64; VDI 2127, VDI 2130: 40° at least, 30° at low speed and load.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.numerics.turn_fit import turn_curve
from linkwright.kernel.result import Result

Floats = NDArray[np.float64]

# Minimum transmission angles [rad]: of a linkage that runs fast or under load; of one that does not; and
# where it is near its dead centre, as friction of the joints alone asks for some ten degrees.
_GOOD = np.radians(40.0)
_FAIR = np.radians(30.0)
_NEAR_LOCK = np.radians(15.0)

# Angles that differ by less are equal: an optimum at a limit lies on either side of it by rounding [rad].
_SAME = 1e-6


def transmission_caution(angle: float, remedy: str = "") -> tuple[str, ...]:
    """What to know of a minimum transmission angle; nothing where it is good.

    `angle`: minimum transmission angle in the motion that is used [rad].
    """
    if angle >= _GOOD - _SAME:
        return ()
    found = f"the transmission angle falls to {np.degrees(angle):.3g}°"
    if angle < _NEAR_LOCK:
        meaning = "the linkage nearly locks there: friction may stop it, and joint clearance moves its output"
    elif angle < _FAIR:
        meaning = "handbooks ask for 40° at least, 30° at low speed and load; joint forces and wear are high"
    else:
        meaning = "enough at low speed and load; handbooks ask for 40° else"
    return (f"{found}: {meaning}" + (f"; {remedy}" if remedy else ""),)


def least_transmission(of: Callable[[Floats], Floats], start: float, end: float) -> float:
    """Minimum transmission angle while the crank turns from one angle to another, exactly [rad].

    `of`: transmission angle at crank angles [rad]; `start`, `end`: crank angles [rad]. Returns: at an end, or
    where crank and frame are in line.
    """
    turn = turn_curve(lambda phi: of(phi)[None], np.sort([start, end]), "transmission angle")
    return turn.extreme(-1)[0]


class TransmissionResult(Result):
    """A result with a minimum transmission angle, and a caution where that is small."""

    transmission_angle_min: float
    # What raises the transmission angle.
    remedy: ClassVar[str] = "raise transmission_angle_min"

    @property
    def warnings(self) -> tuple[str, ...]:
        """What to know of the linkage."""
        return transmission_caution(self.transmission_angle_min, self.remedy)
