"""Tables of an FMU: what is set, what is read, what may be changed."""

from __future__ import annotations

from linkwright.fmi.fmu import Fmu
from linkwright.fmi.variables import Group, Variable
from linkwright.kernel.page.table import Row, Table, row
from linkwright.kernel.reader.numbers import measured
from linkwright.kernel.reader.out_units import reader

_TITLES = {"input": "Inputs", "parameter": "Parameters"}
_OF_MECHANISM = {Group.POINT: "points", Group.LINK: "links", Group.SLIDE: "slides"}


def fmu_tables(unit: Fmu) -> list[Table]:
    """The FMU, its inputs and parameters with their start values, and its outputs."""
    return [_itself(unit), *(_started(unit, causality) for causality in _TITLES), _outputs(unit)]


def _itself(unit: Fmu) -> Table:
    """Version, library, size of the model."""
    rows: list[Row] = [
        ("version of FMI", "", unit.version),
        ("platforms", "", ", ".join(unit.platforms)),
        *(row(unit, name)[:3] for name in ("states", "event_indicators", "accuracy")),
    ]
    return Table("fmu", "FMU", ("quantity", "", "value"), rows)


def _started(unit: Fmu, causality: str) -> Table:
    """Variables that the importing tool sets."""
    rows: list[Row] = [(v.name, "", _start(v)) for v in unit.named(causality)]
    return Table(f"fmu_{causality}s", _TITLES[causality], ("variable", "", "start"), rows)


def _start(variable: Variable) -> str:
    """The start value with its unit."""
    if variable.is_bool:
        return str(variable.start).lower()
    return measured(float(variable.start or 0.0), variable.unit)


def _outputs(unit: Fmu) -> Table:
    """Variables that the importing tool reads; of the mechanism how many."""
    outputs = unit.named("output")
    rows: list[Row] = [(v.name, "", _unit(v)) for v in outputs if v.group not in _OF_MECHANISM]
    for group, name in _OF_MECHANISM.items():
        count = sum(v.group == group for v in outputs)
        if count:
            rows.append((f"{name}.*", "", f"{count} variables"))
    return Table("fmu_outputs", "Outputs", ("variable", "", "unit"), rows)


def _unit(variable: Variable) -> str:
    """The unit in which a tool shows it, in brackets as at the head of a column."""
    unit = reader().shown(variable.unit)[0]
    return f"[{unit}]" if unit else "–"
