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
from linkwright.errors import AssemblyError
from linkwright.machine import Machine

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
    """

    ranges: tuple[tuple[float, float], ...]
    element: str

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
    angles = turn_angles(_ANGLES)[:-1]
    gaps = compiled.gaps(angles)
    is_open = ~(gaps >= 0)
    if not is_open.any():
        return full
    element = compiled.dyads[int(np.argmax(is_open.any(axis=1)))]
    closes = ~is_open.any(axis=0)
    starts = np.flatnonzero(closes & ~np.roll(closes, 1))
    ends = np.flatnonzero(closes & ~np.roll(closes, -1))
    ranges = []
    for start in starts:
        end = ends[np.searchsorted(ends, start) % len(ends)]
        low = _edge(compiled, angles[start], -1)
        high = _edge(compiled, angles[end], +1)
        ranges.append((low, high if high > low else high + 2 * np.pi))
    return Closure(tuple(ranges), element)


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
    mechanism = machine.mechanism
    remedy = "change the lengths"
    what = found.element
    if found.element in mechanism.sliders:
        rod = mechanism.sliders[found.element].rod
        what = f"the rod of {found.element} ({rod:g} m)"
        remedy = "lengthen the rod or shorten the crank"
    elif found.element in mechanism.rockers:
        rocker = mechanism.rockers[found.element]
        what = f"coupler and rocker of {found.element} ({rocker.coupler:g} m and {rocker.rocker:g} m)"
        remedy = "shorten the crank, or change coupler and rocker until the crank can turn fully (Grashof)"
    if not found.ranges:
        return f"the mechanism does not close at any crank angle: {what} cannot reach; {remedy}"
    where = " and ".join(f"{_deg(low)}° to {_deg(high)}°" for low, high in found.ranges)
    return f"the mechanism does not close all round: {what} closes only for crank angles {where}; {remedy}"


def _deg(angle: float) -> str:
    return f"{np.degrees(angle):.2f}"


@lru_cache(maxsize=8)
def turn_angles(n: int) -> NDArray[np.float64]:
    """Crank angles from 0 to 2π inclusive, ``n`` intervals [rad]; shared by results, so read-only."""
    angles = np.linspace(0.0, 2 * np.pi, n + 1)
    angles.flags.writeable = False
    return angles
