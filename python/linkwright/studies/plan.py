"""A study that is ready to run: variables, responses and limits of a machine, all of them checked."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import suggestion
from linkwright.kernel.description.formula import NUMBERS, FormulaError, Node, names, parse
from linkwright.kernel.errors import (
    InputError,
    MachineError,
    Problem,
    ShapeError,
    UnitError,
    require_within,
    show,
)
from linkwright.kernel.limits import LATIN_ROWS, LEVELS, SWEEP_ROWS
from linkwright.kernel.public.arguments import array, integer
from linkwright.kernel.units.kinds import KINDS, Kind
from linkwright.kernel.units.reading import parse as parse_quantity
from linkwright.kernel.units.reading import parse_any
from linkwright.machine.address import get, known_place
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine
from linkwright.machine.tolerances import tolerance_names
from linkwright.studies import sampling
from linkwright.studies.axes import Axis, axis, require_places
from linkwright.studies.model import WAYS, StudyFile, Sweep, Variable
from linkwright.studies.responses import asked, require_place
from linkwright.studies.study_response import StudyResponse


@dataclass(frozen=True)
class Formula:
    """A number that follows from others."""

    name: str
    tree: Node  # the formula
    addresses: tuple[str, ...] = ()  # entries of the machine that take its value; none of a response


@dataclass(frozen=True)
class StudyPlan:
    """A study that is ready to run.

    Attributes
    ----------
    machine : Machine
        The machine, as it is without the study.
    study : StudyFile
        The study as it stands in its file.
    axes : tuple of Axis
        The variables.
    derived : tuple of Formula
        What follows from them.
    asked : tuple of StudyResponse
        Responses that analyses give.
    formulas : tuple of Formula
        Responses that follow from others.
    limits : dict of str to (float, float)
        Response → minimum and maximum that are allowed [SI], infinite without.
    listed : ndarray, shape (n, variables), or None
        Rows of a list, in SI.
    """

    machine: Machine
    study: StudyFile
    axes: tuple[Axis, ...]
    derived: tuple[Formula, ...]
    asked: tuple[StudyResponse, ...]
    formulas: tuple[Formula, ...]
    limits: dict[str, tuple[float, float]] = field(default_factory=dict)
    listed: Floats | None = None

    @property
    def sweep(self) -> Sweep:
        """How rows are drawn."""
        return self.study.sweep

    @property
    def n_rows(self) -> int:
        """How many rows a sweep has."""
        if self.listed is not None:
            return len(self.listed)
        if self.sweep.method == "grid":
            return int(np.prod([axis.n_levels for axis in self.axes], dtype=float))
        return self.sweep.rows or 0

    @property
    def responses(self) -> tuple[str, ...]:
        """Names of the responses, in the order of the file."""
        return tuple(self.study.responses)

    @property
    def units(self) -> dict[str, str]:
        """SI unit of each variable and response; empty for a number without one, and for a formula."""
        known = {axis.name: axis.unit for axis in self.axes} | {
            asked.name: asked.unit for asked in self.asked
        }
        return {name: known.get(name, "") for name in self.columns}

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of variables, derived numbers and responses."""
        return (*(axis.name for axis in self.axes), *(entry.name for entry in self.derived), *self.responses)

    def shares(self, start: int, stop: int) -> Floats:
        """Rows of the sweep as shares, 0 to 1, (stop - start, variables); `InputError` for rows beyond it."""
        start, stop = self._span(start, stop)
        n, seed = len(self.axes), self.sweep.seed
        match self.sweep.method:
            case "grid":
                return sampling.grid([axis.levels for axis in self.axes], start, stop)
            case "sobol":
                return sampling.sobol(n, seed, start, stop)
            case "latin_hypercube":
                return sampling.latin_hypercube(n, self.n_rows, seed, start, stop)
        return sampling.random(n, seed, start, stop)

    def rows(self, start: int, stop: int) -> dict[str, Floats]:
        """Values of the variables in rows of the sweep [SI], (stop - start,) each; `InputError` beyond it."""
        start, stop = self._span(start, stop)
        if self.listed is not None:
            return {axis.name: self.listed[start:stop, i] for i, axis in enumerate(self.axes)}
        return self.values(self.shares(start, stop))

    def values(self, shares: Floats) -> dict[str, Floats]:
        """Values of the variables [SI], (n,) each, at shares (n, variables); `InputError` outside 0 to 1."""
        shares = array("shares", shares)
        if shares.ndim != 2 or shares.shape[1] != len(self.axes):
            expected = f"(n, {len(self.axes)}), a share of each variable"
            raise ShapeError(f"shares: found an array of shape {shares.shape}, expected {expected}")
        if shares.size and not (shares.min() >= 0 and shares.max() <= 1):
            raise InputError(f"shares: found {shares.min():g} to {shares.max():g}, expected 0 to 1")
        columns = enumerate(self.axes)
        return {axis.name: np.ascontiguousarray(axis.values(shares[:, i])) for i, axis in columns}

    def _span(self, start: int, stop: int) -> tuple[int, int]:
        """First row and the one after the last, of those that the sweep has."""
        start, stop = integer("start", start), integer("stop", stop)
        if not 0 <= start <= stop <= self.n_rows:
            raise InputError(f"rows {start} to {stop}: expected numbers from 0 to {self.n_rows}, in order")
        return start, stop


