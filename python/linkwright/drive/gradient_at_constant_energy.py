r"""Derivatives of the measures of speed fluctuation at constant kinetic energy.

With E = 1 the extreme speeds are :math:`\sqrt{2/J}` and the acceleration is :math:`-J'/J^2`. Their extremes
have the derivatives at their crank angles (envelope theorem); where an extreme occurs at two angles with
different derivatives, or at a segment boundary that an entry moves, there are only one-sided derivatives.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from linkwright.drive.evenness import inertias, mean_of_extremes, motion_coefficient, unevenness
from linkwright.kernel.arrays import Floats
from linkwright.kernel.numerics.extreme import ALIKE_OF_SOLVED, Kinks, common, occurs_at
from linkwright.kernel.numerics.tangent import Tangent
from linkwright.kernel.numerics.turn_curve import TurnCurve
from linkwright.kernel.numerics.turn_fit import turn_curve
from linkwright.linkages.whole_cycle import over_known_cycle
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine, compile_machine
from linkwright.machine.tangents import Derivatives, Directions, directions, spread

# Share of the peak within which extremes at two angles are one: the series are good to 1e-13, and ends of
# their pieces beside a top are not taken for rivals.
_SAME = 1e-11

# An extreme this near to a joint of a motion law is on it [rad].
_ON_JOINT = 1e-7

# Share of the inertia by which one that is constant varies: rounding.
_CONSTANT = 1e-12

# Quantities of the revolution.
_INERTIA, _ACCELERATION = 0, 1


class _Extreme(NamedTuple):
    """An extreme with its derivatives, NaN by entries that have none, and why that is."""

    number: Tangent
    why: str


def constant_energy_tangents(machine: Machine, variables: Sequence[str]) -> Derivatives:
    """δ, H and k_p at constant energy by some entries. Raises what `constant_energy` raises."""
    # Loads do not count: their kinks are none of the inertia.
    bare = machine.with_entries({"loads": {}})
    own = [name for name in variables if not name.startswith("loads.")]
    program = directions(bare, own)
    refused = dict(program.refused)
    listed = tuple(name for name in variables if name not in refused)
    compiled = over_known_cycle(compile_machine(bare).first())
    turn = turn_curve(_curves(compiled), compiled.kinks(), "inertia reduced to the crank")
    high, low = turn.extreme(1, _INERTIA)[0], turn.extreme(-1, _INERTIA)[0]
    if high - low <= _CONSTANT * high:
        nothing = "it is zero: the inertia is constant"
        names = ("unevenness", "dynamism", "motion_coefficient")
        return Derivatives(listed, {}, {}, dict.fromkeys(names, nothing), refused)
    reads = _Reads(compiled, program, turn)
    largest, smallest = reads.inertia(1), reads.inertia(-1)
    peak = reads.acceleration()
    slow, fast = (2 / largest.number) ** 0.5, (2 / smallest.number) ** 0.5
    mean = mean_of_extremes(slow, fast)
    delta, dynamic = unevenness(slow, fast, mean), peak.number / mean**2
    numbers = {
        "unevenness": delta,
        "dynamism": dynamic,
        "motion_coefficient": motion_coefficient(delta, dynamic),
    }
    of_speed = largest.why or smallest.why
    whys = {"unevenness": of_speed, "dynamism": of_speed or peak.why}
    whys["motion_coefficient"] = whys["dynamism"]
    tangents = {name: spread(number, program.variables, listed) for name, number in numbers.items()}
    ties = {name: why for name, why in whys.items() if why and np.isnan(tangents[name].d).any()}
    return Derivatives(listed, tangents, ties, {}, refused)


def _curves(compiled: CompiledMachine) -> Any:
    """Inertia, and acceleration at E = 1 with its sign turned, over the crank angle."""

    def curves(phi: Floats) -> Floats:
        inertia, slope = inertias(compiled, phi)
        return np.stack([inertia, slope / inertia**2])

    return curves


class _Reads:
    """Reads extremes of a revolution with their derivatives."""

    def __init__(self, compiled: CompiledMachine, program: Directions, turn: TurnCurve) -> None:
        self.compiled, self.program, self.turn = compiled, program, turn
        self.kinks = Kinks.of(compiled, program)

    def inertia(self, sign: int) -> _Extreme:
        """The maximum or minimum inertia."""
        angles = self.turn.extremes(sign, _INERTIA, _SAME)
        along = self.compiled.inertias_along(self.program.values, angles)[0]
        return self._extreme(self.turn.extreme(sign, _INERTIA)[0], angles, along)

    def acceleration(self) -> _Extreme:
        """The peak of |J′|/J²."""
        peak = max(abs(self.turn.extreme(sign, _ACCELERATION)[0]) for sign in (1, -1))
        angles, slopes = [], []
        for sign in (1, -1):
            if abs(self.turn.extreme(sign, _ACCELERATION)[0]) < peak * (1 - _SAME):
                continue
            at = self.turn.extremes(sign, _ACCELERATION, _SAME)
            inertia, slope = (values[:, None] for values in inertias(self.compiled, at))
            along = self.compiled.inertias_along(self.program.values, at)
            angles.append(at)
            slopes.append(sign * (along[1] / inertia**2 - 2 * slope * along[0] / inertia**3))
        return self._extreme(peak, np.concatenate(angles), np.concatenate(slopes))

    def _extreme(self, value: float, angles: Floats, along: Floats) -> _Extreme:
        """An extreme that is reached at some angles, with the derivatives that it has at all of them."""
        d = common(along, alike=ALIKE_OF_SOLVED)
        why = occurs_at(angles) if np.isnan(d).any() else ""
        for angle in angles.tolist():
            moving = self.kinks.moved_at(angle, _ON_JOINT)
            if moving.any():
                d, why = np.where(moving, np.nan, d), self.kinks.words(angle, moving)
        return _Extreme(Tangent(value, d), why)
