"""Whether a mechanism closes: at which crank angles every dyad can be assembled.

Each dyad has a radicand, (length to spare)² in a sense, that is negative where its links cannot meet: l² − h²
for a rod l at distance h from its guide, 4a²u² − (u² + a² − b²)² for a coupler a and a rocker b whose ends
are u apart, c² − o² for a pin at distance c from the pivot of a slot with offset o. The angles where it
changes sign bound the ranges in which the mechanism moves. For two guides that cross it is the square of the
sine between them, for a group solved together the determinant of its equations, squared: both are zero where
the motion is not determined.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import Annotated

import numpy as np

from linkwright.kernel.arrays import Bools, Floats
from linkwright.kernel.errors import AssemblyError, InputError
from linkwright.kernel.numerics.zeros import minima, zeros
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Record
from linkwright.kernel.units.kinds import ANGLE
from linkwright.linkages.dyads import dyads_of
from linkwright.linkages.obstacle import change_point, describe, missing_length
from linkwright.linkages.period import turns_to_repeat
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine, compile_machine
from linkwright.machine.program.core import Channel, Element
from linkwright.machine.program.smooth_laws import LARGEST

# A radicand whose parabola through three angles dips below this share of its maximum is looked into.
_CLOSE = 1e-3

# A radicand below this share counts as zero: links in line to a hundred-thousandth of their length.
_ZERO = 1e-10

# How far beside such an angle the links meet again [rad]: a radicand grows with the square of the distance.
_REACH = 1e-4

# Angles of a first look, and the share of its maximum above which every radicand has room to spare: one that
# falls to zero between two of these angles is a few ten-thousandths at the nearer one.
_FEW = 180
_AMPLE = 0.02

# Angles at which closure is examined; gaps and openings between two of them are found by the minima and
# maxima that the parabolas through three angles promise.
_ANGLES = 1440

# Distance from a change point at which rates are compared [rad], and the difference, over one and their size,
# that they may have there: a rate that is smooth changes by a hundredth of this.
_BESIDE = 1e-5
_JUMP = 1e-3

# So near to where its pin passes over its pivot [rad] a slotted lever has no sound motion: rounding of the
# pin's place, 1e-16 of the crank, makes 1e-16 over the cube of this of ψ″, a millionth.
_OVER_PIVOT = 5e-4

# How near a limit of its rotation a crank stands at it [rad].
_AT_LIMIT = 1e-6

# Doublings of the revolutions examined in a motion that never repeats: some 8000 revolutions either way.
_DOUBLINGS = 13


_CLOSURE_RANGES = (
    "Ranges of crank angle in which every element closes [rad]; one range of a full revolution, "
    "or of all the revolutions of a longer motion, if it turns fully, none if it never closes. A "
    "range may pass 2π."
)


@dataclass(frozen=True)
class Closure(Record):
    """Where a mechanism closes."""

    ranges: Annotated[tuple[tuple[float, float], ...], About(_CLOSURE_RANGES)]
    element: Annotated[str, About("Name of the first element that does not close; empty if all do.")]
    change_point: Annotated[
        float | None,
        Label(
            "crank angle of the change point",
            "",
            "rad",
            "That element is at its limit of closure there, and its speeds are indeterminate.",
        ),
    ] = None
    turns: Annotated[
        int | None,
        Label(
            "revolutions of the crank until the motion repeats",
            "",
            "",
            "None if it never does, as with a screw.",
        ),
    ] = 1

    @property
    def turns_fully(self) -> bool:
        """Whether the crank can rotate fully."""
        return not self.element

    @property
    def moves(self) -> bool:
        """Whether the first range is more than a single angle, at which the mechanism stands."""
        return bool(self.ranges) and self.ranges[0][1] - self.ranges[0][0] >= ANGLE.least


@public
def closure(machine: Machine) -> Closure:
    """Find the crank angles at which the mechanism closes.

    Parameters
    ----------
    machine : Machine

    Returns
    -------
    Closure
        Ranges of crank angle, and the element that limits them.
    """
    return closure_of(compile_machine(machine))


def closure_of(compiled: CompiledMachine) -> Closure:
    """`closure` of a compiled machine: every analysis asks for it, and it is found once."""
    kept: Closure | None = compiled.kept.get("closure")
    if kept is None:
        kept = compiled.kept["closure"] = _found_closure(compiled)
    return kept


def _found_closure(compiled: CompiledMachine) -> Closure:
    turns = turns_to_repeat(compiled)
    if turns is None:
        return _endless(compiled)
    full = Closure(((0.0, 2 * np.pi * turns),), "", turns=turns)
    if not _parts(compiled):
        return full
    gaps = _gaps(compiled, _over(turns, _FEW))
    flat = np.flatnonzero((gaps == 0).all(axis=1))
    if len(flat):
        # Guides that are always parallel never meet.
        return Closure((), _parts(compiled)[int(flat[0])], turns=turns)
    if (gaps.min(axis=1) > _AMPLE * gaps.max(axis=1)).all():
        return full
    return _Search(compiled, turns).run() or full


def _parts(compiled: CompiledMachine) -> tuple[str, ...]:
    """Names of what limits the motion: the driver whose law has no value somewhere, and the dyads."""
    gap = compiled.law_gap
    return compiled.dyads if gap is None else (gap.element, *compiled.dyads)


def _gaps(compiled: CompiledMachine, angles: Floats) -> Floats:
    """−1 where a law has no value, 1 where it has; and radicands of the dyads, (parts, n)."""
    gaps = compiled.gaps(angles)
    if compiled.law_gap is None:
        return gaps
    laws = [Channel.Slide(part.slide) for part in compiled.elements if isinstance(part, Element.Law)]
    values = np.array([row for rows in compiled.motion(laws, angles) for row in rows[:2]])
    known = (np.abs(values) < LARGEST).all(axis=0)
    # What hangs on the law has no place there.
    return np.concatenate([np.where(known, 1.0, -1.0)[None], np.where(known, gaps, np.nan)])


def _shares(compiled: CompiledMachine, gaps: Floats, sizes: Floats) -> Floats:
    """Radicands (parts, n) over their sizes (parts, 1); −1 where a group does not close, for any size."""
    shares = gaps / sizes
    first = len(gaps) - len(compiled.dyads)
    for element in compiled.elements:
        if isinstance(element, Element.Group):
            row = first + element.dyad
            shares[row] = np.where(gaps[row] < 0, -1.0, shares[row])
    return shares


def _over(turns: int, per_turn: int) -> Floats:
    """Crank angles of a whole period, its end included."""
    if turns == 1:
        return turn_angles(per_turn)
    return np.linspace(0.0, 2 * np.pi * turns, per_turn * turns + 1)


def limiter_at(compiled: CompiledMachine, angle: float) -> str:
    """Name of the dyad that limits the motion at an end of a range."""
    return limiters_at(compiled, [angle])[0]


def limiters_at(compiled: CompiledMachine, angles: Iterable[float]) -> list[str]:
    """Names of the dyads that limit the motion at ends of ranges."""
    search = _Search(compiled, 1)
    return [search.limiter(angle) for angle in angles]


class _Search:
    """Angles of a fine scan over the period, with further ones where something happens between them."""

    def __init__(self, compiled: CompiledMachine, turns: int) -> None:
        self.compiled, self.turns = compiled, turns
        self.period = 2 * np.pi * turns
        self.angles: Floats = _over(turns, _ANGLES)[:-1].copy()
        gaps = _gaps(compiled, self.angles)
        # A dyad that closes nowhere is measured by how far it is from closing.
        known = np.abs(gaps) if not (gaps > 0).any() else gaps
        self.sizes: Floats = np.nan_to_num(known).max(axis=1, keepdims=True)
        self.sizes[self.sizes <= 0] = np.nan_to_num(np.abs(gaps)).max() or 1.0
        self.room = self._least(gaps)

    def _least(self, gaps: Floats) -> Floats:
        # A dyad behind one that does not close is NaN, and that one is negative.
        least: Floats = np.fmin.reduce(_shares(self.compiled, gaps, self.sizes), axis=0)
        return least

    def spare(self, angles: Floats) -> Floats:
        return self._least(_gaps(self.compiled, angles))

    def limiter(self, angle: float) -> str:
        gaps = _shares(self.compiled, _gaps(self.compiled, np.array([angle])), self.sizes)
        return _parts(self.compiled)[int(np.nanargmin(gaps[:, 0]))]

    def run(self) -> Closure | None:
        """The closure; None if it closes all round."""
        touches = self._between(+1)
        self._between(-1)
        # Links in line leave zero, or by rounding a little less.
        closes = self.room >= -_ZERO
        if not closes.all():
            ranges = _without(tuple(self._ranges(closes)), map(self._about, touches), self.period)
            return Closure(ranges, self._element(closes), turns=self.turns)
        if not touches:
            return None
        # A dyad is stretched or folded: the positions alone do not tell the rates of its links there.
        at = touches[0]
        ranges = _without(((at, at + self.period),), map(self._about, touches), self.period)
        return Closure(ranges, self.limiter(at), at, self.turns)

    def _between(self, sign: int) -> list[float]:
        """Adds minima below zero between closing angles (+1), or maxima above zero between open ones (−1)."""
        # Gives the angles of minima that touch zero where the motion does not go on.
        room = sign * self.room
        before, after = np.roll(room, 1), np.roll(room, -1)
        bend = np.maximum(before + after - 2 * room, 1e-30)
        lowest = room - (after - before) ** 2 / (8 * bend)
        places = np.flatnonzero((room <= before) & (room <= after) & (room >= -_ZERO) & (lowest < _CLOSE))
        if not len(places):
            return []
        step = 2 * np.pi / _ANGLES
        near = self.angles[places]
        at, least = minima(lambda x: sign * self.spare(x), near - step, near + step)
        missed = least < -_ZERO
        order = np.argsort(angles := np.concatenate([self.angles, at[missed] % self.period]))
        room = np.concatenate([self.room, sign * least[missed]])
        self.angles, self.room = angles[order], room[order]
        touches = at[np.abs(least) <= _ZERO]
        return [
            float(x) % self.period
            for x in touches
            if not (self._is_known(float(x)) or _passes(self.compiled, float(x)))
        ]

    def _about(self, at: float) -> tuple[float, float]:
        """Angles between which links that touch zero do not meet: one and the same where they are in line."""
        reach = np.array([at - _REACH, at + _REACH])
        spare, least = self.spare(reach), float(self.spare(np.array([at]))[0])
        if least >= 0 or (spare <= 0).any():
            return at, at
        near, far = zeros(self.spare, reach, np.array([at, at]))
        low, high = np.where(self.spare(near) >= 0, near, far)
        return float(low), float(high)

    def _is_known(self, at: float) -> bool:
        """Whether the dyad that touches zero passes a change point there."""
        near, turn = self.limiter(at), 2 * np.pi
        known = (
            point for dyad in dyads_of(self.compiled) if dyad.name == near for point in dyad.change_points
        )
        return any(abs((at - point + np.pi) % turn - np.pi) < _BESIDE for point in known)

    def _element(self, closes: Bools) -> str:
        gaps = _gaps(self.compiled, self.angles[~closes])
        fails = (_shares(self.compiled, gaps, self.sizes) < -_ZERO).any(axis=1)
        return _parts(self.compiled)[int(np.argmax(fails))]

    def _ranges(self, closes: Bools) -> Iterator[tuple[float, float]]:
        starts = np.flatnonzero(closes & ~np.roll(closes, 1))
        ends = np.flatnonzero(closes & ~np.roll(closes, -1))
        if not len(starts):
            return
        inside = self.angles[np.concatenate([starts, ends])]
        around = np.concatenate([np.roll(self.angles, 1)[starts], np.roll(self.angles, -1)[ends]])
        # The neighbour across the end of the period.
        around = inside + (around - inside + self.period / 2) % self.period - self.period / 2
        edges = self._edges(inside, around)
        for low, start in zip(edges[: len(starts)], starts, strict=True):
            high = edges[len(starts) + np.searchsorted(ends, start) % len(ends)]
            yield float(low), float(high if high >= low else high + self.period)

    def _edges(self, inside: Floats, outside: Floats) -> Floats:
        """Ends of the ranges, between angles that close and their neighbours that do not."""
        near, far = zeros(self.spare, inside, outside)
        edges = np.where(self.spare(near) >= 0, near, far)
        # An angle that closes by rounding alone is the edge itself.
        return np.where(self.spare(inside) > 0, edges, inside)


def _without(
    ranges: tuple[tuple[float, float], ...], gaps: Iterable[tuple[float, float]], period: float
) -> tuple[tuple[float, float], ...]:
    for before, after in gaps:
        cut: list[tuple[float, float]] = []
        for low, high in ranges:
            turn = period * np.floor((high - before) / period)
            left, right = float(before + turn), float(after + turn)
            if right - period > low:
                # Once at each end of a range of a whole period.
                cut.append((right - period, min(left, high)))
            elif low < left < high:
                cut += [(low, left), (right, high)]
            else:
                cut.append((low, high))
        ranges = tuple((low, high) for low, high in cut if low <= high)
    return ranges


def _endless(compiled: CompiledMachine) -> Closure:
    """A motion that never repeats: from where it is at angle zero as far as it goes, both ways."""
    reach, endless = 2 * np.pi, Closure(((0.0, 2 * np.pi),), "", turns=None)
    for _ in range(_DOUBLINGS if _parts(compiled) else 0):
        angles = np.linspace(-reach, reach, 2 * _ANGLES + 1)
        gaps = _gaps(compiled, angles)
        closes = _closing(compiled, gaps)
        sizes = np.nan_to_num(np.abs(gaps)).max(axis=1, keepdims=True)
        worst = np.nan_to_num(_shares(compiled, gaps, np.maximum(sizes, 1e-300)), nan=-1.0).min(axis=1)
        element = _parts(compiled)[int(np.argmin(worst))]
        if not closes[_ANGLES]:
            return Closure((), element, turns=None)
        ends = [_first_end(compiled, angles[_ANGLES::way], closes[_ANGLES::way]) for way in (-1, 1)]
        if ends != [None, None]:
            low = -reach if ends[0] is None else ends[0]
            high = reach if ends[1] is None else ends[1]
            endless = Closure(((low, high),), element, turns=None)
        if None not in ends:
            break
        reach *= 2
    return endless


def _first_end(compiled: CompiledMachine, angles: Floats, closes: Bools) -> float | None:
    """Where a motion that starts at the first angle ends; None if it goes on to the last."""
    if closes.all():
        return None

    def least(at: Floats) -> Floats:
        gap: Floats = np.fmin.reduce(_gaps(compiled, at), axis=0)
        return gap

    first = int(np.argmin(closes))
    return float(zeros(least, angles[first - 1 : first], angles[first : first + 1])[0][0])


def _closing(compiled: CompiledMachine, gaps: Floats) -> Bools:
    """At which angles every dyad closes, (n,). Links in line leave zero, or by rounding a little less."""
    sizes = np.nan_to_num(gaps).max(axis=1, keepdims=True)
    shares = _shares(compiled, gaps, np.where(sizes > 0, sizes, 1.0))
    closes: Bools = ((shares >= -_ZERO) & (sizes > 0)).all(axis=0)
    return closes


def _passes(compiled: CompiledMachine, at: float) -> bool:
    """Whether the links go on where one touches zero: directions and rates agree before, at and after it."""
    # A group is not carried on through a change point, and its rates jump; a lever whose pin passes over its
    # pivot turns about at once.
    angles = at + np.array([-_BESIDE, 0.0, _BESIDE])
    links = [compiled.link_motion(link, angles) for link in compiled.links.values()]
    numbers = np.array([row for link in links for row in (*link.direction, link.d1)]).reshape(-1, 3)
    jumps = np.ptp(numbers, axis=1)
    return bool((jumps <= _JUMP * (1 + np.abs(numbers).max(axis=1))).all())


def require_full_turn(compiled: CompiledMachine, machine: Machine) -> None:
    """Raise an `AssemblyError` with the ranges that close and a remedy unless the crank rotates fully."""
    closed = closure_of(compiled)
    if not closed.turns_fully:
        raise closure_error(closed, machine)


def require_off_limits(compiled: CompiledMachine, machine: Machine, angle: float) -> None:
    """Raise an `AssemblyError` if a crank stands at a limit of its rotation, where its links go on."""
    closed = closure_of(compiled)
    if closed.turns_fully:
        return
    ends = np.array(closed.ranges).ravel()
    apart = np.abs((ends - angle + math.pi) % math.tau - math.pi)
    if apart.size and float(apart.min()) <= _AT_LIMIT:
        raise closure_error(closed, machine)


def require_closed(compiled: CompiledMachine, machine: Machine, angles: Floats) -> None:
    """Raise if the mechanism does not close at some crank angles, or is not determined between them."""
    if not _parts(compiled):
        return
    gaps = _gaps(compiled, angles)
    closes = (gaps >= 0).all(axis=0)
    if closes.all() and not has_levers(compiled):
        return
    at = float(angles[int(np.argmin(closes))])
    closed = closure_of(compiled)
    if closes.all():
        if _meets_change_point(closed, angles):
            raise closure_error(closed, machine)
        return
    if closed.turns_fully:
        # Less than nothing by rounding alone.
        return
    text = f"at crank angle {_deg(at)}° {_sentence(closed, machine)}"
    raise AssemblyError(text, element=closed.element, crank_angle=at)


def require_finite_rates(table: Floats, compiled: CompiledMachine, machine: Machine, angles: Floats) -> None:
    """Raise an `AssemblyError` at the very end of a range, where the rates in a table grow without limit."""
    at = np.flatnonzero(np.isinf(table).any(axis=tuple(range(table.ndim - 1))))
    if at.size:
        angle = float(angles[at[0]])
        closed = closure_of(compiled)
        why = "" if closed.turns_fully else f": {_sentence(closed, machine)}"
        text = f"at crank angle {_deg(angle)} velocities grow without limit{why}"
        raise AssemblyError(text, element=closed.element, crank_angle=angle)


def in_cycle(closed: Closure, angle: float) -> float:
    """Crank angle within the cycle or range where the mechanism stands as at `angle` [rad], if any."""
    if closed.turns is None:
        return angle
    period = 2 * np.pi * closed.turns
    if closed.turns_fully:
        return float(angle % period)
    shifted = (low + (angle - low) % period for low, _ in closed.ranges)
    within = (at for at, (_, high) in zip(shifted, closed.ranges, strict=True) if at <= high)
    return float(next(within, angle))


def has_levers(compiled: CompiledMachine) -> bool:
    """Whether there is a dyad that is not carried on through a change point: levers turn about there."""
    return any(isinstance(element, Element.SlottedLever) for element in compiled.elements)


def _meets_change_point(closed: Closure, angles: Floats) -> bool:
    """Whether a change point where the motion does not go on lies at one of the angles, or between them."""
    if closed.change_point is None or closed.turns is None:
        return False
    turns = (angles - closed.change_point) / (2 * np.pi * closed.turns)
    near = np.abs(turns - np.round(turns)) * 2 * np.pi * closed.turns < _OVER_PIVOT
    return bool(near.any() or np.ptp(np.floor(turns)) > 0)


def closure_error(closed: Closure, machine: Machine) -> AssemblyError:
    """The error of a mechanism that does not turn fully: what does not close, where, and the remedy."""
    at = closed.ranges[0][1] if closed.ranges else 0.0
    at = at if closed.turns is None else at % (2 * np.pi * closed.turns)
    return AssemblyError(_sentence(closed, machine), element=closed.element, crank_angle=at)


def is_screw(machine: Machine) -> bool:
    """Whether only screws and the like drive the machine, whose travel ends: no crank that rotates on."""
    own = machine.mechanism
    screws = [driver.per_turn for driver in own.linear_drivers.values()]
    return bool(screws) and all(screws) and not (own.cranks or own.cams or machine.pumping_unit)


def driver_word(machine: Machine) -> str:
    """What rotates at the angle φ: the crank, or the drive of a screw."""
    return "drive" if is_screw(machine) else "crank"


def _sentence(closed: Closure, machine: Machine) -> str:
    gap = compile_machine(machine).law_gap
    if gap is not None and closed.element == gap.element:
        where = " and ".join(_range(low, high, closed.turns) for low, high in closed.ranges)
        return f"the mechanism moves only at crank angles {where}: {gap}" if where else str(gap)
    if closed.change_point is not None:
        what, remedy = change_point(closed.element, machine)
        where = f"a change point at crank angle {_deg(closed.change_point)}°"
        return f"{closed.element} reaches {where}: {what}; {remedy}"
    what, remedy = describe(closed.element, machine)
    if closed.ranges and closed.turns is not None:
        short = missing_length(closed.element, machine, closed.ranges, closed.turns)
        if short:
            what, remedy = f"{what}; {short}", "shorten the stroke, or move the points of the cylinder"
    if not closed.ranges:
        return f"the mechanism does not close at any crank angle: {what}; {remedy}"
    where = " and ".join(_range(low, high, closed.turns) for low, high in closed.ranges)
    if is_screw(machine):
        return (
            f"the mechanism closes only at drive angles {where}: beyond, {what}; keep the drive within them"
        )
    return f"the mechanism closes only at crank angles {where}: beyond, {what}; {remedy}"


def _range(low: float, high: float, turns: int | None) -> str:
    """A range in degrees; one that passes a full revolution is given about 0°."""
    turn = 2 * np.pi * (turns or 1)
    back = turn if turns and high > turn * (1 + 1e-9) else 0.0
    return f"{_deg(low - back)}° to {_deg(high - back)}°"


def _deg(angle: float) -> str:
    rounded = round(float(np.degrees(angle)), 2)
    return f"{0.0 if rounded == 360.0 else rounded:.2f}"


@lru_cache(maxsize=8)
def turn_angles(n: int, turns: int = 1) -> Floats:
    """Crank angles from 0, both ends included, ``n`` ≥ 1 intervals per revolution [rad]; read-only."""
    if n < 1:
        raise InputError(f"n = {n}: expected at least 1 interval of the revolution")
    angles = np.linspace(0.0, 2 * np.pi * turns, n * turns + 1)
    angles.flags.writeable = False
    return angles