def plan(machine: Machine, study: StudyFile, listed: Floats | None = None) -> StudyPlan:
    """Check a study against its machine; `listed`: ndarray, shape (n, variables), rows of a list [SI].

    Raises `MachineError` with all problems, keys from the top of the study.
    """
    problems: list[Problem] = []

    def gather(items: Iterable[tuple[str, Any]], read: Any) -> tuple[Any, ...]:
        results = []
        for name, item in items:
            try:
                results.append(read(name, item))
            except MachineError as error:
                problems.extend(error.problems)
        return tuple(results)

    axes = gather(study.variables.items(), lambda name, variable: axis(machine, name, variable))
    known = [*study.variables]
    derived = gather(study.derived.items(), lambda name, entry: _derived(machine, known, name, entry))
    direct = [(name, response) for name, response in study.responses.items() if response.formula is None]
    made = [(name, response) for name, response in study.responses.items() if response.formula is not None]
    responses = gather(direct, lambda name, response: asked(machine, name, response, study.paths))
    known += [*study.derived, *(name for name, _ in direct)]
    formulas = gather(
        made, lambda name, response: _formula(known, f"responses.{name}", name, response.formula or "")
    )
    units = {response.name: response.unit for response in responses}
    # The unit of a limit is that of its response: where there is none, there is nothing to compare.
    sound = {response.name for response in responses} | {name for name, _ in made}
    limited = [
        (name, limit)
        for name, limit in study.constraints.items()
        if name in sound or name not in study.responses
    ]
    limits = gather(limited, lambda name, constraint: (name, _limits(study, units, name, constraint)))
    problems += [*_lost_points(machine, study), *_other_problems(machine, study, listed)]
    if problems:
        raise MachineError(problems)
    if listed is not None:
        for nth, variable in enumerate(axes):
            require_places(variable, listed[:, nth], f"{study.sweep.file}: column {variable.name}")
            if study.variables[variable.name].range is not None:
                _require_in_range(variable, listed[:, nth], f"{study.sweep.file}: column {variable.name}")
    ready = StudyPlan(machine, study, axes, derived, responses, formulas, dict(limits), listed)
    _check_rows(ready)
    # Numbers do not make lists longer; other tables may.
    if all(axis.is_number for axis in axes):
        gather(((one.name, one) for one in responses), lambda _, response: require_place(machine, response))
    if problems:
        raise MachineError(problems)
    return ready


