"""Harmonics of a measured card that stand above its noise."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from linkwright.kernel.arrays import Bools, Floats

# Share of the harmonics, the highest, that are taken for noise, and by how much others must stand above it.
_NOISE, _ABOVE = 1 / 3, 4.0

# A harmonic counts if half of so many below it stand above the noise as well: rounding makes single ones.
_WINDOW = 8

# Harmonics of a card at least: below, no shape of a pump card is left.
_LEAST = 6

# Relative size of a coefficient that is rounding.
_ROUNDING = 1e-12


class Filtered(NamedTuple):
    """A measured quantity by its harmonics above the noise."""

    samples: Floats  # (m,) of a period
    harmonics: int
    noise: float  # standard deviation of the noise of a sample


def filtered(values: Floats, m: int, harmonics: int | None) -> Filtered:
    """A quantity of n samples by its harmonics above the noise, or by as many as given, at m samples."""
    n = len(values)
    coefficients = np.fft.rfft(values) / n
    highest = (n - 1) // 2
    sizes = np.abs(coefficients[1 : highest + 1])
    # Half of Rayleigh-distributed amplitudes lie below 1.18 of their parameter.
    tail = sizes[int((1 - _NOISE) * highest) :]
    floor = max(float(np.median(tail)) / 1.1774, _rounding(values) / np.sqrt(2 * n))
    level = max(_ABOVE * floor, _ROUNDING * float(np.abs(coefficients).max()))
    chosen = max(_highest(sizes > level), min(_LEAST, highest))
    count = min(chosen if harmonics is None else harmonics, highest, (m - 1) // 2)
    kept = np.zeros(m // 2 + 1, dtype=complex)
    kept[: count + 1] = coefficients[: count + 1]
    return Filtered(np.fft.irfft(kept * m, m), count, floor * np.sqrt(2 * n))


def _rounding(values: Floats) -> float:
    """Standard deviation of rounding to multiples of the smallest difference of the values."""
    different = np.unique(values)
    return float(np.diff(different).min()) / np.sqrt(12) if len(different) > 1 else 0.0


def _highest(above: Bools) -> int:
    """The highest harmonic above the noise, of which most of those just below it are."""
    below = np.convolve(above, np.ones(_WINDOW))[: len(above)]
    counted = np.minimum(np.arange(1, len(above) + 1), _WINDOW)
    places = np.flatnonzero(above & (below >= counted / 2))
    return int(places[-1]) + 1 if len(places) else 0


def smoothed(samples: Floats, harmonics: int) -> Floats:
    """Samples under Lanczos' factors sin(πx)/(πx), x = n/(N + 1): a steep flank does not ripple."""
    coefficients = np.fft.rfft(samples)
    factors = np.sinc(np.arange(len(coefficients)) / (harmonics + 1))
    return np.fft.irfft(coefficients * factors, len(samples))
