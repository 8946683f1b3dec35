"""How the numbers of the core's program follow the entries of a machine: their exact derivatives.

A description is translated a second time with tangents (`kernel.numerics.tangent`) in place of the entries
that are asked for; every number of the program comes out with its derivatives by them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.errors import LinkwrightError
from linkwright.kernel.numerics.tangent import Tangent
from linkwright.machine.address import exchanged, get, is_given
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import Translation, compile_machine

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Directions:
    """Derivatives of the program's numbers.

    `values` is (parameters, variables); `refused` has addresses without a derivative, with the reason.
    """

    variables: tuple[str, ...]
    values: Floats
    refused: Mapping[str, str]


_CHANGE_POINTS = (
    "the mechanism passes change points, which exist for these lengths alone; vary other entries, or lengths "
    "that keep it clear of them"
)


def directions(machine: Machine, variables: Sequence[str]) -> Directions:
    """Derivatives of the program's numbers by entries of a machine, in the order of the entries.

    Entries that follow from others (the breakdown speed of a motor from its rated point) are varied one at a
    time, all others of the file held; given ones are varied together.
    """
    compiled = compile_machine(machine)
    folds = any(getattr(element, "change_points", ()) for element in compiled.elements)
    together = [name for name in variables if is_given(machine, name)]
    groups = [together, *([name] for name in variables if name not in set(together))]
    columns: dict[str, Floats] = {}
    refused: dict[str, str] = {}
    for group in filter(None, groups):
        columns.update(_columns(machine, group, refused, folds=folds))
    known = tuple(name for name in variables if name in columns)
    # Numbers that follow from the motion, at the end, are series at change points: nothing here moves them.
    values = np.zeros((len(compiled.parameters), len(known)))
    for place, name in enumerate(known):
        values[: len(columns[name]), place] = columns[name]
    return Directions(known, values, refused)


def _columns(
    machine: Machine, names: Sequence[str], refused: dict[str, str], *, folds: bool
) -> dict[str, Floats]:
    """Derivatives of the described numbers by each entry that has them."""
    try:
        return _derived(machine, names, refused, folds=folds)
    except (TypeError, ValueError, ArithmeticError, LinkwrightError) as error:
        if len(names) == 1:
            refused[names[0]] = _reason(names[0], error)
            return {}
    # One of them has no derivative: which, is found one by one.
    found: dict[str, Floats] = {}
    for name in names:
        found |= _columns(machine, [name], refused, folds=folds)
    return found


def _reason(name: str, error: Exception) -> str:
    if name.rsplit(".", 1)[-1].isdecimal():
        return "an entry of a table; its numbers do not vary"
    if isinstance(error, TypeError):
        return "the machine does not follow it by plain arithmetic (a count, a motion law, a searched length)"
    return str(error)


def _derived(
    machine: Machine, names: Sequence[str], refused: dict[str, str], *, folds: bool
) -> dict[str, Floats]:
    seeds = {
        name: Tangent(float(get(machine, name)), unit)
        for name, unit in zip(names, np.eye(len(names)), strict=True)
    }
    program = Translation(exchanged(machine, seeds), motor=True, brake=False).program
    table = np.zeros((len(program.parameters), len(names)))
    for row, number in zip(table, program.parameters, strict=True):
        if isinstance(number, Tangent):
            row[:] = number.d
    columns = dict(zip(names, table.T, strict=True))
    if folds:
        moved = [name for name in names if columns[name][: program.n_own].any()]
        refused.update(dict.fromkeys(moved, _CHANGE_POINTS))
    return {name: column for name, column in columns.items() if name not in refused}
