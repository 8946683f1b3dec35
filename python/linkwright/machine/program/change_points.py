"""Change points of a dyad, of one machine or of each of a batch, as its element in the core has them.

A dyad whose links come into line passes from one of its assemblies to the other, and the motion goes on
smoothly (`docs/theory/folding.md`). Where lengths do not tell how, a machine is refused.
"""

from __future__ import annotations

import numpy as np

from linkwright import _core
from linkwright.kernel.arrays import Floats, Integers
from linkwright.kernel.errors import AssemblyError

# Numbers of a change point and of an arm that are out of reach, in the order of the fields of `ChangePoint`
# and `Arm` in `crates/linkwright-core/src/linkage`.
_NO_POINT = [1.0, 0.0, 1.0, 0.0, -1.0, *[0.0] * 12]
_NO_ARM = [1.0, -1.0, *[0.0] * 40]

# Lengths whose difference is this share of themselves are distinguished (`UNDECIDED` in the core's
# `in_line`).
_TOLD_APART = 1e-8


def undecided_error(name: str, point: _core.InLine) -> AssemblyError:
    """What is to be said where the lengths of a dyad do not tell how its motion goes on.

    `point`: where its links are all but in line.
    """
    return AssemblyError(
        f"{name} comes within {abs(point.spare):.3g} m of a change point at crank angle "
        f"{np.degrees(point.crank_angle):.6f}°, its links almost in line: its lengths do not determine in "
        "which of its two assemblies it continues; give lengths that agree to all digits, or that differ by "
        f"a relative {_TOLD_APART:g} or more",
        element=name,
        crank_angle=point.crank_angle,
    )


def in_line(
    plan: _core.Plan, parameters: Floats, slots: Integers, values: Floats, element: int
) -> list[list[_core.InLine]]:
    """Where the links of an element come into line over the revolution, by crank angle, in each machine.

    `plan`: what comes before the element is settled; `parameters` (n_parameters,): of the first machine;
    `slots` (k,): which of them vary; `values` (k, n): their values.
    """
    n = values.shape[1]
    points = _core.in_line(plan, parameters, slots, values, element)
    if not points:
        return [[]] * n
    line: list[list[_core.InLine]] = [[] for _ in range(n)]
    for point in points:
        line[point.row].append(point)
    return line


def undecided(points: list[_core.InLine], sign: float) -> _core.InLine | None:
    """The first place where lengths do not tell how the motion goes on, or its joint goes round too fast.

    An arm that goes round about a pivot, which the pin all but meets, has no digits left.

    `sign`: side of the dyad where the product of half-angle sines over all points is positive, ±1.
    """
    angles = np.array([point.crank_angle for point in points])
    for k, point in enumerate(points):
        if not point.series:
            return point
        # The sign of the root after the point; an odd number of points brings the other in the next
        # revolution.
        after = sign * np.prod(np.sin((point.crank_angle - np.delete(angles, k)) / 2))
        goes_positive, goes_negative = (True, True) if len(points) % 2 else (after > 0, after <= 0)
        lost = (goes_positive and point.lost_positive) or (goes_negative and point.lost_negative)
        if lost:
            return point
    return None


def stored(lines: list[list[_core.InLine]], first: int) -> tuple[list[_core.ChangePoint], Floats]:
    """The change points of all machines, and the numbers that they refer to.

    `lines`: a list a machine; machines with fewer have the rest out of reach; `first`: slot of the first of
    the numbers. Returns: change_points: as many as the machine with most has; numbers: (k, n) A column a
    machine.
    """
    # At least one, so that there are numbers: that of a machine without an answer is out of reach.
    most = max(1, *(len(points) for points in lines))
    has_arms = any(point.arms for points in lines for point in points)
    columns = np.stack([_numbers(points, most, has_arms) for points in lines], axis=-1)
    width = columns.shape[1]
    points = [_core.ChangePoint(first=first + k * width, has_arms=has_arms) for k in range(most)]
    return points, columns.reshape(-1, len(lines))


def _numbers(points: list[_core.InLine], most: int, has_arms: bool) -> Floats:
    """Numbers of one machine's change points, (most, numbers)."""
    no_arms = _NO_ARM * 2 if has_arms else []
    numbers = [[*point.series, *(point.arms or no_arms)] for point in points]
    return np.array(numbers + [[*_NO_POINT, *no_arms]] * (most - len(points)))


def folding(dyad: _core.Element, change_points: list[_core.ChangePoint]) -> _core.Element:
    """A dyad as one with change points; a rod on a fixed guide becomes one on any guide."""
    if isinstance(dyad, _core.Element.Rocker):
        return _core.Element.Rocker(
            joint=dyad.joint,
            coupler_link=dyad.coupler_link,
            rocker_link=dyad.rocker_link,
            dyad=dyad.dyad,
            pin=dyad.pin,
            pivot=dyad.pivot,
            coupler=dyad.coupler,
            rocker=dyad.rocker,
            inverse_coupler=dyad.inverse_coupler,
            inverse_rocker=dyad.inverse_rocker,
            sign=dyad.sign,
            change_points=change_points,
        )
    assert isinstance(dyad, _core.Element.SliderRod | _core.Element.GuidedRod)
    return _core.Element.GuidedRod(
        point=dyad.point,
        link=dyad.link,
        slide=dyad.slide,
        dyad=dyad.dyad,
        pin=dyad.pin,
        line=dyad.line if isinstance(dyad, _core.Element.GuidedRod) else _fixed_guide(dyad),
        rod=dyad.rod,
        inverse_rod=dyad.inverse_rod,
        sign=dyad.sign,
        change_points=change_points,
    )


def _fixed_guide(rod: _core.Element.SliderRod) -> _core.Line:
    return _core.Line(through=rod.through, link=None, cos=rod.cos, sin=rod.sin, offset=rod.offset)
