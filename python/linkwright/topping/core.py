"""The core's knife of a topper over many heads; `crates/linkwright-topper/src` has the formulas."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from linkwright import _core
from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.kernel.arrays import Floats
from linkwright.machine.program.numbers import core_law


class KnifeWay(NamedTuple):
    """How a knife goes: y(t) = law(phase + rate t) + drift t across the row."""

    # (k, 2): over its phase from 0 to 2π, or its harmonics from the constant on, cosine and sine [m].
    law: MotionLaw | Floats
    # Phases at which the law or one of its first two derivatives jumps, increasing [rad].
    corners: Sequence[float]
    rate: float  # phase per time [rad/s]
    drift: float  # A constant speed across the row [m/s]
    reach: float  # peak absolute value of the law [m]
    # slowest, fastest: extremes of the speed across the row [m/s].
    slowest: float
    fastest: float


class KnifeKernel:
    """An edge that goes over heads. ``edge_angle``: α [rad]; ``forward_speed``: v [m/s]."""

    def __init__(self, way: KnifeWay, edge_angle: float, forward_speed: float) -> None:
        self._core = _core.TopperKnife(
            core_law(way.law)
            if isinstance(way.law, MotionLaw)
            else np.ascontiguousarray(way.law.ravel(), dtype=float),
            corners=list(way.corners),
            angle=edge_angle,
            forward=forward_speed,
            rate=way.rate,
            drift=way.drift,
            reach=way.reach,
            slowest=way.slowest,
            fastest=way.fastest,
        )

    def cover(
        self,
        radius: ArrayLike,
        offset: ArrayLike,
        phase: ArrayLike,
        *,
        length: float | None = None,
        fine: int = 16,
    ) -> _core.TopperCover:
        """Needs of heads, and what an edge leaves; radius, offset (n,) [m]; phase [rad]; length [m]."""
        columns = [_column(radius), _column(offset), _in_one_revolution(_column(phase))]
        return self._core.cover(
            radius=columns[0],
            offset=columns[1],
            phase=columns[2],
            n=max(map(len, columns)),
            length=length,
            fine=fine,
        )


def _column(values: ArrayLike) -> Floats:
    return np.ascontiguousarray(np.atleast_1d(values), dtype=float)


def _in_one_revolution(phase: Floats) -> Floats:
    """Phases from 0 to 2π; the remainder takes longer than what a head needs, and most are there already."""
    if len(phase) and phase.min() >= 0 and phase.max() < 2 * np.pi:
        return phase
    within: Floats = np.mod(phase, 2 * np.pi)
    return within
