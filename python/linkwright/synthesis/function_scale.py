"""A function y(x) on the scales of crank and rocker, with the arguments at which it shall be met.

    φ = φ₀ + Δφ (x − x₀)/(x_n − x₀)          ψ = ψ₀ + Δψ (y − y₀)/(y_n − y₀)

Source: Hartenberg, Denavit, Kinematic Synthesis of Linkages, 1964.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.errors import InputError
from linkwright.synthesis.expression import function_of
from linkwright.synthesis.task import FunctionTask

Floats = NDArray[np.float64]

# Intervals of the range at which the machine is analysed again.
_STEPS = 720


def chebyshev_points(start: float, end: float, n: int) -> Floats:
    r"""Arguments spread so that the error between them tends to be even.

    .. math:: x_j = \tfrac12 (x_0 + x_n) - \tfrac12 (x_n - x_0) \cos\frac{(2j - 1)\pi}{2n}

    `start`, `end`: first and last argument of the range. Returns: (n,) in order from start to end.

    Source: Hartenberg, Denavit, Kinematic Synthesis of Linkages, 1964.
    """
    j = np.arange(1, n + 1)
    return 0.5 * (start + end) - 0.5 * (end - start) * np.cos((2 * j - 1) * np.pi / (2 * n))


@dataclass(frozen=True)
class Scale:
    """The function on its scales: points, crank and rocker angles from their starts, and the same "
    "over the range."""

    points: Floats
    crank: Floats
    rocker: Floats
    x: Floats
    wanted: Floats
    crank_over: Floats
    rocker_over: Floats
    per_angle: float

    @classmethod
    def of(cls, task: FunctionTask) -> Scale:
        """The scales of a task."""
        ends = task.range if task.range is not None else (min(task.x or ()), max(task.x or ()))
        points = _points(task, ends)
        function = _function(task)
        x = np.linspace(ends[0], ends[1], _STEPS + 1)
        y, y0, yn = function(points), *function(np.array(ends))
        if not np.isfinite(yn - y0) or abs(yn - y0) <= 1e-12 * max(abs(yn), abs(y0), 1e-300):
            raise InputError(
                f"function: {y0:.6g} at both ends of the range, so rocker_range has no scale; expected "
                "different values"
            )
        per_angle = (yn - y0) / task.rocker_range
        part, over = (points - ends[0]) / (ends[1] - ends[0]), np.linspace(0, 1, _STEPS + 1)
        wanted = function(x)
        angles = ((y - y0) / per_angle, (wanted - y0) / per_angle)
        crank = (part * task.crank_range, over * task.crank_range)
        return cls(points, crank[0], angles[0], x, wanted, crank[1], angles[1], float(per_angle))


def _points(task: FunctionTask, ends: tuple[float, ...]) -> Floats:
    """Arguments at which the function shall be met."""
    if task.x is not None:
        return np.asarray(task.x)
    if task.spacing == "even":
        return np.linspace(ends[0], ends[1], task.points)
    return chebyshev_points(ends[0], ends[1], task.points)


def _function(task: FunctionTask) -> Callable[[Floats], Floats]:
    """The function of a task; one given by points is a polynomial through few of them, straight "
    "between many."""
    if task.function is not None:
        return function_of(task.function)
    x, y = np.asarray(task.x), np.asarray(task.y)
    order = np.argsort(x)
    x, y = x[order], y[order]
    if (np.diff(x) <= 0).any():
        raise InputError("x: the same argument twice, expected different ones")
    if len(x) <= 6:
        middle, half = 0.5 * (x[0] + x[-1]), 0.5 * (x[-1] - x[0])
        factors = np.linalg.solve(np.vander((x - middle) / half), y)
        return lambda at: np.polyval(factors, (np.asarray(at) - middle) / half)
    return lambda at: np.interp(at, x, y)
