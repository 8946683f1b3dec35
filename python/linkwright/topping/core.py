"""The core's knife of a topper over many heads; `crates/linkwright-core/src/topper` has the formulas."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from linkwright import _core
from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.machine.program.numbers import core_law

Floats = NDArray[np.float64]


class KnifeWay(NamedTuple):
    """How a knife goes: y(t) = law(phase + rate t) + drift t across the row.

    Attributes
    ----------
    law : MotionLaw or ndarray, shape (k, 2)
        Over its phase from 0 to 2π, or its harmonics from the constant on, cosine and sine [m].
    corners : sequence of float
        Phases at which the law or one of its first two derivatives jumps, increasing [rad].
    rate : float
        Phase per time [rad/s].
    drift : float
        A constant speed across the row [m/s].
    reach : float
        Peak absolute value of the law [m].
    slowest, fastest : float
        Extremes of the speed across the row [m/s].
    """

    law: MotionLaw | Floats
    corners: Sequence[float]
    rate: float
    drift: float
    reach: float
    slowest: float
    fastest: float


class KnifeKernel:
    """An edge that goes over heads.

    Parameters
    ----------
    way : KnifeWay
        How the knife goes across the row.
    edge_angle : float
        α [rad].
    forward_speed : float
        v [m/s].
    """

    def __init__(self, way: KnifeWay, edge_angle: float, forward_speed: float) -> None:
        self._core = _core.TopperKnife(
            core_law(way.law)
            if isinstance(way.law, MotionLaw)
            else np.ascontiguousarray(way.law.ravel(), dtype=float),
            list(way.corners),
            edge_angle,
            forward_speed,
            way.rate,
            way.drift,
            [way.reach, way.slowest, way.fastest],
        )

    def cover(
        self,
        radius: ArrayLike,
        offset: ArrayLike,
        phase: ArrayLike,
        *,
        length: float | None = None,
        fine: int = 16,
    ) -> Floats:
        """What heads need, and what an edge leaves of them.

        Parameters
        ----------
        radius, offset : array_like, shape (n,)
            Of the discs, and of their centres to the left of the row [m]; one, or one a head.
        phase : array_like
            Of the law when the middle of the edge is abreast of the centre [rad].
        length : float, optional
            Of the edge [m]; without it, areas are zero.
        fine : int
            Stations per revolution of the law, and as many more.

        Returns
        -------
        ndarray, shape (n, 6)
            Length needed [m]; x and y from the centre of the point that is reached last [m]; area left on the
            right of the edge, on its left, and between two passes of it [m²].
        """
        columns = [np.ascontiguousarray(np.atleast_1d(each), dtype=float) for each in (radius, offset, phase)]
        columns[2] = np.mod(columns[2], 2 * np.pi)
        return self._core.cover((columns[0], columns[1], columns[2]), max(map(len, columns)), length, fine)


def _core_law(law: MotionLaw | Floats) -> _core.MotionLaw | Floats:
    """Pieces, or harmonics one after another."""
    return core_law(law) if isinstance(law, MotionLaw) else np.ascontiguousarray(law.ravel(), dtype=float)
