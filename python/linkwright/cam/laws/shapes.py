"""From a law of rest to rest to a section with any boundary values, in the way that suits the law."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from linkwright.cam.laws.boundary import Boundary
from linkwright.cam.laws.half_law import with_boundary
from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.cam.laws.parabolic import constant_velocity
from linkwright.cam.laws.polynomial import polynomial
from linkwright.kernel.errors import LawError, Problem

# What differs by less than this share is the same.
_SAME = 1e-9


def straight(task: Boundary) -> MotionLaw:
    """Constant velocity: the lift alone counts."""
    return constant_velocity().scaled(task.lift)


def suited(law: MotionLaw, task: Boundary) -> MotionLaw:
    """A law of rest to rest for any boundary values if it is symmetric, else for rest alone.

    Parameters
    ----------
    law : MotionLaw
        From 0 to 1.
    task : Boundary
        The boundary values.

    Returns
    -------
    MotionLaw
        From 0 to 1.

    Raises
    ------
    LawError
        The law is not symmetric, and other boundary values than its own are asked for.
    """
    return with_boundary(law, task) if is_symmetric(law) else at_rest_only(law, task)


def is_symmetric(law: MotionLaw) -> bool:
    """Whether the second half of a law of rest to rest is the mirror image of the first."""
    z = np.linspace(0.0, 0.5, 17)
    return bool(np.abs(law.at(z) + law.at(1 - z) - 1).max() < _SAME)


def at_rest_only(law: MotionLaw, task: Boundary) -> MotionLaw:
    """A law that cannot but begin and end at rest.

    Parameters
    ----------
    law : MotionLaw
        From 0 to 1.
    task : Boundary
        The boundary values.

    Returns
    -------
    MotionLaw
        From 0 to 1.

    Raises
    ------
    LawError
        Other boundary values are asked for.
    """
    own = law.scaled(task.lift)
    ends = (float(own.at(0.0, 2)), float(own.at(1.0, 2, "before")))
    wanted = (task.acceleration_start, task.acceleration_end)
    limit = _SAME * (1 + abs(task.lift) * max(map(abs, ends)))
    differs = any(a is not None and abs(a - b) > limit for a, b in zip(wanted, ends, strict=True))
    if task.velocity_start or task.velocity_end or differs:
        found = f"a law of rest to rest for the task {task.letters}"
        remedy = 'take law = "polynomial", or one of the symmetric laws'
        raise LawError(Problem("", found, "a law that begins and ends as the neighbours ask", remedy))
    return own


def by_conditions(
    task: Boundary,
    continuity_start: int = 2,
    continuity_end: int = 2,
    powers: Sequence[int] | None = None,
) -> MotionLaw:
    """The polynomial that meets the boundary values.

    Parameters
    ----------
    task : Boundary
        The boundary values; accelerations that are None are zero.
    continuity_start, continuity_end : int
        Order of the highest derivative that is set there; those above the second are zero.
    powers : sequence of int, optional
        Powers to be used instead of 0, 1, 2, …

    Returns
    -------
    MotionLaw
        From 0 to 1.

    Raises
    ------
    LawError
        A velocity or acceleration is asked for that the order leaves out; powers that cannot do it.
    """
    start = (0.0, task.velocity_start, task.acceleration_start or 0.0)
    end = (task.lift, task.velocity_end, task.acceleration_end or 0.0)
    at_start = _conditions("continuity_start", start, continuity_start)
    return polynomial(at_start, _conditions("continuity_end", end, continuity_end), powers)


def _conditions(key: str, values: Sequence[float], order: int) -> dict[int, float]:
    """Order → value, up to the order that is wanted."""
    left_out = [i for i in range(order + 1, len(values)) if values[i]]
    if left_out:
        expected = f"{left_out[-1]} or more, as the section has a derivative of that order at this end"
        raise LawError(Problem(key, str(order), expected))
    return dict(enumerate([*values, *[0.0] * order][: order + 1]))
