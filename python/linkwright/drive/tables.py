"""Results of a drive as tables of text, for the page and for the terminal."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from linkwright.drive.steady_state import SteadyState
from linkwright.drive.study import DriveStudy
from linkwright.kernel.page.quantities import SHOWN, degrees, number
from linkwright.kernel.page.table import Row, Table, row, rows_of, with_unit
from linkwright.kernel.result import Result


def drive_tables(study: DriveStudy) -> Iterator[Table]:
    """What there is of reduction, steady motion, its evenness, the drive, run-up, run-down, step method."""
    parts = (_reduction, _steady, _measures, _drive, _run_up, _run_down, _step_method)
    yield from (table for part in parts if (table := part(study)) is not None)


def _extremes(result: Any, *names: str) -> list[Row]:
    """Rows of values that have an angle."""
    return [row(result, name, f"at φ = {_on_turn(getattr(result, f'{name}_angle'))}") for name in names]


def _on_turn(angle: float) -> str:
    """A crank angle from 0° on; a full turn is 0°."""
    text = degrees(angle)
    return "0°" if text == "360°" else text


def _reduction(study: DriveStudy) -> Table | None:
    reduced = study.reduction
    if reduced is None:
        return None
    rows = _extremes(reduced, "inertia_min", "inertia_max")
    rows += rows_of(reduced, "torque_load_mean", "torque_load_max")
    # Most machines have no viscous friction, and no use for a row of zeros.
    rows += rows_of(reduced, "viscous_mean") if reduced.viscous_mean else []
    return Table("reduction", "Reduced to the crank", ("quantity", "", "value", "where"), rows)


def _steady(study: DriveStudy) -> Table | None:
    steady = study.steady_state
    if steady is None:
        return None
    rows = _extremes(steady, "speed_min", "speed_max", "acceleration_min", "acceleration_max")
    rows += rows_of(steady, "period", "multiplier", "accuracy", "steps")
    return Table("steady_state", "Steady motion", ("quantity", "", "value", "where"), rows)


def _measures(study: DriveStudy) -> Table | None:
    """δ, H and k_p by each way of taking the mean, beside the limits that they are compared with."""
    columns = list(_measure_columns(study))
    if not columns:
        return None
    words = [(shown.word, shown.symbol) for shown in (SHOWN[name] for name in _MEASURES)]
    speeds = ("mean speed", "ω_m", *(with_unit(values[0], "rad/s") for _, values in columns))
    # The limit has any speed.
    rows: list[Row] = [speeds] if study.steady_state is not None else []
    for n, (word, symbol) in enumerate(words, start=1):
        rows.append((word, symbol, *(number(values[n]) for _, values in columns)))
    return Table("measures", "Evenness of motion", ("measure", "", *(head for head, _ in columns)), rows)


_MEASURES = ("unevenness", "dynamism", "motion_coefficient")


def _measure_columns(study: DriveStudy) -> Iterator[tuple[str, Sequence[float | None]]]:
    """Head, and mean speed, δ, H, k_p."""
    steady, stepped, limit = study.steady_state, study.step_method, study.constant_energy
    if steady is not None:
        own = [getattr(steady, name) for name in _MEASURES]
        timed = [getattr(steady, f"{name}_time") for name in _MEASURES]
        yield "mean of the extremes", [steady.speed_mean_extremes, *own]
        yield "mean over time", [steady.speed_mean_time, *timed]
    if stepped is not None:
        values = [getattr(stepped, name) for name in _MEASURES]
        yield "step method", [stepped.speed_mean_extremes, *values]
    if limit is not None:
        yield "constant energy", [None, *(getattr(limit, name) for name in _MEASURES)]


def _drive(study: DriveStudy) -> Table | None:
    """Work, power and torque of the drive, beside what the motor is rated for."""
    steady, drive = study.steady_state, study.machine.drive
    if steady is None or drive is None or drive.motor is None:
        return None
    motor = drive.motor
    power, torque = with_unit(motor.power_rated, "W"), with_unit(motor.torque_rated, "N m")
    breakdown = with_unit(getattr(motor, "torque_breakdown", None), "N m")
    rows = rows_of(steady, "energy_motor", "energy_drive", "energy_load", "efficiency")
    rows += [row(steady, "power_motor_mean", _beside("rated", power)), row(steady, "power_motor_max")]
    rows += rows_of(steady, "torque_motor_mean")
    rows += [row(steady, "torque_motor_rms", _beside("rated", torque)), row(steady, "torque_motor_min")]
    rows += [row(steady, "torque_motor_max", _beside("breakdown", breakdown))]
    return Table("drive", "Drive in a turn of steady motion", ("quantity", "", "value", "motor"), rows)


def _beside(word: str, value: str) -> str:
    return "" if value.startswith("–") else f"{word} {value}"


def _run_up(study: DriveStudy) -> Table | None:
    run_up = study.run_up
    if run_up is None:
        return None
    rows = rows_of(run_up, "turns", "time", "speed_peak")
    title = f"Run-up, until within {100 * run_up.settled:.3g} % of steady motion"
    return Table("run_up", title, ("quantity", "", "value", ""), rows)


def _run_down(study: DriveStudy) -> Table | None:
    stop = study.run_down
    if stop is None:
        return None
    rows = [*rows_of(stop, "turns", "time"), ("crank angle at rest", "φ_end", degrees(stop.angle_end), "")]
    return Table("run_down", "Run-down, motor off, brake on", ("quantity", "", "value", ""), rows)


def _step_method(study: DriveStudy) -> Table | None:
    """The step method beside the exact solution."""
    stepped, steady = study.step_method, study.steady_state
    if stepped is None:
        return None
    names = ("speed_min", "speed_max", "acceleration_min", "acceleration_max", *_MEASURES)
    rows = [_compared(stepped, steady, name) for name in names]
    rows.append(("turns until the speed repeats to 0.1 %", "n", str(stepped.turns), "", ""))
    title = f"Step method of Baranov with steps of {degrees(stepped.step)}"
    return Table("step_method", title, ("quantity", "", "step method", "exact", "difference"), rows)


def _compared(stepped: Result, steady: SteadyState | None, name: str) -> Row:
    shown, value = SHOWN[name], getattr(stepped, name)
    if steady is None:
        return shown.word, shown.symbol, with_unit(value, shown.unit), "–", "–"
    exact = getattr(steady, name)
    off = f"{number(100 * (value / exact - 1), 2)} %" if exact else "–"
    return shown.word, shown.symbol, with_unit(value, shown.unit), with_unit(exact, shown.unit), off
