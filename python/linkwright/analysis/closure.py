"""Whether a mechanism closes: at which crank angles every dyad can be assembled.

Each dyad has a radicand, (length to spare)² in a sense, that is negative where its links cannot meet: l² − h²
for a rod l at distance h from its guide, 4a²u² − (u² + a² − b²)² for a coupler a and a rocker b whose ends
are u apart, c² − o² for a pin at distance c from the pivot of a slot with offset o. The angles where it
changes sign bound the ranges in which the mechanism moves. For two guides that cross it is the square of the
sine between them, for a group solved together the determinant of its equations, squared: both are zero where
the motion is not determined.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from linkwright.analysis.obstacle import describe
from linkwright.analysis.period import turns_to_repeat
from linkwright.engine import Compiled, compile_machine
from linkwright.errors import AssemblyError, InputError
from linkwright.machine import Machine

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

# A radicand below this share of its greatest is looked into: a parabola that falls to zero between two of the
# angles below is a few millionths at the nearer one.
_CLOSE = 1e-3

# Difference in what the crank feels from one turn to the next, over its size, that counts as rounding.
_SAME = 1e-7

# Doublings of the turns looked at in a motion that never repeats: some 8000 turns either way.
_DOUBLINGS = 13

# A radicand below this share counts as zero: links in line to a hundred-thousandth of their length.
_ZERO = 1e-10

# Angles of a first look, and the share of its greatest above which every radicand has room to spare: one that
# falls to zero between two of these angles is a few ten-thousandths at the nearer one.
_FEW = 180
_AMPLE = 0.02

# Angles at which closure is looked at; a gap narrower than a quarter of a degree may go unseen here, and is
# then found by the analysis that meets it.
_ANGLES = 1440


@dataclass(frozen=True)
class Closure:
    """Where a mechanism closes.

    Attributes
    ----------
    ranges : tuple of (float, float)
        Ranges of crank angle in which every element closes [rad]; one range of a full turn, or of all the
        turns of a longer motion, if it turns fully, none if it never closes. A range may pass 2π.
    element : str
        Name of the first element that does not close; empty if all do.
    change_point : float or None
        Crank angle at which that element closes with nothing to spare [rad] and its motion does not go on
        by itself: its speeds are not determined there.
    turns : int or None
        Turns of the crank after which the motion repeats; None if it never does, as with a screw.
    """

    ranges: tuple[tuple[float, float], ...]
    element: str
    change_point: float | None = None
    turns: int | None = 1

    @property
    def turns_fully(self) -> bool:
        """Whether the crank can turn all round."""
        return not self.element


def closure(machine: Machine) -> Closure:
    """Find the crank angles at which the mechanism closes.

    Parameters
    ----------
    machine : Machine
        The machine.

    Returns
    -------
    Closure
        Ranges of crank angle, and the element that limits them.
    """
    return closure_of(compile_machine(machine))


def closure_of(compiled: Compiled) -> Closure:
    """`closure` of a compiled machine."""
    turns = turns_to_repeat(compiled)
    if turns is None:
        return _endless(compiled)
    full = Closure(((0.0, 2 * np.pi * turns),), "", turns=turns)
    if not compiled.dyads:
        return full
    gaps = compiled.gaps(turn_angles(_FEW) if turns == 1 else _over(turns, _FEW))
    if (gaps.min(axis=1) > _AMPLE * gaps.max(axis=1)).all():
        return full
    angles = _over(turns, _ANGLES)[:-1]
    gaps = compiled.gaps(angles)
    is_open = _open(gaps)
    if not is_open.any():
        return _change_point(compiled, angles, gaps) or full
    ranges = _ranges(compiled, angles, _closing(is_open), 2 * np.pi * turns)
    return Closure(ranges, _first_of(compiled, is_open), turns=turns)


def _over(turns: int, per_turn: int) -> Floats:
    return np.linspace(0.0, 2 * np.pi * turns, per_turn * turns + 1)


def _open(gaps: Floats) -> Flags:
    """Where each dyad does not close, (dyads, n). Links in line leave zero, or by rounding a little less."""
    sizes = np.nan_to_num(gaps).max(axis=1, keepdims=True)
    closes: Flags = (gaps >= -_ZERO * sizes) & (sizes > 0)
    return np.logical_not(closes)


def _closing(is_open: Flags) -> Flags:
    """At which angles every dyad closes, (n,)."""
    closes: Flags = np.logical_not(np.any(is_open, axis=0))
    return closes


def _first_of(compiled: Compiled, is_open: Flags) -> str:
    return compiled.dyads[int(np.argmax(is_open.any(axis=1)))]


def _ranges(
    compiled: Compiled, angles: Floats, closes: Flags, period: float
) -> tuple[tuple[float, float], ...]:
    """The ranges of a motion that repeats; the last may go on into the next period."""
    starts = np.flatnonzero(closes & ~np.roll(closes, 1))
    ends = np.flatnonzero(closes & ~np.roll(closes, -1))
    step = 2 * np.pi / _ANGLES
    ranges = []
    for start in starts:
        end = ends[np.searchsorted(ends, start) % len(ends)]
        low = _edge(compiled, angles[start], -step)
        high = _edge(compiled, angles[end], step)
        ranges.append((float(low), float(high if high > low else high + period)))
    return tuple(ranges)


def _endless(compiled: Compiled) -> Closure:
    """A motion that never repeats: from where it is at angle zero as far as it goes, both ways."""
    reach = 2 * np.pi
    for _ in range(_DOUBLINGS):
        angles = np.linspace(-reach, reach, 2 * _ANGLES + 1)
        is_open = _open(compiled.gaps(angles)) if compiled.dyads else np.zeros((1, len(angles)), dtype=bool)
        closes = _closing(is_open)
        if not closes[_ANGLES]:
            return Closure((), _first_of(compiled, is_open), turns=None)
        step = angles[1] - angles[0]
        ahead, behind = closes[_ANGLES:], closes[_ANGLES::-1]
        if not ahead.all() and not behind.all():
            high = _edge(compiled, float((np.argmin(ahead) - 1) * step), step)
            low = _edge(compiled, float(-(np.argmin(behind) - 1) * step), -step)
            return Closure(((low, high),), _first_of(compiled, is_open), turns=None)
        reach *= 2
    return Closure(((0.0, 2 * np.pi),), "", turns=None)


def _change_point(compiled: Compiled, angles: Floats, gaps: Floats) -> Closure | None:
    """The first dyad whose radicand falls to zero at some angle between those looked at; None if none does.

    There the dyad is stretched or folded: the rates of its links have no limit that the positions alone
    could tell. Dyads that are known to pass their change points are left out.
    """
    sizes, lows = gaps.max(axis=1), gaps.min(axis=1)
    for dyad in np.flatnonzero(lows < _CLOSE * sizes):
        if compiled.dyads[dyad] in compiled.passing:
            continue
        centre, reach = float(angles[gaps[dyad].argmin()]), 2 * np.pi / _ANGLES
        # The radicand is a parabola there: its zero is met when its square root is, at 1e-7 of the size.
        for _ in range(6):
            near_by = np.linspace(centre - reach, centre + reach, 41)
            near = compiled.gaps(near_by)[dyad]
            centre, reach = float(near_by[near.argmin()]), reach / 20
        if near.min() <= _ZERO * sizes[dyad]:
            at = centre % (2 * np.pi)
            return Closure(((at, at + 2 * np.pi),), compiled.dyads[dyad], at)
    return None


def _edge(compiled: Compiled, inside: float, step: float) -> float:
    """The angle, within one step of an angle inside a range, at which the range ends; by bisection."""
    good, bad = inside, inside + step
    # Fifty halvings of a quarter of a degree go beyond rounding.
    for _ in range(50):
        middle = 0.5 * (good + bad)
        if (compiled.gaps(np.array([middle])) >= 0).all():
            good = middle
        else:
            bad = middle
    return good


def require_full_turn(compiled: Compiled, machine: Machine) -> None:
    """Raise if the crank cannot turn all round, or if the machine is not the same again after one turn.

    Raises
    ------
    AssemblyError
        Says which element does not close, where the mechanism closes, and what to change.
    """
    found = closure_of(compiled)
    if not found.turns_fully:
        raise _error(found, machine)
    if found.turns != 1 and not _feels_one_turn(compiled):
        after = f"only after {found.turns} turns" if found.turns else "never"
        raise AssemblyError(
            f"masses and loads are {after} again where they were, so one turn of the crank does not tell the "
            "motion; let the crank be the part that turns slowest, or give masses and loads to parts that "
            "repeat with it"
        )


def _feels_one_turn(compiled: Compiled) -> bool:
    """Whether the crank feels the same inertia and load in the next turn."""
    first, next_ = (compiled.first().reductions(turn_angles(16) + turn) for turn in (0.0, 2 * np.pi))
    sizes = np.abs(first).max(axis=1, keepdims=True)
    return bool((np.abs(next_ - first) <= _SAME * sizes).all())


def require_angles(compiled: Compiled, machine: Machine, angles: Floats) -> None:
    """Raise with the reason if the mechanism does not close at one of some crank angles [rad].

    Raises
    ------
    AssemblyError
        Says which element does not close, where the mechanism closes, and what to change.
    """
    found = closure_of(compiled)
    if not found.turns_fully:
        raise _error(found, machine)
    if compiled.dyads:
        is_open = _open(compiled.gaps(angles))
        if is_open.any():
            element = _first_of(compiled, is_open)
            at = float(angles[int(np.argmax(is_open.any(axis=0)))])
            raise AssemblyError(
                f"the mechanism does not close at crank angle {_deg(at)}°: {describe(element, machine)[0]}",
                element=element,
                crank_angle=at,
            )


def _error(found: Closure, machine: Machine) -> AssemblyError:
    """The error that tells of a mechanism that does not turn fully."""
    at = found.ranges[0][1] % (2 * np.pi) if found.ranges else 0.0
    return AssemblyError(_sentence(found, machine), element=found.element, crank_angle=at)


def _sentence(found: Closure, machine: Machine) -> str:
    """What does not close, where, and the remedy."""
    if found.change_point is not None:
        return (
            f"{found.element} reaches a change point at crank angle {_deg(found.change_point)}°: its links "
            "are in line there and the speeds are not determined; change a length by a little"
        )
    what, remedy = describe(found.element, machine)
    if not found.ranges:
        return f"the mechanism does not close at any crank angle: {what}; {remedy}"
    where = " and ".join(_range(low, high, found.turns) for low, high in found.ranges)
    return f"the mechanism closes only at crank angles {where}: beyond, {what}; {remedy}"


def _range(low: float, high: float, turns: int | None) -> str:
    """A range in degrees; one that passes a full turn is given about 0°."""
    turn = 2 * np.pi * (turns or 1)
    back = turn if turns and high > turn * (1 + 1e-9) else 0.0
    return f"{_deg(low - back)}° to {_deg(high - back)}°"


def _deg(angle: float) -> str:
    rounded = round(float(np.degrees(angle)), 2)
    return f"{0.0 if rounded == 360.0 else rounded:.2f}"


@lru_cache(maxsize=8)
def turn_angles(n: int) -> NDArray[np.float64]:
    """Crank angles from 0 to 2π inclusive, ``n`` intervals [rad]; shared by results, so read-only.

    Raises
    ------
    InputError
        ``n`` is less than 1.
    """
    if n < 1:
        raise InputError(f"n = {n}: expected at least 1 interval of the turn")
    angles = np.linspace(0.0, 2 * np.pi, n + 1)
    angles.flags.writeable = False
    return angles
