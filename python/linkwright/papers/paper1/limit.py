r"""The constant-energy limit of a drive, and the inertia with which it would fit a published row.

At constant energy :math:`\omega = \omega_m\,\sqrt{J_1/J(\varphi)}` and
:math:`\varepsilon = -\tfrac12\omega^2 J'/J`, scaled to the published mean of the
speed. The limit depends on one number that the paper does not print of three of its drives, the inertia
:math:`I_0 i^2` of motor, coupling and gearbox at the crank.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from linkwright.drive.constant_energy import ConstantEnergy, constant_energy_of
from linkwright.drive.reduction import Reduction

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Fit:
    """The inertia of the drive with which the constant-energy limit comes nearest to a published row.

    Attributes
    ----------
    inertia : float
        I_0 i², at the crank [kg m²].
    unevenness, dynamism : float
        δ and H with it [–].
    misfit : float
        Root of the mean square of their relative deviations from the published ones [–].
    """

    inertia: float
    unevenness: float
    dynamism: float
    misfit: float

    @property
    def fits(self) -> bool:
        """Whether both are met to 2 %, about what three printed digits and a coarse step allow."""
        return self.misfit <= 0.02


def with_drive_inertia(reduced: Reduction, now: float, wanted: float) -> Reduction:
    """The reduction with another inertia of the drive at the crank than it has now [kg m²]."""
    more = wanted - now
    return replace(
        reduced,
        inertia_reduced=reduced.inertia_reduced + more,
        inertia_min=reduced.inertia_min + more,
        inertia_max=reduced.inertia_max + more,
    )


def fitted_inertia(reduced: Reduction, now: float, unevenness: float, dynamism: float) -> Fit:
    """Find the inertia of the drive [kg m²] with which the limit comes nearest to published δ and H.

    Between 0 and ten times the one that is in the reduction, to 1 % of that, refined once to 0.01 %.
    """

    def tried(wanted: float) -> Fit:
        found = constant_energy_of(with_drive_inertia(reduced, now, wanted))
        off = (found.unevenness / unevenness - 1, found.dynamism / dynamism - 1)
        misfit = float(np.sqrt(0.5 * (off[0] ** 2 + off[1] ** 2)))
        return Fit(wanted, found.unevenness, found.dynamism, misfit)

    coarse = _nearest([tried(x * now) for x in np.linspace(0.0, 10.0, 1001)])
    width = 0.01 * now
    fine = np.linspace(max(0.0, coarse.inertia - width), coarse.inertia + width, 201)
    return _nearest([tried(float(x)) for x in fine])


def _nearest(tried: list[Fit]) -> Fit:
    return min(tried, key=lambda each: each.misfit)


def scaled_to(found: ConstantEnergy, reduced: Reduction, speed_mean: float) -> dict[str, float]:
    """The limit's row of the table of results at a mean of the extremes of the speed [rad/s]; SI."""
    half = 0.5 * found.unevenness * speed_mean
    _, epsilon = limit_curves(reduced, speed_mean)
    return {
        "speed_min": speed_mean - half,
        "speed_max": speed_mean + half,
        "speed_mean": speed_mean,
        "acceleration_min": float(epsilon.min()),
        "acceleration_max": float(epsilon.max()),
        "unevenness": found.unevenness,
        "dynamism": found.dynamism,
        "motion_coefficient": found.motion_coefficient,
    }


def limit_curves(reduced: Reduction, speed_mean: float) -> tuple[Floats, Floats]:
    """ω [rad/s] and ε [rad/s²] over the revolution at constant energy, at a mean of the extremes of ω."""
    J = reduced.inertia_reduced
    extremes = 0.5 * (reduced.inertia_min**-0.5 + reduced.inertia_max**-0.5)
    omega = speed_mean / (extremes * np.sqrt(J))
    return omega, -0.5 * omega**2 * reduced.inertia_reduced_d1 / J
