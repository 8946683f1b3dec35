r"""The published step scheme of paper 1, and the limit that it tends to.

At constant energy :math:`\omega = \omega_m\,\sqrt{J_1/J(\varphi)}` and
:math:`\varepsilon = -\tfrac12\omega^2 J'/J`, scaled to the published mean of the
speed. The limit depends on one number that the paper does not print of three of its drives, the inertia
:math:`I_0 i^2` of motor, coupling and gearbox at the crank.

.. math::

    \omega_{k+1} = \frac{M_p(\omega_k) - M_0(\varphi_k)}{i}\,\frac{\Delta\varphi}{I_k\,\omega_k}
        + \frac{3 I_k - I_{k+1}}{2 I_k}\,\omega_k

from rest, with the motor's torque on a straight line from the starting to the breakdown torque, and by
Kloss's formula above the breakdown speed. The factor 1/i is no part of equation (1): at the crank both
torques act in full. It and the straight line belong to this reproduction and to nothing else in the package.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from linkwright.drive.evenness import ConstantEnergy, constant_energy_of
from linkwright.drive.model.motor import InductionMotor
from linkwright.drive.reduction import Reduction
from linkwright.drive.step_method import StepMotion, by_steps, whole_steps
from linkwright.kernel.arrays import Floats
from linkwright.linkages.closure import turn_angles
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine


@dataclass(frozen=True)
class Fit:
    """The inertia of the drive with which the constant-energy limit comes nearest to a published row."""

    inertia: float  # I_0 i², at the crank [kg m²]
    # δ and H with it [–].
    unevenness: float
    dynamism: float
    misfit: float  # root of the mean square of their relative deviations from the published ones [–]

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
        constant_energy = constant_energy_of(with_drive_inertia(reduced, now, wanted))
        off = (constant_energy.unevenness / unevenness - 1, constant_energy.dynamism / dynamism - 1)
        misfit = float(np.sqrt(0.5 * (off[0] ** 2 + off[1] ** 2)))
        return Fit(wanted, constant_energy.unevenness, constant_energy.dynamism, misfit)

    coarse = _nearest([tried(x * now) for x in np.linspace(0.0, 10.0, 1001)])
    width = 0.01 * now
    fine = np.linspace(max(0.0, coarse.inertia - width), coarse.inertia + width, 201)
    return _nearest([tried(float(x)) for x in fine])


def _nearest(tried: list[Fit]) -> Fit:
    return min(tried, key=lambda place: place.misfit)


def scaled_to(energy: ConstantEnergy, reduced: Reduction, speed_mean: float) -> dict[str, float]:
    """The limit's row of the table of results at a mean of the extremes of the speed [rad/s]; SI."""
    half = 0.5 * energy.unevenness * speed_mean
    _, epsilon = limit_curves(reduced, speed_mean)
    return {
        "speed_min": speed_mean - half,
        "speed_max": speed_mean + half,
        "speed_mean": speed_mean,
        "acceleration_min": float(epsilon.min()),
        "acceleration_max": float(epsilon.max()),
        "unevenness": energy.unevenness,
        "dynamism": energy.dynamism,
        "motion_coefficient": energy.motion_coefficient,
    }


def limit_curves(reduced: Reduction, speed_mean: float) -> tuple[Floats, Floats]:
    """ω [rad/s] and ε [rad/s²] over the revolution at constant energy, at a mean of the extremes of ω."""
    J = reduced.inertia_reduced
    extremes = 0.5 * (reduced.inertia_min**-0.5 + reduced.inertia_max**-0.5)
    omega = speed_mean / (extremes * np.sqrt(J))
    return omega, -0.5 * omega**2 * reduced.inertia_reduced_d1 / J


# Steps of the angle that are tried, in degrees; all divide the revolution.
STEPS = (0.25, 0.5, 1.0, 2.0, 3.0, 5.0, 10.0)

# Share of the speed by which it may differ from steady motion when a run-up counts as done, as in `run_up`.
_SETTLED = 0.01


def published_scheme(machine: Machine, *, step: float = np.radians(1.0)) -> StepMotion:
    """Motion from rest by the published scheme: all revolutions, and the measures of the last.

    The step of the angle [rad] must divide the revolution.

    Raises InputError: the step does not divide the revolution; StartError: the machine does not start, or
    comes to rest.

    Source: Paper 1, equations (4), (8), (9), (11), (12).
    """
    assert machine.drive is not None
    compiled = compile_machine(machine)
    n = whole_steps(step)
    at = compiled.reductions(turn_angles(n)[:-1])
    M_0 = at.load + at.dry
    motor, gearbox = machine.drive.motor, machine.drive.gearbox
    assert isinstance(motor, InductionMotor)
    i, eta = gearbox.ratio, gearbox.efficiency

    def torque(k: int, omega: float) -> float:
        M_p = motor_torque(motor, i * omega) * i * eta
        return (M_p - float(M_0[k])) / i

    return by_steps(at.inertia, torque, step=2 * np.pi / n)


def motor_torque(motor: InductionMotor, speed: float) -> float:
    """Torque at a shaft speed [rad/s] as published [N m]: straight to breakdown, then Kloss, paper 1 (8)."""
    omega_0, omega_cr = motor.speed_synchronous, motor.speed_breakdown
    M_start, M_cr = motor.torque_start, motor.torque_breakdown
    assert omega_0 is not None
    assert omega_cr is not None
    assert M_start is not None
    assert M_cr is not None
    if speed < omega_cr:
        return M_start + (M_cr - M_start) * speed / omega_cr
    s = (omega_0 - speed) / (omega_0 - omega_cr)
    # M = 2 M_cr / (s + 1/s), written so that it holds at s = 0.
    return 2 * M_cr * s / (1 + s * s)


def turns_to_steady(motion: StepMotion) -> int:
    """Whole revolutions after which the speed stays within 1 % of the last revolution at the same angle."""
    n = round(2 * np.pi / motion.step)
    speed = motion.speed[1:]
    turns = speed[: len(speed) // n * n].reshape(-1, n)
    outside = np.abs(turns / turns[-1] - 1).max(axis=1) > _SETTLED
    return int(np.flatnonzero(outside)[-1]) + 1 if outside.any() else 0


def schemes(machine: Machine) -> dict[float, StepMotion]:
    """The published scheme by each step of the angle in degrees that is tried."""
    return {degrees: published_scheme(machine, step=np.radians(degrees)) for degrees in STEPS}
