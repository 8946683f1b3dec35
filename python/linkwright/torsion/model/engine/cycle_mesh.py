"""Crank angles of a cycle for integrals: Gauss points in panels that end where the pressure has a corner."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from itertools import pairwise

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Gauss points of a panel: integrals of polynomials up to degree 11 are exact.
_POINTS = 6
# Panels of the closed cycle. With a compression ratio of 20 the pressure's nearest pole is some 25 deg away
# from the dead centre, so six points leave 1e-10 of it.
_CLOSED = math.radians(6.0)
# Panels of the gas exchange: order 24 turns by less than a third of its period from point to point.
_OPEN = math.radians(10.0)


@dataclass(frozen=True, eq=False)
class CycleMesh:
    """Crank angles and what they count in integrals."""

    angle: Array  # (m,) increasing [rad]
    weight: Array  # (m,) what each counts in an integral [rad]
    half_width: Array  # (m/6,) of the panels [rad]

    def integrals(self, values: Array) -> Array:
        """Integrals from the start to every angle, (n, m).

        Integrals of the polynomials through the points of each panel. `values`: (n, m) rows of values.
        """
        _, w, S = _gauss()
        panels = values.reshape(*values.shape[:-1], -1, _POINTS) * self.half_width[:, None]
        whole = panels @ w
        before = np.cumsum(whole, axis=-1) - whole
        return np.asarray((panels @ S.T + before[..., None]).reshape(values.shape))


@cache
def _gauss() -> tuple[Array, Array, Array]:
    """Gauss points, weights on −1 … 1, and integrals of Lagrange's polynomials from −1 to each point."""
    x, w = legendre.leggauss(_POINTS)
    k = np.arange(_POINTS)
    # The polynomial through the points has the Legendre coefficients (k + ½) Σ w_j P_k(x_j) y_j.
    analysis = (k[:, None] + 0.5) * legendre.legvander(x, _POINTS - 1).T * w
    S = np.column_stack([legendre.legval(x, legendre.legint(column, lbnd=-1)) for column in analysis.T])
    return np.asarray(x), np.asarray(w), np.asarray(S)


def mesh(edges: Array) -> CycleMesh:
    """Gauss points between given edges.

    Six points a panel. `edges`: (k,) ends of panels, increasing [rad].
    """
    x, w, _ = _gauss()
    half, middle = np.diff(edges) / 2, (edges[1:] + edges[:-1]) / 2
    return CycleMesh((middle[:, None] + half[:, None] * x).ravel(), np.outer(half, w).ravel(), half)


def closed_edges(start: float, end: float, releases: list[tuple[float, float]]) -> Array:
    """Ends of panels between closing and opening, (k,).

    Increasing [rad]. `start`, `end`: crank angles of closing and of opening [rad]; `releases`: [rad].
    """
    marks = [_even(start, end, _CLOSED)]
    for begin, duration in releases:
        n = 2 * math.ceil(duration / _CLOSED)
        marks.append(begin + duration * (np.arange(n + 1) / n) ** 2)
    edges = np.unique(np.concatenate(marks))
    return _apart(edges, {start, end, *(each for b, d in releases for each in (b, b + d))})


def open_edges(start: float, end: float, corners: tuple[float, ...]) -> Array:
    """Ends of panels between opening and closing, (k,).

    Increasing [rad]. `start`, `end`: crank angles of opening and of closing [rad]; `corners`: where the
    pressure has corners [rad].
    """
    ends = sorted({start, end, *(each for each in corners if start < each < end)})
    return np.unique(np.concatenate([_even(a, b, _OPEN) for a, b in pairwise(ends)]))


def _even(start: float, end: float, width: float) -> Array:
    return np.linspace(start, end, math.ceil((end - start) / width) + 1)


def _apart(edges: Array, corners: set[float]) -> Array:
    """The edges without those that lie close before another and are no corner."""
    keep = np.r_[np.diff(edges) > 0.05 * _CLOSED, True]
    first_of_release = np.isin(edges, list(corners))
    return np.asarray(edges[keep | first_of_release])
