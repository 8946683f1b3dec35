"""Responses of many machines: those that the core computes in lanes and threads at once, others one by one.

Branches and starts of a batch are those of its first machine (`linkwright.drive.batch`): the machine
of the study stands in front of every batch, so that they are the same however rows are divided.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.drive.batch import STATUS, fast_starts, steady_states
from linkwright.driveline.batch import elastic_motions
from linkwright.kernel.arrays import Floats, Indices
from linkwright.kernel.description.formula import NUMBERS
from linkwright.kernel.errors import FindingError, InputError
from linkwright.kernel.numerics.formula_value import value
from linkwright.kernel.public import public
from linkwright.kernel.public.arguments import rows as rows_of_numbers
from linkwright.machine.address import get, outside, replace
from linkwright.machine.analysis import Of
from linkwright.machine.machine import Machine
from linkwright.studies.axes import require_places, variant
from linkwright.studies.plan import Formula, StudyPlan
from linkwright.studies.point_responses import point_numbers, require_numbers, why_open
from linkwright.studies.responses import ANALYSES, analysis, entry_number
from linkwright.studies.rows import FAILED, IMPOSSIBLE, NO_NUMBER, SOLVED, Rows
from linkwright.studies.study_response import ENTRY, MOTION, PATH, StudyResponse

# Analyses of forces that keep contacts.
IN_CONTACT = ("forces", "cam_force")

# Rows whose points are in memory at once.
_TOGETHER = 2000


@public
def evaluate(plan: StudyPlan, variables: Mapping[str, Floats]) -> Rows:
    """Responses of machines.

    Parameters
    ----------
    plan : StudyPlan
        The study.
    variables : mapping of str to ndarray, shape (n,)
        Values of all variables in SI; places in the list of those that are no numbers.

    Returns
    -------
    Rows
        One a machine, in their order.

    Raises
    ------
    InputError
        The variables are not those of the study, or no lists of finite numbers of one length.
    """
    columns = _columns(plan, variables)
    n = len(next(iter(columns.values())))
    rows = Rows(columns, np.zeros(n, np.uint8), np.zeros(n, np.int32), [""], np.zeros(n, np.uint8))
    _add_formulas(rows, plan.derived, IMPOSSIBLE)
    for asked in plan.asked:
        columns[asked.name] = np.full(n, np.nan)
    entries = _entries(plan, columns)
    _refuse_impossible(plan.machine, entries, rows)
    for machine, members in _machines(plan, rows):
        own = {address: column[members] for address, column in entries.items()}
        _solve(plan, _Members(machine, own, rows, members))
    _require_finite(rows, plan)
    _add_formulas(rows, plan.formulas, FAILED)
    failed = rows.status != SOLVED
    for name in plan.responses:
        columns[name][failed] = np.nan
    rows.fast_starts[failed] = 0
    rows.columns = {name: columns[name] for name in plan.columns}
    return rows


def _columns(plan: StudyPlan, variables: Mapping[str, Floats]) -> dict[str, Floats]:
    """Values of the variables of a study by name, lists of one length. Raises InputError: they are not."""
    wanted = [axis.name for axis in plan.axes]
    if sorted(variables) != sorted(wanted):
        expected = f"those of the study: {', '.join(wanted)}"
        raise InputError(f"variables: found {', '.join(variables) or 'none'}, expected {expected}")
    columns: dict[str, Floats] = {}
    for name in variables:
        columns[name] = np.array(rows_of_numbers(f"variables[{name}]", variables[name]))
        lengths = {len(column) for column in columns.values()}
        if len(lengths) > 1:
            raise InputError(
                f"variables[{name}]: found {len(columns[name])} values, others have another number"
            )
    for axis in plan.axes:
        require_places(axis, columns[axis.name], f"variables[{axis.name}]")
    return columns


def _entries(plan: StudyPlan, columns: Mapping[str, Floats]) -> dict[str, Floats]:
    numbers = [(axis.name, axis.addresses) for axis in plan.axes if axis.is_number]
    numbers += [(entry.name, entry.addresses) for entry in plan.derived]
    return {place: columns[name] for name, addresses in numbers for place in addresses}


def _refuse_impossible(machine: Machine, entries: Mapping[str, Floats], rows: Rows) -> None:
    """Let rows fail whose entries are out of range, as a single machine refuses them."""
    for address, column in entries.items():
        wrong, expected = outside(machine, address, column)
        if wrong.any():
            rows.fail(wrong, IMPOSSIBLE, f"{address}: expected {expected}")


def _machines(plan: StudyPlan, rows: Rows) -> Any:
    choices = [axis for axis in plan.axes if not axis.is_number]
    sound = np.flatnonzero(rows.status == SOLVED)
    if not choices:
        yield plan.machine, sound
        return
    places = np.stack([rows.columns[choice.name] for choice in choices], axis=1).astype(int)[sound]
    kinds, members = np.unique(places, axis=0, return_inverse=True)
    for nth, kind in enumerate(kinds):
        changes = [
            (address, choice.choices[place])
            for choice, place in zip(choices, kind, strict=True)
            for address in choice.addresses
        ]
        own = sound[members.ravel() == nth]
        try:
            yield variant(plan.machine, changes), own
        except InputError as error:
            rows.fail(own, IMPOSSIBLE, _sentence(error))


def _solve(plan: StudyPlan, part: _Members) -> None:
    if not len(part.members):
        return
    batch = [asked for asked in plan.asked if asked.is_batch and part.entries]
    single = [asked for asked in plan.asked if asked not in batch]
    solved = (
        (("steady_state",), part.steady),
        (("elastic_motion",), part.elastic),
        ((MOTION, PATH), part.points),
        ((ENTRY,), part.entry_numbers),
    )
    for names, solve in solved:
        wanted = [asked for asked in batch if asked.analysis in names]
        if wanted:
            try:
                solve(wanted)
            except (InputError, FindingError) as error:
                # A batch is refused as a whole where entries of one row do not go together, or where the
                # machine of the study, which leads it, does not move. Alone, each row that cannot be computed
                # says why, and what was refused for no row of them is refused by all.
                single += wanted
                part.rows.one_by_one[_sentence(error)] += len(part.members)
    if single and part.entries:
        single = part.together(single)
    if single:
        part.one_by_one(single)


def _with_first(machine: Machine, entries: Mapping[str, Floats]) -> dict[str, Floats]:
    columns = {}
    for address, column in entries.items():
        first = get(machine, address)
        number = first if isinstance(first, int | float) else column[0]
        columns[address] = np.concatenate([[number], column])
    return columns


@dataclass(frozen=True)
class _Members:
    machine: Machine
    entries: dict[str, Floats]  # address → its values in these rows
    rows: Rows
    members: Indices  # which rows they are

    def steady(self, wanted: list[StudyResponse]) -> None:
        states = steady_states(self.machine, _with_first(self.machine, self.entries))
        status = states.status[1:]
        self.rows.fast_starts[self.members] = states.fast_starts[1:]
        for asked in wanted:
            self.rows.columns[asked.name][self.members] = getattr(states, asked.quantity)[1:]
        for code in np.unique(status[status != 0]):
            self.rows.fail(self.members[status == code], FAILED, STATUS[int(code)])

    def elastic(self, wanted: list[StudyResponse]) -> None:
        """Elastic drivelines; one whose motion was not found with the others says alone why it has none."""
        motions = elastic_motions(self.machine, _with_first(self.machine, self.entries))
        numbers = [motions.number(asked.quantity, *asked.of)[1:] for asked in wanted]
        for asked, values in zip(wanted, numbers, strict=True):
            self.rows.columns[asked.name][self.members] = values
        alone = ~np.isfinite(numbers).all(axis=0)
        if alone.any():
            own = {address: column[alone] for address, column in self.entries.items()}
            _Members(self.machine, own, self.rows, self.members[alone]).one_by_one(wanted)

    def points(self, wanted: list[StudyResponse]) -> None:
        """Points of all rows at once, in blocks that fit into memory."""
        for start in range(0, len(self.members), _TOGETHER):
            part = slice(start, start + _TOGETHER)
            own = {address: column[part] for address, column in self.entries.items()}
            table = point_numbers(replace(self.machine, _with_first(self.machine, own)), wanted)
            for asked in wanted:
                values = table[asked.name][1:]
                self.rows.columns[asked.name][self.members[part]] = values
                self.rows.fail(self.members[part][~np.isfinite(values)], FAILED, why_open(asked))

    def entry_numbers(self, wanted: list[StudyResponse]) -> None:
        for asked in wanted:
            (address,) = asked.of
            varied = self.entries.get(address)
            self.rows.columns[asked.name][self.members] = (
                entry_number(self.machine, address) if varied is None else varied
            )

    def together(self, wanted: list[StudyResponse]) -> list[StudyResponse]:
        """Responses of analyses that take many machines at once; gives those that are left."""
        if self.machine.has_crank:
            return wanted
        by_key: dict[Any, list[StudyResponse]] = {}
        for asked in wanted:
            by_key.setdefault(asked.key, []).append(asked)
        left: list[StudyResponse] = []
        for group in by_key.values():
            many = None if group[0].analysis not in ANALYSES else ANALYSES[group[0].analysis].many
            results = None if many is None or group[0].options else self._results(many)
            if results is None:
                left += group
                continue
            for row, result in zip(self.members, results, strict=True):
                try:
                    for asked in group:
                        self.rows.columns[asked.name][row] = asked.number(result)
                except FindingError as error:
                    self.rows.fail(row, FAILED, _sentence(error))
        return left

    def _results(self, many: Of) -> Any:
        """Results of all rows, of which the first is checked as a whole; None where each row says why not."""
        try:
            sound_variant(
                self.machine, {address: float(column[0]) for address, column in self.entries.items()}
            )
            return many(self.machine, self.entries)
        except (InputError, FindingError) as error:
            self.rows.one_by_one[_sentence(error)] += len(self.members)
            return None

    def one_by_one(self, wanted: list[StudyResponse]) -> None:
        for nth, row in enumerate(self.members):
            if self.rows.status[row] != SOLVED:
                continue
            try:
                own = sound_variant(
                    self.machine, {address: float(c[nth]) for address, c in self.entries.items()}
                )
                for asked, number in zip(wanted, numbers(own, wanted), strict=True):
                    self.rows.columns[asked.name][row] = number
                if own.has_crank:
                    # The batch may have found them, where no single analysis solves the steady motion.
                    self.rows.fast_starts[row] = max(self.rows.fast_starts[row], fast_starts(own))
            except FindingError as error:
                self.rows.fail(row, FAILED, _sentence(error))
            except InputError as error:
                self.rows.fail(row, IMPOSSIBLE, _sentence(error))


def sound_variant(machine: Machine, entries: Mapping[str, float]) -> Machine:
    """The machine with numbers exchanged, checked as a whole."""
    changed = replace(machine, entries) if entries else machine
    return Machine.model_validate(changed.model_dump(by_alias=True, exclude_unset=True))


def numbers(machine: Machine, wanted: list[StudyResponse]) -> list[float]:
    """Responses of one machine; an analysis is made once for all that share it.

    Raises `FindingError` if the machine cannot do it, `InputError` if an analysis needs what it does not
    have.
    """
    results: dict[Any, Any] = {}
    of_points = require_numbers(machine, [one for one in wanted if one.analysis in (MOTION, PATH)])
    answers = []
    for asked in wanted:
        if asked.name in of_points:
            answers.append(of_points[asked.name])
            continue
        if asked.analysis == ENTRY:
            answers.append(entry_number(machine, *asked.of))
            continue
        if asked.key not in results:
            result = analysis(asked.analysis)(machine, *asked.arguments, **asked.options)
            # Forces of a contact that is lost are not those of the machine.
            lost = getattr(result, "findings", ()) if asked.analysis in IN_CONTACT else ()
            if lost:
                # Without its numbers one reason stands for all rows.
                raise FindingError(lost[0].partition(":")[0])
            results[asked.key] = result
        answers.append(asked.number(results[asked.key]))
    return answers


def _add_formulas(rows: Rows, formulas: tuple[Formula, ...], status: int) -> None:
    n = len(rows)
    for formula in formulas:
        with np.errstate(all="ignore"):
            values = value(formula.tree, {**NUMBERS, **rows.columns})
        column = np.array(np.broadcast_to(np.asarray(values, dtype=float), (n,)))
        rows.columns[formula.name] = column
        rows.fail(~np.isfinite(column), status, NO_NUMBER.format(formula.name))


def _require_finite(rows: Rows, plan: StudyPlan) -> None:
    """Let rows fail whose response is neither a number nor its substitute: NaN is never an answer."""
    for asked in plan.asked:
        column = rows.columns[asked.name]
        is_number = np.isfinite(column)
        if asked.otherwise is not None:
            is_number |= column == asked.otherwise
        rows.fail(~is_number, FAILED, NO_NUMBER.format(asked.name))


def _sentence(error: Exception) -> str:
    return " ".join(str(error).split())
