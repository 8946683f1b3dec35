"""One stretch of a law, polynomial and harmonics over its own u from 0 to 1, and where it is zero.

.. math:: s(u) = \\sum_i c_i u^i + \\sum_j (a_j \\cos k_j u + b_j \\sin k_j u)

For its zeros the function is interpolated in so many Chebyshev points that nothing but rounding is left over;
the zeros of the series are eigenvalues of its colleague matrix.

Source: Trefethen, *Approximation Theory and Approximation Practice* (2013), chapter 18.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from linkwright.kernel.arrays import Floats
from linkwright.kernel.numerics.tangent import Tangent, cos, plain, primal, sin, total, variables_of

# Points beyond the degree of the polynomial, and for each radian of the fastest harmonic: its series falls
# like Bessel functions J_n(k/2), which are below rounding from n = k/2 + 20 on for the frequencies of motion
# laws.
_MORE = 24

# A zero this far outside is one at the end, moved by rounding.
_OUTSIDE = 1e-12

# Of a series, what is below this share of its largest coefficient is rounding.
_ROUNDING = 4e-15

# An eigenvalue farther from the real line than this is no zero; a double zero splits by the root of rounding.
_REAL = 1e-7


def zeros(function: Callable[[Floats], Floats], degree: int, frequency: float = 0.0) -> list[float]:
    """Zeros between 0 and 1, increasing. ``frequency``: of the fastest harmonic in it [rad]."""
    n = degree + (int(frequency) + _MORE if frequency else 1)
    series = _series(function, n)
    series = series[: _last(series) + 1]
    if len(series) < 2:
        return []
    roots = chebyshev.chebroots(series)
    real = roots.real[np.abs(roots.imag) < _REAL]
    u = 0.5 * (real + 1)
    return sorted(np.clip(u[(u > -_OUTSIDE) & (u < 1 + _OUTSIDE)], 0.0, 1.0).tolist())


def _series(function: Callable[[Floats], Floats], n: int) -> Floats:
    """Chebyshev coefficients of the interpolant of degree n, from its values in the n + 1 points."""
    x = np.cos(np.pi * (np.arange(n + 1) + 0.5) / (n + 1))
    coefficients = chebyshev.chebvander(x, n).T @ function(0.5 * (x + 1)) * 2 / (n + 1)
    coefficients[0] *= 0.5
    series: Floats = coefficients
    return series


def _last(series: Floats) -> int:
    """Index of the last coefficient above rounding; -1 if none is."""
    kept = np.flatnonzero(np.abs(series) > _ROUNDING * float(np.abs(series).max()))
    return int(kept[-1]) if len(kept) else -1


class Harmonic(NamedTuple):
    """a cos ku + b sin ku."""

    frequency: float  # k [rad over the piece]
    cosine: float
    sine: float


class Piece(NamedTuple):
    """A stretch of a law, over u from 0 to 1."""

    polynomial: tuple[float, ...]  # coefficients from the constant on; none is zero
    harmonics: tuple[Harmonic, ...] = ()  # what is added to the polynomial

    def at(self, u: Any) -> Any:
        """Value over u, of the same shape; with derivatives where the piece or u has some."""
        u = u if isinstance(u, Tangent) else np.asarray(u, dtype=float)
        value: Any = np.zeros(np.shape(u))
        for coefficient in reversed(self.polynomial):
            value = value * u + coefficient
        for k, a, b in self.harmonics:
            value = value + a * np.cos(k * u) + b * np.sin(k * u)
        return value

    def value(self, u: Any) -> Any:
        """The value at one place, a number; with derivatives if it has some."""
        return plain(self.at(u))

    @property
    def numbers(self) -> tuple[Any, ...]:
        """All coefficients."""
        return (*self.polynomial, *(x for wave in self.harmonics for x in wave))

    @property
    def primal(self) -> Piece:
        """The piece without derivatives."""
        if variables_of(self.numbers) is None:
            return self
        harmonics = tuple(Harmonic(*map(primal, wave)) for wave in self.harmonics)
        return Piece(tuple(map(primal, self.polynomial)), harmonics)

    def derivative(self, length: float) -> Piece:
        """Derivative by x = length·u."""
        polynomial = tuple(i * c / length for i, c in enumerate(self.polynomial))[1:]
        harmonics = tuple(Harmonic(k, k * b / length, -k * a / length) for k, a, b in self.harmonics)
        return Piece(polynomial, harmonics)

    def integral(self, length: float, start: float = 0.0) -> Piece:
        """Integral over x = length·u that begins with a value."""
        harmonics = tuple(Harmonic(k, -b * length / k, a * length / k) for k, a, b in self.harmonics)
        constant = start - total(harmonic.cosine for harmonic in harmonics)
        return Piece((constant, *(c * length / (i + 1) for i, c in enumerate(self.polynomial))), harmonics)

    def scaled(self, factor: float, shift: float = 0.0) -> Piece:
        """Factor times the piece, plus a constant."""
        polynomial = [factor * c for c in self.polynomial] or [0.0]
        polynomial[0] += shift
        return Piece(
            tuple(polynomial), tuple(Harmonic(k, factor * a, factor * b) for k, a, b in self.harmonics)
        )

    def part(self, low: float, high: float) -> Piece:
        """The stretch from u = low to high, counted from 0 to 1 anew; low above high turns it round."""
        width = high - low
        n = len(self.polynomial)
        shifted = tuple(
            total(self.polynomial[j] * math.comb(j, i) * low ** (j - i) for j in range(i, n)) * width**i
            for i in range(n)
        )
        return Piece(shifted, tuple(_shifted(harmonic, low, width) for harmonic in self.harmonics))

    def plus(self, other: Piece) -> Piece:
        """The sum of two pieces over the same stretch."""
        n = max(len(self.polynomial), len(other.polynomial))
        first, second = (piece.polynomial + (0.0,) * (n - len(piece.polynomial)) for piece in (self, other))
        polynomial = tuple(a + b for a, b in zip(first, second, strict=True))
        return Piece(polynomial, self.harmonics + other.harmonics)

    @property
    def waves(self) -> float:
        """The highest frequency [rad over the piece]."""
        return max((abs(primal(harmonic.frequency)) for harmonic in self.harmonics), default=0.0)

    def vanishes(self, scale: float) -> bool:
        """Whether all coefficients are zero within rounding of a scale."""
        sizes = [*self.polynomial, *(x for harmonic in self.harmonics for x in harmonic[1:])]
        return all(abs(size) <= 64 * np.finfo(float).eps * scale for size in sizes)


def _shifted(harmonic: Harmonic, low: float, width: float) -> Harmonic:
    k, a, b = harmonic
    c, s = cos(k * low), sin(k * low)
    return Harmonic(k * width, a * c + b * s, b * c - a * s)
