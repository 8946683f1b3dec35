"""After how many turns of the crank a mechanism is again where it was.

A linkage of cranks and dyads repeats every turn. Gears make it repeat when all of them have come round; a dyad with an
odd number of change points, and a group, may need two turns and more.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from linkwright.analysis.closure import require_full_turn
from linkwright.engine import Compiled, compile_machine
from linkwright.errors import FindingError
from linkwright.machine import Machine

# Turns after which a mechanism counts as not periodic.
TURNS_MAX = 24

# Kinds of rows that may need more than a turn: gears, what runs along with them, continuous angles, dyads with
# change points, groups (`crates/linkwright-core/src/plan.rs`).
_SLOW = frozenset((8, 9, 10, 11, 12))

# Crank angles at which positions are compared: no simple share of the turn.
_LOOKS = np.array([0.123, 1.357, 2.718, 4.321, 5.813])

# Difference in position, over the mechanism's size, that is rounding after some turns.
_SAME = 1e-9


def period_turns(machine: Machine) -> int | None:
    """Turns of the crank after which every point and link is again where it was.

    Parameters
    ----------
    machine : Machine
        The machine.

    Returns
    -------
    int or None
        The least number up to 24; None if there is none, as with a rack on a gear that turns on and on.

    Raises
    ------
    AssemblyError
        The mechanism does not close all round.
    """
    compiled = compile_machine(machine)
    require_full_turn(compiled, machine)
    return period_of(compiled)


def period_of(compiled: Compiled) -> int | None:
    """`period_turns` of a compiled machine that closes all round."""
    if not _SLOW.intersection(row[0] for row in compiled.rows):
        return 1
    places = _places(compiled)
    off = np.abs(places[:, 1:] - places[:, :1])
    # NaN must not pass for the same.
    same = (off <= _SAME * _size(places)).all(axis=(0, 2))
    return int(np.argmax(same)) + 1 if same.any() else None


def _places(compiled: Compiled) -> np.ndarray:
    """Coordinates of points and directions of links, (numbers, turns + 1, looks)."""
    phi = (_LOOKS + 2 * np.pi * np.arange(TURNS_MAX + 1)[:, None]).ravel()
    what = [(0, point) for point in compiled.points.values()]
    what += [(1, link) for link in compiled.links.values()]
    n = 6 * len(compiled.points) + 4 * len(compiled.links)
    out = np.empty((1, n, len(phi)))
    first_row(compiled).motions(phi, what, out.reshape(-1))
    points = out[0, : 6 * len(compiled.points)].reshape(-1, 6, len(phi))[:, :2]
    links = out[0, 6 * len(compiled.points) :].reshape(-1, 4, len(phi))[:, :2]
    rows = np.concatenate([points.reshape(-1, len(phi)), links.reshape(-1, len(phi))])
    return rows.reshape(len(rows), TURNS_MAX + 1, len(_LOOKS))


def first_row(compiled: Compiled) -> Compiled:
    """The first machine of a batch, or the machine itself."""
    return replace(compiled, slots=np.empty(0, dtype=np.int32), values=np.empty((0, 1)))


def _size(places: np.ndarray) -> np.ndarray:
    """Spread of each number over the first turn, and at least that of a unit vector where it stands still."""
    spread = np.ptp(places[:, 0], axis=1)
    largest = max(float(spread.max(initial=0.0)), 1e-300)
    return np.maximum(spread, 1e-3 * largest)[:, None, None]


def require_one_turn(compiled: Compiled, machine: Machine) -> None:
    """Raise if the mechanism does not repeat after one turn of the crank.

    Raises
    ------
    FindingError
        Says after how many turns it does, and what to change.
    """
    turns = period_of(compiled)
    if turns == 1:
        return
    repeats = (
        f"does not repeat within {TURNS_MAX} turns of the crank"
        if turns is None
        else f"repeats only after {turns} turns of the crank"
    )
    raise FindingError(
        f"{machine.name} {repeats}, and masses and loads are reduced over one turn; change the ratio of its gears, "
        "or let the turning crank be one that turns once in a whole period"
    )
