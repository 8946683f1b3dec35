r"""Quantities over a revolution as Chebyshev series, piece by piece: their means, work and extremes.

Integrals of the series are exact, and its extremes are zeros of its derivative. `turn_fit` finds the series.

Source: L. N. Trefethen, Approximation Theory and Approximation Practice, 2013, chapters 3, 18, 19.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from numpy.polynomial import chebyshev

from linkwright.kernel.arrays import Complexes, Floats

# Values that differ by less than this share of the peak are equal.
_SAME = 1e-13


@dataclass(frozen=True)
class TurnCurve:
    """k quantities over the crank angle."""

    ends: Floats  # (p + 1,): ends of the pieces, increasing [rad]
    series: Floats  # (p, k, N): Chebyshev coefficients of each piece over its own width
    peak: Floats  # (k,): peak absolute value of each quantity among the nodes
    size: Floats  # (k,): integral of the absolute values, to some digits
    # (k,): error of the integrals, measured: deviation of each piece from the one that it is half of.
    error: Floats

    def integral(self) -> Floats:
        """Integral of each quantity over all pieces, (k,)."""
        # Summed in pairs: one after another, thousands of pieces lose three digits.
        pieces = np.einsum("pkn,n,p->kp", self.series, _integrals(self.series.shape[-1]), self._half())
        integral: Floats = pieces.sum(axis=1)
        return integral

    def mean(self) -> Floats:
        """Mean of each quantity, (k,)."""
        mean: Floats = self.integral() / (self.ends[-1] - self.ends[0])
        return mean

    def rms(self) -> Floats:
        """Root of the mean square of each quantity, (k,)."""
        values, weights = self._gauss(0.0)[:2]
        rms: Floats = np.sqrt(np.einsum("pkn,pn->k", values**2, weights) / (self.ends[-1] - self.ends[0]))
        return rms

    def harmonics(self, orders: Floats) -> Complexes:
        r"""Means :math:`\overline{f_k e^{-i\nu\varphi}}` over the revolution for orders ν, (k, orders)."""
        values, weights, phi = self._gauss(float(np.abs(orders).max(initial=0.0)))
        waves = np.exp(-1j * np.multiply.outer(orders, phi)) * weights / (self.ends[-1] - self.ends[0])
        harmonics: Complexes = np.einsum("pkn,opn->ko", values, waves, optimize=True)
        return harmonics

    def at(self, phi: Floats) -> Floats:
        """Values at crank angles within the pieces, (k, n); at a jump those after it."""
        last = len(self.ends) - 2
        piece = np.clip(np.searchsorted(self.ends, phi, side="right") - 1, 0, last)
        half = self._half()[piece]
        x = (phi - self.ends[piece]) / half - 1.0
        waves = chebyshev.chebvander(x, self.series.shape[-1] - 1)
        curves: Floats = np.einsum("nj,nkj->kn", waves, self.series[piece])
        return curves

    def crossings(self, k: int = 0) -> Floats:
        """Angles at which a quantity changes its sign, increasing [rad]; a touch is none."""
        zeros = [_zeros(series) for series in self.series[:, k]]
        middle, half = 0.5 * (self.ends[1:] + self.ends[:-1]), self._half()
        inside = [m + h * x for m, h, x in zip(middle, half, zeros, strict=True)]
        # A set, since `np.unique` imports masked arrays, which takes as long as a small study.
        marks = np.array(sorted(set(np.concatenate([self.ends, *inside]).tolist())))
        value = self.at(0.5 * (marks[1:] + marks[:-1]))[k]
        # What is rounding has no sign.
        kept = np.flatnonzero(np.abs(value) > _SAME * self.peak[k])
        changed = np.flatnonzero(np.diff(np.sign(value[kept])))
        crossings: Floats = marks[kept[changed + 1]]
        return crossings

    def extreme(self, sign: int, k: int = 0) -> tuple[float, float]:
        """Maximum (+1) or minimum (−1) value of a quantity, and the first crank angle that has it [rad].

        At a jump it is the limit from the side that has it.
        """
        values, angles = self._candidates(sign, k)
        first = np.flatnonzero(values >= values.max() - _SAME * self.peak[k])
        at = first[np.argmin(angles[first])]
        return float(sign * values[at]), float(angles[at])

    def extremes(self, sign: int, k: int, share: float) -> Floats:
        """Crank angles that have the maximum (+1) or minimum (−1) but for a share of the peak, increasing."""
        values, angles = self._candidates(sign, k)
        near: Floats = np.unique(angles[values >= values.max() - share * self.peak[k]])
        return near

    def excess(self, k: int, other: int, factor: float) -> TurnCurve:
        r"""The continuous quantity :math:`\int (f_k - \bar f_k)\,d\varphi + c f_o` with c the factor, from
        the first end.
        """
        n = self.series.shape[-1]
        surplus = self.series[:, k].copy()
        surplus[:, 0] -= self.mean()[k]
        rising = chebyshev.chebint(surplus.T, lbnd=-1).T * self._half()[:, None]
        # All polynomials T_n are 1 at the end of a piece.
        rising[:, 0] += np.concatenate([[0.0], np.cumsum(rising.sum(axis=1))[:-1]])
        rising[:, :n] += factor * self.series[:, other]
        peak = np.abs(rising).sum(axis=1).max(keepdims=True)
        return TurnCurve(self.ends, rising[:, None], peak, peak, self.error[[k]])

    def combined(self, weights: Floats, constants: Floats) -> TurnCurve:
        """Sums of the quantities with weights (m, k), plus constants (m,)."""
        series = np.einsum("mk,pkn->pmn", weights, self.series)
        series[:, :, 0] += constants
        values, quadrature = replace(self, series=series)._gauss(0.0)[:2]
        peak, size = np.abs(values).max(axis=(0, 2)), np.einsum("pkn,pn->k", np.abs(values), quadrature)
        return TurnCurve(self.ends, series, peak, size, np.abs(weights) @ self.error)

    def _gauss(self, order: float) -> tuple[Floats, Floats, Floats]:
        """Values (p, k, m), weights (p, m) and angles (p, m) of Gauss–Legendre quadrature."""
        # Exact for squares of the series, and for them times a wave of an order: a wave that turns by z
        # between the middle and the end of a piece is a polynomial of some z degrees, and some ten more, to
        # rounding.
        half, n = self._half(), self.series.shape[-1]
        x, w = np.polynomial.legendre.leggauss(n + int(np.ceil(order * half.max())) + 10 * (order > 0))
        values = self.series @ chebyshev.chebvander(x, n - 1).T
        middle = 0.5 * (self.ends[1:] + self.ends[:-1])
        return values, np.multiply.outer(half, w), middle[:, None] + np.multiply.outer(half, x)

    def _half(self) -> Floats:
        half: Floats = 0.5 * np.diff(self.ends)
        return half

    def _candidates(self, sign: int, k: int) -> tuple[Floats, Floats]:
        """Values times the sign, and angles, that may be the maximum: ends of pieces and zeros of slopes."""
        series = sign * self.series[:, k]
        low, high = series @ _alternating(series.shape[1]), series.sum(axis=1)
        values, angles = [low, high], [self.ends[:-1], self.ends[1:]]
        looks, rise = _looks(series.shape[1])
        samples = series @ looks
        top, bottom = samples.max(axis=1), samples.min(axis=1)
        bound = top + rise * (top - bottom)
        best = max(low.max(), high.max(), top.max())
        middle, half = 0.5 * (self.ends[1:] + self.ends[:-1]), self._half()
        # The piece that promises most comes first and spares most of the others.
        for p in np.argsort(-bound):
            if bound[p] < best - _SAME * self.peak[k]:
                break
            x = _flat_points(series[p])
            values.append(series[p] @ _waves(x, series.shape[1]))
            angles.append(middle[p] + half[p] * x)
            best = max(best, values[-1].max(initial=best))
        return np.concatenate(values), np.concatenate(angles)


@cache
def _integrals(count: int) -> Floats:
    """Integrals of T_n from −1 to 1: 2/(1 − n²) for even n."""
    n = np.arange(count)
    even = n % 2 == 0
    return np.where(even, 2.0 / np.where(even, 1.0 - n**2, 1.0), 0.0)


@cache
def _looks(count: int) -> tuple[Floats, float]:
    """T_n of 4 N places, (N, 4 N), and the share of their range by which N terms may exceed them."""
    # A polynomial of degree n is at most 1/cos(π n/2M) times its largest size on the M zeros of T_M, about
    # the middle of the range: H. Ehlich, K. Zeller, Schwankung von Polynomen zwischen Gitterpunkten,
    # Mathematische Zeitschrift 86 (1964) 41–44.
    places = chebyshev.chebpts1(4 * count)
    rise = 0.5 * (1 / np.cos(np.pi * (count - 1) / (8 * count)) - 1)
    return np.ascontiguousarray(chebyshev.chebvander(places, count - 1).T), float(rise)


def _flat_points(series: Floats) -> Floats:
    """Where the derivative of a series is zero, within its piece."""
    return _zeros(series @ _slopes(len(series)))


def _zeros(series: Floats) -> Floats:
    """Where a series is zero, within its piece: eigenvalues of its colleague matrix."""
    # Leading coefficients of rounding would put zeros anywhere.
    degree = int(np.flatnonzero(np.abs(series) > 1e-15 * np.abs(series).max(initial=0.0))[-1:].sum())
    if degree == 0:
        return np.empty(0)
    if degree == 1:
        roots = np.array([-series[0] / series[1]])
    else:
        matrix, scale = _colleague(degree)
        matrix = matrix.copy()
        matrix[:, 0] -= series[degree - 1 :: -1] / series[degree] * scale
        roots = np.linalg.eigvals(matrix)
    # A double zero splits into a complex pair by the root of rounding.
    real = roots.real[np.abs(roots.imag) < 1e-6]
    return np.asarray(real[np.abs(real) <= 1.0])


@cache
def _alternating(count: int) -> Floats:
    """T_n(−1) = (−1)ⁿ."""
    return np.where(np.arange(count) % 2 == 0, 1.0, -1.0)


@cache
def _slopes(count: int) -> Floats:
    """Coefficients → those of the derivative, (N, N − 1)."""
    return np.ascontiguousarray(chebyshev.chebder(np.eye(count)).T)


@cache
def _colleague(degree: int) -> tuple[Floats, Floats]:
    """Colleague matrix of T_n alone, and by what the other coefficients over the leading one count in it."""
    # Turned over, as `chebroots` has it: so its eigenvalues err less.
    matrix = chebyshev.chebcompanion(np.append(np.zeros(degree), 1.0))[::-1, ::-1]
    scale = np.full(degree, 0.5)
    scale[-1] = np.sqrt(0.5)
    return np.ascontiguousarray(matrix), scale


def _waves(x: Floats, count: int) -> Floats:
    """T_n(x) = cos(n arccos x) at places within the piece, (N, places)."""
    return np.asarray(np.cos(np.multiply.outer(np.arange(count), np.arccos(x))))
