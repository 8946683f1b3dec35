"""Tables of studies."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from linkwright.kernel.page.table import Row, Table
from linkwright.kernel.reader.numbers import measured, number
from linkwright.studies.allocation import Allocation
from linkwright.studies.axes import Axis
from linkwright.studies.choices import choice_names
from linkwright.studies.fit import Fit
from linkwright.studies.front import Front
from linkwright.studies.optimise import Optimum
from linkwright.studies.plan import StudyPlan
from linkwright.studies.sweep import Sweep
from linkwright.studies.tolerance import Tolerance

# Reasons of failed rows in a table.
_REASONS = 8


# Variables whose values stand beside the extremes.
_BESIDE = 5


def sweep_tables(sweep: Sweep, plan: StudyPlan, units: dict[str, str]) -> list[Table]:
    """Extremes of the responses with the variables there, and why rows have no answer."""
    shown = plan.axes[:_BESIDE]
    rows: list[Row] = []
    for name, extremes in sweep.extremes.items():
        for key, word in (("min", "minimum"), ("max", "maximum")):
            at = int(extremes[f"{key}_row"])
            there = plan.rows(at, at + 1)
            beside = [_value(axis, float(there[axis.name][0]), units) for axis in shown]
            rows.append((f"{word} of {name}", "", measured(extremes[key], units[name]), str(at), *beside))
    heads = ("response", "", "value", "row", *(axis.name for axis in shown))
    tables = [Table("sweep", "Responses", heads, rows)] if rows else []
    if sweep.reasons:
        listed: list[Row] = [(text, "", str(count)) for text, count in list(sweep.reasons.items())[:_REASONS]]
        if len(sweep.reasons) > _REASONS:
            rest = sum(list(sweep.reasons.values())[_REASONS:])
            listed.append((f"{len(sweep.reasons) - _REASONS} further reasons", "", str(rest)))
        tables.append(Table("failed", "Rows without a result", ("reason", "", "rows"), listed))
    return tables


def _value(axis: Axis, value: float, units: dict[str, str]) -> str:
    return measured(value, units[axis.name]) if axis.is_number else choice_names(axis.choices)[int(value)]


def tolerance_tables(tolerance: Tolerance, units: dict[str, str]) -> list[Table]:
    """Scatter of the variables and of the responses, and what contributes to it."""
    return [_given(tolerance, units), _scatter(tolerance, units), _contributions(tolerance)]


def _given(tolerance: Tolerance, units: dict[str, str]) -> Table:
    rows: list[Row] = []
    for name, given in tolerance.variables.items():
        mean = given["mean"]
        numbers = (mean, given["deviation"], given["low"] - mean, given["high"] - mean)
        rows.append((name, "", *(measured(value, units[name]) for value in numbers)))
    heads = ("variable", "", "mean", "standard deviation", "lower limit deviation", "upper limit deviation")
    return Table("variables", "Variables", heads, rows)


def _scatter(tolerance: Tolerance, units: dict[str, str]) -> Table:
    keys = ("mean", "deviation", "deviation_first_order", "band_low", "band_high", "worst_low", "worst_high")
    rows: list[Row] = [
        (name, "", *(measured(response[key], units[name]) for key in keys))
        for name, response in tolerance.responses.items()
    ]
    heads = ("response", "", "mean", "standard deviation", "to first order", "99.73 % from", "to")
    return Table("scatter", "Scatter", (*heads, "worst case from", "to"), rows)


def _contributions(tolerance: Tolerance) -> Table:
    rows: list[Row] = []
    for name, parts in tolerance.contributions.items():
        for variable, share in parts.items():
            slope = number(tolerance.slopes[name][variable])
            rows.append(
                (name, "", variable, f"{100 * share:.3g} %", slope, *_indices(tolerance, name, variable))
            )
    heads = ("response", "", "variable", "share of the variance", "derivative [SI]", "Sobol index", "total")
    return Table("contributions", "Contributions", heads, rows)


def _indices(tolerance: Tolerance, name: str, variable: str) -> list[str]:
    both = tolerance.indices.get(name, {}).get(variable, (None, None))
    ends = tolerance.index_intervals.get(name, {}).get(variable, ((0.0, 0.0),) * 2)
    return [
        number(index, 3) + ("" if index is None else f" ± {number(0.5 * (high - low), 2)}")
        for index, (low, high) in zip(both, ends, strict=True)
    ]


def allocation_tables(allocation: Allocation, units: dict[str, str]) -> list[Table]:
    """The cheapest tolerances."""
    rows: list[Row] = []
    for name, (low, high) in allocation.tolerances.items():
        factor = number(allocation.factors[name])
        rows.append((name, "", *(measured(end, units[name]) for end in (low, high)), factor))
    heads = ("variable", "", "lower limit deviation", "upper limit deviation", "times as wide")
    return [Table("allocation", "Cheapest tolerances", heads, rows)]


def optimum_tables(optimum: Optimum, units: dict[str, str]) -> list[Table]:
    """The best machine, and the best of each combination of choices."""
    rows: list[Row] = []
    for name, value in (*optimum.variables.items(), *optimum.responses.items()):
        rows.append((name, "", _cell(value, units[name])))
    tables = [Table("optimum", f"Best by {optimum.goal}", ("name", "", "value"), rows)]
    if optimum.tried:
        names = [name for name in optimum.tried[0] if name != "refused"]
        listed: list[Row] = []
        for one in optimum.tried:
            first, *others = (_cell(one[name], units.get(name, "")) for name in names)
            listed.append((first, "", *others, one["refused"] or ""))
        tables.append(Table("tried", "Choices", (names[0], "", *names[1:], "nearest"), listed))
    return tables


def _cell(value: Any, unit: str) -> str:
    if value is None or isinstance(value, float):
        return measured(value, unit)
    if isinstance(value, Mapping):
        return ", ".join(f"{key} = {_cell(entry, '')}" for key, entry in value.items())
    return str(value)


def front_tables(front: Front, units: dict[str, str]) -> list[Table]:
    """A row for each machine of a front: goals first, then variables, and what is active."""
    first = front.machines[0]
    names = [*front.goals, *first.variables, *(name for name in first.responses if name not in front.goals)]
    rows: list[Row] = []
    for nth, machine in enumerate(front.machines, start=1):
        values = {**machine.variables, **machine.responses}
        shown = [_cell(values[name], units[name]) for name in names]
        rows.append((str(nth), "", *shown, "; ".join(machine.active) or "–"))
    return [
        Table("front", "Machines of which none is better in both goals", ("", "", *names, "active"), rows)
    ]


def fit_tables(fit: Fit) -> list[Table]:
    """Fitted numbers with their intervals, and their correlations."""
    rows: list[Row] = []
    for name, value in fit.values.items():
        low, high = fit.intervals[name]
        shown = (measured(number, fit.units[name]) for number in (value, fit.deviations[name], low, high))
        rows.append((name, "", *shown))
    heads = ("number", "", "value", "standard deviation", f"{100 * fit.level:g} % from", "to")
    tables = [Table("fit", "Fitted numbers", heads, rows)]
    names = list(fit.values)
    if len(names) > 1:
        pairs: list[Row] = [
            (name, "", *(number(fit.correlations[name][other], 3) for other in names)) for name in names
        ]
        tables.append(Table("correlations", "Correlations", ("number", "", *names), pairs))
    return tables
