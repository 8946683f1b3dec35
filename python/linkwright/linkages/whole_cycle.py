"""The cycle of a machine: revolutions of the crank after which what is computed repeats.

Every quantity over a cycle asks here: means and extremes of inertia and loads take the revolutions after
which the crank feels the same again, forces those after which every point and link is back too. A mechanism
with change points, or with gears at a fraction of the speed, differs from one revolution to the next.
"""

from __future__ import annotations

import math

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.cycle import TURNS_MAX
from linkwright.kernel.errors import AssemblyError
from linkwright.linkages.closure import turn_angles
from linkwright.linkages.period import turns_to_repeat
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine, compile_machine

# Difference of inertia or load on the crank from one revolution to the next, over its size, that counts as
# rounding.
_SAME = 1e-7


def over_whole_cycle(compiled: CompiledMachine) -> CompiledMachine:
    """The machine over the revolutions after which the crank feels the same masses and loads again.

    The `AssemblyError` says after how many revolutions it does, if they are many, and what to change.
    """
    known: CompiledMachine | None = compiled.kept.get("whole cycle")
    if known is None:
        known = compiled.kept["whole cycle"] = _whole_cycle(compiled)
    return known


def over_whole_motion(compiled: CompiledMachine) -> CompiledMachine | None:
    """The machine over the revolutions after which every point and link is where it was, with all loads.

    None if these are more than a cycle may take, or there are none.
    """
    turns = turns_to_repeat(compiled)
    if turns is None or math.lcm(turns, compiled.turns) > TURNS_MAX:
        return None
    return compiled.over_turns(turns) if turns > 1 else compiled


def force_turns(compiled: CompiledMachine) -> int:
    """Revolutions after which all forces repeat: with every point and link, else with what the crank feels.

    The `AssemblyError` is that of `over_whole_cycle`.
    """
    return (over_whole_motion(compiled) or over_whole_cycle(compiled)).turns


def cycle_of(machine: Machine) -> float:
    """Angle of the crank after which all that it feels repeats; of what never does, a revolution [rad]."""
    try:
        return over_whole_cycle(compile_machine(machine).first()).cycle
    except AssemblyError:
        return 2 * np.pi


def _whole_cycle(compiled: CompiledMachine) -> CompiledMachine:
    if compiled.one_turn:
        return compiled
    turns = turns_to_repeat(compiled)
    if turns == 1 or _repeats(compiled):
        return compiled
    if turns is None or math.lcm(turns, compiled.turns) > TURNS_MAX:
        after = f"they do only after {turns}" if turns else "they never do"
        raise AssemblyError(
            f"masses and loads do not repeat within {TURNS_MAX} revolutions of the crank: {after}; choose "
            "the slowest part as the crank, or put masses and loads on parts that repeat with it"
        )
    return compiled.over_turns(turns)


def _repeats(compiled: CompiledMachine) -> bool:
    """Whether the crank feels the same inertia and load in the next cycle of the loads."""
    looks = turn_angles(16, compiled.turns)
    first, next_ = (_felt(compiled.first(), looks + cycle) for cycle in (0.0, compiled.cycle))
    return bool((np.abs(next_ - first) <= _SAME * np.abs(first).max(axis=1, keepdims=True)).all())


def _felt(compiled: CompiledMachine, angles: Floats) -> Floats:
    """What the crank feels at crank angles, (quantities, n)."""
    at = compiled.reductions(angles)
    laws = compiled.law_torques(angles, compiled.speed_guess)
    return np.stack([at.inertia, at.inertia_slope, at.load, at.dry, at.viscous, laws[0]])
