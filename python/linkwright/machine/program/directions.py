"""How the numbers of the core's program follow the entries of a machine: their exact derivatives.

A description is translated a second time with tangents in place of the entries that are asked for
(`linkwright.machine.tangents`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import Translation, compile_machine
from linkwright.machine.tangents import columns

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

    Entries that follow from others are varied one at a time, as `linkwright.machine.tangents.columns` says.
    """
    compiled = compile_machine(machine)
    refused: dict[str, str] = {}
    found = columns(machine, variables, _numbers, refused)
    if any(getattr(element, "change_points", ()) for element in compiled.elements):
        n_own = Translation(machine, motor=True, brake=False).program.n_own
        moved = [name for name, column in found.items() if column[:n_own].any()]
        refused.update(dict.fromkeys(moved, _CHANGE_POINTS))
    known = tuple(name for name in variables if name in found and name not in refused)
    # Numbers that follow from the motion, at the end, are series at change points: nothing here moves them.
    values = np.zeros((len(compiled.parameters), len(known)))
    for place, name in enumerate(known):
        values[: len(found[name]), place] = found[name]
    return Directions(known, values, refused)


def _numbers(machine: Machine) -> Sequence[Any]:
    """The program's numbers."""
    return Translation(machine, motor=True, brake=False).program.parameters
