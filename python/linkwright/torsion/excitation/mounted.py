"""Torques of the mechanisms on a train, for its forced vibration."""

from __future__ import annotations

import numpy as np

from linkwright.drive.model.motor import ConstantSpeedMotor
from linkwright.kernel.arrays import Floats
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine
from linkwright.torsion.core.torque import motor_program
from linkwright.torsion.excitation.drive_line import (
    NEGLIGIBLE,
    ORDERS,
    damping_of,
    harmonics_of,
    mounted_mechanism,
    slope_of,
)
from linkwright.torsion.excitation.harmonics import Source


def mounted_sources(
    machine: Machine, turning: Floats, place: dict[str, int], speeds: Floats
) -> tuple[list[Source], Floats]:
    """Torques of the mechanisms of a train on their discs at constant speed.

    And damping of mechanisms and motors, (discs, speeds), as of `mechanism_sources` [N m s/rad]. `turning`:
    (discs,) speed of each disc over that of the first; `speeds`: (speeds,) [rad/s].
    """
    train, sources = machine.train, []
    assert train is not None
    damping = np.zeros((len(place), len(speeds)))
    for name, mechanism in train.mechanisms.items():
        disc, compiled = place[mechanism.on], mounted_mechanism(machine, name)
        omega = turning[disc] * speeds
        nu = np.arange(ORDERS * compiled.turns + 1) / compiled.turns
        M = harmonics_of(compiled, omega, nu) * np.exp(1j * nu * mechanism.phase)[:, None]
        size = np.abs(M).max(axis=1)
        kept = (nu > 0) & (size > NEGLIGIBLE * size.max())
        sources.append(Source(disc, turning[disc] * nu[kept], M[kept], M[0].real))
        damping[disc] += np.maximum(damping_of(compiled, omega), 0.0)
    for motor in train.motors.values():
        if not isinstance(motor.motor, ConstantSpeedMotor):
            disc = place[motor.on]
            driven = motor_program(motor.motor, float(turning[disc]))
            damping[disc] += np.maximum(-_motor_slope(driven, speeds) / turning[disc], 0.0)
    return sources, damping


def _motor_slope(driven: CompiledMachine, speeds: Floats) -> Floats:
    """Derivative of the torque of a motor by the speed of the first disc [N m s/rad]."""
    return slope_of(lambda at: driven.motor_torques(at).motor, speeds)
