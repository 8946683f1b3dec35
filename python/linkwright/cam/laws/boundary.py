r"""Velocities and accelerations at the ends of a section: the tasks of VDI 2143, and laws that meet them.

A section counts over its own z from 0 to 1, and its derivatives by z: a section over the angle β with the
slope s′ has the velocity s′ β and the acceleration s″ β² here. The ends of VDI 2143 are

| letter | end | velocity | acceleration |
| --- | --- | --- | --- |
| R | dwell (Rast) | 0 | 0 |
| G | constant speed (Geschwindigkeit) | v | 0 |
| U | turning point (Umkehr) | 0 | a |
| B | any motion (Bewegung) | v | a |

Any symmetric law of rest to rest serves for any boundary values. The first half of a law f brings a follower
from rest to its maximum velocity. Stretched over a section it changes the velocity there,

.. math:: x(z) = v_0 z + (v_1 - v_0)\,G(z) + \bigl(s - v_0 - (v_1 - v_0)\,G(1)\bigr) f(z), \qquad
          G'(z) = \frac{f'(z/2)}{f'(1/2)}

and f itself covers what is left of the lift s. Accelerations at the ends that the sum does not have are added
by a quintic that changes nothing else there. A section of a family keeps the family's smoothness: its
harmonics, and no jump that f has not.

Source: VDI 2143 Blatt 1 (1980) takes halves of symmetric laws for the tasks R-G and G-R; the sum for
two velocities is the same formula once for each.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from linkwright.cam.laws.handbook import constant_velocity
from linkwright.cam.laws.motion_law import MotionLaw, combined
from linkwright.cam.laws.polynomial import polynomial
from linkwright.kernel.errors import LawError, Problem
from linkwright.kernel.numerics.tangent import moves


@dataclass(frozen=True)
class Boundary:
    """Lift over a section, and velocity and acceleration at its ends, by z."""

    lift: float  # change over the section [m or rad]
    # velocity_start, velocity_end: [m or rad].
    velocity_start: float = 0.0
    velocity_end: float = 0.0
    # acceleration_start, acceleration_end: [m or rad]; None leaves it to the law, which has none unless it
    # says so.
    acceleration_start: float | None = None
    acceleration_end: float | None = None

    @property
    def letters(self) -> str:
        """The task in the letters of VDI 2143, such as ``"R-G"``."""
        ends = (
            (self.velocity_start, self.acceleration_start or 0.0),
            (self.velocity_end, self.acceleration_end or 0.0),
        )
        return "-".join("RGUB"[(v != 0) + 2 * (a != 0)] for v, a in ends)


_REST = {0: 0.0, 1: 0.0, 2: 0.0}


def half_law(law: MotionLaw) -> MotionLaw:
    """The first half of a symmetric law, stretched to a section and to an end velocity of one."""
    middle = law.value(0.5, 1)
    return law.stretch(0.0, 0.5).placed(0.0, 1.0).scaled(2 / middle)


def with_boundary(law: MotionLaw, task: Boundary) -> MotionLaw:
    """A symmetric law made to meet boundary values; accelerations that are None are free."""
    moved = law.scaled(task.lift)
    if moves(task.velocity_start) or moves(task.velocity_end):
        moved = _moved(law, task)
    start, end = moved.value(0.0, 2), moved.value(1.0, 2, "before")
    missing = [
        0.0 if wanted is None else wanted - there
        for wanted, there in ((task.acceleration_start, start), (task.acceleration_end, end))
    ]
    if not any(map(moves, missing)):
        return moved
    bend = polynomial(_REST | {2: missing[0]}, _REST | {2: missing[1]})
    return combined((1.0, moved), (1.0, bend))


def _moved(law: MotionLaw, task: Boundary) -> MotionLaw:
    v_0, change = task.velocity_start, task.velocity_end - task.velocity_start
    G = half_law(law)
    left = task.lift - v_0 - change * G.value(1.0)
    return combined((v_0, constant_velocity()), (change, G), (left, law))


# What differs by less than this share is the same.
_SAME = 1e-9


def straight(task: Boundary) -> MotionLaw:
    """Constant velocity: the lift alone counts."""
    return constant_velocity().scaled(task.lift)


def suited(law: MotionLaw, task: Boundary) -> MotionLaw:
    """A law of rest to rest for any boundary values if it is symmetric, else for rest alone."""
    return with_boundary(law, task) if is_symmetric(law) else at_rest_only(law, task)


def is_symmetric(law: MotionLaw) -> bool:
    """Whether the second half of a law of rest to rest is the mirror image of the first."""
    z = np.linspace(0.0, 0.5, 17)
    return bool(np.abs(law.at(z) + law.at(1 - z) - 1).max() < _SAME)


def at_rest_only(law: MotionLaw, task: Boundary) -> MotionLaw:
    """A law that cannot but begin and end at rest."""
    own = law.scaled(task.lift)
    ends = (own.value(0.0, 2), own.value(1.0, 2, "before"))
    wanted = (task.acceleration_start, task.acceleration_end)
    limit = _SAME * (1 + abs(task.lift) * max(map(abs, ends)))
    differs = any(a is not None and abs(a - b) > limit for a, b in zip(wanted, ends, strict=True))
    if moves(task.velocity_start) or moves(task.velocity_end) or differs:
        found = f"a rest-to-rest law for the boundary conditions {task.letters}"
        remedy = 'take law = "polynomial", or one of the symmetric laws'
        raise LawError(
            Problem("", found, "a law that matches the neighbouring sections at both ends", remedy)
        )
    return own


def by_conditions(
    task: Boundary,
    continuity_start: int = 2,
    continuity_end: int = 2,
    powers: Sequence[int] | None = None,
) -> MotionLaw:
    """The polynomial that meets the boundary values; accelerations that are None are zero."""
    start = (0.0, task.velocity_start, or_none(task.acceleration_start))
    end = (task.lift, task.velocity_end, or_none(task.acceleration_end))
    at_start = _conditions("continuity_start", start, continuity_start)
    return polynomial(at_start, _conditions("continuity_end", end, continuity_end), powers)


def or_none(value: float | None) -> float:
    """An acceleration, none where nothing is said."""
    return 0.0 if value is None else value


def _conditions(key: str, values: Sequence[float], order: int) -> dict[int, float]:
    left_out = [i for i in range(order + 1, len(values)) if moves(values[i])]
    if left_out:
        expected = f"{left_out[-1]} or more, as the section has a derivative of that order at this end"
        raise LawError(Problem(key, str(order), expected))
    return dict(enumerate([*values, *[0.0] * order][: order + 1]))
