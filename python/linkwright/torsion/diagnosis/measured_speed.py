r"""A speed measured over a cycle, or recorded over the crank angle, as harmonics.

.. math:: c_\nu = \frac2K \sum_{k=0}^{K-1} \omega_k\, e^{-i\nu\varphi_k}, \qquad
    \sigma_\nu = \sigma \sqrt{2/K}

for K samples at even steps of the angle; σ is the standard deviation of a sample, and that of real and
imaginary part of each harmonic follows.

Samples at even steps over whole cycles, from the angle :math:`\varphi_0` on, are those of `measured_speed`
turned back by :math:`e^{-i\nu\varphi_0}`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from linkwright.kernel.arrays import Complexes, Floats
from linkwright.kernel.errors import InputError, ShapeError
from linkwright.kernel.public import public
from linkwright.kernel.public.arguments import Column
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.result import PlainRecord
from linkwright.kernel.units.kinds import COUNT, SPEED
from linkwright.kernel.units.marks import Quantity, positive

# How close waves in the time of the samples must be to a whole number.
_EQUAL = 1e-9


@dataclass(frozen=True)
class MeasuredSpeed(PlainRecord):
    """Harmonics of the speed of a disc.

    Attributes
    ----------
    disc : str
        Where it was measured.
    orders : ndarray, shape (orders,)
        Cycles per revolution of the first disc.
    harmonics : ndarray of complex, shape (orders,)
        c of Re Σ c e^{iνφ}, φ the angle of the first disc [rad/s].
    noise : ndarray, shape (orders,), or None
        Standard deviation of their real and imaginary parts, if known [rad/s].
    """

    disc: str
    orders: Floats
    harmonics: Complexes
    noise: Floats | None = None


@public
def measured_speed(
    disc: str, samples: Floats, turns: int, orders: Column, noise: float | None = None
) -> MeasuredSpeed:
    """Harmonics of a speed from samples.

    Parameters
    ----------
    disc : str
        Where it was measured.
    samples : array_like, shape (n,)
        Speed at even steps of the angle of the first disc, from 0 on, over whole revolutions [rad/s].
    turns : int
        How many revolutions of the first disc they span.
    orders : array_like, shape (orders,)
        Those wanted.
    noise : float, optional
        Standard deviation of a sample [rad/s].

    Returns
    -------
    MeasuredSpeed
        Its mean is left out.

    Raises
    ------
    ShapeError
        Too few samples for the highest order.
    InputError
        A sample is no number, or an order does not repeat in these revolutions.
    """
    in_range(
        samples=(samples, Quantity(SPEED)), orders=(orders, positive(COUNT)), noise=(noise, positive(SPEED))
    )
    values, wanted = np.asarray(samples, float), np.atleast_1d(np.asarray(orders, float))
    waves = wanted * turns
    apart = np.abs(waves - np.rint(waves)) > _EQUAL * np.maximum(waves, 1.0)
    if apart.any() or (waves < 1).any():
        order = wanted[apart | (waves < 1)][0]
        raise InputError(
            f"order {order:.6g} does not repeat in {turns} revolutions: expected multiples of 1/{turns}"
        )
    if len(values) <= 2 * waves.max():
        least = int(2 * np.rint(waves.max())) + 1
        raise ShapeError(
            f"{len(values)} samples in {turns} revolutions: order {wanted.max():.6g} needs {least}"
        )
    angle = 2 * np.pi * turns * np.arange(len(values)) / len(values)
    harmonics = 2 / len(values) * np.exp(-1j * wanted[:, None] * angle) @ values
    spread = None if noise is None else np.full(len(wanted), noise * np.sqrt(2 / len(values)))
    return MeasuredSpeed(disc, wanted, harmonics, spread)


# Share of a step by which angles may miss even steps: records are printed with a few digits.
_UNEVEN = 0.02
# Fewest samples that show what any engine does.
_FEWEST = 8


@dataclass(frozen=True)
class RecordedSpeed:
    """Speed of a disc at even steps of the crank angle."""

    start: float  # crank angle of the first sample [rad]
    samples: Floats  # (n,) [rad/s]
    turns: int  # of the crank that they span

    @property
    def mean(self) -> float:
        """Mean speed over the angle [rad/s]."""
        return float(self.samples.mean())

    def orders(self, orders: Floats) -> Floats:
        """Those of some orders that the record can tell.

        Orders that repeat in the revolutions of the record, with more than two samples a wave. `orders`:
        (orders,) cycles per revolution.
        """
        waves = orders * self.turns
        is_integer = np.abs(waves - np.rint(waves)) <= 1e-9 * np.maximum(waves, 1.0)
        resolved: Floats = orders[is_integer & (waves >= 1) & (2 * waves < len(self.samples))]
        return resolved

    def harmonics(self, disc: str, orders: Floats, noise: float | None = None) -> MeasuredSpeed:
        """Harmonics over the crank angle, 0 where it is 0; `noise`: deviation of a sample [rad/s]."""
        measured = measured_speed(disc, self.samples, self.turns, orders, noise)
        turned = measured.harmonics * np.exp(-1j * measured.orders * self.start)
        return MeasuredSpeed(disc, measured.orders, turned, measured.noise)


def recorded_speed(angle: ArrayLike, speed: ArrayLike, turns: int) -> RecordedSpeed:
    """A record over one or more whole cycles.

    A last sample that stands where the first does a cycle later is left out. `angle`: (n,) crank angles,
    increasing by even steps [rad]; `speed`: (n,) [rad/s].
    """
    phi, omega = np.asarray(angle, float), np.asarray(speed, float)
    if phi.shape != omega.shape or phi.ndim != 1:
        raise ShapeError(f"{phi.size} angles and {omega.size} speeds: expected as many of both")
    if len(phi) < _FEWEST:
        raise ShapeError(f"{len(phi)} samples of the speed: expected at least {_FEWEST}")
    step = _even_step(phi)
    cycle = 2 * np.pi * turns
    # With the step after the last sample, or with the first sample once more.
    for n in (len(phi), len(phi) - 1):
        cycles = n * step / cycle
        if round(cycles) >= 1 and abs(n * step - round(cycles) * cycle) <= step / 2:
            return RecordedSpeed(float(phi[0]), omega[:n], round(cycles) * turns)
    a, b, span = np.degrees([phi[0], phi[-1], cycle])
    raise InputError(
        f"speed from {a:.6g}° to {b:.6g}° in steps of {np.degrees(step):.6g}°: expected whole cycles of "
        f"{span:.6g}°"
    )


def _even_step(phi: Floats) -> float:
    step = float(phi[-1] - phi[0]) / (len(phi) - 1)
    steps = np.diff(phi)
    wrong = np.flatnonzero(~(np.abs(steps - step) <= _UNEVEN * abs(step))) if step > 0 else np.array([0])
    if len(wrong):
        at, here = np.degrees(phi[wrong[0]]), np.degrees(steps[wrong[0]])
        raise InputError(
            f"a step of {here:.6g}° after {at:.6g}°: expected even steps that increase, "
            f"{np.degrees(step):.6g}°; sample the speed over the angle, by the marks of a disc"
        )
    return step
