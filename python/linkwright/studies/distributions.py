"""Distributions of variables: the value below which a share of all machines lies, cut off at the ends."""

from __future__ import annotations

import math

import numpy as np

from linkwright.kernel.arrays import Floats

# Places of the sum of two scatters, and directions of a pin: the sum is smooth over a deviation of the first.
_PLACES, _DIRECTIONS = 16_385, 64


def scattered(kind: str, mean: float, deviation: float, low: float, high: float, shares: Floats) -> Floats:
    """Values below which shares of a distribution that is cut off at its ends lie."""
    if kind == "uniform":
        return low * (1 - shares) + high * shares
    if kind == "arcsine":
        return mean - 0.5 * (high - low) * np.cos(np.pi * shares)
    if kind == "triangular":
        # Kotz, van Dorp, Beyond Beta, 2004, section 1.1.
        peak, span = (mean - low) / (high - low), high - low
        rising = low + span * np.sqrt(shares * peak)
        return np.where(shares < peak, rising, high - span * np.sqrt((1 - shares) * (1 - peak)))
    from scipy.special import ndtri

    start, end = normal_shares(kind, mean, deviation, low, high)
    within = np.clip(start + (end - start) * shares, 2.0**-53, 1 - 2.0**-53)
    return np.clip(_unscored(kind, mean, deviation, ndtri(within)), low, high)


def loosened(
    kind: str, mean: float, deviation: float, low: float, high: float, play: float, shares: Floats
) -> Floats:
    """Values below which shares of a scatter lie to which a pin adds its play times a cosine."""
    from scipy.special import ndtr

    start, end = normal_shares(kind, mean, deviation, low, high)
    count = max(_DIRECTIONS, math.ceil(8 * play / deviation))
    # Chebyshev's nodes: all directions are alike.
    shifts = play * np.cos((np.arange(count) + 0.5) * np.pi / count)
    places = np.linspace(low - play, high + play, _PLACES)
    below = np.zeros(_PLACES)
    for shift in shifts.tolist():
        below += np.clip((ndtr((places - shift - mean) / deviation) - start) / (end - start), 0.0, 1.0)
    values: Floats = np.interp(shares, below / count, places)
    return values


def normal_shares(kind: str, mean: float, deviation: float, low: float, high: float) -> tuple[float, float]:
    """Shares of the whole distribution below its ends."""
    if kind not in ("normal", "lognormal"):
        return 0.0, 1.0
    from scipy.special import ndtr

    middle, width = _bell(kind, mean, deviation)
    if kind == "normal":
        return float(ndtr((low - middle) / width)), float(ndtr((high - middle) / width))
    start = float(ndtr((math.log(low) - middle) / width)) if low > 0 else 0.0
    return start, float(ndtr((math.log(high) - middle) / width)) if high < math.inf else 1.0


def _bell(kind: str, mean: float, deviation: float) -> tuple[float, float]:
    """Mean and deviation of the normal variable: the value, or its logarithm."""
    # Johnson, Kotz, Balakrishnan, *Continuous Univariate Distributions*, vol. 1, 2nd ed. 1994, chapter 14.
    if kind == "normal":
        return mean, deviation
    variance = math.log1p((deviation / mean) ** 2)
    return math.log(mean) - 0.5 * variance, math.sqrt(variance)


def _unscored(kind: str, mean: float, deviation: float, scores: Floats) -> Floats:
    middle, width = _bell(kind, mean, deviation)
    values = middle + width * scores
    return np.exp(values) if kind == "lognormal" else values
