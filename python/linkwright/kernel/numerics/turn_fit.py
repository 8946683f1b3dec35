r"""Quantities over a revolution, fitted by Chebyshev series from kink to kink with a measured error.

A piece is a series through N nodes inside it, so that a jump at its end is seen from one side only. It is
halved until the series of the whole agrees with the values of its halves and close to its ends, where nothing
of it was fitted; that deviation is the error, and the halves, which are better, are kept. A kink between the
last node and an end is seen at the end only.

Where a kink or a jump is not known beforehand, halving closes in on it: the piece that holds it becomes as
narrow as its share of the integral must be.

Source: R. Pachón, R. B. Platte, L. N. Trefethen, Piecewise-smooth chebfuns, IMA Journal of Numerical Analysis
30 (2010) 898–916.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from linkwright.kernel.arrays import Bools, Floats
from linkwright.kernel.errors import ConvergenceError, FindingError
from linkwright.kernel.numerics.turn_curve import TurnCurve

# Values of k quantities at crank angles (n,), shape (k, n).
Quantities = Callable[[Floats], Floats]

# Nodes of a piece: fewer ask for more pieces, more for longer ones; the work is smallest between 12 and 24.
_NODES = 16

# Pieces of the revolution to begin with, so that a peak of some ten degrees is not between the first nodes.
_PIECES = 8

# Where the ends of a piece are looked at, as a share of it: inside, since a jump may be at the end.
_INSIDE = 1e-9

# Deviation at an end over that inside, beyond which it is a kink: rounding is off by as much everywhere.
_KINK = 10.0

# Deviation over the peak, and share of the mean size, at which a piece will do: some hundreds of rounding.
_CLOSE = 1e-13

# Within so small an angle [rad] everything is a polynomial of low degree, and the high coefficients are
# rounding. It is looked at at two places of a piece that is much longer, of which a jump is in one at most.
_PROBE = 2e-10
_PROBED = (0.382, 0.618)
_LONG = 1e-8

# Deviation in terms of the mean high coefficient of rounding: coefficients are a third of the values'
# rounding (√(2/N)), and the maximum of some hundred deviations, amplified by extrapolation, is ten of them.
_ROUNDING = 40.0

# Width [rad] of a piece that holds a jump: what is left of it counts for nothing in an integral.
_NARROW = 1e-13

# Open pieces at most, besides those to begin with: jumps and kinks take one each, a quantity without any
# smoothness takes all.
_PIECES_MAX = 4096

# Error of a mean over the mean size beyond which there is no answer: two digits better than the loads of any
# machine are known.
_ERROR_MAX = 1e-8


def turn_curve(of: Quantities, kinks: Floats, what: str) -> TurnCurve:
    """Quantities over a revolution, as exactly as their rounding allows; `what` they are, for messages.

    `kinks`: (m + 1,), angles between which they are smooth, from start to end of the revolution [rad]; one
    that is left out costs pieces, not accuracy. The error of the integrals is below 1e-9 of the mean size of
    each quantity, and near rounding as a rule: a `ConvergenceError` if it is greater, a `FindingError` if a
    quantity has no value at some angle.
    """
    fit = _Fit(of, what)
    fit.begin(kinks)
    while fit.is_open:
        fit.halve()
    return fit.result()


class _Fit:
    """Pieces under way: those done, and those whose halves are to be compared with them."""

    def __init__(self, of: Quantities, what: str) -> None:
        self.of, self.what = of, what
        self.done: list[_Pieces] = []

    def begin(self, kinks: Floats) -> None:
        """The first pieces, and how large the quantities are."""
        counts = np.ceil(np.diff(kinks) / (2 * np.pi / _PIECES) - 1e-9).astype(int)
        spans = zip(kinks[:-1], kinks[1:], counts, strict=True)
        ends = np.append(
            np.concatenate([np.linspace(a, b, n, endpoint=False) for a, b, n in spans]), kinks[-1]
        )
        self.low, self.high = ends[:-1], ends[1:]
        self.most = len(self.low) + _PIECES_MAX
        values = self._values(self.low, self.high)
        self.peak = np.abs(values).max(axis=(0, 2))
        self.size = _size(values, self.low, self.high)
        self.series = values @ _analysis().T

    @property
    def is_open(self) -> bool:
        """Whether pieces are left that are not good enough, and there is room for their halves."""
        return 0 < len(self.low) <= self.most

    def halve(self) -> None:
        """Compare all open pieces with the values of their halves; keep the halves of those that agree."""
        middle = 0.5 * (self.low + self.high)
        low, high = np.stack([self.low, middle], axis=1), np.stack([middle, self.high], axis=1)
        values = self._values(low.ravel(), high.ravel())
        self.peak = np.maximum(self.peak, np.abs(values).max(axis=(0, 2)))
        halves = values.reshape(len(middle), 2, *values.shape[1:])
        inside = np.abs(np.einsum("pkn,hmn->phkm", self.series, _prediction()) - halves).max(axis=(1, 3))
        at_ends = np.abs(self.series @ _at_ends() - self._ends()).max(axis=2)
        off = np.where(at_ends > _KINK * inside, at_ends, inside)
        width = (self.high - self.low)[:, None]
        rounding = np.zeros_like(off)
        doubtful = ~self._is_good(off, width, rounding) & (width[:, 0] > _LONG)
        if doubtful.any():
            rounding[doubtful] = self._rounding(self.low[doubtful], width[doubtful, 0])
        good = self._is_good(off, width, rounding) | (width[:, 0] < _NARROW)
        series = (values @ _analysis().T).reshape(halves.shape)
        # A polynomial through a jump overshoots; so narrow a piece counts by its mean alone.
        series[width[:, 0] < _NARROW, ..., 1:] = 0.0
        kept = low[good].ravel(), high[good].ravel(), _flat(series[good])
        self.done.append(_Pieces(*kept, (off * width)[good], (rounding * width)[good]))
        self.low, self.high, self.series = low[~good].ravel(), high[~good].ravel(), _flat(series[~good])
        self.left = np.repeat((off * width)[~good] / 2, 2, axis=0)

    def _is_good(self, off: Floats, width: Floats, rounding: Floats) -> Bools:
        """Whether a deviation is rounding, or small beside the peak and, times the width, beside the mean."""
        share = off * width <= np.maximum(_CLOSE * self.size, rounding * width)
        near = off <= np.maximum(_CLOSE * self.peak, rounding)
        good: Bools = (share & near).all(axis=1)
        return good

    def _rounding(self, low: Floats, width: Floats) -> Floats:
        """How far rounding moves the values of pieces, (p, k)."""
        errors = []
        for share in _PROBED:
            start = low + share * width
            tail = self._values(start, start + _PROBE) @ _analysis()[_NODES // 2 :].T
            errors.append(np.sqrt((tail**2).mean(axis=2)))
        rounding: Floats = _ROUNDING * np.minimum(*errors)
        return rounding

    def result(self) -> TurnCurve:
        """All pieces in order, if they are good enough."""
        if len(self.low):
            nothing = np.zeros_like(self.left)
            self.done.append(_Pieces(self.low, self.high, self.series, self.left, nothing))
        low, high, series, errors, roundings = (
            np.concatenate([getattr(piece, name) for piece in self.done]) for name in _Pieces._fields
        )
        order = np.argsort(low)
        error, size = errors.sum(axis=0), _size(series @ _synthesis(), low, high)
        wrong = error > np.maximum(_ERROR_MAX * size, roundings.sum(axis=0))
        if wrong.any():
            raise self._too_fast(
                f"its integral is known to {(error / size)[wrong].max():.1e} of its size only"
            )
        return TurnCurve(np.append(low[order], high.max()), series[order], self.peak, size, error)

    def _too_fast(self, fault: str) -> ConvergenceError:
        return ConvergenceError(
            f"{self.what} over the crank angle: {fault}; look for a mechanism that nearly locks, or a "
            "formula that varies without end",
            method="piecewise Chebyshev series",
            iterations=sum(len(piece.low) for piece in self.done),
        )

    def _values(self, low: Floats, high: Floats) -> Floats:
        """Values at the nodes of pieces, (p, k, N)."""
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        return self._at(middle[:, None] + half[:, None] * _nodes())

    def _ends(self) -> Floats:
        """Values close to the ends of the open pieces, (p, k, 2)."""
        inside = _INSIDE * (self.high - self.low)
        return self._at(np.stack([self.low + inside, self.high - inside], axis=1))

    def _at(self, angles: Floats) -> Floats:
        """Values at angles of each piece, (p, n) to (p, k, n)."""
        phi = np.ascontiguousarray(angles.ravel())
        values = self.of(phi)
        if not np.isfinite(values).all():
            at = np.degrees(phi[np.argmin(np.isfinite(values).all(axis=0))])
            raise FindingError(f"the {self.what} has no finite value at crank angle {at:.4g}°")
        samples: Floats = values.reshape(len(values), *angles.shape).swapaxes(0, 1)
        return samples


class _Pieces(NamedTuple):
    """Pieces that are done: ends (2m,), series (2m, k, N); errors and rounding of the integrals (…, k)."""

    low: Floats
    high: Floats
    series: Floats
    error: Floats
    rounding: Floats


def _size(values: Floats, low: Floats, high: Floats) -> Floats:
    """Integrals of the absolute values of quantities (p, k, N), to some digits."""
    size: Floats = (high - low) @ np.abs(values).mean(axis=2)
    return size


def _flat(pairs: Floats) -> Floats:
    """Halves one after another, (pieces, 2, k, N) → (2 pieces, k, N)."""
    flat: Floats = pairs.reshape(-1, *pairs.shape[2:])
    return flat


@cache
def _nodes() -> Floats:
    """Zeros of T_N, increasing."""
    nodes: Floats = np.asarray(chebyshev.chebpts1(_NODES))
    return nodes


@cache
def _analysis() -> Floats:
    """Values at the nodes → coefficients: (2/N) T_n(x_j), half of it for n = 0."""
    matrix = chebyshev.chebvander(_nodes(), _NODES - 1).T * (2 / _NODES)
    matrix[0] *= 0.5
    return np.asarray(matrix)


@cache
def _synthesis() -> Floats:
    """Coefficients → values at the nodes."""
    return np.ascontiguousarray(chebyshev.chebvander(_nodes(), _NODES - 1).T)


@cache
def _prediction() -> Floats:
    """Coefficients of a piece → values at the nodes of its halves, (2, N, N)."""
    halves = (0.5 * (_nodes() - 1), 0.5 * (_nodes() + 1))
    return np.stack([chebyshev.chebvander(x, _NODES - 1) for x in halves])


@cache
def _at_ends() -> Floats:
    """Coefficients of a piece → values close to its ends, (N, 2)."""
    return np.ascontiguousarray(chebyshev.chebvander([2 * _INSIDE - 1, 1 - 2 * _INSIDE], _NODES - 1).T)
