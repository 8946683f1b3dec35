r"""The published scheme of paper 1 as its numbers show it: equation (4) with the net torque over the ratio.

.. math::

    \omega_{k+1} = \frac{M_p(\omega_k) - M_0(\varphi_k)}{i}\,\frac{\Delta\varphi}{I_k\,\omega_k}
        + \frac{3 I_k - I_{k+1}}{2 I_k}\,\omega_k

from rest, with the motor's torque on a straight line from the starting to the breakdown torque, and by
Kloss's formula above the breakdown speed. The factor 1/i is no part of equation (1): at the crank both
torques act in full. It and the straight line belong to this reproduction and to nothing else in the package.
"""

from __future__ import annotations

import numpy as np

from linkwright.drive.model.motor import InductionMotor
from linkwright.drive.step_method import StepMotion, by_steps, whole_steps
from linkwright.linkages.closure import turn_angles
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine

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
    J, _, load, dry, _ = compiled.reductions(turn_angles(n)[:-1])
    M_0 = load + dry
    motor, gearbox = machine.drive.motor, machine.drive.gearbox
    assert isinstance(motor, InductionMotor)
    i, eta = gearbox.ratio, gearbox.efficiency

    def torque(k: int, omega: float) -> float:
        M_p = motor_torque(motor, i * omega) * i * eta
        return (M_p - float(M_0[k])) / i

    return by_steps(J, torque, step=2 * np.pi / n)


def motor_torque(motor: InductionMotor, speed: float) -> float:
    """Torque at a speed of the shaft [rad/s] as the published row shows it [N m].

    Straight from the starting to the breakdown torque, then by Kloss's formula, paper 1 (8).
    """
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
