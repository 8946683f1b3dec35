r"""Ice at a propeller in the motion of a train: pulses over the angle of the propeller.

.. math:: M = -C_q Q_\mathrm{max}\,r(\varphi) \sum \sin\frac{\pi(\varphi - \varphi_k)}{\alpha_i}, \qquad
    \varphi = \theta - \theta_0

over all pulses that last at φ; r rises from 0 to 1 over the ramp at the beginning, and falls so at the end.
The pulses follow the propeller as it slows down; θ₀, its angle at the first impact, is therefore that of the
motion itself, computed up to there.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.core.curve import switched
from linkwright.kernel.core.periodic_table import spline
from linkwright.kernel.errors import InputError
from linkwright.torsion.core.torque import TrainTorque
from linkwright.torsion.model.ice_impacts import IceImpacts
from linkwright.torsion.model.train_transient import TrainTransient

# Samples of a revolution: pulses of the rules begin and end at whole multiples of a quarter of a degree.
_SAMPLES = 1440

# Revolutions beyond the ice in a table at least: it may not begin again while the train still moves.
_BEYOND = 2.0


class IceStart(NamedTuple):
    """Where the ice of one event begins."""

    angle: float  # of the disc of the propeller [rad]
    turns: int  # revolutions after which its table would repeat


# A table has some million samples at most; ice passes in seconds, 1000 revolutions take minutes.
TURNS_MAX = 1000


# By the place of the event among those of the manoeuvre.
IceStarts = Mapping[int, IceStart]


@dataclass(frozen=True)
class IceMilling:
    """One sequence of impacts, as it went.

    Attributes
    ----------
    on : str
        Disc of the propeller.
    torque_max : float
        Largest ice torque Q_max [N m].
    amplitude : float
        C_q, peak of a pulse over Q_max.
    duration : float
        α_i, angle in which a pulse lasts [rad].
    impacts : int
        All pulses.
    start : float
        Time of the first impact [s].
    end : float or None
        When the last pulse has passed [s]; None where the manoeuvre ends before, or the propeller stops.
    speed_before, speed_min : float
        Of the propeller at the first impact, and its minimum while there is ice [rad/s].
    """

    on: str
    torque_max: float
    amplitude: float
    duration: float
    impacts: int
    start: float
    end: float | None
    speed_before: float
    speed_min: float


def ice_events(manoeuvre: TrainTransient) -> list[tuple[int, IceImpacts]]:
    """Events of ice with their places among all, by time."""
    listed = [(n, event) for n, event in enumerate(manoeuvre.events) if isinstance(event, IceImpacts)]
    return sorted(listed, key=lambda one: one[1].time)


def ice_torque(name: str, on: int, event: IceImpacts, start: IceStart) -> TrainTorque:
    """The torque of the ice on the disc of the propeller."""
    size = event.pulse.amplitude * event.largest_torque
    table = spline(pulses(event, _angles(start.turns)), 2 * np.pi * start.turns)
    weight = switched([(event.time, 1.0, 0.0)], 0.0)
    return TrainTorque(name, on, -size, shape=table, phase=-start.angle, weight=weight)


def pulses(event: IceImpacts, angle: Floats) -> Floats:
    """Pulses over the peak of one, with ramps, (n,); `angle`: (n,) from the first impact on, rising [rad]."""
    alpha, total = event.pulse.duration, np.zeros_like(angle)
    for begin in event.begins:
        first, last = np.searchsorted(angle, begin, "right"), np.searchsorted(angle, begin + alpha)
        total[first:last] += np.sin(np.pi * (angle[first:last] - begin) / alpha)
    if event.ramp:
        total *= np.clip(np.minimum(angle, event.length - angle) / event.ramp, 0.0, 1.0)
    return total


def turns_needed(event: IceImpacts, speed: float, left: float) -> int:
    """Revolutions of a table: those of the ice, or all that the propeller may still make, and some more.

    `speed`: of the propeller at the first impact [rad/s]; `left`: time of the manoeuvre after it [s].
    """
    most = max(event.length, abs(speed) * left) / (2 * np.pi)
    return within_limit(int(np.ceil(most + _BEYOND)))


def within_limit(turns: int) -> int:
    """Revolutions of a table, or the error that they are too many."""
    if turns > TURNS_MAX:
        raise InputError(
            f"train.transient: after the first impact of ice the propeller may make {turns} revolutions, and "
            f"its pulses are computed for {TURNS_MAX}: shorten the duration of the manoeuvre"
        )
    return turns


def is_outrun(event: IceImpacts, start: IceStart, angle: Floats) -> bool:
    """Whether the propeller turned beyond the table of its ice; `angle`: (n,) from the impact on [rad]."""
    period, since = 2 * np.pi * start.turns, angle - start.angle
    return bool(since.max() >= period or since.min() <= event.length - period)


def milled(event: IceImpacts, start: IceStart, time: Floats, angle: Floats, speed: Floats) -> IceMilling:
    """How a sequence of impacts went. `time`, `angle`, `speed`: (n,) of the propeller [s, rad, rad/s]."""
    after = time >= event.time
    passed = np.flatnonzero(after & (angle - start.angle >= event.length))
    last = int(passed[0]) if len(passed) else len(time) - 1
    within = after & (np.arange(len(time)) <= last)
    return IceMilling(
        on=event.on,
        torque_max=event.largest_torque,
        amplitude=event.pulse.amplitude,
        duration=event.pulse.duration,
        impacts=len(event.begins),
        start=event.time,
        end=float(time[last]) if len(passed) else None,
        speed_before=float(np.interp(event.time, time, speed)),
        speed_min=float(speed[within].min()),
    )


def ice_notes(millings: Sequence[IceMilling]) -> list[str]:
    """What a reader of the result has to know of the ice, in sentences."""
    notes = []
    for one in millings:
        if one.speed_before <= 0:
            notes.append(
                f"{one.on} does not rotate ahead at the first ice impact: the pulses assume ahead rotation"
            )
        elif one.speed_min <= 0:
            notes.append(
                f"the ice stops {one.on}: pulses over the angle are not valid beyond standstill, and the "
                "rules have no torque for a blocked propeller"
            )
        elif one.end is None:
            notes.append(f"the manoeuvre ends before the ice has passed {one.on}")
    return notes


def _angles(turns: int) -> Floats:
    return np.linspace(0.0, 2 * np.pi * turns, turns * _SAMPLES, endpoint=False)
