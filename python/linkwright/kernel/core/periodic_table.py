r"""A function that repeats with an angle, as the core takes it: value, slope and bend at even knots.

Between the knots the core runs quintics through all three, so that the slope it uses is that of the very
function whose value it uses. Three ways lead to the knots:

- *smooth*: the trigonometric polynomial through even samples, exact for anything that has fewer waves than
half the
  samples; for inertias of mechanisms, whose harmonics fall geometrically;
- *spline*: the periodic cubic spline through even samples; for torques with kinks, about which a
trigonometric
  polynomial would swing;
- *waves*: given harmonics.

References
----------
.. [1] Trefethen, Spectral Methods in MATLAB, 2000, chapter 3: differentiation by the discrete Fourier
transform.
.. [2] de Boor, A Practical Guide to Splines, 1978, chapter IV: cubic splines by the slopes at their knots.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from linkwright.kernel.arrays import Floats

# Knots between which a quintic of a function with the harmonics of a slider-crank errs by less than 1e-12.
_KNOTS = 512

# Knots a wave at least: the sixth power of 2π/32 over 46080 is 1e-9.
_KNOTS_A_WAVE = 32


@dataclass(frozen=True)
class PeriodicTable:
    """Value, slope and bend at even knots over a period, the first at angle zero."""

    period: float  # [rad]
    # (knots,): the function and its first and second derivatives by the angle.
    value: Floats
    slope: Floats
    bend: Floats

    @property
    def mean(self) -> float:
        """Mean value over a period: of the function that the core uses, exactly."""
        # The integral of a quintic is h(y₀ + y₁)/2 + h²(s₀ − s₁)/10 + …; the differences cancel over the
        # period.
        h = self.period / len(self.value)
        return float(self.value.mean() + h * h / 60 * self.bend.mean())


def smooth(values: ArrayLike, period: float = 2 * np.pi) -> PeriodicTable:
    """The trigonometric polynomial through even samples, (samples,), over one period [rad], with at least 512
    knots.

    The first sample is at angle zero; its repetition at the end is left out.
    """
    y = np.asarray(values, dtype=np.float64)
    n = len(y)
    knots = n * max(1, -(-_KNOTS // n))
    spectrum = np.fft.rfft(y)
    padded = np.zeros(knots // 2 + 1, dtype=complex)
    padded[: len(spectrum)] = spectrum * (knots / n)
    # The wave of two samples is known only at them: half of it counts either way, so that it is a cosine.
    if n % 2 == 0 and knots > n:
        padded[n // 2] *= 0.5
    waves = 2j * np.pi / period * np.arange(len(padded))
    if knots % 2 == 0:
        waves[-1] = 0.0
    lists = [np.fft.irfft(padded * waves**order, knots) for order in range(3)]
    return PeriodicTable(period, lists[0] if knots > n else y, lists[1], lists[2])


def spline(values: ArrayLike, period: float = 2 * np.pi) -> PeriodicTable:
    """The periodic cubic spline through even samples, (samples,), over one period [rad].

    The first sample is at angle zero; its repetition at the end is left out. There is a knot at each sample;
    the core's quintics are then the spline's cubics.
    """
    y = np.asarray(values, dtype=np.float64)
    h = period / len(y)
    # (s₋ + 4s + s₊)/3 = (y₊ − y₋)/h has the same equation at every knot, so that waves solve it.
    wave = 2 * np.pi * np.arange(len(y) // 2 + 1) / len(y)
    ratio = 1j * np.sin(wave) * 3 / ((2 + np.cos(wave)) * h)
    slope = np.fft.irfft(np.fft.rfft(y) * ratio, len(y))
    rise = np.roll(y, -1) - y
    bend = 6 * rise / h**2 - (4 * slope + 2 * np.roll(slope, -1)) / h
    return PeriodicTable(period, y, slope, bend)


def waves(
    orders: Sequence[float], amplitudes: ArrayLike, phases: ArrayLike, turns: int = 1, mean: float = 0.0
) -> PeriodicTable:
    r"""Harmonics :math:`\sum M_\nu \cos(\nu\varphi + \beta_\nu)` about a mean, exact at the knots.

    ν in cycles per revolution, whole numbers times the `turns` of a period; M_ν and β_ν [rad], (orders,)
    each.
    """
    nu, amplitude, phase = (np.atleast_1d(np.asarray(x, dtype=float)) for x in (orders, amplitudes, phases))
    highest = float(nu.max(initial=0.0)) * turns
    knots = max(_KNOTS, _KNOTS_A_WAVE * int(np.ceil(highest)))
    angle = 2 * np.pi * turns * np.arange(knots)[:, None] / knots
    phi = nu * angle + phase
    value = mean + (amplitude * np.cos(phi)).sum(axis=1)
    slope = -(amplitude * nu * np.sin(phi)).sum(axis=1)
    bend = -(amplitude * nu**2 * np.cos(phi)).sum(axis=1)
    return PeriodicTable(2 * np.pi * turns, value, slope, bend)
