"""What a mechanism does to its driveline: harmonics on the crank, damping, speed of service."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from linkwright.drive.steady_state import steady_state
from linkwright.machine.machine import Machine
from linkwright.torsion.model.drive_train import CRANK
from linkwright.torsion.response.drive_line import mechanism_harmonics, station_damping
from linkwright.torsion.response.torques import Source

Floats = NDArray[np.float64]

# Orders of the crank that count, and the share of the largest below which one does not.
_ORDERS = 24
_NEGLIGIBLE = 1e-12


def mechanism_sources(
    machine: Machine, turning: Floats, place: dict[str, int], speeds: Floats
) -> tuple[list[Source], Floats]:
    """Torque of a mechanism on its crank at constant speed.

    Gives `sources`: on the crank; `damping`: (discs, speeds) of motor and mechanism where their torques fall
    or rise with the speed; none where they would excite [N m s/rad]. `turning`: (discs,) speed of each disc
    over that of the first; `speeds`: (speeds,) [rad/s].
    """
    n = turning[place[CRANK]]
    of_crank = np.arange(_ORDERS + 1.0)
    found = mechanism_harmonics(machine, n * speeds, of_crank)
    size = np.abs(found).max(axis=1)
    kept = (of_crank > 0) & (size > _NEGLIGIBLE * size.max())
    damping = np.zeros((len(place), len(speeds)))
    for station, c in station_damping(machine, n * speeds).items():
        if station in place:
            damping[place[station]] += np.maximum(c, 0.0)
    return [Source(place[CRANK], n * of_crank[kept], found[kept], found[0].real)], damping


def steady_speed(machine: Machine) -> float:
    """Mean speed of the crank in rigid steady motion; without a motor its design speed [rad/s]."""
    drive = machine.drive
    if drive is not None and drive.motor is None and drive.speed is not None:
        return drive.speed
    return steady_state(machine).speed_mean_time
