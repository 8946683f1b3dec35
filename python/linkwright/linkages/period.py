"""After how many revolutions of the crank a mechanism is again where it was.

Cranks and dyads repeat after one revolution. Gears and belts of other ratios take several, a screw or a rack
on the crank never comes back, and a group may close only after its branch has been run through twice.
"""

from __future__ import annotations

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.public import public
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine, compile_machine
from linkwright.machine.program.core import Channel

# Turns after which a motion counts as one that does not repeat: trains of gears with up to so many teeth.
_TURNS_MAX = 240

# Crank angles that are compared, spread unevenly over the revolution so that no symmetry hides a difference
# [rad].
_ANGLES = np.array([0.317, 1.291, 2.053, 3.371, 4.423, 5.687])

# Difference over the size of the mechanism that counts as rounding: that of an angle of a thousand radians is
# far below, a tooth of the largest gear far above.
_ROUNDING = 1e-9


@public
def period_turns(machine: Machine) -> int | None:
    """Revolutions of the crank after which the motion of the mechanism repeats.

    Parameters
    ----------
    machine : Machine

    Returns
    -------
    int or None
        The minimum number up to 240; None if there is none, as with a rack on a gear that turns on and on.
    """
    return turns_to_repeat(compile_machine(machine))


def turns_to_repeat(compiled: CompiledMachine) -> int | None:
    """Revolutions of the crank after which all points and links are as before; None if not within 240."""
    if compiled.one_turn:
        return 1
    turns = np.arange(_TURNS_MAX + 1)
    angles = (2 * np.pi * turns[:, None] + _ANGLES).ravel()
    places = _places(compiled, angles).reshape(-1, len(turns), len(_ANGLES))
    apart = np.abs(places - places[:, :1]).max(axis=(0, 2), initial=0.0)
    same = np.flatnonzero(apart[1:] <= _ROUNDING)
    return int(same[0]) + 1 if len(same) else None


def _places(compiled: CompiledMachine, angles: Floats) -> Floats:
    """Points over the mechanism's size, and directions of links, (numbers, n); zero where nothing closes."""
    what: list[Channel] = [Channel.Point(index) for index in compiled.points.values()]
    what += [Channel.Link(index) for index in compiled.links.values()]
    # Of a point its place, of a link its direction.
    rows = np.concatenate([np.empty((0, len(angles))), *(rows[0] for rows in compiled.motion(what, angles))])
    points, links = np.split(rows, [2 * len(compiled.points)])
    points = np.where(np.isfinite(points), points, 0.0)
    size = np.abs(points).max(initial=0.0)
    places: Floats = np.nan_to_num(np.concatenate([points / (size or 1.0), links]))
    return places
