"""Derivatives of responses by the variables of a study: exact where the analysis has them.

A variable reaches a response through its entries of the machine, of which the derivatives are those of
`linkwright.sensitivity` and of places of points, and through derived numbers and formulas, which tangents go
through. What has no exact derivative, such as an extreme of a sampled speed, is differenced over four places
within the range, to fourth order.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats, Indices
from linkwright.kernel.description.formula import NUMBERS
from linkwright.kernel.description.formula import names as names_in
from linkwright.kernel.errors import FindingError, InputError
from linkwright.kernel.numerics.formula_value import OPERATIONS, value
from linkwright.kernel.numerics.tangent import Tangent, primal
from linkwright.machine.machine import Machine
from linkwright.machine.tangents import Derivatives
from linkwright.sensitivity.sources import SOURCES, chosen, source
from linkwright.studies.axes import Axis
from linkwright.studies.engine import evaluate, sound_variant
from linkwright.studies.plan import Formula, StudyPlan
from linkwright.studies.point_slopes import point_tangents
from linkwright.studies.responses import entry_number
from linkwright.studies.study_response import ENTRY, StudyResponse


@dataclass(frozen=True)
class Slopes:
    """Responses at a place with their derivatives by the variables.

    `values` by response [SI], `slopes` likewise, (variables,); `exact` names those that are no differences,
    and `ties` those that have only one-sided derivatives, with the reason.
    """

    values: dict[str, float]
    slopes: dict[str, Floats]
    exact: frozenset[str]
    ties: dict[str, str]


def slopes(
    plan: StudyPlan, at: Floats, steps: Floats, count: Callable[[int], None] = lambda n: None
) -> Slopes:
    """Responses and their derivatives.

    `at`: values of the variables, numbers all of them, (variables,) [SI]; `steps`: of differences, where
    there is no other way, likewise; `count`: called with the number of machines before they are computed.
    Raises FindingError: the machine there, or one a step beside it, has no answer.
    """
    count(1)
    known = _variables(plan, at)
    is_followed = not any(tangent is None for tangent in known.values())
    analysed, ties = _analysed(plan, known) if is_followed else ({}, {})
    known |= analysed
    missing = [asked.name for asked in plan.asked if asked.name not in analysed]
    is_lost = np.any([~np.isfinite(tangent.d) for tangent in analysed.values()], axis=0)
    if missing or not is_followed or _worked_all(plan, known) is None:
        is_lost = np.ones(len(at), dtype=bool)
    by = np.flatnonzero(is_lost & [axis.is_continuous for axis in plan.axes])
    count(4 * len(by))
    differenced = _differences(plan, at, steps, by) if is_lost.any() else {}
    known |= {name: differenced[name] for name in missing}
    rough = set(missing)
    for name, tangent in analysed.items():
        lost = ~np.isfinite(tangent.d)
        if lost.any():
            known[name] = Tangent(tangent.value, np.where(lost, differenced[name].d, tangent.d))
            rough.add(name)
    for formula in plan.formulas:
        worked = _worked(formula, known) if is_followed else None
        known[formula.name] = differenced[formula.name] if worked is None else worked
        if worked is None or rough & set(names_in(formula.tree)):
            rough.add(formula.name)
    responses = {name: _tangent(known[name], len(at)) for name in plan.responses}
    return Slopes(
        {name: response.value for name, response in responses.items()},
        {name: response.d for name, response in responses.items()},
        frozenset(set(plan.responses) - rough),
        ties,
    )


def _variables(plan: StudyPlan, at: Floats) -> dict[str, Any]:
    """Variables and derived numbers with their derivatives by the variables; None where there are none."""
    known: dict[str, Any] = {
        axis.name: Tangent(x, unit) for axis, x, unit in zip(plan.axes, at, np.eye(len(at)), strict=True)
    }
    for derived in plan.derived:
        known[derived.name] = _worked(derived, known)
    return known


def entries_at(plan: StudyPlan, at: Floats) -> dict[str, Any]:
    """Address → value [SI] at `at` (variables,), with derivatives; `InputError` if one has none."""
    return _entries(plan, _variables(plan, at))


def machine_at(plan: StudyPlan, entries: Mapping[str, Any]) -> Machine:
    """The machine with such entries, checked as a whole; a FindingError if it cannot be."""
    try:
        return sound_variant(plan.machine, {place: float(primal(x)) for place, x in entries.items()})
    except InputError as error:
        raise FindingError(" ".join(str(error).split())) from None


def _entries(plan: StudyPlan, known: Mapping[str, Any]) -> dict[str, Any]:
    named = [(axis.name, axis.addresses) for axis in plan.axes]
    named += [(entry.name, entry.addresses) for entry in plan.derived]
    strange = [name for name, _ in named if known[name] is None]
    if strange:
        raise InputError(f"derived.{strange[0]}: found a formula without derivatives, expected a smooth one")
    return {place: known[name] for name, places in named for place in places}


def _tangent(x: Any, n: int) -> Tangent:
    return x if isinstance(x, Tangent) else Tangent(float(x), np.zeros(n))


# Where branches meet, a search needs the derivatives of one of them: of the first.
_OPERATIONS = OPERATIONS | {
    "min": lambda *x: min(x, key=primal),
    "max": lambda *x: max(x, key=primal),
    "abs": lambda x: -x if x < 0 else x,
}


def _worked(formula: Formula, known: Mapping[str, Any]) -> Any:
    """Value of a formula with its derivatives; None if one of its functions has no rule for them."""
    try:
        with np.errstate(all="ignore"):
            tangent = value(formula.tree, {**NUMBERS, **known}, _OPERATIONS)
    except (TypeError, KeyError, ArithmeticError, ValueError):
        return None
    return tangent if isinstance(tangent, Tangent) else float(tangent)


def _worked_all(plan: StudyPlan, known: Mapping[str, Any]) -> dict[str, Any] | None:
    worked_all = dict(known)
    for formula in plan.formulas:
        worked_all[formula.name] = _worked(formula, worked_all)
        if worked_all[formula.name] is None:
            return None
    return worked_all


def _analysed(plan: StudyPlan, known: Mapping[str, Any]) -> tuple[dict[str, Tangent], dict[str, str]]:
    """Responses of analyses with exact derivatives, NaN where there is none, and which of them tie."""
    entries = _entries(plan, known)
    machine = machine_at(plan, entries)
    sources: dict[str, Derivatives | None] = {}
    tangents: dict[str, Tangent] = {}
    ties: dict[str, str] = {}
    of_points, kinks = point_tangents(machine, plan.asked, tuple(entries))
    for name, tangent in of_points.items():
        d = _by_variables(tuple(entries), tangent.d, entries, len(plan.axes))
        tangents[name] = Tangent(tangent.value, d)
    ties |= kinks
    for asked in plan.asked:
        if asked.analysis == ENTRY:
            given = entries.get(*asked.of)
            tangents[asked.name] = _tangent(
                entry_number(machine, *asked.of) if given is None else given, len(plan.axes)
            )
        analysis = _analysis(asked)
        if analysis not in SOURCES or (asked.extreme is not None and not _is_over_speeds(asked)):
            continue
        if analysis not in sources:
            sources[analysis] = _source(machine, analysis, tuple(entries))
        own = sources[analysis]
        named = [] if own is None else chosen(own.tangents, _address(asked))
        if own is None or len(named) != 1:
            continue
        name = named[0]
        tangent = own.tangents[name]
        tangents[asked.name] = Tangent(
            tangent.value, _by_variables(own.variables, tangent.d, entries, len(plan.axes))
        )
        if name in own.ties:
            ties[asked.name] = own.ties[name]
    return tangents, ties


def _by_variables(places: Sequence[str], slopes: Floats, entries: Mapping[str, Any], n: int) -> Floats:
    """Derivatives by entries at places as those by n variables; NaN where one moves an entry without any."""
    table = np.array([entries[place].d for place in places]).reshape(-1, n)
    is_known = np.isfinite(slopes)
    lost = (table[~is_known] != 0).any(axis=0)
    return np.where(lost, np.nan, slopes[is_known] @ table[is_known])


def _source(machine: Any, analysis: str, entries: tuple[str, ...]) -> Derivatives | None:
    """Results with derivatives by entries; None if some have no derivative."""
    try:
        tangents = source(machine, analysis, entries)
    except InputError:
        # silent: what has no exact derivatives is differenced, where the analysis says again what is wrong
        return None
    return None if tangents.refused else tangents


def _analysis(asked: StudyResponse) -> str:
    """The analysis of a response by the name that its derivatives have."""
    return "rod_rotator" if asked.analysis == "rotator" else asked.analysis


def _address(asked: StudyResponse) -> str:
    """The name of a response among the results that have derivatives."""
    place = (str(asked.index),) if asked.index is not None else ()
    inner = (asked.inner,) if asked.inner else ()
    if asked.analysis in ("forces", "free_vibration", "forced_vibration", "elastic_motion"):
        return ".".join((asked.analysis, asked.quantity, *place, *asked.of))
    return ".".join((_analysis(asked), *asked.of, *inner, asked.quantity, *place))


def _is_over_speeds(asked: StudyResponse) -> bool:
    return asked.analysis == "forced_vibration" and asked.extreme == "max" and bool(asked.of)


# Places of differences in steps, and twelve times their weights: about the middle, and to either side of an
# end of the range, beyond which there may be no machine.
_NODES = {0: (1, -1, 2, -2), 1: (1, 2, 3, 4), -1: (-1, -2, -3, -4)}
_WEIGHTS = {0: (8, -8, -1, 1), 1: (48, -36, 16, -3), -1: (-48, 36, -16, 3)}


def n_beside(plan: StudyPlan) -> int:
    """Machines beside a place that differences take, at most."""
    return 4 * sum(axis.is_continuous for axis in plan.axes)


def _differences(plan: StudyPlan, at: Floats, steps: Floats, by: Indices) -> dict[str, Tangent]:
    """Fourth-order differences [1] of all responses by some variables, and 0 by the others."""
    # [1] Fornberg, Generation of finite difference formulas on arbitrarily spaced grids, Math. Comput. 51
    # (1988) 699, tables 1 and 3.
    n, h = len(by), steps[by]
    sides = [_side(plan.axes[i], at[i], steps[i]) for i in by]
    tables = ([table[side] for side in sides] for table in (_NODES, _WEIGHTS))
    nodes, weights = (np.array(rows, dtype=float).reshape(n, 4) for rows in tables)
    points = np.tile(at, (1 + 4 * n, 1))
    points[np.arange(1, 1 + 4 * n), np.repeat(by, 4)] += (nodes * h[:, None]).ravel()
    rows = evaluate(plan, {axis.name: points[:, i].copy() for i, axis in enumerate(plan.axes)})
    rows.require_solved(
        lambda row: f"at a neighbouring step in {plan.axes[by[(row - 1) // 4]].name}" if row else "there"
    )
    differences = {}
    for name in plan.responses:
        f = rows.columns[name]
        slope = np.zeros(len(at))
        slope[by] = (weights * (f[1:].reshape(n, 4) - f[0])).sum(axis=1) / (12 * h)
        differences[name] = Tangent(float(f[0]), slope)
    return differences


def _side(axis: Axis, value: float, step: float) -> int:
    """Side of a value on which differences are taken: 0 for both, as far as its range goes."""
    if axis.low <= value - 2 * step and value + 2 * step <= axis.high:
        return 0
    return 1 if value + 4 * step <= axis.high else -1
