"""The cycle of a machine: revolutions of the crank after which what is computed repeats.

Every quantity over a cycle asks here: means and extremes of inertia and loads take the revolutions after
which the crank feels the same again, forces those after which every point and link is back too. A mechanism
with change points, or with gears at a fraction of the speed, differs from one revolution to the next.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from linkwright.kernel.arrays import Floats, Integers
from linkwright.kernel.description.cycle import TURNS_MAX
from linkwright.kernel.errors import AssemblyError
from linkwright.kernel.units.kinds import ANGLE, LENGTH
from linkwright.kernel.units.reading import worded
from linkwright.linkages.closure import turn_angles
from linkwright.linkages.period import turns_to_repeat
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine, compile_machine
from linkwright.machine.program.core import Channel

# Difference of inertia or load on the crank from one revolution to the next, over its size, that counts as
# rounding.
_SAME = 1e-7

# Angles of a revolution at which laws are compared, a prime number so that no symmetry hides a difference.
_LAW_LOOKS = 97


def over_whole_cycle(compiled: CompiledMachine) -> CompiledMachine:
    """The machine over the revolutions after which the crank feels the same masses and loads again.

    The `AssemblyError` says after how many revolutions it does, if they are many, and what to change.
    """
    if not _turns(compiled):
        raise AssemblyError(_unrepeated(compiled))
    return over_known_cycle(compiled)


def over_known_cycle(compiled: CompiledMachine) -> CompiledMachine:
    """`over_whole_cycle`, and where there is none, over the revolutions that loads over the angle take."""
    turns = _turns(compiled)
    return compiled.over_turns(turns) if turns > compiled.turns else compiled


def first_revolution_words(machine: Machine) -> Iterator[str]:
    """What is to know of quantities over a cycle, if masses and loads do not repeat."""
    compiled = compile_machine(machine).first()
    if not _turns(compiled):
        text = _unrepeated(compiled)
        yield (
            f"{text[0].upper()}{text[1:]}. Inertia, torques and forces over a cycle are those of the first "
            "revolution."
        )


def over_whole_motion(compiled: CompiledMachine) -> CompiledMachine | None:
    """The machine over the revolutions in which motion and loads repeat; None if too many, or none."""
    turns = turns_to_repeat(compiled)
    if turns is None or math.lcm(turns, compiled.turns) > TURNS_MAX:
        return None
    return compiled.over_turns(turns) if turns > 1 else compiled


def force_turns(compiled: CompiledMachine) -> int:
    """Revolutions after which forces repeat: with every point and link, else with what the crank feels."""
    return (over_whole_motion(compiled) or over_known_cycle(compiled)).turns


def cycle_of(machine: Machine) -> float:
    """Angle of the crank after which all that it feels repeats [rad]."""
    return over_known_cycle(compile_machine(machine).first()).cycle


def row_turns(compiled: CompiledMachine) -> Integers:
    """Revolutions of the cycle of each machine of a batch, (rows,); 0 where these are too many, or none."""
    if compiled.one_turn:
        return np.full(compiled.n_rows, compiled.turns, dtype=np.int32)
    # Where masses and loads alone vary, all mechanisms repeat together.
    shared = None if compiled.motion_varies else turns_to_repeat(compiled.first()) or 0
    return np.array([_row_turns(compiled.row(k), shared) for k in range(compiled.n_rows)], dtype=np.int32)


def _row_turns(compiled: CompiledMachine, known: int | None) -> int:
    """Revolutions of a machine's cycle, 0 if there is none; `known`: those after which its motion repeats."""
    if _repeats(compiled):
        return compiled.turns
    turns = turns_to_repeat(compiled) if known is None else known
    together = math.lcm(turns or 0, compiled.turns)
    return together if together <= TURNS_MAX else 0


def _turns(compiled: CompiledMachine) -> int:
    """Revolutions of the cycle of a machine, of a batch of the first; 0 where these are too many, or none."""
    if compiled.one_turn:
        return compiled.turns
    known: int | None = compiled.kept.get("cycle")
    if known is None:
        known = compiled.kept["cycle"] = _row_turns(compiled, None)
    return known


def _unrepeated(compiled: CompiledMachine) -> str:
    turns = turns_to_repeat(compiled)
    after = f"only after {turns} revolutions" if turns else "and never do"
    remedy = _law_that_goes_on(compiled) or (
        "choose the slowest part as the crank, or put masses and loads on parts that repeat with it"
    )
    return f"masses and loads do not repeat within {TURNS_MAX} revolutions of the crank, {after}: {remedy}"


def _law_that_goes_on(compiled: CompiledMachine) -> str:
    """What the first law that does not repeat does beyond a revolution, and its remedy; empty without one."""
    turn = 2 * np.pi
    phi = np.linspace(0.0, turn, _LAW_LOOKS)
    for name, slide in compiled.slides.items():
        if not name.endswith(".law"):
            continue
        first, second, third = (
            compiled.motion([Channel.Slide(slide)], phi + k * turn)[0][0] for k in range(3)
        )
        size = float(np.abs(first).max()) or 1.0
        if np.abs(second - first).max() <= _SAME * size:
            continue
        does = "does not repeat"
        if np.ptp(second) <= _SAME * size:
            does = f"stays at {second[0]:.4g}"
        elif np.ptp(second - first) <= _SAME * size and np.ptp(third - second) <= _SAME * size:
            continue  # a steady advance, as that of index steps
        driver = name.removesuffix(".law")
        kind = LENGTH if driver in compiled.slides else ANGLE
        table = "linear_drivers" if driver in compiled.slides else "cranks"
        place = f"mechanism.{table}.{driver}.advance"
        advance = worded(float(first[-1] - first[0]), kind)
        return (
            f"φ continues beyond 2π, where the law of {driver} {does}; add {place}, {advance}: it then "
            f"starts again in every revolution from where it ended; sections in [axes.{driver}] do the same"
        )
    return ""


def _repeats(compiled: CompiledMachine) -> bool:
    looks = turn_angles(16, compiled.turns)
    first, next_ = (_felt(compiled.first(), looks + cycle) for cycle in (0.0, compiled.cycle))
    return bool((np.abs(next_ - first) <= _SAME * np.abs(first).max(axis=1, keepdims=True)).all())


def _felt(compiled: CompiledMachine, angles: Floats) -> Floats:
    """Inertia and loads at the crank, (quantities, n)."""
    at = compiled.reductions(angles)
    laws = compiled.law_torques(angles, compiled.speed_guess)
    return np.stack([at.inertia, at.inertia_slope, at.load, at.dry, at.viscous, laws[0]])
