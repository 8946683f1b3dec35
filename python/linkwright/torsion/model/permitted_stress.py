r"""Vibratory stress permitted in propulsion shafts by IACS UR M68, in crankshafts by the Korean Register.

**Propulsion shafts.** With the tensile strength σ_B in N/mm², the outside diameter d in mm and λ the speed
over that at rated power,

.. math:: \tau_C = \frac{\sigma_B + 160}{18}\, C_K C_D C_\lambda, \qquad C_D = 0.35 + 0.93\, d^{-0.2}

.. math:: C_\lambda = 3 - 2\lambda^2 \;(\lambda < 0.9), \qquad 1.38 \;(0.9 \le \lambda \le 1.05)

are permitted in continuous operation, in N/mm², as amplitude of the nominal stress: half the peak-to-peak
value, in the plain section, without stress concentration. Where τ_C is exceeded, the speeds are barred and
passed quickly, and the amplitude there must stay below

.. math:: \tau_T = 1.7\, \tau_C/\sqrt{C_K}

About a critical speed :math:`n_c`, with λ there, at least these speeds are barred:

.. math:: \frac{16\, n_c}{18 - \lambda} \le n \le \frac{(18 - \lambda)\, n_c}{16}

In normal operation no speeds above λ = 0.8 may be barred. Above λ = 1.05 nothing is said.

**Crankshafts.** With λ the speed over the highest of continuous service, in N/mm² as amplitude of the nominal
stress,

.. math:: \tau_1 = 45 - 24\lambda^2, \qquad \tau_2 = 2\tau_1 \;(\lambda \le 0.8), \qquad
    \tau_3 = 21 + 237 (\lambda - 0.8) \sqrt{\lambda - 1} \;(1 \le \lambda \le 1.15)

in continuous operation, in transient passage, and above the highest speed, for four-stroke engines in line
and for V engines that fire every 45° or 60°. For two-stroke engines and other V engines 24 becomes 29, and 21
becomes 16. Steel stronger than 440 N/mm² may bear more, :math:`f = 1 + \frac23 (\sigma_B/440 - 1)` times τ₁
and τ₃, and σ_Y/225 times τ₂.

A maker's own limit, or a fatigue calculation of the crankshaft (IACS UR M53), goes before these.

References
----------
.. [1] IACS, UR M68 Dimensions of propulsion shafts and their permissible torsional vibration stresses, Rev.
   3, 2021: M68.3 materials, M68.5 stresses, table of C_K.
.. [2] Korean Register, Rules for the Classification of Steel Ships, part 5, chapter 4, 202 and 206: the same.
.. [3] Korean Register, Rules for the Classification of Steel Ships, part 5, chapter 4, 201: crankshafts.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from linkwright.kernel.arrays import Floats

Design = Literal[
    "flange",
    "shrink_fit",
    "tapered_keyway",
    "cylindrical_keyway",
    "radial_hole",
    "slot",
    "thrust_collar",
    "roller_bearing",
    "propeller_shaft",
    "stern_tube_shaft",
]
Steel = Literal["carbon", "alloy"]

# C_K of M68: intermediate shafts, thrust shafts outside engines, propeller shafts.
DESIGN_FACTORS: dict[Design, float] = {
    "flange": 1.0,
    "shrink_fit": 1.0,
    "tapered_keyway": 0.60,
    "cylindrical_keyway": 0.45,
    "radial_hole": 0.50,
    "slot": 0.30,
    "thrust_collar": 0.85,
    "roller_bearing": 0.85,
    "propeller_shaft": 0.55,
    "stern_tube_shaft": 0.80,
}

# Largest λ of which M68 speaks, and largest at which it lets speeds be barred.
RATIO_MAX = 1.05
RATIO_BARRED_MAX = 0.8

# Strengths that count [Pa]: M68.3.
STRENGTH_MIN = 400e6
_STRENGTH_MAX: dict[Steel, float] = {"carbon": 600e6, "alloy": 800e6}
_STRENGTH_MAX_PROPELLER = 600e6
_PROPELLER: tuple[Design, ...] = ("propeller_shaft", "stern_tube_shaft")

_MPA = 1e6
_MM = 1e-3


def counted_strength(tensile_strength: float, steel: Steel, design: Design) -> float:
    """Strength that counts [Pa]: at most 600 MPa, of alloy steel outside propeller shafts 800 MPa."""
    highest = _STRENGTH_MAX_PROPELLER if design in _PROPELLER else _STRENGTH_MAX[steel]
    return min(tensile_strength, highest)


def size_factor(diameter: float) -> float:
    """C_D. `diameter`: outside [m]."""
    return float(0.35 + 0.93 * (diameter / _MM) ** -0.2)


def speed_factor(speed_ratio: Floats) -> Floats:
    """C_λ, (n,), at λ (n,), speed over rated speed; NaN above λ = 1.05, where nothing is said."""
    ratio = np.asarray(speed_ratio, float)
    below = np.where(ratio < 0.9, 3 - 2 * ratio**2, 1.38)
    return np.where(ratio <= RATIO_MAX, below, np.nan)


def continuous_stress(strength: float, diameter: float, design_factor: float, speed_ratio: Floats) -> Floats:
    """τ_C, permitted in continuous operation, (n,).

    Amplitude of the nominal shear stress [Pa]; NaN where nothing is said. `strength`: σ_B as it counts [Pa];
    `diameter`: outside [m]; `design_factor`: C_K; `speed_ratio`: (n,) λ.
    """
    factors = design_factor * size_factor(diameter) * speed_factor(speed_ratio)
    stress: Floats = (strength / _MPA + 160) / 18 * factors * _MPA
    return stress


def transient_stress(continuous: Floats, design_factor: float) -> Floats:
    """τ_T, permitted while barred ranges are passed, (n,) [Pa]; τ_C (n,) [Pa]; C_K."""
    stress: Floats = 1.7 * continuous / np.sqrt(design_factor)
    return stress


def barred_speeds(critical_speed: float, rated_speed: float) -> tuple[float, float]:
    """Barred speed ranges about a critical one by the formula.

    Lowest and highest, in the unit of n_c. `critical_speed`, `rated_speed`: n_c, and speed at rated power
    [rad/s].
    """
    left = 18 - critical_speed / rated_speed
    return 16 * critical_speed / left, left * critical_speed / 16


Firing = Literal["even", "other"]

# Fall of τ₁ with λ², and τ₃ at λ = 1 [N/mm²].
_FALL: dict[Firing, float] = {"even": 24.0, "other": 29.0}
_ABOVE: dict[Firing, float] = {"even": 21.0, "other": 16.0}

# λ up to which τ₂ may be used, and highest of which the rule speaks.
CRANK_RATIO_PASSED_MAX = 0.8
CRANK_RATIO_MAX = 1.15

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
    amplitude: Floats = np.where(ratio <= CRANK_RATIO_MAX, stress, np.nan) * _strength_factor(strength) * _MPA
    return amplitude


def crank_transient_stress(
    speed_ratio: Floats, firing: Firing, yield_strength: float | None = None
) -> Floats:
    """τ₂, in transient passage, (n,) [Pa]; NaN above λ = 0.8, where none is permitted; σ_Y [Pa]."""
    ratio = np.asarray(speed_ratio, float)
    factor = 1.0 if yield_strength is None else max(yield_strength / _YIELD, 1.0)
    stress = 2 * (45 - _FALL[firing] * ratio**2) * factor * _MPA
    return np.where(ratio <= CRANK_RATIO_PASSED_MAX, stress, np.nan)


def _strength_factor(strength: float | None) -> float:
    """f_m of τ₁ and τ₃."""
    return 1.0 if strength is None else max(1 + 2 / 3 * (strength / _STRENGTH - 1), 1.0)