def _require_in_range(axis: Axis, values: Floats, what: str) -> None:
    """Refuse values of a list outside the range of their variable, as degrees under a head without unit."""
    outside = np.flatnonzero((values < axis.low) | (values > axis.high))
    if len(outside):
        row, unit = int(outside[0]), f" {axis.unit}".rstrip()
        expected = f"{axis.low:.6g} to {axis.high:.6g}{unit}, the range of the variable"
        raise InputError(
            f"{what}, row {row}: found {values[row]:.6g}{unit}, expected {expected}; give the unit in the "
            "header of the column, as in phase [deg]"
        )


def _lost_points(machine: Machine, study: StudyFile) -> Iterable[Problem]:
    points = compile_machine(machine).points if study.paths else {}
    for name, path in study.paths.items():
        if path.point not in points:
            remedy = suggestion(path.point, points) or f"one of {', '.join(points)}"
            yield Problem(f"paths.{name}.point", show(path.point), "a point of the machine", remedy)


def with_tolerances(ready: StudyPlan) -> StudyPlan:
    """The study with the tolerances of its machine as variables, but for entries that it sets itself."""
    machine, study = ready.machine, ready.study
    named = [address for one in ready.axes for address in one.addresses]
    named += [address for one in ready.derived for address in one.addresses]
    taken = [known_place(machine, address) for address in named]
    added: dict[str, Variable] = {}
    for name, address in tolerance_names(machine, ready.columns).items():
        place = known_place(machine, address)
        # A variable may be a whole table, of which the entry is a part.
        if all(place[: len(other)] != other for other in taken):
            text = machine.tolerances[address]
            added[name] = Variable.model_validate({"address": address, "tolerance": text})
    axes = tuple(axis(machine, name, variable) for name, variable in added.items())
    variables = {**study.variables, **added}
    return replace(ready, study=study.with_entries({"variables": variables}), axes=(*ready.axes, *axes))


def require_variables(ready: StudyPlan) -> None:
    """Raise `InputError` if nothing varies but what `linkwright tolerance` takes from the machine."""
    if not ready.axes:
        remedy = 'the tolerances of the machine are variables of "linkwright tolerance" alone'
        raise InputError(f"variables: found none, expected a table for each entry that varies; {remedy}")


def _other_problems(machine: Machine, study: StudyFile, listed: Floats | None) -> Iterable[Problem]:
    """What is missing, what has the name of something else, goals without a response."""
    if not study.variables and not machine.tolerances:
        yield Problem("variables", "nothing", "a table for each entry that varies")
    if not study.responses and study.fit is None:
        yield Problem("responses", "nothing", 'what is asked, such as delta = "steady_state.unevenness"')
    seen = {"row": "the number of a row"} | dict.fromkeys(("status", "reason", "fast_starts"), "a column")
    for table in ("variables", "derived", "responses"):
        for name in getattr(study, table):
            if name in seen:
                yield Problem(f"{table}.{name}", show(name), f"a name that is not {seen[name]} already")
            seen[name] = f"one of the {table}"
    for name in study.goals:
        if name not in study.responses:
            yield Problem(f"goals.{name}", show(name), "a response", suggestion(name, study.responses))
    for name, variable in study.variables.items():
        is_given = any(getattr(variable, way) is not None for way in WAYS)
        if not is_given and listed is None and study.fit is None:
            yield Problem(f"variables.{name}", "nothing", f"one of {', '.join(WAYS)}")
        needs_steps = variable.values is None and not variable.whole and variable.steps is None
        is_grid = study.sweep.method == "grid" and _is_swept(study)
        if is_grid and is_given and needs_steps:
            yield Problem(f"variables.{name}.steps", "nothing", "how many values a grid takes")
    yield from _taken_twice(study)


def _is_swept(study: StudyFile) -> bool:
    return "sweep" in study.model_fields_set or any(variable.steps for variable in study.variables.values())


def _taken_twice(study: StudyFile) -> Iterable[Problem]:
    setters: dict[str, str] = {}
    for table in ("variables", "derived"):
        for name, entry in getattr(study, table).items():
            for address in entry.address:
                if address in setters:
                    expected = f"an entry that {setters[address]} does not set"
                    yield Problem(f"{table}.{name}.address", show(address), expected)
                setters[address] = name
    yield from _within_tables(study, setters)


