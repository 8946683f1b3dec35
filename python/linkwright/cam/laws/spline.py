"""Splines through points.

A spline of odd degree k with its knots in the points has k − 1 conditions to spare: value and derivatives up
to the order (k − 1)/2 at each end are the section's boundary values, those above the second zero. Degree 1
joins the points by straight lines.

Source: de Boor, *A Practical Guide to Splines* (2001), chapters IX and XIII; SciPy has the collocation.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from linkwright.cam.laws.boundary import Boundary
from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.cam.laws.piece import Piece


def spline(places: Sequence[float], values: Sequence[float], task: Boundary, degree: int = 5) -> MotionLaw:
    """The spline through points that meets boundary values."""
    from scipy.interpolate import PPoly, make_interp_spline

    x = np.asarray(places, dtype=float)
    orders = range(1, (degree + 1) // 2)
    start = (task.velocity_start, task.acceleration_start or 0.0, 0.0)
    end = (task.velocity_end, task.acceleration_end or 0.0, 0.0)
    conditions: Any = (
        ([*zip(orders, start, strict=False)], [*zip(orders, end, strict=False)]) if orders else None
    )
    knots = np.concatenate([np.zeros(degree), x, np.ones(degree)])
    curve = make_interp_spline(x, np.asarray(values, dtype=float), degree, knots, conditions)
    # Powers of the distance from the start of each piece, the highest first; a piece counts from 0 to 1.
    powers = PPoly.from_spline(curve.tck).c[:, degree : degree + len(x) - 1][::-1].T
    scale = np.diff(x)[:, None] ** np.arange(degree + 1)
    return MotionLaw(tuple(x.tolist()), tuple(Piece(tuple(row)) for row in (powers * scale).tolist()))
