"""What a machine would have recorded: its motion at the places of a record, and the derivatives of that.

Steady motion over the crank angle has exact derivatives (`linkwright.drive.gradient`); motions in time are
differenced, and the error of that is measured by halving the steps.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from linkwright.drive.steady_state import solved_state, steady_state
from linkwright.drive.transient import Transient, transient
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import FindingError, InputError
from linkwright.kernel.numerics.zeros import zeros
from linkwright.linkages.whole_cycle import over_whole_cycle
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine
from linkwright.machine.tangents import directions
from linkwright.studies.fit_parameters import OWN, Number, number_of
from linkwright.studies.model import FitOptions
from linkwright.studies.plan import StudyPlan
from linkwright.studies.record import MeasuredRecord
from linkwright.studies.slopes import entries_at, machine_at

# Of motions whose differences are taken over steps of 1e-4.
_ACCURACY = 1e-11

# Places of samples are read to this share of their distance.
_PLACE = 1e-6


@dataclass
class RecordModel:
    """What a machine would have recorded, by the numbers that are sought."""

    plan: StudyPlan  # its variables are the first of the numbers
    record: MeasuredRecord  # what was measured
    options: FitOptions  # of which motion
    own: tuple[Number, ...] = ()  # numbers that belong to the record: where it began, torque over current
    count: int = 0  # motions computed so far
    reasons: Counter[str] = field(default_factory=Counter)  # why trials had no answer → how many
    _known: dict[bytes, Floats] = field(default_factory=dict, repr=False)
    # Differences by the numbers of the record leave the machine; to check one may take as long as a motion.
    _last: tuple[bytes, Machine] | None = field(default=None, repr=False)

    def machine(self, x: Floats) -> Machine:
        """The machine with its numbers exchanged."""
        entries = x[: len(self.plan.axes)]
        key = entries.tobytes()
        if self._last is None or self._last[0] != key:
            self._last = key, machine_at(self.plan, entries_at(self.plan, entries))
        return self._last[1]

    def at(self, x: Floats) -> Floats:
        """All channels one after the other, (size,); NaN where the machine cannot do it."""
        key = x.tobytes()
        if key not in self._known:
            try:
                self._known[key] = self.require(x)
            except (FindingError, InputError) as error:
                # The search takes a shorter step; how often that was so is reported with the result.
                text = " ".join(str(error).split())
                self.reasons[text] += 1
                self._known[key] = np.full(self.record.size, np.nan)
        return self._known[key]

    def require(self, x: Floats) -> Floats:
        """Likewise; a `FindingError` if the machine cannot do it, an `InputError` if there is none."""
        self.count += 1
        machine, start = self.machine(x), self._of_record(x)
        match self.options.motion:
            case "steady_state":
                table = self._steady(machine)
            case "manoeuvre":
                table = self._manoeuvre(machine)
            case _:
                table = self._in_time(machine, start["angle_start"], start["speed_start"])
        if "current" in self.record.channels:
            table["current"] = table["torque"] / start["torque_per_current"]
        return np.concatenate([table[name] for name in self.record.channels])

    def slopes(self, x: Floats, steps: Floats) -> tuple[Floats, float]:
        """Derivatives (size, numbers), and how far the largest of them may be wrong, relative to it."""
        exact = self._exact(x)
        if exact is not None:
            return exact, 0.0
        near, far = self.differences(x, steps), self.differences(x, 2 * steps)
        better = (4 * near - far) / 3
        largest = np.abs(better).max(axis=0)
        return better, float((np.abs(better - near).max(axis=0) / np.where(largest > 0, largest, 1.0)).max())

    def jacobian(self, x: Floats, steps: Floats) -> Floats:
        """Derivatives (size, numbers), exact or of second order."""
        exact = self._exact(x)
        return self.differences(x, steps) if exact is None else exact

    def differences(self, x: Floats, steps: Floats) -> Floats:
        """Central differences, (size, numbers); on one side at limits. Raises FindingError."""
        columns = []
        for step, unit, number in zip(steps, np.eye(len(x)), self.numbers, strict=True):
            high, low = (
                x + way * step * unit if number.low <= (x + way * step * unit) @ unit <= number.high else x
                for way in (1, -1)
            )
            columns.append((self.require(high) - self.require(low)) / float((high - low) @ unit))
        return np.stack(columns, axis=1)

    @property
    def numbers(self) -> tuple[Number, ...]:
        """All that is sought."""
        return (*(number_of(self.plan, axis) for axis in self.plan.axes), *self.own)

    def _of_record(self, x: Floats) -> dict[str, float]:
        """Where the record began, and torque over current: fitted or given."""
        given = {name: getattr(self.options, name) for name in OWN}
        fitted = {
            number.name: float(value)
            for number, value in zip(self.own, x[len(self.plan.axes) :], strict=True)
        }
        return {name: value for name, value in given.items() if value is not None} | fitted

    def _in_time(self, machine: Machine, angle: float, speed: float) -> dict[str, Floats]:
        """Channels of a motion in time, constant after it has come to rest."""
        motor, brake = self.options.motion == "run_up", self.options.motion == "run_down"
        span = float(self.record.at[-1] - self.record.at[0])
        duration, turns = (span, np.inf) if self.record.over == "time" else (np.inf, span / (2 * np.pi))
        motion = transient(
            machine,
            angle=angle,
            speed=speed,
            duration=duration,
            turns=turns,
            accuracy=_ACCURACY,
            motor=motor,
            brake=brake,
        )
        past = self.record.at - self.record.at[0]
        time = past if self.record.over == "time" else _times_at(motion, past + angle)
        stands = time > motion.time[-1] if motion.came_to_rest else np.zeros(len(time), dtype=bool)
        turned, turning = motion.at(np.minimum(time, motion.time[-1]))
        turning = np.where(stands, 0.0, turning)
        compiled = compile_machine(machine, motor=motor, brake=brake)
        return self._channels(compiled, turned, turning)

    def _channels(self, compiled: Any, angle: Floats, speed: Floats) -> dict[str, Floats]:
        """What can be measured of a drive, by crank angle and speed, (n,) each."""
        table = {"angle": angle, "speed": speed, "motor_speed": speed * compiled.gear_factors[0]}
        if {"torque", "current"} & set(self.record.channels):
            table["torque"] = compiled.motor_torques(speed).motor
        return table

    def _steady(self, machine: Machine) -> dict[str, Floats]:
        angles, back = np.unique(
            self.record.at % over_whole_cycle(compile_machine(machine)).cycle, return_inverse=True
        )
        state = steady_state(machine, accuracy=_ACCURACY, angles=angles)
        ratio = compile_machine(machine).gear_factors[0]
        return {
            "speed": state.speed[back],
            "motor_speed": ratio * state.speed[back],
            "torque": state.torque_motor[back],
        }

    def _manoeuvre(self, machine: Machine) -> dict[str, Floats]:
        from linkwright.torsion.in_time.transient import torsion_transient

        given = None if machine.train is None else machine.train.transient
        if given is None:
            raise InputError(f"{machine.name} has no manoeuvre to fit: it needs [train.transient]")
        step = float(np.diff(self.record.at).min())
        places = self.record.at / step
        if np.abs(places - np.round(places)).max() > _PLACE * len(places) or self.record.at[0] < 0:
            raise InputError(f"record: found times that are no multiples of {step:.6g} s after the start")
        options = {"duration": float(self.record.at[-1]), "sample_time": step, "accuracy": _ACCURACY}
        manoeuvre = given.model_copy(update=options)
        motion = torsion_transient(machine, manoeuvre)
        kept = np.round(places).astype(int)
        return {
            name: row[kept]
            for names, table in ((motion.discs, motion.speed), (motion.shafts, motion.torque))
            for name, row in zip(names, table, strict=True)
        }

    def _exact(self, x: Floats) -> Floats | None:
        """Exact derivatives (size, numbers) of steady motion; None if there are none."""
        machine = self.machine(x)
        if self.options.motion != "steady_state":
            return None
        tangents = entries_at(self.plan, x[: len(self.plan.axes)])
        ways = directions(machine, tuple(tangents))
        if ways.refused or any(not hasattr(entry, "d") for entry in tangents.values()):
            return None
        by_entry = np.stack([tangents[name].d for name in ways.variables])
        parameters = ways.values @ by_entry
        angles, back = np.unique(
            self.record.at % over_whole_cycle(compile_machine(machine)).cycle, return_inverse=True
        )
        state, solution = solved_state(machine, _ACCURACY, angles)
        if solution is None:
            return None
        sizes = np.abs(x[: by_entry.shape[1]])
        gradient = solution.gradient(parameters, np.where(sizes == 0.0, 1.0, sizes))
        if np.isfinite(gradient.lost).any():
            return None
        curves = gradient.curves(angles)
        speed, torque = curves.speed[back], curves.torque_motor[back]
        compiled = compile_machine(machine)
        ratio = compiled.gear_factors[0], parameters[compiled.gear_slots[0]]
        table = {"speed": state.speed[back], "torque": state.torque_motor[back]}
        slopes = {
            "speed": speed,
            "torque": torque,
            "motor_speed": ratio[0] * speed + table["speed"][:, None] * ratio[1],
        }
        return self._with_own(x, table, slopes)

    def _with_own(self, x: Floats, table: dict[str, Floats], slopes: dict[str, Floats]) -> Floats:
        per = self._of_record(x).get("torque_per_current", np.nan)
        extra = np.zeros((len(self.record.at), len(self.own)))
        columns = []
        for name in self.record.channels:
            if name != "current":
                columns.append(np.hstack([slopes[name], extra]))
                continue
            by_own = extra.copy()
            for place, number in enumerate(self.own):
                by_own[:, place] = -table["torque"] / per**2 if number.name == "torque_per_current" else 0.0
            columns.append(np.hstack([slopes["torque"] / per, by_own]))
        return np.vstack(columns)


def _times_at(motion: Transient, angles: Floats) -> Floats:
    """Times [s] at which a motion passes crank angles; infinite for those that it does not reach."""
    reached = angles <= motion.crank_angle[-1]
    step = np.clip(
        np.searchsorted(motion.crank_angle, angles[reached], side="right") - 1, 0, motion.steps - 1
    )
    near, _ = zeros(
        lambda time: motion.at(time)[0] - angles[reached], motion.time[step], motion.time[step + 1]
    )
    time = np.full(len(angles), np.inf)
    time[reached] = near
    return time
