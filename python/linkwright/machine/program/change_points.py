"""Change points of a dyad, of one machine or of each of a batch, as its row in the core has them.

A dyad whose links come into line passes from one of its assemblies to the other, and the motion goes on
smoothly (`docs/theory/folding.md`). Where lengths do not tell how, a machine is refused.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from linkwright import _core
from linkwright.kernel.errors import AssemblyError

Floats = NDArray[np.float64]

# Numbers of a change point before those of its arms, and of a point and an arm that are out of reach
# (`change_point` and `arm` in `crates/linkwright-core/src/plan.rs`).
_SERIES = 17
_NO_POINT = [1.0, 0.0, 1.0, 0.0, -1.0, *[0.0] * 12]
_NO_ARM = [1.0, -1.0, *[0.0] * 40]

# Lengths whose difference is this share of themselves are distinguished (`UNDECIDED` in the core's
# `in_line`).
_TOLD_APART = 1e-8


class InLine(NamedTuple):
    """Where the links of a dyad come into line.

    Attributes
    ----------
    angle : float
        Crank angle [rad].
    spare : float
        What is left until they are in line [m]; negative where they do not meet.
    series : list of float
        Numbers of a change point; empty where the lengths do not tell what happens there.
    arms : list of float
        Numbers of its two arms where the pin passes near its pivot; else empty.
    lost : tuple of bool
        Whether the arm with a positive, and with a negative, root after the point has no digits left.
    """

    angle: float
    spare: float
    series: list[float]
    arms: list[float]
    lost: tuple[bool, bool]

    def error(self, name: str) -> AssemblyError:
        """What is to be said where it is undecided; ``name`` is that of the dyad."""
        return AssemblyError(
            f"{name} comes within {abs(self.spare):.3g} m of a change point at crank angle "
            f"{np.degrees(self.angle):.6f}°, its links all but in line: its lengths do not tell in which of "
            "its two assemblies it goes on; give lengths that agree to all digits, or that differ by more "
            f"than {_TOLD_APART:g} of themselves",
            element=name,
            crank_angle=self.angle,
        )


def in_line(
    plan: _core.Plan, parameters: Floats, slots: NDArray[np.int32], values: Floats, element: int
) -> list[list[InLine]]:
    """Where the links of an element come into line over the revolution, by crank angle, in each machine.

    Parameters
    ----------
    plan : _core.Plan
        What comes before the element is settled.
    parameters : ndarray, shape (n_parameters,)
        Of the first machine.
    slots : ndarray, shape (k,)
        Which of them vary.
    values : ndarray, shape (k, n)
        Their values.
    element : int
        Place among the elements.

    Returns
    -------
    list of list of InLine
        A list a machine.
    """
    found: list[list[InLine]] = [[] for _ in range(values.shape[1])]
    known = _core.in_line(plan, parameters, slots, values, element)
    for row, angle, spare, series, arms, lost in known:
        found[row].append(InLine(angle, spare, series, arms, lost))
    return found


def undecided(points: list[InLine], sign: float) -> InLine | None:
    """The first place where lengths do not tell how the motion goes on, or its joint goes round too fast.

    An arm that goes round about a pivot, which the pin all but meets, has no digits left.

    Parameters
    ----------
    points : list of InLine
        Of one machine.
    sign : float
        Side of the dyad where the product of half-angle sines over all points is positive, ±1.
    """
    angles = np.array([point.angle for point in points])
    for k, point in enumerate(points):
        if not point.series:
            return point
        # The sign of the root after the point; an odd number of points brings the other in the next
        # revolution.
        after = sign * np.prod(np.sin((point.angle - np.delete(angles, k)) / 2))
        lost = any(point.lost) if len(points) % 2 else point.lost[0 if after > 0 else 1]
        if lost:
            return point
    return None


def encoded(found: list[list[InLine]], first: int) -> tuple[list[int], Floats]:
    """The change points of all machines as entries of the dyad's row, and the numbers that they refer to.

    Parameters
    ----------
    found : list of list of InLine
        A list a machine; machines with fewer have the rest out of reach.
    first : int
        Slot of the first of the numbers.

    Returns
    -------
    entries : list of int
        Number of change points, and the slots of each.
    numbers : ndarray, shape (k, n)
        A column a machine.
    """
    # At least one, so that a row has numbers: that of a machine without an answer is out of reach.
    most = max(1, *(len(points) for points in found))
    has_arms = any(point.arms for points in found for point in points)
    columns = np.stack([_numbers(points, most, has_arms) for points in found], axis=-1)
    slots = first + np.arange(columns.size // len(found)).reshape(most, -1)
    entries = [most]
    for at in slots.tolist():
        entries += [*at[:_SERIES], int(has_arms), *at[_SERIES:]]
    return entries, columns.reshape(-1, len(found))


def _numbers(points: list[InLine], most: int, has_arms: bool) -> Floats:
    """Numbers of one machine's change points, (most, numbers)."""
    no_arms = _NO_ARM * 2 if has_arms else []
    numbers = [[*point.series, *(point.arms or no_arms)] for point in points]
    return np.array(numbers + [[*_NO_POINT, *no_arms]] * (most - len(points)))


def folding_row(row: list[int], frame: int) -> list[int]:
    """The row of a dyad as one with change points; a rod on a fixed guide becomes one on any guide.

    Parameters
    ----------
    row : list of int
        Kind and entries.
    frame : int
        Index of the frame among the links.
    """
    kind, *entries = row
    if kind == 3:
        return [11, *entries]
    if kind == 5:
        return [15, *entries]
    point, link, slide, gap, pin, through, rod, inverse, offset, cos, sin, sign = entries
    return [15, point, link, slide, gap, pin, through, frame, cos, sin, offset, rod, inverse, sign]
