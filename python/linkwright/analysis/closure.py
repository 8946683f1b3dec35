"""Whether a mechanism closes: at which crank angles every dyad can be assembled.

Each dyad has a radicand, (length to spare)² in a sense, that is negative where its links cannot meet: l² − h²
for a rod l at distance h from its guide, 4a²u² − (u² + a² − b²)² for a coupler a and a rocker b whose ends
are u apart. The angles where it changes sign bound the ranges in which the mechanism moves.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from linkwright.engine import Compiled, compile_machine
from linkwright.errors import AssemblyError, InputError
from linkwright.machine import Machine

Floats = NDArray[np.float64]

# A radicand below this share of its greatest is looked into: a parabola that falls to zero between two of the
# angles below is a few millionths at the nearer one.
_CLOSE = 1e-3

# A radicand below this share counts as zero: links in line to a hundred-thousandth of their length.
_ZERO = 1e-10

# Angles of a first look, and the share of its greatest above which every radicand has room to spare: one that
# falls to zero between two of these angles is a few ten-thousandths at the nearer one.
_FEW = 180
_AMPLE = 0.02

# Distance from a change point at which rates are compared [rad], and the difference, over one and their size,
# that they may have there: a rate that is smooth changes by a hundredth of this.
_BESIDE = 1e-5
_JUMP = 1e-3

# Number of a link among what the core can give the motion of.
_LINK = 1

# Angles at which closure is looked at; a gap narrower than a quarter of a degree may go unseen here, and is
# then found by the analysis that meets it.
_ANGLES = 1440


@dataclass(frozen=True)
class Closure:
    """Where a mechanism closes.

    Attributes
    ----------
    ranges : tuple of (float, float)
        Ranges of crank angle in which every element closes [rad]; one range of a full turn if it turns
        fully, none if it never closes. A range may pass 2π.
    element : str
        Name of the first element that does not close; empty if all do.
    change_point : float or None
        Crank angle at which that element closes with nothing to spare [rad]: a change point or dead centre,
        where its links are in line and their speeds are not determined.
    """

    ranges: tuple[tuple[float, float], ...]
    element: str
    change_point: float | None = None

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
    full = Closure(((0.0, 2 * np.pi),), "")
    if not compiled.dyads:
        return full
    gaps = compiled.gaps(turn_angles(_FEW))
    if (gaps.min(axis=1) > _AMPLE * gaps.max(axis=1)).all():
        return full
    angles = turn_angles(_ANGLES)[:-1]
    gaps = compiled.gaps(angles)
    # Links in line leave zero, or by rounding a little less.
    is_open = ~(gaps >= -_ZERO * np.nan_to_num(gaps).max(axis=1, keepdims=True))
    if not is_open.any():
        return _change_point(compiled, gaps) or full
    element = compiled.dyads[int(np.argmax(is_open.any(axis=1)))]
    closes = ~is_open.any(axis=0)
    starts = np.flatnonzero(closes & ~np.roll(closes, 1))
    ends = np.flatnonzero(closes & ~np.roll(closes, -1))
    ranges = []
    for start in starts:
        end = ends[np.searchsorted(ends, start) % len(ends)]
        low = _edge(compiled, angles[start], -1)
        high = _edge(compiled, angles[end], +1)
        ranges.append((float(low), float(high if high > low else high + 2 * np.pi)))
    return Closure(tuple(ranges), element)


def _change_point(compiled: Compiled, gaps: Floats) -> Closure | None:
    """The first dyad whose radicand falls to zero at some angle between those looked at; None if none does.

    There the dyad is stretched or folded: the rates of its links have no limit that the positions alone
    could tell.
    """
    sizes, lows = gaps.max(axis=1), gaps.min(axis=1)
    for dyad in np.flatnonzero(lows < _CLOSE * sizes):
        centre, reach = float(turn_angles(_ANGLES)[gaps[dyad].argmin()]), 2 * np.pi / _ANGLES
        # The radicand is a parabola there: its zero is met when its square root is, at 1e-7 of the size.
        for _ in range(6):
            angles = np.linspace(centre - reach, centre + reach, 41)
            near = compiled.gaps(angles)[dyad]
            centre, reach = float(angles[near.argmin()]), reach / 20
        at = centre % (2 * np.pi)
        if near.min() <= _ZERO * sizes[dyad] and not _passes(compiled, at):
            return Closure(((at, at + 2 * np.pi),), compiled.dyads[dyad], at)
    return None


def _passes(compiled: Compiled, at: float) -> bool:
    """Whether the links go on through a change point: their rates just before and just after it agree.

    Where the core does not carry a dyad on, its joint stays on its side and the rates jump.
    """
    angles = np.array([at - _BESIDE, at + _BESIDE])
    out = np.empty((compiled.n_rows, 4 * len(compiled.links), 2))
    compiled.motions(angles, [(_LINK, index) for index in compiled.links.values()], out.reshape(-1))
    rates = out[0, 2::4]
    jumps = np.abs(rates[:, 1] - rates[:, 0])
    return bool((jumps <= _JUMP * (1 + np.abs(rates).max(axis=1))).all())


def _edge(compiled: Compiled, inside: float, way: int) -> float:
    """The angle, within one interval of an angle inside a range, at which the range ends; by bisection."""
    good, bad = inside, inside + way * 2 * np.pi / _ANGLES
    # Fifty halvings of a quarter of a degree go beyond rounding.
    for _ in range(50):
        middle = 0.5 * (good + bad)
        if (compiled.gaps(np.array([middle])) >= 0).all():
            good = middle
        else:
            bad = middle
    return good


def require_full_turn(compiled: Compiled, machine: Machine) -> None:
    """Raise if the crank cannot turn all round.

    Raises
    ------
    AssemblyError
        Says which element does not close, where the mechanism closes, and what to change.
    """
    found = closure_of(compiled)
    if found.turns_fully:
        return
    raise AssemblyError(_sentence(found, machine), element=found.element, crank_angle=_first_open(found))


def _first_open(found: Closure) -> float:
    return found.ranges[0][1] % (2 * np.pi) if found.ranges else 0.0


def _sentence(found: Closure, machine: Machine) -> str:
    """What does not close, where, and the remedy."""
    mechanism = machine.linkage
    remedy = "change the lengths"
    what = found.element
    if found.change_point is not None:
        return (
            f"{what} reaches a change point at crank angle {_deg(found.change_point)}°: its links are in "
            "line there and the speeds are not determined; change a length by a little"
        )
    if found.element in mechanism.sliders:
        rod = mechanism.sliders[found.element].rod
        what = f"the rod of {found.element} ({rod:g} m) and its guide"
        remedy = "lengthen the rod or shorten the crank"
    elif found.element in mechanism.rockers:
        rocker = mechanism.rockers[found.element]
        what = f"coupler and rocker of {found.element} ({rocker.coupler:g} m and {rocker.rocker:g} m)"
        remedy = "shorten the crank, or change coupler and rocker until the crank can turn fully (Grashof)"
    if not found.ranges:
        return f"the mechanism does not close at any crank angle: {what} cannot reach; {remedy}"
    where = " and ".join(_range(low, high) for low, high in found.ranges)
    return f"the mechanism does not close all round: {what} can meet only at crank angles {where}; {remedy}"


def _range(low: float, high: float) -> str:
    """A range in degrees; one that passes 360° is given about 0°."""
    turn = 2 * np.pi if high > 2 * np.pi * (1 + 1e-9) else 0.0
    return f"{_deg(low - turn)}° to {_deg(high - turn)}°"


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
