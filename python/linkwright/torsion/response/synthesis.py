"""What harmonics add up to over time, in phase: waveforms and their extremes.

Orders with a common base, as ½, 1, 1½, … of a four-stroke engine, repeat after as many revolutions, and their
sum has exact extremes. Orders without one, as those of a wheel with 37 teeth on one with 13, meet in every
phase sooner or later: of them the amplitudes add up.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from math import lcm

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.errors import require_within
from linkwright.kernel.limits import RESPONSE
from linkwright.torsion.core.response import extremes

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]

# Largest number of turns after which orders repeat, and of harmonics in that time.
_TURNS = 60
_HARMONICS = 2048

# How close an order must be to a fraction.
_EQUAL = 1e-9


@dataclass(frozen=True)
class Orders:
    """How orders go together."""

    values: Floats  # (orders,) cycles per revolution
    turns: float  # after which those with a common base repeat
    # (orders,) waves of each in that time; 0 of one that has no common base with the others.
    harmonic: NDArray[np.int64]

    @cached_property
    def together(self) -> NDArray[np.bool_]:
        """Which of them have a common base."""
        return self.harmonic > 0


def orders_together(values: Floats) -> Orders:
    """Find the common base of orders, of as many of them as have one.

    `values`: (orders,) cycles per revolution, above zero.
    """
    return _together(tuple(values.tolist()))


@lru_cache(maxsize=32)
def _together(listed: tuple[float, ...]) -> Orders:
    """The same once for all speeds at which a train is looked at."""
    values = np.array(listed)
    # Orders behind a gear stage go by its ratio, which need be no fraction: they are counted by the lowest.
    units = [1.0, values.min()] if len(values) else [1.0]
    return max((_counted(values, unit) for unit in units), key=lambda each: each.together.sum())


def _counted(values: Floats, unit: float) -> Orders:
    """Orders as fractions of a unit."""
    share = (values / unit).tolist()
    fractions = [Fraction(value).limit_denominator(_TURNS) for value in share]
    close = [abs(f - v) <= _EQUAL * v for f, v in zip(fractions, share, strict=True)]
    turns, highest = 1, max(share, default=0.0)
    for f, fits in sorted(zip(fractions, close, strict=True), key=lambda each: each[0].denominator):
        more = lcm(turns, f.denominator)
        if fits and more <= _TURNS and more * highest <= _HARMONICS:
            turns = more
    # One of far more waves than the others would ask for as many harmonics: it stands alone.
    within = [value * turns <= _HARMONICS for value in share]
    fits_base = [
        ok and few and turns % f.denominator == 0 for f, ok, few in zip(fractions, close, within, strict=True)
    ]
    harmonic = np.where(fits_base, np.rint(np.array(share) * turns), 0).astype(np.int64)
    return Orders(values, turns / unit, harmonic)


def span(orders: Orders, amplitudes: Complexes, mean: Floats | float = 0.0) -> tuple[Floats, Floats]:
    """Maximum and minimum value of what harmonics add up to.

    Gives `greatest`, `least`: with the amplitudes of orders without a common base added to both sides.
    `amplitudes`: (orders, ...).
    """
    top, _, bottom, _ = extremes(coefficients(orders, amplitudes, mean))
    rest = np.abs(amplitudes[~orders.together]).sum(axis=0)
    return top + rest, bottom - rest


def coefficients(orders: Orders, amplitudes: Complexes, mean: Floats | float = 0.0) -> Complexes:
    """Harmonics 0, 1, 2, … of the time in which the orders repeat, (harmonics, ...).

    `amplitudes`: (orders, ...).
    """
    count = int(orders.harmonic.max(initial=0)) + 1
    remedy = "lower the highest order, or train.run.points"
    require_within(RESPONSE, count * math.prod(amplitudes.shape[1:]), "forced response", remedy)
    found = np.zeros((count, *amplitudes.shape[1:]), complex)
    found[orders.harmonic[orders.together]] = amplitudes[orders.together]
    found[0] = mean
    return found


def waveform(orders: Orders, amplitudes: Complexes, mean: Floats | float = 0.0, points: int = 1440) -> Floats:
    """The sum of harmonics over the time in which they repeat, (points, ...).

    Over `Orders.turns` turns. `amplitudes`: (orders, ...).
    """
    harmonic = coefficients(orders, amplitudes, mean)
    phase = 2j * np.pi * np.outer(np.arange(points) / points, np.arange(len(harmonic)))
    found: Floats = np.tensordot(np.exp(phase), harmonic, axes=1).real
    return found
