r"""Whether shafts and couplings bear a manoeuvre: largest torques and stresses against what is permitted.

| limit | against |
| --- | --- |
| `torque_permitted` | largest torque either way, of shafts, couplings, stages, clutches, brakes, freewheels |
| `heat_permitted` | friction work of clutches and brakes (VDI 2241-1) |
| `stress_max` | its stress |
| `swing_permitted` | largest swing of a pendulum |
| vibratory stress in transient passage | half the peak-to-peak stress within two revolutions of disc 1 |

Limits of continuous operation, vibratory torques and heat among them, are those of steady running and not
judged here. Largest torques of shafts, couplings and friction parts are exact between the samples; those of
gear stages and those within two revolutions are read from the samples.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.units.kinds import ANGLE, ENERGY, PRESSURE, TORQUE, Kind
from linkwright.machine.machine import Machine
from linkwright.torsion.excitation.drive_line import train_of
from linkwright.torsion.limits.criteria import PASSING_STRESS, shown_quantity
from linkwright.torsion.response.stress import service_speed, stressed

if TYPE_CHECKING:
    from linkwright.torsion.in_time.transient import TorsionTransient

# Angle of the first disc within which a torque is taken to vibrate about one mean [rad].
_WINDOW = 4 * np.pi


@dataclass(frozen=True)
class PeakJudgement:
    """One limit, and whether a manoeuvre keeps it.

    Attributes
    ----------
    part : str
        Name of the shaft or coupling.
    what : str
        What is limited, in words.
    kind : Kind
        The quantity.
    found, permitted : float
        Where found over permitted is largest, SI.
    time : float
        When [s].
    """

    part: str
    what: str
    kind: Kind
    found: float
    permitted: float
    time: float

    @property
    def is_kept(self) -> bool:
        """Whether the manoeuvre stays within the limit."""
        return self.found <= self.permitted

    @property
    def words(self) -> str:
        """The judgement as a sentence."""
        reached, permitted = (shown_quantity(value, self.kind) for value in (self.found, self.permitted))
        verdict = "within limit" if self.is_kept else "limit exceeded"
        return (
            f"{self.part}: {self.what} {reached} in the manoeuvre at {self.time:.4g} s, permitted "
            f"{permitted}: {verdict}"
        )

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers and texts, ready for JSON."""
        state = "ok" if self.is_kept else "exceeds"
        keys = ("part", "what", "found", "permitted", "time", "words")
        return {key: getattr(self, key) for key in keys} | {"unit": self.kind.unit, "state": state}


def judged(machine: Machine, moved: TorsionTransient) -> tuple[PeakJudgement, ...]:
    """Limits of shafts, couplings and gear stages against a manoeuvre; empty without limits."""
    judgements = (*_torques(machine, moved), *_stresses(machine, moved), *_stages(machine, moved))
    return (*judgements, *_swings_of_pendulums(machine, moved), *_frictions(machine, moved))


def unjudged(machine: Machine, moved: TorsionTransient) -> Iterator[str]:
    """Limits of gear stages that cannot be judged, in sentences."""
    for name, row, _ in _limited_stages(machine, moved):
        if not np.isfinite(row).all():
            yield (
                f"{name}: torque_permitted is not checked: the torque of the stage is statically "
                "indeterminate"
            )


def _stages(machine: Machine, moved: TorsionTransient) -> Iterator[PeakJudgement]:
    for name, row, permitted in _limited_stages(machine, moved):
        if np.isfinite(row).all():
            worst = int(np.abs(row).argmax())
            torque, time = float(abs(row[worst])), float(moved.time[worst])
            yield PeakJudgement(name, "torque", TORQUE, torque, permitted, time)


def _swings_of_pendulums(machine: Machine, moved: TorsionTransient) -> Iterator[PeakJudgement]:
    pendulums = {} if machine.train is None else machine.train.pendulums
    for name, row in zip(moved.pendulums, moved.swing, strict=True):
        permitted = pendulums[name].swing_permitted
        if permitted is not None:
            worst = int(np.abs(row).argmax())
            yield PeakJudgement(
                name, "swing", ANGLE, float(abs(row[worst])), permitted, float(moved.time[worst])
            )


