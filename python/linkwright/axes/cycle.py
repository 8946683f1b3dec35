"""One cycle of a machine with axes: the torque of every driver along the motion of the master.

Everything is smooth between the ends of sections and the kinks of loads. Each such piece is sampled by
itself, with the values of its own side at both ends, so that jumps are met and means are exact.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from linkwright.drive.steady_state import solved_state
from linkwright.drive.study import has_motor
from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.cycle import TURNS_MAX
from linkwright.kernel.errors import FindingError, InputError
from linkwright.kernel.numerics.tangent import primal
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.units.kinds import SPEED
from linkwright.kernel.units.marks import positive
from linkwright.kinetostatics.forces import forces
from linkwright.kinetostatics.motion import Motion
from linkwright.kinetostatics.result import Forces
from linkwright.linkages.closure import require_full_turn
from linkwright.linkages.law_jumps import law_jumps, require_finite_accelerations
from linkwright.linkages.whole_cycle import over_known_cycle
from linkwright.machine.machine import Machine
from linkwright.machine.own_motors import axis_drivers, without_drive
from linkwright.machine.program.compiled import CompiledMachine, compile_machine
from linkwright.machine.program.core import Channel

# Intervals of a revolution of the master, at least of a piece, and at most of a cycle of many revolutions.
_INTERVALS, _LEAST, _MOST = 720, 8, 8640

# Revolutions of a start or stop that so many intervals can show.
_STARTING = 120

# How far the slope of a formula at the end of a cycle may differ from that at its start, as a share.
_REPEATS = 1e-6

# By how much an end of a piece is looked at inside the piece [rad], and pieces shorter than that are none.
_INSIDE, _SHORT = 1e-10, 1e-8

# Share of its peak below which a velocity is rest, and weights of even samples in the value before them.
_REST, _CONTINUE = 1e-9, (6.0, -15.0, 20.0, -15.0, 6.0, -1.0)

# Accuracy of the steady motion of a crankshaft that is the master.
_ACCURACY = 1e-10


@dataclass(frozen=True)
class AxesCycle:
    """A motion of the master with all forces along it."""

    angle: Floats  # (n,): of the master [rad]; ends of pieces occur twice, once for each side
    forces: Forces  # at these angles

    @property
    def time(self) -> Floats:
        """From the start of the cycle [s]."""
        return self.forces.time


# Difference from it that is friction, as a share of the peak torque; less is the error of the polynomial.
_FRICTION = 1e-5


def continued(angle: Floats, velocity: Floats, torque: Any) -> Any:
    """The torque of a driver, at rest at the end of a piece that moves as the piece leads to it.

    Friction there has no sense of its own; the polynomial through the next samples has.
    """
    rests = np.abs(velocity) <= _REST * np.max(np.abs(velocity), initial=0.0)
    bounds = [0, *(np.flatnonzero(np.diff(angle) == 0) + 1), len(angle)]
    torque, least = torque.copy(), _FRICTION * np.max(np.abs(primal(torque)), initial=0.0)
    for first, last in pairwise(bounds):
        for end, step in ((first, 1), (last - 1, -1)):
            inside = end + step * np.arange(1, len(_CONTINUE) + 1)
            if last - first > len(_CONTINUE) and rests[end] and not rests[inside[0]]:
                led = sum(share * torque[int(at)] for share, at in zip(_CONTINUE, inside, strict=True))
                if abs(primal(led) - primal(torque[end])) > least:
                    torque[end] = led
    return torque


def axes_cycle(machine: Machine, speed: float | None = None) -> AxesCycle:
    """Forces over the cycle of a machine with axes; the same as before for the same machine and speed.

    `speed`: of the master [rad/s]. Without it, the master follows the steady motion of the crankshaft where
    that has a motor, else the speed that the file gives.
    """
    kept = compile_machine(machine).kept
    key = f"axes_at_{speed}"
    if key not in kept:
        kept[key] = _cycle(machine, speed)
    known: AxesCycle = kept[key]
    return known


def _cycle(machine: Machine, speed: float | None) -> AxesCycle:
    compiled = compile_machine(machine)
    require_full_turn(compiled, machine)
    require_finite_accelerations(machine)
    with_motor = speed is None and has_motor(machine)
    if speed is None and not with_motor:
        speed = master_speed(machine)
    if speed is not None:
        in_range(speed=(speed, positive(SPEED)))
    whole = _with_all_loads(machine, compiled)
    turns = _law_turns(machine, compiled, over_known_cycle(whole).turns)
    angle, inside = _sampled(machine, whole, turns)
    if speed is not None:
        still = np.zeros_like(angle)
        motion = Motion(inside, np.full_like(angle, speed), still, angle / speed)
    else:
        motion = _steady_motion(machine, angle, inside)
    return AxesCycle(angle, forces(machine, motion, contributions=False))


def _law_turns(machine: Machine, compiled: CompiledMachine, turns: int) -> int:
    """Revolutions, a multiple of `turns`, after which formulas of axes have the slopes of their start.

    Raises FindingError if there are none.
    """
    corners = {jump.name for jump in law_jumps(machine) if jump.order == 1}
    own = set(axis_drivers(machine)) - corners
    ends = np.array([2 * math.pi * turns * k - _INSIDE for k in range(1 + TURNS_MAX // turns)])
    ends[0] = _INSIDE
    repeats = np.full(len(ends) - 1, True)
    for name, driver in machine.linkage.laws().items():
        if name not in own or driver.advance is not None:
            continue
        law = Channel.Slide(compiled.slides[f"{name}.law"])
        ((_, slope, _),) = compiled.motion([law], ends)
        ((_, within, _),) = compiled.motion([law], np.linspace(0.0, float(ends[1]), _LEAST * turns))
        repeats &= np.abs(slope[1:] - slope[0]) <= _REPEATS * np.abs(within).max()
        if not repeats.any():
            raise FindingError(
                f'the law of {name}, "{driver.law}", does not repeat: its slope is {slope[0]:.4g} at the '
                f"start of a cycle and {slope[1]:.4g} at its end; write a law that repeats, or advance, by "
                "which it restarts in every cycle"
            )
    return turns * (1 + int(np.argmax(repeats)))


def master_speed(machine: Machine) -> float:
    """Speed of the master that the file gives [rad/s]; an `InputError` where it gives none."""
    if machine.design_speed is None:
        raise InputError(
            'master: found no speed, expected that of the cycle: [master] with cycle_time = "0.5 s", or '
            '--speed "120 rpm"'
        )
    return float(machine.design_speed)


def _with_all_loads(machine: Machine, compiled: CompiledMachine) -> CompiledMachine:
    """The machine with the loads that its crankshaft does not feel."""
    return compile_machine(without_drive(machine)) if has_motor(machine) else compiled


def _sampled(machine: Machine, compiled: CompiledMachine, turns: int) -> tuple[Floats, Floats]:
    """Angles of the master over some revolutions, piece by piece, and where their values are taken."""
    cycle = 2 * math.pi * turns
    own = compiled.over_turns(turns)
    places = [0.0, cycle, *own.kinks()]
    in_turn = [jump.angle for jump in law_jumps(machine)]
    for driver in machine.linkage.drivers().values():
        followed = driver.follows()
        if followed is not None:
            law = getattr(followed, "law", followed.lift)
            in_turn += [float(followed.phase + place) % (2 * math.pi) for place in law.primal.breaks]
    places += [place + 2 * math.pi * k for place in in_turn for k in range(turns)]
    ends = np.sort([place for place in places if 0 <= place <= cycle])
    ends = ends[np.append(True, np.diff(ends) > _SHORT)]
    ends[-1] = cycle
    per_turn = min(_INTERVALS, _MOST // turns)
    angles, inside = [], []
    for low, high in pairwise(ends.tolist()):
        n = max(_LEAST, math.ceil(per_turn * (high - low) / (2 * math.pi)))
        piece = np.linspace(low, high, n + 1)
        angles.append(piece)
        inside.append(np.clip(piece, low + _INSIDE, high - _INSIDE))
    return np.concatenate(angles), np.concatenate(inside)


def _steady_motion(machine: Machine, angle: Floats, inside: Floats) -> Motion:
    """The crankshaft's own motion at angles of the master."""
    first, _ = solved_state(machine, _ACCURACY, 4)
    cycle = 2 * math.pi * first.turns
    done = np.floor(inside / cycle)
    within = inside - done * cycle
    places, back = np.unique(within, return_inverse=True)
    curves, _ = solved_state(machine, _ACCURACY, places)
    time = done * curves.period + curves.time[back]
    # Both sides of an end of a piece are at one time.
    ends = np.flatnonzero(np.diff(angle) == 0)
    time[ends + 1] = time[ends]
    return Motion(inside, curves.speed[back], curves.acceleration[back], time - time[0])


def start_cycle(machine: Machine, duration: float, speed: float, *, stops: bool = False) -> AxesCycle:
    """Forces while the speed of the master rises evenly from rest, or falls to rest, from φ = 0 on.

    `duration`: of the start or stop [s]; `speed`: of the master in operation [rad/s].
    """
    rate = speed / duration
    turns = 0.5 * speed * duration / (2 * math.pi)
    if turns > _STARTING:
        key = "stop_time" if stops else "start_time"
        raise InputError(
            f"master.{key}: found {duration:.6g} s, {turns:.4g} revolutions of the master, expected at most "
            f"{_STARTING} revolutions: so slow a change of speed adds nothing to the cycle; remove it"
        )
    n = int(min(max(_INTERVALS, math.ceil(_INTERVALS * turns)), _MOST))
    time = np.linspace(0.0, duration, n + 1)
    omega = speed - rate * time if stops else rate * time
    angle = speed * time - 0.5 * rate * time**2 if stops else 0.5 * rate * time**2
    motion = Motion(angle, omega, np.full_like(time, -rate if stops else rate), time)
    return AxesCycle(angle, forces(machine, motion, contributions=False))
