"""Derivatives of the force and torque that a knife takes from its drive.

The torque is that of the equilibrium of all members at the design speed; an extreme has the derivative at its
crank angle, and none by entries that move a kink there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from linkwright.kernel.numerics.extreme import ALIKE_OF_SOLVED, differ, occurs_at
from linkwright.kernel.numerics.tangent import Tangent
from linkwright.kinetostatics.gradient import ON_KINK, drive_torque_along
from linkwright.machine.machine import Machine
from linkwright.machine.tangents import Directions, seeded
from linkwright.topping.knife import DRIVE_ANGLES, KnifeDrive, carried, other_peaks
from linkwright.topping.uncut_along import slopes

# Share of the largest torque below which the mean is what angles half a degree apart leave of kinks.
_NOTHING = 1e-6


@dataclass(frozen=True)
class DriveAlong:
    """Mass of a knife and torque of its drive with derivatives by the entries of `program`."""

    program: Directions
    numbers: dict[str, Tangent]
    ties: dict[str, str]
    missing: dict[str, str]


def drive_along(machine: Machine, names: Sequence[str], drive: KnifeDrive) -> DriveAlong:
    """Mass and torques of a knife's drive by some entries."""
    ends = np.array([drive.torque_max_angle, drive.torque_min_angle])
    rivals = [other_peaks(machine, drive, end) for end in ("max", "min")]
    looked = [*DRIVE_ANGLES, *rivals[0], *rivals[1], *ends]
    program, torque, kinks = drive_torque_along(machine, names, np.array(looked))
    at_rivals = torque.d[len(DRIVE_ANGLES) : -2]
    others = [at_rivals[: len(rivals[0])], at_rivals[len(rivals[0]) :]]
    along = seeded(machine, program.variables)
    assert along.drive is not None
    speed_d = np.broadcast_to(slopes(along.drive.speed), len(program.variables))
    numbers = {"knife_mass": Tangent(drive.mass, np.broadcast_to(slopes(carried(along)), len(speed_d)))}
    ties: dict[str, str] = {}
    for nth, end in enumerate(("max", "min")):
        name, moving = f"drive_torque_{end}", kinks.moved_at(float(ends[nth]), ON_KINK)
        d = np.concatenate([torque.d[[nth - 2]], others[nth]])
        differs = differ(d, np.abs(torque.d).max(), ALIKE_OF_SOLVED)
        value, alike = getattr(drive, f"torque_{end}"), np.where(differs, np.nan, d[0])
        numbers[name], why = kinks.extreme(value, alike, float(ends[nth]), moving)
        if why or differs.any():
            ties[name] = why or occurs_at((ends[nth], *rivals[nth]))
    means = {"drive_torque_mean": Tangent(drive.torque_mean, torque.d[: len(DRIVE_ANGLES)].mean(axis=0))}
    speed = Tangent(machine.drive.speed, speed_d) if machine.drive and machine.drive.speed else 0.0
    means["drive_power_mean"] = means["drive_torque_mean"] * speed
    nothing = abs(drive.torque_mean) <= _NOTHING * max(abs(drive.torque_max), abs(drive.torque_min))
    missing = (
        dict.fromkeys(means, "it is zero: the knife returns over a revolution the work that it takes")
        if nothing
        else {}
    )
    return DriveAlong(program, numbers | ({} if nothing else means), ties, missing)
