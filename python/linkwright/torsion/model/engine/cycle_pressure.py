r"""The pressure in a cylinder over its working cycle: angles for integrals, curves through points.

On each interval of width h with secant s it is Hermite's cubic; the slope at a point between secants of the
same sign is their weighted harmonic mean, at an extreme zero,

.. math:: \frac{w_1 + w_2}{d} = \frac{w_1}{s_-} + \frac{w_2}{s_+}, \qquad w_1 = 2 h_+ + h_-, \quad
    w_2 = h_+ + 2 h_-

References
----------
.. [1] Fritsch, Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300-304.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache, cached_property
from itertools import pairwise

import numpy as np
from numpy.polynomial import legendre

from linkwright.kernel.arrays import Floats

# Gauss points of a panel: integrals of polynomials up to degree 11 are exact.
_POINTS = 6
# Panels of the closed cycle. With a compression ratio of 20 the pressure's nearest pole is some 25 deg away
# from the dead centre, so six points leave 1e-10 of it.
_CLOSED = math.radians(6.0)
# Panels of the gas exchange: order 24 advances by less than a third of its period from point to point.
_OPEN = math.radians(10.0)
# Share of a panel by which durations of a release at which one more is taken lie beside its multiples: so a
# small change of a round angle, as most files have, leaves the mesh as it is.
_BESIDE = 0.137


@dataclass(frozen=True, eq=False)
class CycleMesh:
    """Crank angles and what they count in integrals."""

    angle: Floats  # (m,) increasing [rad]
    weight: Floats  # (m,) what each counts in an integral [rad]
    half_width: Floats  # (m/6,) of the panels [rad]

    def integrals(self, values: Floats) -> Floats:
        """Integrals from the start to every angle, (n, m), of the panel polynomials through `values`."""
        _, w, S = _gauss()
        panels = values.reshape(*values.shape[:-1], -1, _POINTS) * self.half_width[:, None]
        panel = panels @ w
        before = np.cumsum(panel, axis=-1) - panel
        return np.asarray((panels @ S.T + before[..., None]).reshape(values.shape))


@cache
def _gauss() -> tuple[Floats, Floats, Floats]:
    """Gauss points, weights on −1 … 1, and integrals of Lagrange's polynomials from −1 to each point."""
    x, w = legendre.leggauss(_POINTS)
    k = np.arange(_POINTS)
    # The polynomial through the points has the Legendre coefficients (k + ½) Σ w_j P_k(x_j) y_j.
    analysis = (k[:, None] + 0.5) * legendre.legvander(x, _POINTS - 1).T * w
    S = np.column_stack([legendre.legval(x, legendre.legint(column, lbnd=-1)) for column in analysis.T])
    return np.asarray(x), np.asarray(w), np.asarray(S)


def mesh(edges: Floats) -> CycleMesh:
    """Six Gauss points in each panel between increasing `edges` (k,) [rad]."""
    x, w, _ = _gauss()
    half, middle = np.diff(edges) / 2, (edges[1:] + edges[:-1]) / 2
    return CycleMesh((middle[:, None] + half[:, None] * x).ravel(), np.outer(half, w).ravel(), half)


def closed_edges(start: float, end: float, releases: list[tuple[float, float]]) -> Floats:
    """Ends of panels between closing and opening, (k,), increasing [rad]; `releases` [rad]."""
    marks = [_even(start, end, _CLOSED)]
    for begin, duration in releases:
        n = 2 * math.ceil(duration / _CLOSED + _BESIDE)
        marks.append(begin + duration * (np.arange(n + 1) / n) ** 2)
    edges = np.unique(np.concatenate(marks))
    return _apart(edges, {start, end, *(edge for b, d in releases for edge in (b, b + d))})


def open_edges(start: float, end: float, corners: tuple[float, ...]) -> Floats:
    """Ends of panels between opening and closing, (k,).

    Increasing [rad]. `start`, `end`: crank angles of opening and of closing [rad]; `corners`: where the
    pressure has corners [rad].
    """
    ends = sorted({start, end, *(corner for corner in corners if start < corner < end)})
    return np.unique(np.concatenate([_even(a, b, _OPEN) for a, b in pairwise(ends)]))


def _even(start: float, end: float, width: float) -> Floats:
    return np.linspace(start, end, math.ceil((end - start) / width) + 1)