def _frictions(machine: Machine, moved: TorsionTransient) -> Iterator[PeakJudgement]:
    """Clutches, brakes and freewheels: peak torque, and friction work of the whole manoeuvre."""
    train = machine.train
    parts = {} if train is None else {**train.clutches, **train.brakes, **train.freewheels}
    for k, name in enumerate(moved.frictions):
        torque, heat = (getattr(parts[name], key, None) for key in ("torque_permitted", "heat_permitted"))
        if torque is not None:
            time = float(moved.friction_torque_max_time[k])
            yield PeakJudgement(name, "torque", TORQUE, float(moved.friction_torque_max[k]), torque, time)
        if heat is not None:
            end = float(moved.time[-1])
            yield PeakJudgement(name, "friction work", ENERGY, float(moved.friction_heat[k]), heat, end)


def _limited_stages(machine: Machine, moved: TorsionTransient) -> Iterator[tuple[str, Floats, float]]:
    """Gear stages with a permitted torque: name, torque (n,) and permitted torque [N m]."""
    gears = {} if machine.train is None else machine.train.gears
    for name, row in zip(moved.stages, moved.stage_torque, strict=True):
        permitted = gears[name].torque_permitted if name in gears else None
        if permitted is not None:
            yield name, row, permitted


def _torques(machine: Machine, moved: TorsionTransient) -> Iterator[PeakJudgement]:
    shafts = train_of(machine).shafts
    couplings = {} if machine.train is None else machine.train.couplings
    bearing = {name: shaft.limit for name, shaft in shafts.items() if shaft.limit is not None} | couplings
    for name, limit in bearing.items():
        permitted = limit.torque_permitted
        if permitted is not None:
            torque, time = _largest(moved, name)
            yield PeakJudgement(name, "torque", TORQUE, torque, permitted, time)


def _stresses(machine: Machine, moved: TorsionTransient) -> Iterator[PeakJudgement]:
    shafts = train_of(machine).shafts
    for name, (section, limit) in stressed(shafts).items():
        if shafts[name].limit is None:
            continue
        factor = limit.concentration / section.section_modulus
        torque, time = _largest(moved, name)
        if limit.stress_max is not None:
            size = factor * torque
            yield PeakJudgement(name, "maximum stress", PRESSURE, size, limit.stress_max, time)
        times, speeds, swings = _swings(moved, name)
        service = service_speed(machine, np.abs(moved.speed[0]))
        permitted = limit.permitted_stress(speeds / service, section.diameter)[1]
        known = np.flatnonzero(np.isfinite(permitted))
        if len(known):
            worst = known[np.argmax(factor * swings[known] / permitted[known])]
            stress, most = float(factor * swings[worst]), float(permitted[worst])
            yield PeakJudgement(name, PASSING_STRESS, PRESSURE, stress, most, float(times[worst]))


def _largest(moved: TorsionTransient, name: str) -> tuple[float, float]:
    s = moved.shafts.index(name)
    greatest, least = float(moved.torque_max[s]), float(moved.torque_min[s])
    if greatest >= -least:
        return greatest, float(moved.torque_max_time[s])
    return -least, float(moved.torque_min_time[s])


def _swings(moved: TorsionTransient, name: str) -> tuple[Floats, Floats, Floats]:
    """Time, speed of the first disc and half the peak-to-peak torque, in revolutions that overlap."""
    torque, turned = moved.torque[moved.shafts.index(name)], np.abs(moved.angle[0] - moved.angle[0, 0])
    # A disc that turns back and forth stays in its window.
    turned = np.maximum.accumulate(turned)
    starts = np.arange(0.0, max(turned[-1] - _WINDOW, 0.0) + 1e-9, 0.5 * _WINDOW)
    first = np.searchsorted(turned, starts)
    last = np.maximum(np.searchsorted(turned, starts + _WINDOW, side="right"), first + 1)
    last[-1] = len(turned)
    swings = [0.5 * float(np.ptp(torque[a:b])) for a, b in zip(first, last, strict=True)]
    speeds = [float(np.abs(moved.speed[0, a:b]).mean()) for a, b in zip(first, last, strict=True)]
    return moved.time[first], np.array(speeds), np.array(swings)
