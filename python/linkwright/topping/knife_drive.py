"""What it takes to move the knife: its inertia force, and the torque of its drive at the design speed.

Inertia and loads are those of the machine file; `linkwright.kinetostatics.forces` balances all members.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.kinetostatics.forces import forces
from linkwright.machine.machine import Machine
from linkwright.topping.knife import Knife
from linkwright.topping.model.motion import MemberKnife

Floats = NDArray[np.float64]

# Crank angles of the revolution; then so often so many about an extreme, which leaves 1e-12 of it.
_ANGLES, _LOOKS, _CLOSE = 720, 3, 40


@dataclass(frozen=True)
class KnifeDrive:
    """Force and torque at the design speed.

    Attributes
    ----------
    mass : float
        Of the bodies on the knife [kg].
    inertia_force_max : float
        Peak absolute value of mass times acceleration of the knife [N].
    torque_max, torque_min, torque_mean : float
        Extremes and mean of the driving torque at the crank [N m].
    power_mean : float
        Mean power at the crank [W].
    """

    mass: float
    inertia_force_max: float
    torque_max: float
    torque_min: float
    torque_mean: float
    power_mean: float


def knife_drive(machine: Machine, knife: Knife) -> KnifeDrive | None:
    """Inertia force of the knife and torque of its drive.

    Parameters
    ----------
    machine : Machine
        The machine.
    knife : Knife
        Its knife.

    Returns
    -------
    KnifeDrive or None
        None if no mechanism moves the knife, or nothing has mass.

    Raises
    ------
    FindingError
        There are no forces.
    """
    motion = None if machine.topper is None else machine.topper.motion
    drive = machine.drive
    if not isinstance(motion, MemberKnife) or drive is None or drive.speed is None or not machine.bodies:
        return None
    mass = sum(body.mass or 0.0 for name, body in machine.bodies.items() if (body.on or name) == motion.of)
    found = forces(machine, speed=drive.speed, n=_ANGLES)
    # The revolution's end is its start.
    mean = float(np.mean(found.torque_drive[:-1]))
    return KnifeDrive(
        mass=float(mass),
        inertia_force_max=float(mass * knife.acceleration_max),
        torque_max=_highest(machine, drive.speed, found.crank_angle, found.torque_drive, 1.0),
        torque_min=-_highest(machine, drive.speed, found.crank_angle, found.torque_drive, -1.0),
        torque_mean=mean,
        power_mean=mean * drive.speed,
    )


def _highest(machine: Machine, speed: float, angle: Floats, torque: Floats, sign: float) -> float:
    """The maximum torque, times a sign: looked at more closely about the highest so far."""
    step = 2 * np.pi / _ANGLES
    for _ in range(_LOOKS):
        at = int(np.nanargmax(sign * torque))
        angle = np.linspace(angle[at] - step, angle[at] + step, _CLOSE + 1)
        torque = forces(machine, speed=speed, angles=angle).torque_drive
        step = 2 * step / _CLOSE
    return float(np.nanmax(sign * torque))
