"""Derivatives of a predicted rod string by the entries of the machine.

The core follows the periodic motion in duals, from its solution: what a sweep between string and pump makes
of the wave's derivative is that derivative again. A valve that opens a little later moves no load by itself,
since loads are continuous there. Numbers are worked out of cards with derivatives by the formulas of the
prediction itself.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from linkwright.kernel.numerics.extreme import chosen, greatest, they_differ
from linkwright.kernel.numerics.tangent import Tangent, primal
from linkwright.machine.machine import Machine
from linkwright.machine.tangents import Derivatives, scalars_of, spread
from linkwright.pumping.gear_gradient import gear_scalars, without_derivatives
from linkwright.rods.motion_gradient import MovedRod, moved_rod
from linkwright.rods.numbers import api_terms
from linkwright.rods.polished_rod import over_angle, with_load
from linkwright.rods.prediction import Solution, polished_rod_load, solution
from linkwright.rods.scalars import goodman_loadings, string_scalars

# Accuracy of the solution that is differentiated, that of a prediction.
_ACCURACY = 1e-3


def string_tangents(machine: Machine, variables: Sequence[str], accuracy: float = _ACCURACY) -> Derivatives:
    """Scalars of a predicted rod string by some entries. Raises what `rod_string` raises."""
    solved = solution(machine, accuracy)
    refused: dict[str, str] = {}
    moved = moved_rod(machine, solved, variables, refused)
    listed = tuple(name for name in variables if name not in refused)
    result, string, cards = solved.result, moved.string, moved.cards
    scalars = string_scalars(
        string, moved.stroke, moved.period, cards, moved.mean_load, primal(moved.position)
    )
    gears, ties, missing = _gears(solved, moved)
    best = gears.get("gear_best")
    torque = best and greatest(best["torque_net_up"], best["torque_net_down"])
    terms = api_terms(string, scalars, torque)
    parts: dict[str, Mapping[str, Any]] = {"": scalars, "numbers": terms, **gears}
    if result.stress.loading_max is not None:
        loadings = goodman_loadings(string, cards.load).values()
        parts["stress"] = {"loading_max": greatest(*(x for x in loadings if np.isfinite(primal(x))))}
    tangents: dict[str, Tangent] = {}
    for part, numbers in parts.items():
        of = getattr(result, part) if part else result
        known = {name: x for name, x in numbers.items() if x is not None}
        found = scalars_of(of, known, moved.known, listed)
        tangents |= {f"{part}.{name}".lstrip("."): x for name, x in found.items()}
    usual = tuple(tangents)
    if moved.drive is not None:
        own = {name: spread(x, moved.known, listed) for name, x in moved.drive.tangents.items()}
        tangents |= {f"drive.{name}": x for name, x in own.items()}
        ties |= {f"drive.{name}": why for name, why in moved.drive.ties.items()}
        missing |= {f"drive.{name}": why for name, why in moved.drive.missing.items()}
    worst = tangents.get("stress.loading_max")
    if worst is not None and np.isnan(worst.d).any():
        ties["stress.loading_max"] = (
            f"sections have the same loading; {they_differ(chosen(listed, np.isnan(worst.d)))}"
        )
    lost = {} if moved.drive is None else moved.drive.lost
    return Derivatives(listed, tangents, ties, missing, refused, lost, usual=usual)


def _gears(
    solved: Solution, moved: MovedRod
) -> tuple[dict[str, dict[str, Any]], dict[str, str], dict[str, str]]:
    """Scalars of the gearbox with given and best counterbalance, ties, and those without derivatives."""
    along, result = moved.unit, solved.result
    if along is None or result.gear is None:
        return {}, {}, {}
    rod: Any = solved.rod
    load = polished_rod_load(moved.string, primal(moved.position), moved.cards.load[0])
    heights = over_angle(moved.angles, load)
    gears: dict[str, dict[str, Any]] = {}
    ties: dict[str, str] = {}
    missing: dict[str, str] = {}
    for name, gear in (("gear", result.gear), ("gear_best", result.gear_best)):
        is_best = name == "gear_best"
        still = replace(rod.rod, unit=with_load(rod.unit, primal(heights), is_best=is_best))
        follows = replace(along, unit=with_load(along.unit, heights, is_best=is_best))
        gears[name], tied = gear_scalars(still, follows, gear)
        ties |= {key.replace("gear", name, 1): why for key, why in tied.items()}
        missing |= {f"{name}.{key}": why for key, why in without_derivatives(gear).items()}
    return gears, ties, missing
