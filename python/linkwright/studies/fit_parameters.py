"""The numbers that a record is fitted by: variables of a study, and where the record began."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from linkwright.kernel.errors import InputError
from linkwright.machine.address import get
from linkwright.machine.program.compiled import compile_machine
from linkwright.studies.axes import Axis
from linkwright.studies.model import FitOptions
from linkwright.studies.plan import StudyPlan
from linkwright.studies.record import MeasuredRecord

# Numbers that belong to the record, and their units.
OWN = {"speed_start": "rad/s", "angle_start": "rad", "torque_per_current": "N m/A"}

# Motions of a drive in time, of which one without its motor has no torque to be measured.
_IN_TIME, _WITHOUT_MOTOR = ("run_up", "run_down", "coast"), ("run_down", "coast")


@dataclass(frozen=True)
class Number:
    """A number that is sought."""

    # Name of the variable, or of the record's own; SI unit as it is printed.
    name: str
    unit: str
    # First value and limits [SI].
    start: float
    low: float
    high: float
    scale: float  # what counts as a large change of it [SI]


def numbers_of_record(
    plan: StudyPlan, record: MeasuredRecord, options: FitOptions
) -> tuple[FitOptions, tuple[Number, ...]]:
    """What is known of a record, and the numbers of it that are sought besides the variables.

    Raises `InputError` if the motion does not have what was recorded, or has it not over time or angle; or
    its start has to be given.
    """
    _check_variables(plan)
    _check_record(record, options)
    if options.angle_start is None and record.over == "angle":
        options = options.model_copy(update={"angle_start": float(record.at[0])})
    wanted = ["torque_per_current"] if "current" in record.channels else []
    wanted += ["speed_start", "angle_start"] if options.motion in _IN_TIME else []
    return options, tuple(_own(name, plan, record) for name in wanted if getattr(options, name) is None)


def _check_variables(plan: StudyPlan) -> None:
    for axis in plan.axes:
        if axis.choices or axis.distribution is not None or axis.is_whole:
            found = "a list, whole numbers or a scatter"
            raise InputError(f"variables.{axis.name}: found {found}, expected a range or nothing")


def _check_record(record: MeasuredRecord, options: FitOptions) -> None:
    over = {"steady_state": "angle", "manoeuvre": "time"}.get(options.motion, record.over)
    if record.over != over:
        raise InputError(f"record: found {record.over}, expected {over} along the record of {options.motion}")
    known = {"speed", "motor_speed"} | (set() if options.motion in _WITHOUT_MOTOR else {"torque", "current"})
    known |= {"angle"} if options.motion in _IN_TIME else set()
    known = set(record.units) if options.motion == "manoeuvre" else known
    strange = [name for name in record.channels if name not in known]
    if strange:
        listed = ", ".join(sorted(known)) or "names of discs and shafts of the train"
        raise InputError(f"record: found {strange[0]} of {options.motion}, expected {listed}")


def _own(name: str, plan: StudyPlan, record: MeasuredRecord) -> Number:
    if name == "angle_start":
        start = float(record.channels.get("angle", [0.0])[0])
        return Number(name, OWN[name], start, -np.inf, np.inf, 1.0)
    if name == "speed_start":
        speed, size = _first_speed(plan, record)
        return Number(name, OWN[name], speed, 0.0, np.inf, size)
    motor = plan.machine.drive and plan.machine.drive.motor
    torque = abs(float(getattr(motor, "torque_rated", 0.0) or 1.0))
    ratio = torque / (float(np.abs(record.channels["current"]).mean()) or 1.0)
    return Number(name, OWN[name], ratio, 0.0, np.inf, ratio)


def _first_speed(plan: StudyPlan, record: MeasuredRecord) -> tuple[float, float]:
    """Crank speed of the first sample, and the largest [rad/s]."""
    if "angle" in record.channels:
        speed = np.gradient(record.channels["angle"], record.at)
    if "motor_speed" in record.channels:
        speed = record.channels["motor_speed"] / compile_machine(plan.machine).gear_factors[0]
    if "speed" in record.channels:
        speed = record.channels["speed"]
    if not {"angle", "motor_speed", "speed"} & set(record.channels):
        raise InputError(
            'fit.speed_start: found nothing, expected it where no speed is recorded, such as "0 rpm"'
        )
    return max(float(speed[0]), 0.0), float(np.abs(speed).max()) or 1.0


def number_of(plan: StudyPlan, axis: Axis) -> Number:
    """A variable as a sought number from the machine's value; `InputError` without value and range."""
    value, low, high = get(plan.machine, axis.addresses[0]), axis.low, axis.high
    if not isinstance(value, int | float):
        value = 0.5 * (low + high)
        if not math.isfinite(value):
            raise InputError(f"variables.{axis.name}: found no value in the machine, expected a range")
    is_size = axis.unit != "rad" and value > 0
    if is_size and math.isinf(low) and math.isinf(high):
        low = 0.0
    start = float(np.clip(value, low, high))
    span = 0.5 * (high - low) if math.isfinite(high - low) else 1.0
    return Number(axis.name, axis.unit, start, low, high, start if is_size else span)
