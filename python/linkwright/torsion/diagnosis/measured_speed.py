r"""A speed measured over a cycle, as harmonics.

.. math:: c_\nu = \frac2K \sum_{k=0}^{K-1} \omega_k\, e^{-i\nu\varphi_k}, \qquad
    \sigma_\nu = \sigma \sqrt{2/K}

for K samples at even steps of the angle; σ is the standard deviation of a sample, and that of real and
imaginary part of each harmonic follows.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.errors import InputError, ShapeError
from linkwright.kernel.public import public
from linkwright.kernel.public.arguments import Column
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.units import COUNT, SPEED, Quantity, positive

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]

# How close waves in the time of the samples must be to a whole number.
_EQUAL = 1e-9


@dataclass(frozen=True)
class MeasuredSpeed:
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
