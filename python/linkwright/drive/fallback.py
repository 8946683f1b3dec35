"""Where a motion comes to whose steady motion was not found: followed in time, from turn to turn."""

from __future__ import annotations

from linkwright.drive.motion_events import motion_extremes
from linkwright.drive.transient import End, Transient, transient
from linkwright.kernel.errors import LinkwrightError
from linkwright.machine.machine import Machine

# Cycles that the machine is followed for: what forgets nine tenths of a disturbance in each settles in nine.
_CYCLES = 60

# Change of the speed over a cycle, as a share, below which it has settled.
_SETTLED = 1e-6

_ADVICE = "simulate the machine in time (linkwright transient)"


def in_time(machine: Machine, speed: float, turns: int) -> str:
    """What the machine does from a speed at φ = 0 [rad/s], as a clause, else advice; ``turns`` of a cycle."""
    try:
        first = transient(machine, speed=speed, turns=_CYCLES * turns)
        if first.end != End.TURNS:
            return _ended(first)
        last = transient(machine, speed=float(first.speed[-1]), turns=turns)
    except LinkwrightError:
        # silent: the finding keeps its advice
        return _ADVICE
    start, end = last.speed[[0, -1]]
    if last.end != End.TURNS or abs(end - start) > _SETTLED * start:
        return _ADVICE
    slowest, fastest = motion_extremes(last)[:2]
    return (
        f"simulated in time from {speed:.4g} rad/s it settles between {slowest.value:.5g} and "
        f"{fastest.value:.5g} rad/s (linkwright transient)"
    )


def _ended(motion: Transient) -> str:
    if motion.end not in (End.STALL, End.REVERSAL):
        return _ADVICE
    how = "comes to rest" if motion.end == End.STALL else "turns back"
    return f"simulated in time it {how} after {motion.turns:.4g} revolutions (linkwright transient)"
