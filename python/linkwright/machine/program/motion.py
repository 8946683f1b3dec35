"""Motion of points, links and slides of one machine over the crank angle, as the core gives it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import accumulate, pairwise
from typing import Any, NamedTuple

import numpy as np

from linkwright import _core
from linkwright.kernel.arrays import Floats
from linkwright.kernel.numerics.tangent import Tangent

_NO_SLOTS = np.empty(0, dtype=np.int32)
_NO_VALUES = np.empty((0, 1))


class PointRows(NamedTuple):
    """Place of a point [m], first and second derivative by the crank angle, (2, n) each."""

    place: Floats
    d1: Floats
    d2: Floats


class LinkRows(NamedTuple):
    """Cosine and sine of a link's angle (2, n), first and second derivative of the angle (n,)."""

    direction: Floats
    d1: Floats
    d2: Floats


class SlideRows(NamedTuple):
    """Coordinate of a slide [m], first and second derivative, (n,) each."""

    position: Floats
    d1: Floats
    d2: Floats


Rows = PointRows | LinkRows | SlideRows

# How many numbers the core gives at each angle.
WIDTHS: dict[type[_core.Channel], int] = {
    _core.Channel.Point: 6,
    _core.Channel.Link: 4,
    _core.Channel.Slide: 3,
}


def motion(
    plan: _core.Plan,
    parameters: Floats,
    channels: Sequence[_core.Channel],
    angles: Floats,
    slopes: Floats | None = None,
) -> list[Rows]:
    """Motion of what is asked for at crank angles (n,) [rad]; tangents with `slopes`, (numbers, n, k)."""
    ends = list(accumulate((WIDTHS[type(channel)] for channel in channels), initial=0))
    out = np.empty((1, ends[-1], len(angles)))
    _core.motions(plan, parameters, _NO_SLOTS, _NO_VALUES, angles, channels, out)
    table: Any = out[0] if slopes is None else Tangent(out[0], slopes)
    tables = [table[start:end] for start, end in pairwise(ends)]
    return [_ROWS[type(channel)](table) for channel, table in zip(channels, tables, strict=True)]


def point_motion(plan: _core.Plan, parameters: Floats, point: int, angles: Floats) -> PointRows:
    """Motion of a point at crank angles (n,) [rad]."""
    (rows,) = motion(plan, parameters, [_core.Channel.Point(point)], angles)
    assert isinstance(rows, PointRows)
    return rows


def link_motion(plan: _core.Plan, parameters: Floats, link: int, angles: Floats) -> LinkRows:
    """Motion of a link at crank angles (n,) [rad]."""
    (rows,) = motion(plan, parameters, [_core.Channel.Link(link)], angles)
    assert isinstance(rows, LinkRows)
    return rows


_ROWS: dict[type[_core.Channel], Callable[[Floats], Rows]] = {
    _core.Channel.Point: lambda rows: PointRows(rows[:2], rows[2:4], rows[4:]),
    _core.Channel.Link: lambda rows: LinkRows(rows[:2], rows[2], rows[3]),
    _core.Channel.Slide: lambda rows: SlideRows(*rows),
}
