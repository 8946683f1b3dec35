"""Derivatives of a predicted rod string by the entries of the machine.

The core follows the periodic motion in duals, from its solution: what a sweep between string and pump makes
of the wave's derivative is that derivative again. A valve that opens a little later moves no load by itself,
since loads are continuous there. An extreme has the derivative of the curve at its place (envelope theorem).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.numerics.tangent import Tangent, lifted
from linkwright.machine.machine import Machine
from linkwright.machine.tangents import Derivatives, directions, followed, scalars_of
from linkwright.pumping.model.unit import PumpingUnit
from linkwright.rods.core import Cards, numbers_of, solve_along
from linkwright.rods.model.rod_string import RodString
from linkwright.rods.numbers import api_terms
from linkwright.rods.polished_rod import HarmonicRod, UnitRod, crank_speed
from linkwright.rods.prediction import Solution, solution
from linkwright.rods.scalars import goodman_loadings, string_scalars

# Accuracy of the solution that is differentiated, that of a prediction.
_ACCURACY = 1e-3

_UNIT = "pumping_unit."

_WITH_MOTOR = (
    "string and motor decide each other's motion, which is not differentiated; give drive.speed in place of "
    "the motor"
)


class _Along(NamedTuple):
    """A string with derivatives, and what moves it."""

    string: RodString
    unit: PumpingUnit | None
    period: Any
    stroke: Any
    numbers: list[Any]


def string_tangents(machine: Machine, variables: Sequence[str], accuracy: float = _ACCURACY) -> Derivatives:
    """Scalars of a predicted rod string by some entries. Raises what `rod_string` raises."""
    solved = solution(machine, accuracy)
    refused: dict[str, str] = {}
    if isinstance(solved.rod, UnitRod) and solved.rod.has_motor:
        return Derivatives((), {}, {}, {}, dict.fromkeys(variables, _WITH_MOTOR))
    own = [name for name in variables if name.startswith(("rod_string.", _UNIT)) or name == "drive.speed"]
    rows: dict[str, Floats] = {}
    if isinstance(solved.rod, UnitRod):
        rows = _unit_rows(solved, [name for name in own if name.startswith(_UNIT)], refused)
        own = [name for name in own if name not in refused]
    known, along = followed(machine, own, _along, refused)
    cards, mean_load = _cards(solved, along, known, rows)
    moved = solved.rod.motion(cards.load.shape[-1]).position
    scalars = string_scalars(along.string, along.stroke, along.period, cards, mean_load, moved)
    listed = tuple(name for name in variables if name not in refused)
    result = solved.result
    tangents = scalars_of(result, scalars, known, listed)
    terms = {name: x for name, x in api_terms(along.string, scalars).items() if x is not None}
    numbers = scalars_of(result.numbers, terms, known, listed)
    tangents |= {f"numbers.{name}": x for name, x in numbers.items()}
    loadings = goodman_loadings(along.string, cards.load)
    if loadings and result.stress.loading_max is not None and np.isfinite(result.stress.loading_max):
        worst = loadings[int(np.nanargmax(result.stress.loading))]
        found = scalars_of(result.stress, {"loading_max": worst}, known, listed)
        tangents["stress.loading_max"] = found["loading_max"]
    return Derivatives(listed, tangents, {}, {}, refused)


def _along(machine: Machine) -> _Along:
    string, unit = machine.rod_string, machine.pumping_unit
    assert string is not None
    period = 2 * np.pi / crank_speed(machine, string)
    stroke = string.stroke if unit is None else unit.stroke
    return _Along(string, unit, period, stroke, numbers_of(string, period))


def _unit_rows(solved: Solution, names: Sequence[str], refused: dict[str, str]) -> dict[str, Floats]:
    """Derivatives of the polished rod's position at its samples by entries of the unit."""
    from linkwright.pumping.gradient import RodAlong

    rod, moved = solved.rod.rod, solved.moved  # type: ignore[union-attr]
    program = directions(rod.machine, names)
    refused.update(program.refused)
    known, unit = followed(rod.machine, program.variables, lambda machine: machine.pumping_unit, refused)
    at = [program.variables.index(name) for name in known]
    along: Any = RodAlong.of_unit(rod, unit, program.values[:, at])
    rise = along.motion(moved.crank_angle)[0]
    return dict(zip(known, lifted(rise, len(known)).d.T, strict=True))


def _cards(
    solved: Solution, along: _Along, known: Sequence[str], rows: dict[str, Floats]
) -> tuple[Cards, Any]:
    """The cards with derivatives, and the mean load of the plunger."""
    own, n, k = solved.solved, len(solved.moved.position), len(known)
    numbers = np.array([lifted(number, k).d for number in along.numbers]).reshape(-1, k)
    motion = np.zeros((k, n))
    if isinstance(solved.rod, HarmonicRod):
        motion = np.outer(lifted(along.stroke, k).d, solved.moved.position / solved.rod.stroke)
    for name, row in rows.items():
        motion[known.index(name)] = row
    found = solve_along(
        solved.string, solved.moved.period, solved.moved.position, own.wave, (numbers.T, motion)
    )
    stations = len(solved.string.sections) + 1
    work = found.work.T
    cards = Cards(
        Tangent(own.cards.position, np.moveaxis(found.position, 0, -1)),
        Tangent(own.cards.load, np.moveaxis(found.load, 0, -1)),
        Tangent(own.cards.work, work[:stations]),
        Tangent(own.cards.loss, work[stations:]),
    )
    return cards, Tangent(own.mean_load, found.ends[:, 0])
