r"""What a knife cuts of heads, by any law: the length that each needs, and what a shorter edge leaves.

With the middle of the edge at q along itself and p normal to itself, seen from the centre of a head (`edge`),
it crosses the chord :math:`\pm\sqrt{d^2/4 - p^2}` of the disc and cuts of it what lies within
:math:`q \pm L/2`. If the edge never retreats, each chord is crossed once, and the head needs

.. math:: L = 2\max_t\left(|q| + \sqrt{d^2/4 - p^2}\right).

A retreating edge crosses some chords again; any crossing counts.

References
----------
.. [1] Derived here.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike

from linkwright.kernel.arrays import Floats, Indices
from linkwright.kernel.errors import FindingError, InputError
from linkwright.kernel.quantities import Label
from linkwright.kernel.result import Result
from linkwright.topping.edge import Edge, barely_advances
from linkwright.topping.roots import Roots

# Stations per revolution of the law for one machine: tops between them are then distinguished to 1e-9.
FINE = 128

# Stations per revolution of the law for many heads: two tops that differ by less than 1e-6 of the head may be
# confused.
COARSE = 16

# At a large angle, the point that is reached last lies within cot α of the end of the pass: so many stations
# see it, times tan α; no more than the second for an edge that barely advances.
_ASLANT, _MOST = 4, 100_000


@dataclass(frozen=True)
class Coverage(Result):
    """What heads need, and what is left of them; arrays (n,), a head each."""

    length_needed: Annotated[
        Floats,
        Label(
            "minimum edge length for a complete cut",
            "",
            "m",
            "Zero if the cut does not meet the root.",
            over="length_needed",
        ),
    ]
    last_x: Annotated[
        Floats,
        Label("x of the point cut last", "", "m", "From the centre of the head."),
    ]
    last_y: Annotated[Floats, Label("y of the point cut last", "", "m", "Likewise.")]
    uncut_right: Annotated[
        Floats,
        Label("uncut area beyond the right end of the edge", "", "m²", "Zero without a length."),
    ]
    uncut_left: Annotated[Floats, Label("uncut area beyond the left end of the edge", "", "m²", "Likewise.")]
    uncut_between: Annotated[
        Floats,
        Label("uncut area between two passes of the edge", "", "m²", "Likewise."),
    ]

    @property
    def uncut(self) -> Annotated[Floats, Label("area that is left", "", "m²")]:
        """In all three places."""
        return self.uncut_right + self.uncut_left + self.uncut_between


def coverage(
    edge: Edge,
    diameter: ArrayLike,
    offset: ArrayLike = 0.0,
    phase: ArrayLike = 0.0,
    *,
    length: float | None = None,
    fine: int = FINE,
) -> Coverage:
    """What an edge cuts of n heads.

    `diameter`, `offset`, `phase`: array_like, shape (n,) or (1,): d of the discs [m], their centres to the
    left of the row [m], phase of the knife when the middle of the edge is abreast of the centre [rad].
    `length`: of the edge [m]; without it, only what is needed is examined. `fine`: stations per revolution
    of the law; an edge at a large angle takes more. Raises `InputError` for a negative diameter or a number
    that is not finite.
    """
    radius, place, angle = (
        np.atleast_1d(np.asarray(values, dtype=float)) for values in (diameter, offset, phase)
    )
    if not all(np.isfinite(values).all() for values in (radius, place, angle)) or (radius < 0).any():
        raise InputError("heads: found a negative diameter or a number that is not finite")
    radius = 0.5 * radius
    n = max(len(values) for values in (radius, place, angle))
    if edge.stands:
        none, discs = np.zeros(n), np.pi * np.broadcast_to(radius, n) ** 2
        return Coverage(
            np.where(discs > 0, np.inf, 0.0), none, none, none, none, discs * (length is not None)
        )
    stations = _stations(edge, fine, float(2 * radius.max()), float(np.abs(place).max()))
    heads = edge.kernel.cover(radius, place, angle, length=length, fine=stations)
    columns: tuple[Floats, ...] = (
        *(heads.length, heads.last_x, heads.last_y),
        *(heads.uncut_right, heads.uncut_left, heads.uncut_between),
    )
    # A head without a disc has no point to be cut.
    if (radius == 0).any():
        columns = tuple(np.where(radius == 0, 0.0, column) for column in columns)
    return Coverage(*columns)


def _stations(edge: Edge, fine: int, diameter: float, offset: float) -> int:
    """Stations per revolution: more at a large angle; fewer if each stretch between corners has them all."""
    leans = [edge.angle] if edge.retreats else [edge.angle, *edge.leans]
    aslant = int(min(_MOST, _ASLANT * np.abs(np.tan(leans)).max()))
    if edge.knife.corners and not edge.retreats:
        fine = max(2, int(fine / max(1.0, edge.turns(diameter, offset))))
    return max(fine, aslant)


# Progress callback, 0 to 1.
Watch = Callable[[float], None]

# Heads in a portion: some milliseconds, or a second for an edge that runs backwards.
_PORTION = 8192


@dataclass(frozen=True)
class Pass:
    """What an edge does to roots; arrays (n,), a root each."""

    # (n,): minimum length that cuts through the head [m]; infinite for a root that is missed, zero for
    # one that is lost.
    length_needed: Floats
    # (n,): share of the head that is left [–]: all of one that is missed, nothing of one that is lost. Zero
    # if no length was given.
    left: Floats


def pass_over(
    edges: Sequence[Edge],
    roots: Roots,
    *,
    length: float | None = None,
    fine: int = COARSE,
    watch: Watch | None = None,
) -> Pass:
    """Let an edge pass over roots; ``length`` [m]: without it only what is needed is examined."""
    require_advance(edges, roots)
    phase = roots.phase(edges[0].knife.rate, edges[0].forward_speed)
    diameter, missed = roots.diameter, roots.is_missed
    needed, left = np.zeros(len(phase)), np.zeros(len(phase))
    done = 0
    for edge, heads in _shared(edges, phase, diameter):
        for start in range(0, len(heads), _PORTION):
            part = heads[start : start + _PORTION]
            cut = coverage(edge, diameter[part], roots.offset[part], phase[part], length=length, fine=fine)
            needed[part] = cut.length_needed
            left[part] = np.clip(cut.uncut / (0.25 * np.pi * diameter[part] ** 2), 0.0, 1.0)
            done += len(part)
            if watch is not None:
                watch(done / len(phase))
    needed[missed] = np.inf
    if length is not None:
        left[missed] = 1.0
    return Pass(needed, left)


def require_advance(edges: Sequence[Edge], roots: Roots) -> None:
    """Refuse an edge that cannot be followed over the largest head farthest from the row."""
    largest, farthest = float(roots.diameter.max()), float(np.abs(roots.offset).max())
    for edge in edges:
        reason = barely_advances(edge, largest, farthest)
        if reason is not None:
            raise FindingError(reason)


def _shared(edges: Sequence[Edge], phase: Floats, diameter: Floats) -> list[tuple[Edge, Indices]]:
    if len(edges) == 1:
        return [(edges[0], np.flatnonzero(diameter > 0))]
    goes_left = np.cos(phase) >= 0
    sides = (goes_left, ~goes_left)
    return [(edge, np.flatnonzero(side & (diameter > 0))) for edge, side in zip(edges, sides, strict=True)]
