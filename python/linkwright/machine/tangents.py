"""Exact derivatives of numbers that follow from the entries of a machine by plain arithmetic.

The entries are exchanged for tangents (`kernel.numerics.tangent`), and whatever is worked out of the
machine comes out with its derivatives by them. So do the numbers of
the core's program: the description is translated a second time.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError, LinkwrightError
from linkwright.kernel.numerics.tangent import Tangent, lifted, primal
from linkwright.machine.address import entry_at, entry_of, exchanged, exchanged_at, is_given, known_place
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine, Translation, compile_machine
from linkwright.machine.program.core import Element
from linkwright.machine.program.mechanism import MechanismProgram

# What tells that an entry is not followed.
_FAILURES = (TypeError, AttributeError, ValueError, ArithmeticError, LinkwrightError)

_WHOLE = "a cycle is a whole number of revolutions"


def columns(
    machine: Machine,
    names: Sequence[str],
    numbers: Callable[[Machine], Sequence[Any]],
    refused: dict[str, str],
) -> dict[str, Floats]:
    """Derivatives of numbers by each entry that has some, (numbers,); the others go into `refused`."""
    known, listed = followed(machine, names, numbers, refused)
    table = np.array([lifted(number, len(known)).d for number in listed]).reshape(len(listed), len(known))
    return dict(zip(known, table.T, strict=True))


def _reason(name: str, error: Exception) -> str:
    if isinstance(error, LinkwrightError):
        return " ".join(str(error).split())
    if name.rsplit(".", 1)[-1].isdecimal():
        return "only the values of this table are differentiated, not the positions of its points"
    if isinstance(error, TypeError):
        return "not differentiable: it is a count, selects a motion law, or enters a searched length"
    return str(error)


@dataclass(frozen=True)
class Directions:
    """Derivatives of the program's numbers.

    `values` is (parameters, variables); `sizes` (variables,) are those of the entries, 1 where one is zero;
    `refused` has addresses without a derivative, with the reason.
    """

    variables: tuple[str, ...]
    values: Floats
    sizes: Floats
    refused: Mapping[str, str]

    def only(self, entries: Sequence[str]) -> Directions:
        """Those by some of the entries, in their order."""
        at = [self.variables.index(entry) for entry in entries]
        return Directions(tuple(entries), self.values[:, at], self.sizes[at], self.refused)

    def has_those_of(self, other: Directions) -> bool:
        """Whether the numbers are those of other directions."""
        return np.array_equal(self.values, other.values) and np.array_equal(self.sizes, other.sizes)

    def lost(self, angles: Floats) -> dict[str, float]:
        """Entries by which the move of a kink was not found, by `angles` of the kinks [rad], else NaN."""
        pairs = zip(self.variables, angles.tolist(), strict=True)
        return {name: angle for name, angle in pairs if np.isfinite(angle)}

    def __post_init__(self) -> None:
        """Keep the values row by row, as the core reads them."""
        object.__setattr__(self, "values", np.ascontiguousarray(self.values))


# Numbers of one form agree within rounding: to this share, or to this number in SI.
_ALIKE, _NOTHING = 1e-6, 1e-9

_OTHER_FORM = (
    "not differentiable here: a segment of a motion law or table has zero length or height, so the "
    "structure changes"
)

_PARTING = (
    "it separates segment boundaries of two laws that coincide, at which velocity or acceleration of both "
    "jumps"
)
CHANGE_POINTS = (
    "the mechanism passes change points, which exist only for these exact lengths; vary other entries, or "
    "choose lengths away from change points"
)


def directions(
    machine: Machine, variables: Sequence[str], *, motor: bool = True, brake: bool = False
) -> Directions:
    """Derivatives of the program's numbers by entries of a machine, in the order of the entries.

    Entries that follow from others are varied as `seeded` says.
    `motor`, `brake`: whether the motor is on and the brake applied.
    """

    def program(machine: Machine) -> MechanismProgram:
        return Translation(machine, motor=motor, brake=brake).program

    compiled = compile_machine(machine, motor=motor, brake=brake)
    asked, last = tuple(variables), compiled.kept.get("directions")
    if last is not None and last[0] == asked:
        kept: Directions = last[1]
        return kept
    refused: dict[str, str] = {}
    unvaried = program(machine)
    derivatives = columns(
        machine, variables, lambda along: _of_form(unvaried.parameters, program(along).parameters), refused
    )
    if any(getattr(element, "change_points", ()) for element in compiled.elements):
        moved = [name for name, column in derivatives.items() if column[: unvaried.n_own].any()]
        refused.update(dict.fromkeys(moved, CHANGE_POINTS))
    if sum(isinstance(element, Element.Programme) for element in compiled.elements) > 1:
        refused.update(dict.fromkeys(_parting(compiled, derivatives), _PARTING))
    known = tuple(name for name in variables if name in derivatives and name not in refused)
    values = _columns_of(compiled, [derivatives[name] for name in known])
    sizes = np.array([abs(float(entry_of(machine, name))) or 1.0 for name in known])
    directions = Directions(known, values, sizes, refused)
    # Several analyses of a machine ask for the same ones.
    compiled.kept["directions"] = asked, directions
    return directions


def _of_form(parameters: Sequence[float], along: Sequence[Any]) -> Sequence[Any]:
    """Parameters with tangents, which have to be one by one those of the machine. Raises InputError."""
    values = [*map(primal, along)]
    if len(values) != len(parameters) or not np.allclose(values, parameters, rtol=_ALIKE, atol=_NOTHING):
        raise InputError(_OTHER_FORM)
    return along


def _columns_of(compiled: CompiledMachine, derivatives: Sequence[Floats]) -> Floats:
    """Derivatives of all parameters by some entries, (parameters, entries)."""
    # Numbers that follow from the motion, at the end, are series at change points: nothing here moves them.
    values = np.zeros((len(compiled.parameters), len(derivatives)))
    for place, column in enumerate(derivatives):
        values[: len(column), place] = column
    return values


def _parting(compiled: CompiledMachine, derivatives: Mapping[str, Floats]) -> list[str]:
    along = compiled.kinks_along(_columns_of(compiled, [*derivatives.values()]), compiled.kinks())
    return [name for name, moves in zip(derivatives, along.T, strict=True) if np.isnan(moves).any()]


@dataclass(frozen=True)
class Derivatives:
    """Scalars of an analysis with their derivatives by `variables`.

    `tangents`: by name, NaN for an entry without one; `ties`: names with one-sided derivatives only, or
    with none for some entries, and the reason; `missing`: names that have none at all; `refused`: entries
    that have none; `lost`: entries for which the shift of a kink was not found, with its crank angle [rad];
    `words`, `units`: of names that are no declared quantities of the result; `usual`: what is given if no
    name is asked for, all without it.
    """

    variables: tuple[str, ...]
    tangents: Mapping[str, Tangent]
    ties: Mapping[str, str]
    missing: Mapping[str, str]
    refused: Mapping[str, str]
    lost: Mapping[str, float] = field(default_factory=dict)
    words: Mapping[str, str] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    usual: tuple[str, ...] | None = None

    def only(self, entries: Sequence[str]) -> Derivatives:
        """Those by some of the entries, in their order."""
        at = [self.variables.index(entry) for entry in entries]
        tangents = {name: Tangent(tangent.value, tangent.d[at]) for name, tangent in self.tangents.items()}
        return replace(self, variables=tuple(entries), tangents=tangents)


def spread(number: Any, known: Sequence[str], listed: Sequence[str], value: float | None = None) -> Tangent:
    """`number` with derivatives by `known` entries as one by those `listed`; `value`: exact."""
    along = lifted(number, len(known))
    d = dict(zip(known, along.d, strict=True))
    row = np.array([d.get(name, 0.0) for name in listed])
    return Tangent(float(along.value) if value is None else value, row)


def scalars_of(
    result: Any, numbers: Mapping[str, Any], known: Sequence[str], listed: Sequence[str]
) -> dict[str, Tangent]:
    """Numbers that a result has, with their values there and derivatives as `spread` gives them."""
    values = {name: getattr(result, name) for name in numbers}
    return {
        name: spread(numbers[name], known, listed, float(value))
        for name, value in values.items()
        if value is not None
    }


def followed(
    machine: Machine, names: Sequence[str], work: Callable[[Machine], Any], refused: dict[str, str]
) -> tuple[tuple[str, ...], Any]:
    """What is worked out of a machine with tangents by some entries, and by which; others are `refused`.

    Entries that `work` cannot follow, counts and searched numbers, are found one by one.
    """
    cycles = [name for name in names if name.endswith(".cycle")]
    refused.update(dict.fromkeys(cycles, _WHOLE))
    known = tuple(name for name in names if name not in refused)
    try:
        return known, work(seeded(machine, known))
    except _FAILURES:
        for name in known:
            try:
                work(seeded(machine, [name]))
            except _FAILURES as error:
                refused[name] = _reason(name, error)
    known = tuple(name for name in known if name not in refused)
    return known, work(seeded(machine, known))


def seeded(machine: Machine, names: Sequence[str]) -> Machine:
    """The machine with tangents by some of its entries.

    An entry that follows from others keeps its derivatives by these, beside that by itself with all entries
    of the file held.
    """
    units = dict(zip(names, np.eye(len(names)), strict=True))
    seeds: dict[str, Any] = {
        name: Tangent(float(entry_of(machine, name)), unit) for name, unit in units.items()
    }
    following = {name: known_place(machine, name) for name in names if not is_given(machine, name)}
    given = exchanged(machine, {name: seeds[name] for name in names if name not in following})
    alone = [given, *(exchanged(machine, {name: seeds[name]}) for name in following)]
    for name, place in following.items():
        entries = [entry_at(one, place) for one in alone]
        d = sum((x.d for x in entries if isinstance(x, Tangent)), start=np.zeros(len(names)))
        seeds[name] = Tangent(seeds[name].value, d)
    return exchanged_at(given, {place: seeds[name] for name, place in following.items()})
