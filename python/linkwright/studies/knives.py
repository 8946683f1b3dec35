"""Studies of the knife of a topper: its length, angle, speeds or height varied over a field of roots.

All variants meet the same roots, in rows that begin in the same phases: what differs between them is due to
the knife, not to chance.

| varied | entry of the machine |
| --- | --- |
| `edge_length`, `edge_angle`, `forward_speed` | the same of the topper |
| `knife_speed` | the same; of a knife that a mechanism moves, `drive.speed` in proportion |
| `cut_height` | `topper.field.cut_height_shift`: the mean height of the slices is the one asked for |
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import FindingError, InputError, require_within
from linkwright.kernel.limits import FIELD_VARIANTS
from linkwright.kernel.public import public
from linkwright.kernel.public.arguments import array
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.units.kinds import RATIO
from linkwright.kernel.units.marks import INSIDE_ONE, Quantity
from linkwright.kernel.units.reading import worded
from linkwright.machine.address import replace
from linkwright.machine.machine import Machine
from linkwright.studies.axes import between
from linkwright.studies.engine import evaluate
from linkwright.studies.plan import StudyPlan
from linkwright.studies.read import new_study
from linkwright.topping.edge import edges_of, require_topper
from linkwright.topping.model.topper import MemberKnife
from linkwright.topping.roots import draw_roots
from linkwright.topping.sweep import ENTRIES, FOUND, FieldSweep

# Entries that may be zero, and that may have any sign.
_FROM_ZERO, _SIGNED = ("knife_speed",), ("edge_angle", "cut_height")

# Variants that are computed between two words of progress.
_PORTION = 8

# Share by which values may miss equal steps by rounding, so that they are written as a range.
_ROUNDING = 1e-12


@dataclass(frozen=True)
class Knob:
    """The variable of a study by which an entry of the knife takes its value x: factor · x, or x − shift."""

    variable: str
    address: str
    factor: float = 1.0
    shift: float = 0.0

    def values(self, asked: Floats) -> Floats:
        """Values of the variable, (n,), for those of the entry."""
        return self.factor * asked - self.shift

    @property
    def formula(self) -> str:
        """The entry by the variable."""
        if self.shift:
            return f"{self.variable} + {self.shift!r}"
        return self.variable if self.factor == 1 else f"{self.variable}/{self.factor!r}"


def field_study(
    machine: Machine, over: Mapping[str, ArrayLike], *, seed: int | None = None, level: float = 0.95
) -> StudyPlan:
    """A study of one or two entries of a knife over a field of roots, for `sweep`.

    `over`: values of entries of `ENTRIES` in SI, whose grid varies the last one fastest; `seed` replaces
    that of the field; `level` is the confidence of the intervals. Raises `InputError` for what cannot vary.
    """
    axes = _axes(over)
    return _plan(machine, axes, seed, level)[0]


@public
def sweep_field(
    machine: Machine,
    over: Mapping[str, ArrayLike],
    *,
    seed: int | None = None,
    level: float = 0.95,
    watch: Callable[[float], None] | None = None,
) -> FieldSweep:
    """Vary one or two entries of a knife over a field of roots.

    Parameters
    ----------
    machine : Machine
        With a topper.
    over : mapping of str to array_like, shape (k,)
        Values of one or two entries of `ENTRIES`; heights of the cut are shifted so that their mean is
        the one asked for.
    seed : int, optional
        Seed of the random generator, in place of that of the field.
    level : float
        Confidence level of the intervals.
    watch : callable, optional
        Progress callback, 0 to 1.

    Returns
    -------
    FieldSweep
        All combinations.

    Raises
    ------
    InputError
        No topper, no such entry, values that are none of it, too many of them.
    FindingError
        No variant can be computed.
    """
    axes = _axes(over)
    grid = np.meshgrid(*axes.values(), indexing="ij")
    columns = {name: values.ravel() for name, values in zip(axes, grid, strict=True)}
    answers = {name: np.full(columns[next(iter(axes))].size, np.nan) for name in FOUND}
    watched, reasons = _Progress(watch, len(answers[FOUND[0]])), Counter[str]()
    for own, part in _by_rest(machine, axes):
        plan, knobs = _plan(own, part, seed, level)
        members = np.all([np.isin(columns[name], part[name]) for name in part], axis=0)
        values = {knob.variable: knob.values(columns[name][members]) for name, knob in knobs.items()}
        responses = _evaluated(plan, values, watched, reasons)
        for name in FOUND:
            answers[name][members] = responses[name]
    if np.isnan(answers[FOUND[0]]).all():
        raise FindingError(next(iter(reasons)))
    arrays: dict[str, Any] = answers
    return FieldSweep(columns, tuple(len(axis) for axis in axes.values()), level=level, **arrays)


class _Progress:
    """How many variants of all are done."""

    def __init__(self, watch: Callable[[float], None] | None, total: int) -> None:
        self.watch, self.total, self.done = watch, total, 0

    def add(self, n: int) -> None:
        self.done += n
        if self.watch is not None:
            self.watch(self.done / self.total)


def _evaluated(
    plan: StudyPlan, values: Mapping[str, Floats], watched: _Progress, reasons: Counter[str]
) -> dict[str, Floats]:
    """Responses of variants in blocks; counts the reasons of failures."""
    total = len(next(iter(values.values())))
    parts = []
    for start in range(0, total, _PORTION):
        rows = evaluate(plan, {name: column[start : start + _PORTION] for name, column in values.items()})
        parts.append(rows.columns)
        reasons.update(rows.failures())
        watched.add(len(rows))
    return {name: np.concatenate([part[name] for part in parts]) for name in FOUND}


def _by_rest(machine: Machine, axes: dict[str, Floats]) -> list[tuple[Machine, dict[str, Floats]]]:
    """Machines, each with what varies of it: a knife on a mechanism that rests is one without mechanism."""
    speeds = axes.get("knife_speed")
    topper = require_topper(machine)
    if speeds is None or not isinstance(topper.motion, MemberKnife) or speeds.all():
        return [(machine, axes)]
    still = replace(machine, {"topper.motion": {"kind": "constant"}, "topper.knife_speed": 0.0})
    groups = [(still, speeds[speeds == 0]), (machine, speeds[speeds != 0])]
    return [(own, {**axes, "knife_speed": part}) for own, part in groups if len(part)]


def _plan(
    machine: Machine, axes: Mapping[str, Floats], seed: int | None, level: float
) -> tuple[StudyPlan, dict[str, Knob]]:
    in_range(level=(level, Quantity(RATIO, INSIDE_ONE)))
    fitted = with_field(machine, seed, needed="cut_height" in axes)
    knobs = {name: knob_of(fitted, name) for name in axes}
    for name, knob in knobs.items():
        if knob.address == "drive.speed" and not axes[name].all():
            raise InputError(
                f"{name}: found 0 m/s, expected more than 0 in a study: a mechanism turns, and its knife "
                "does not rest"
            )
    variables = {
        knob.variable: {"address": knob.address, **_valued(knob.values(axes[name]))}
        for name, knob in knobs.items()
    }
    interval = {} if level == 0.95 else {"level": level}
    responses: dict[str, Any] = {
        name: {"formula": knob.formula} for name, knob in knobs.items() if knob.variable != name
    }
    for name in FOUND:
        responses[name] = {"quantity": f"topper_field.{name}", **interval}
    # More heads may be missed than 5 %: such a variant has all other answers.
    responses["length_for_95"]["otherwise"] = np.inf
    tables = {"variables": variables, "responses": responses, "sweep": {"method": "grid"}}
    return new_study(fitted, tables), knobs


def knob_of(machine: Machine, name: str) -> Knob:
    """The variable of an entry of the knife."""
    topper = require_topper(machine)
    if name == "knife_speed" and isinstance(topper.motion, MemberKnife):
        assert machine.drive is not None
        assert machine.drive.speed is not None
        (edge,) = edges_of(machine, topper)
        return Knob("crank_speed", "drive.speed", machine.drive.speed / edge.knife.mean_speed)
    if name == "cut_height":
        assert topper.field is not None
        # The heights have any scatter: all of them are moved alike.
        mean = float(draw_roots(topper).cut_height.mean())
        return Knob("shift", "topper.field.cut_height_shift", shift=mean - topper.field.cut_height_shift)
    return Knob(name, f"topper.{name}")


def with_field(machine: Machine, seed: int | None, *, needed: bool) -> Machine:
    """The machine with a field that has the seed, if one is given or it is needed."""
    topper = require_topper(machine)
    if seed is not None and seed < 0:
        raise InputError(f"seed: found {seed}, expected at least 0")
    if seed is None and not needed:
        return machine
    if topper.field is None:
        machine = replace(machine, {"topper.field": {"kind": "random"}})
    return machine if seed is None else replace(machine, {"topper.field.seed": seed})


def _valued(values: Floats) -> dict[str, Any]:
    """Values of a variable: a range where they are many and even, otherwise one by one."""
    n = len(values)
    low, high = float(values[0]), float(values[-1])
    if n > 2 and low < high:
        even = np.linspace(low, high, n)
        if np.abs(values - even).max() <= _ROUNDING * (high - low):
            return between(low, high, n)
    return {"values": values.tolist()}


def _axis(name: str, values: ArrayLike) -> Floats:
    if name not in ENTRIES:
        raise InputError(f'over: found "{name}", expected an entry of the knife; {suggestion(name, ENTRIES)}')
    axis = np.atleast_1d(array(f"over: {name}", values))
    if axis.ndim != 1 or not len(axis) or not np.isfinite(axis).all():
        raise InputError(f"over: found no list of finite numbers for {name}")
    wrong = _beyond(name, axis)
    if wrong is not None:
        raise InputError(f"over: found {name} {worded(wrong, ENTRIES[name])}, expected {_expected(name)}")
    return axis


def _beyond(name: str, axis: Floats) -> float | None:
    if name == "edge_angle":
        off = np.abs(axis) >= np.pi / 2
    elif name in _SIGNED:
        off = np.zeros(len(axis), dtype=bool)
    else:
        off = axis < 0 if name in _FROM_ZERO else axis <= 0
    return float(axis[off][0]) if off.any() else None


def _expected(name: str) -> str:
    if name == "edge_angle":
        return "an angle between -90 and 90 deg"
    return "0 or more" if name in _FROM_ZERO else "more than 0"


def _axes(over: Mapping[str, ArrayLike]) -> dict[str, Floats]:
    axes = {name: _axis(name, values) for name, values in over.items()}
    if not 1 <= len(axes) <= 2:
        raise InputError(f"over: found {len(axes)} entries, expected one or two")
    total = float(np.prod([len(axis) for axis in axes.values()], dtype=float))
    require_within(FIELD_VARIANTS, total, "over", "reduce the ranges, or use coarser steps")
    return axes
