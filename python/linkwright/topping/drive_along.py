"""Derivatives of the force and torque that a knife takes from its drive.

The torque is that of the equilibrium of all members at the design speed; an extreme has the derivative at its
crank angle, and none by entries that move a kink there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.kernel.numerics.tangent import Tangent
from linkwright.kinetostatics.gradient import drive_torque_along
from linkwright.machine.machine import Machine
from linkwright.machine.tangents import Directions, seeded
from linkwright.topping.knife import DRIVE_ANGLES, KnifeDrive, as_high, carried
from linkwright.topping.uncut_along import slopes

# Share of the largest derivative by which those of an extreme at two angles may differ: they are good to
# 1e-8.
_SAME = 1e-6

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
    rivals = [as_high(machine, drive, end) for end in ("max", "min")]
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
        name, moving = f"drive_torque_{end}", kinks.moved_at(float(ends[nth]))
        d = torque[nth - 2].d
        apart = np.abs(others[nth] - d) > _SAME * np.abs(torque.d).max()
        d = np.where(moving | apart.any(axis=0), np.nan, d)
        numbers[name] = Tangent(getattr(drive, f"torque_{end}"), d)
        if moving.any():
            ties[name] = kinks.words(float(ends[nth]), moving)
        elif apart.any():
            places = " and ".join(f"{np.degrees(angle):.4g}°" for angle in (ends[nth], *rivals[nth]))
            ties[name] = f"the extreme occurs at {places}"
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


def spread(number: Any, names: Sequence[str], listed: Sequence[str]) -> Tangent:
    """A number with its derivatives by some entries as one with those by others; zero where it has none."""
    d = dict(zip(names, np.broadcast_to(slopes(number), len(names)), strict=True))
    value = number.value if isinstance(number, Tangent) else float(number)
    return Tangent(value, np.array([d.get(name, 0.0) for name in listed]))
