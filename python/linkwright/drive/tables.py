"""Results of a drive as tables of text, for the page and for the terminal."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

from linkwright.drive.model.motor import ConstantSpeedMotor
from linkwright.drive.reduction import Reduction
from linkwright.drive.steady_state import SteadyState
from linkwright.drive.step_method import StepMotion
from linkwright.kernel.page.table import Row, Table, few, rows_in
from linkwright.kernel.quantities import in_table, shown
from linkwright.kernel.reader.numbers import crank_angle, cycle_of_angles, degrees, measured, number, parted
from linkwright.machine.analysis import Results


def drive_tables(study: Results) -> Iterator[Table]:
    """What there is of reduction, steady motion, speed fluctuation, drive, run-up, run-down, step method."""
    parts = (_reduction, _steady, _measures, _drive, _run_up, _run_down, _step_method)
    yield from (table for part in parts if (table := part(study)) is not None)


def _rows(result: Reduction | SteadyState, table: str, *, without: Collection[str] = ()) -> list[Row]:
    cycle = cycle_of_angles(result.crank_angle)
    return rows_in(result, table, at=lambda angle: crank_angle(angle, "at φ = ", cycle), without=without)


def _reduction(study: Results) -> Table | None:
    reduced = study.reduction
    if reduced is None or not (reduced.inertia_max or reduced.torque_load.any()):
        return None
    # Most machines have no viscous friction, and no use for a row of zeros.
    without = [] if reduced.viscous_mean else ["viscous_mean"]
    without += [] if reduced.inertia_max else ["inertia_min", "inertia_max"]
    rows = _rows(reduced, "reduction", without=without)
    return Table("reduction", "Reduced to the crank", ("quantity", "", "value", "where"), rows)


def _steady(study: Results) -> Table | None:
    steady = study.steady_state
    if steady is None:
        return None
    heads = ("quantity", "", "value", "where")
    rows = _rows(steady, "steady_state", without=_NUMERICAL)
    title = "Steady motion" + (f", cycle of {steady.turns} revolutions" if steady.turns > 1 else "")
    return Table("steady_state", title, heads, rows)


# What says how the solution was found, not how the machine moves.
_NUMERICAL = ("multiplier", "accuracy", "steps")


def numerical_tables(study: Results) -> Iterator[Table]:
    """How the steady motion was found, and how stable it is."""
    steady = study.steady_state
    if steady is not None:
        heads = ("quantity", "", "value", "")
        without = [name for name in in_table(type(steady), "steady_state") if name not in _NUMERICAL]
        rows = _rows(steady, "steady_state", without=without)
        yield Table("numerical", "Numerical details of the steady motion", heads, rows)


def _measures(study: Results) -> Table | None:
    """δ, H and k_p by each way of taking the mean, beside the limits that they are compared with."""
    columns = list(_measure_columns(study))
    if not columns:
        return None
    words = [(mark.word, mark.symbol) for mark in (shown(SteadyState, name) for name in _MEASURES)]
    speeds = ("mean speed", "ω_m", *(measured(values[0], "rad/s") for _, values in columns))
    # The limit has any speed.
    rows: list[Row] = [speeds] if study.steady_state is not None else []
    for n, (word, symbol) in enumerate(words, start=1):
        rows.append((word, symbol, *(number(values[n]) for _, values in columns)))
    return Table("measures", "Speed fluctuation", ("measure", "", *(head for head, _ in columns)), rows)


_MEASURES = ("unevenness", "dynamism", "motion_coefficient")


def _measure_columns(study: Results) -> Iterator[tuple[str, Sequence[float | None]]]:
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


def _drive(study: Results) -> Table | None:
    steady, drive = study.steady_state, study.machine.drive
    if steady is None or drive is None or drive.motor is None:
        return None
    motor = drive.motor
    power, torque = measured(motor.power_rated, "W"), measured(motor.torque_rated, "N m")
    breakdown = measured(getattr(motor, "torque_breakdown", None), "N m")
    beside = {
        "power_motor_mean": _beside("rated", power),
        "torque_motor_rms": _beside("rated", torque),
        "torque_motor_max": _beside("breakdown", breakdown),
    }
    rows = rows_in(steady, "drive", beside)
    return Table("drive", "Drive in steady motion", ("quantity", "", "value", "motor"), rows)


def _beside(word: str, value: str) -> str:
    return "" if value.startswith("–") else f"{word} {value}"


def _run_up(study: Results) -> Table | None:
    run_up = study.run_up
    if run_up is None:
        return None
    rows = rows_in(run_up, "run_up")
    title = f"Run-up, until within {100 * run_up.settled:.3g} % of steady motion"
    return Table("run_up", title, ("quantity", "", "value", ""), rows)


def _run_down(study: Results) -> Table | None:
    stop = study.run_down
    if stop is None:
        return None
    heads = ("quantity", "", "value", "")
    return Table("run_down", "Run-down, motor off, brake on", heads, rows_in(stop, "run_down"))


def _step_method(study: Results) -> Table | None:
    stepped, steady = study.step_method, study.steady_state
    if stepped is None:
        return None
    names = ("speed_min", "speed_max", "acceleration_min", "acceleration_max", *_MEASURES)
    rows = [_compared(stepped, steady, name) for name in names]
    rows.append(("revolutions until the speed repeats to 0.1 %", "n", str(stepped.turns), "", ""))
    title = f"Step method of Baranov with steps of {degrees(stepped.step)}"
    return Table("step_method", title, ("quantity", "", "step method", "exact", "difference"), rows)


def _compared(stepped: StepMotion, steady: SteadyState | None, name: str) -> Row:
    mark, value = shown(StepMotion, name), getattr(stepped, name)
    if steady is None:
        return mark.word, mark.symbol, measured(value, mark.unit), "–", "–"
    exact = getattr(steady, name)
    off = f"{number(100 * (value / exact - 1), 2)} %" if exact else "–"
    return mark.word, mark.symbol, measured(value, mark.unit), measured(exact, mark.unit), off


def drive_headline(study: Results) -> Iterator[tuple[str, str, str]]:
    """The few numbers that one looks for first: word, value, unit."""
    steady, run_up, reduced = study.steady_state, study.run_up, study.reduction
    if steady is not None:
        yield "mean speed", *parted(steady.speed_mean_time, "rad/s")
        drive = study.machine.drive
        # Steady motion has a motor.
        assert drive is not None
        assert drive.motor is not None
        motor = drive.motor
        if not isinstance(motor, ConstantSpeedMotor):
            yield "speed fluctuation δ", number(steady.unevenness), ""
            yield "dynamic factor H", number(steady.dynamism), ""
        # Without losses the mean is zero within rounding.
        power = steady.power_motor_mean if steady.power_motor_mean > 1e-9 * steady.power_motor_max else 0.0
        yield "mean motor power", *parted(power, "W")
        if motor.torque_rated is not None:
            share = steady.torque_motor_rms / motor.torque_rated
            yield "rms torque of the motor over its rated torque", number(share, 3), ""
    if run_up is not None:
        yield "run-up time", *parted(run_up.time, "s")
    if steady is None and reduced is not None:
        # Without masses there is no inertia to tell of, without loads no torque.
        names = ("inertia_min", "inertia_max") if reduced.inertia_max else ()
        yield from few(reduced, (*names, "torque_load_mean") if reduced.torque_load.any() else names)
