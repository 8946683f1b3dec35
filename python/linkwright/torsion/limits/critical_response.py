"""Synthesis at the critical speeds: the order that is critical alone, and all orders in phase.

At the speed at which an order peaks in a mode, the shaft that is nearest to its permitted stress there; where
no stress is limited, the shaft that the order twists most.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from linkwright.kernel.units import PRESSURE, TORQUE, Kind
from linkwright.torsion.limits.survey import Survey
from linkwright.torsion.modes.campbell import CampbellDiagram, CriticalSpeed
from linkwright.torsion.response.forced import TorsionResponse
from linkwright.torsion.response.stress import ShaftStress, shaft_stress

# Orders that differ by a smaller share are one.
_EQUAL = 1e-9


class CriticalResponse(NamedTuple):
    """A shaft at a critical speed.

    Attributes
    ----------
    order, mode : float, int
        Cycles per revolution of the first disc; row of `FreeVibration`.
    speed : float
        Of the first disc, at which the order peaks [rad/s].
    shaft : str
        The shaft that is nearest to its limit there.
    kind : Kind
        Stress, or torque where none is limited.
    single, total : float
        Amplitude of the order alone, and half the peak-to-peak value of all orders in phase [SI].
    permitted : float or None
        In continuous operation [Pa].
    """

    order: float
    mode: int
    speed: float
    shaft: str
    kind: Kind
    single: float
    total: float
    permitted: float | None


def critical_responses(seen: Survey, diagram: CampbellDiagram) -> tuple[CriticalResponse, ...]:
    """What the shafts carry at all critical speeds, by speed."""
    speeds = seen.at.torques.speeds
    listed = [(one, _peak(one, float(speeds.min()), float(speeds.max()))) for one in diagram.critical]
    if not listed or not seen.found.shafts:
        return ()
    response = seen.carried_at(np.array([speed for _, speed in listed]))
    stress = shaft_stress(seen.machine, response, seen.service)
    limited = np.flatnonzero(np.isfinite(stress.continuous).any(axis=1)).tolist()
    return tuple(_at(one, n, response, stress, limited) for n, (one, _) in enumerate(listed))


def _peak(critical: CriticalSpeed, low: float, high: float) -> float:
    """Speed at which the order peaks, as far as it is among the speeds."""
    speed = critical.speed if critical.peak_speed is None else critical.peak_speed
    return min(max(speed, low), high)


def _at(
    critical: CriticalSpeed, n: int, response: TorsionResponse, stress: ShaftStress, limited: Sequence[int]
) -> CriticalResponse:
    """One critical speed, in its column of the response."""
    same = np.abs(response.orders - critical.order) <= _EQUAL * critical.order
    single = np.abs(response.shaft_torques[same, :, n].sum(axis=0))
    speed = float(response.speeds[n])
    if limited:
        used = np.nan_to_num(stress.vibratory[limited, n] / stress.continuous[limited, n], nan=-1.0)
        row = limited[int(used.argmax())]
        s = response.shafts.index(stress.shafts[row])
        total, torque = float(stress.vibratory[row, n]), float(response.shaft_torque_vibratory[s, n])
        permitted = float(stress.continuous[row, n])
        share = float(single[s]) / torque if torque else 0.0
        return CriticalResponse(
            critical.order,
            critical.mode,
            speed,
            stress.shafts[row],
            PRESSURE,
            share * total,
            total,
            permitted if np.isfinite(permitted) else None,
        )
    s = int(np.nan_to_num(single, nan=-1.0).argmax())
    total = float(response.shaft_torque_vibratory[s, n])
    numbers = (TORQUE, float(single[s]), total, None)
    return CriticalResponse(critical.order, critical.mode, speed, response.shafts[s], *numbers)