def _within_tables(study: StudyFile, setters: Mapping[str, str]) -> Iterable[Problem]:
    """Entries of a table among the values of a variable that another variable sets."""
    for name, variable in study.variables.items():
        for table in variable.address:
            below = {
                place.removeprefix(f"{table}."): place for place in setters if place.startswith(f"{table}.")
            }
            for choice in variable.values or ():
                for place in (place for key, place in below.items() if _holds(choice, key.split("."))):
                    expected = f"tables without an entry that {setters[place]} sets"
                    yield Problem(f"variables.{name}.values", show(place), expected)
                    below = {}


def _holds(table: object, keys: Sequence[str]) -> bool:
    for key in keys:
        if not isinstance(table, Mapping) or key not in table:
            return False
        table = table[key]
    return True


def _check_rows(ready: StudyPlan) -> None:
    limit = LATIN_ROWS if ready.sweep.method == "latin_hypercube" else SWEEP_ROWS
    require_within(limit, ready.n_rows, "rows of the sweep", "reduce the ranges, or use coarser steps")
    if ready.sweep.method == "grid" and ready.listed is None:
        for axis in ready.axes:
            require_within(LEVELS, axis.n_levels, f"levels of {axis.name}", "vary it more coarsely")


def _derived(machine: Machine, known: list[str], name: str, entry: Any) -> Formula:
    formula = _formula(known, f"derived.{name}", name, entry.formula)
    for address in entry.address:
        try:
            known_place(machine, address)
        except MachineError as error:
            problem = error.problems[0]
            key = f"derived.{name}.address"
            raise MachineError([Problem(key, show(address), problem.expected, problem.remedy)]) from None
        if not isinstance(get(machine, address), int | float | None):
            raise MachineError(
                [Problem(f"derived.{name}.address", show(address), "an entry that is a number")]
            )
    known.append(name)
    return Formula(name, formula.tree, entry.address)


def _formula(known: list[str], key: str, name: str, text: str) -> Formula:
    try:
        tree = parse(text)
    except FormulaError as error:
        raise MachineError([Problem(f"{key}.formula", show(text), error.expected, error.remedy)]) from None
    strange = [name for name in names(tree) if name not in (*known, *NUMBERS)]
    if strange:
        expected = "names of variables, of derived numbers before it, and in a response of other responses"
        raise MachineError(
            [Problem(f"{key}.formula", show(strange[0]), expected, suggestion(strange[0], known))]
        )
    return Formula(name, tree)


def _limits(study: StudyFile, units: Mapping[str, str], name: str, constraint: Any) -> tuple[float, float]:
    if name not in study.responses:
        remedy = suggestion(name, study.responses)
        raise MachineError([Problem(f"constraints.{name}", show(name), "a response", remedy)])
    kind = kind_of(units.get(name, ""))
    low, high = (
        default if value is None else _quantity(f"constraints.{name}.{key}", value, kind)
        for key, value, default in (("min", constraint.min, -np.inf), ("max", constraint.max, np.inf))
    )
    if low > high:
        found = f"{show(constraint.min)} to {show(constraint.max)}"
        raise MachineError([Problem(f"constraints.{name}", found, "min of at most max: nothing keeps both")])
    return low, high


def kind_of(unit: str) -> Kind | None:
    """The quantity that a unit as it is printed belongs to; None for none of those of a machine file."""
    ascii_unit = unit.replace("²", "^2").replace("³", "^3").replace("·", " ")
    return next((kind for kind in KINDS if kind.unit == ascii_unit), None)


def _quantity(key: str, value: object, kind: Kind | None) -> float:
    try:
        return parse_any(value) if kind is None else parse_quantity(value, kind)
    except UnitError as error:
        problem = error.problem
        raise MachineError([Problem(key, problem.found, problem.expected, problem.remedy)]) from None