def _apart(edges: Floats, corners: set[float]) -> Floats:
    """Edges without those close before another, corners excepted."""
    keep = np.r_[np.diff(edges) > 0.05 * _CLOSED, True]
    first_of_release = np.isin(edges, list(corners))
    return np.asarray(edges[keep | first_of_release])


def periodic_cubic(knots: Floats, values: Floats, period: float, at: Floats) -> Floats:
    """Value of the monotone periodic cubic through knots (k,) at arguments (m,) of any size."""
    x, y = _one_period(knots, values, period)
    h = np.diff(x)
    s = np.diff(y) / h
    d = _slopes(h, s)
    t = x[0] + np.mod(at - x[0], period)
    i = np.clip(np.searchsorted(x, t, side="right") - 1, 0, len(h) - 1)
    u = t - x[i]
    # Newton's form of Hermite's cubic.
    square = (3 * s - 2 * d[:-1] - d[1:]) / h
    cube = (d[:-1] + d[1:] - 2 * s) / h**2
    return np.asarray(y[i] + u * (d[:-1][i] + u * (square[i] + u * cube[i])))


def _one_period(knots: Floats, values: Floats, period: float) -> tuple[Floats, Floats]:
    # Knots closer than a millionth of the period are the same.
    if abs(knots[-1] - knots[0] - period) < 1e-6 * period:
        knots, values = knots[:-1], np.r_[(values[0] + values[-1]) / 2, values[1:-1]]
    return np.r_[knots, knots[0] + period], np.r_[values, values[0]]


def _slopes(h: Floats, s: Floats) -> Floats:
    before, after = np.roll(h, 1), h
    left, right = np.roll(s, 1), s
    w_1, w_2 = 2 * after + before, after + 2 * before
    same = left * right > 0
    with np.errstate(divide="ignore", invalid="ignore"):
        mean = (w_1 + w_2) / (w_1 / left + w_2 / right)
    d = np.where(same, mean, 0.0)
    return np.asarray(np.r_[d, d[0]])


@dataclass(frozen=True, eq=False)
class CyclePressure:
    """Pressures at n speeds as sums of a few traces over m crank angles.

    Torque is linear in the pressure, so its harmonics are found for the traces alone and then summed.
    """

    speeds: Floats  # (n,) of the crank [rad/s]
    angle: Floats  # (m,) crank angles from the top dead centre of firing, increasing over one cycle [rad]
    weight: Floats  # (m,) what each angle counts in an integral over the cycle [rad]
    traces: Floats  # (k, m) absolute pressures [Pa]
    firing: Floats  # (n, k) share of each trace in the pressure at each speed
    motored: Floats  # (n, k) the same without combustion
    crankcase_pressure: float  # under the piston [Pa]

    @cached_property
    def pressure(self) -> Floats:
        """Absolute pressure, shape (n, m) [Pa]."""
        return self.firing @ self.traces

    def at(self, angle: Floats) -> tuple[Floats, Floats]:
        """Pressure at any crank angles, by the monotone cubic through the points.

        Absolute pressure with combustion and without, shape (n, j) each [Pa]. `angle`: (j,) [rad].
        """
        cycle = float(self.weight.sum())
        traces = np.array([periodic_cubic(self.angle, trace, cycle, angle) for trace in self.traces])
        return self.firing @ traces, self.motored @ traces

    @property
    def peak_pressure(self) -> Floats:
        """Maximum pressure at each speed, shape (n,) [Pa]."""
        return np.asarray(peak(self.angle, self.pressure))


def peak(angle: Floats, pressure: Floats) -> Floats:
    """Maximum value of each row, by the parabola through its maximum point and the two beside it, (n,).

    The maximum values [Pa]. `angle`: (m,) crank angles [rad]; `pressure`: (n, m) rows of pressures [Pa].
    """
    top = np.clip(np.argmax(pressure, axis=1), 1, len(angle) - 2)
    row = np.arange(len(pressure))
    a, b, c = (angle[top + i] for i in (-1, 0, 1))
    p, q, r = (pressure[row, top + i] for i in (-1, 0, 1))
    # Divided differences of the parabola: slope at the middle, and half its curvature.
    left, right = (q - p) / (b - a), (r - q) / (c - b)
    half = (right - left) / (c - a)
    slope = left + half * (b - a)
    rise = -(slope**2) / (4 * np.where(half < 0, half, -np.inf))
    return np.asarray(q + rise)
