r"""Vibratory stress that the Korean Register permits in crankshafts of main engines.

With λ the speed over the highest of continuous service, in N/mm² as amplitude of the nominal stress,

.. math:: \tau_1 = 45 - 24\lambda^2, \qquad \tau_2 = 2\tau_1 \;(\lambda \le 0.8), \qquad
    \tau_3 = 21 + 237 (\lambda - 0.8) \sqrt{\lambda - 1} \;(1 \le \lambda \le 1.15)

in continuous operation, in transient passage, and above the highest speed, for four-stroke engines in line
and for V engines that fire every 45° or 60°. For two-stroke engines and other V engines 24 becomes 29, and 21
becomes 16. Steel stronger than 440 N/mm² may bear more, :math:`f = 1 + \frac23 (\sigma_B/440 - 1)` times τ₁
and τ₃, and σ_Y/225 times τ₂.

A maker's own limit, or a fatigue calculation of the crankshaft (IACS UR M53), goes before these.

References
----------
.. [1] Korean Register, Rules for the Classification of Steel Ships, part 5, chapter 4, 201: crankshafts.
"""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

Firing = Literal["even", "other"]

# Fall of τ₁ with λ², and τ₃ at λ = 1 [N/mm²].
_FALL: dict[Firing, float] = {"even": 24.0, "other": 29.0}
_ABOVE: dict[Firing, float] = {"even": 21.0, "other": 16.0}

# λ up to which τ₂ may be used, and highest of which the rule speaks.
RATIO_PASSED_MAX = 0.8
RATIO_MAX = 1.15

_MPA = 1e6
# Strength and yield from which on more is permitted, and the most that counts without approval [Pa].
_STRENGTH = 440e6
_YIELD = 225e6
STRENGTH_COUNTED = {"carbon": 590e6, "alloy": 835e6}


def crank_stress(speed_ratio: Floats, firing: Firing, strength: float | None = None) -> Floats:
    """τ₁ and, above the highest speed, τ₃, (n,).

    Amplitude of the nominal shear stress [Pa]; NaN above λ = 1.15, where nothing is said. `speed_ratio`: (n,)
    λ; `strength`: σ_B as it counts [Pa].
    """
    ratio = np.asarray(speed_ratio, float)
    below = 45 - _FALL[firing] * ratio**2
    above = _ABOVE[firing] + 237 * (ratio - 0.8) * np.sqrt(np.maximum(ratio - 1, 0.0))
    stress = np.where(ratio <= 1, below, above)
    found: Floats = np.where(ratio <= RATIO_MAX, stress, np.nan) * _strength_factor(strength) * _MPA
    return found


def crank_transient_stress(
    speed_ratio: Floats, firing: Firing, yield_strength: float | None = None
) -> Floats:
    """τ₂, in transient passage, (n,).

    [Pa]; NaN above λ = 0.8, where none is permitted. `speed_ratio`: (n,) λ; `yield_strength`: σ_Y [Pa].
    """
    ratio = np.asarray(speed_ratio, float)
    factor = 1.0 if yield_strength is None else max(yield_strength / _YIELD, 1.0)
    stress = 2 * (45 - _FALL[firing] * ratio**2) * factor * _MPA
    return np.where(ratio <= RATIO_PASSED_MAX, stress, np.nan)


def _strength_factor(strength: float | None) -> float:
    """f_m of τ₁ and τ₃."""
    return 1.0 if strength is None else max(1 + 2 / 3 * (strength / _STRENGTH - 1), 1.0)
