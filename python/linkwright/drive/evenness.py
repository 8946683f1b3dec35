r"""How evenly a shaft turns: the coefficients δ, H and k_p, of one motion or of many at once.

.. math:: \delta = \frac{\omega_{max} - \omega_{min}}{\omega_m}, \quad
    H = \frac{|\varepsilon|_{max}}{\omega_m^2}, \quad k_p = \delta^2 + H

The mean speed :math:`\omega_m` is that of the extremes or that over time; the caller says which.

References
----------
.. [1] Paper 1, (13) to (15).
"""

from __future__ import annotations

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

V = TypeVar("V", float, NDArray[np.float64])


def mean_of_extremes(slow: V, fast: V) -> V:
    """(ω_max + ω_min)/2 [rad/s]."""
    return 0.5 * (fast + slow)


def unevenness(slow: V, fast: V, mean: V) -> V:
    """δ of the slowest and the fastest speed, about a mean speed [–]."""
    return (fast - slow) / mean


def dynamism(least: V, greatest: V, mean: V) -> V:
    """H of the minimum and maximum angular acceleration, at a mean speed [–]."""
    steepest: V = np.maximum(np.abs(least), np.abs(greatest))
    found: V = steepest / mean**2
    return found


def motion_coefficient(delta: V, H: V) -> V:
    """k_p of δ and H [–]."""
    return delta**2 + H
