"""Exact derivatives of numbers that follow from the entries of a machine by plain arithmetic.

The entries are exchanged for tangents (`kernel.numerics.tangent`), and whatever is worked out of the
machine comes out with its derivatives by them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.errors import LinkwrightError
from linkwright.kernel.numerics.tangent import Tangent
from linkwright.machine.address import exchanged, get, is_given
from linkwright.machine.machine import Machine

Floats = NDArray[np.float64]


def columns(
    machine: Machine,
    names: Sequence[str],
    numbers: Callable[[Machine], Sequence[Any]],
    refused: dict[str, str],
) -> dict[str, Floats]:
    """Derivatives of numbers by each entry that has them, entry → (numbers,); the others go into `refused`.

    Entries that follow from others (the breakdown speed of a motor from its rated point) are varied one at a
    time, all others of the file held; given ones are varied together.
    """
    together = [name for name in names if is_given(machine, name)]
    groups = [together, *([name] for name in names if name not in set(together))]
    found: dict[str, Floats] = {}
    for group in filter(None, groups):
        found |= _of_group(machine, group, numbers, refused)
    return found


def _of_group(
    machine: Machine,
    names: Sequence[str],
    numbers: Callable[[Machine], Sequence[Any]],
    refused: dict[str, str],
) -> dict[str, Floats]:
    try:
        return _derived(machine, names, numbers)
    except (TypeError, ValueError, ArithmeticError, LinkwrightError) as error:
        if len(names) == 1:
            refused[names[0]] = _reason(names[0], error)
            return {}
    # One of them has no derivative: which, is found one by one.
    found: dict[str, Floats] = {}
    for name in names:
        found |= _of_group(machine, [name], numbers, refused)
    return found


def _reason(name: str, error: Exception) -> str:
    if name.rsplit(".", 1)[-1].isdecimal():
        return "an entry of a table; its numbers do not vary"
    if isinstance(error, TypeError):
        return "the machine does not follow it by plain arithmetic (a count, a motion law, a searched length)"
    return str(error)


def _derived(
    machine: Machine, names: Sequence[str], numbers: Callable[[Machine], Sequence[Any]]
) -> dict[str, Floats]:
    seeds = {
        name: Tangent(float(get(machine, name)), unit)
        for name, unit in zip(names, np.eye(len(names)), strict=True)
    }
    listed = numbers(exchanged(machine, seeds))
    table = np.zeros((len(listed), len(names)))
    for row, number in zip(table, listed, strict=True):
        if isinstance(number, Tangent):
            row[:] = number.d
    return dict(zip(names, table.T, strict=True))
