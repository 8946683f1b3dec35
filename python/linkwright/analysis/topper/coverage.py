r"""What a knife cuts of heads, by any law: the length that each needs, and what a shorter edge leaves.

Seen from the centre of a head, δ to the left of the row, the middle of the edge is at

.. math:: q = v t \sin\alpha + (y - \delta)\cos\alpha, \qquad p = v t \cos\alpha - (y - \delta)\sin\alpha

along the edge and normal to it. It moves parallel to itself, so at p it crosses the chord
:math:`\pm\sqrt{d^2/4 - p^2}` of the disc and cuts of it what lies within :math:`q \pm L/2`. If the edge never
retreats, :math:`v\cos\alpha > \dot y\sin\alpha`, each chord is crossed once, and the head needs

.. math:: L = 2\max_t\left(|q| + \sqrt{d^2/4 - p^2}\right).

A retreating edge crosses some chords again; any crossing counts.

If phases come as they may and the edge never retreats, at some head the knife is at one end of its stroke S
just as it crosses the point farthest to the other side: then :math:`L = (S + d + 2\Delta)/\cos\alpha`.

References
----------
.. [1] Derived here.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from linkwright.analysis.result import Result
from linkwright.analysis.topper.knife import Knife
from linkwright.engine.topper import KnifeKernel
from linkwright.errors import InputError

Floats = NDArray[np.float64]

# Stations a turn of the law for one machine: tops between them are then told apart to 1e-9.
FINE = 128

# Stations a turn of the law for many heads: two tops that differ by less than 1e-6 of the head may be
# confused.
COARSE = 16

# Far aslant, the point that is reached last lies within cot α of the end of the pass: so many stations see
# it, times tan α; no more than the second for an edge that hardly goes on.
_ASLANT, _MOST = 4, 100_000

# Turns of the law over a head that are followed: for an edge that retreats the work grows with their square,
# for any other the core runs out of stations.
_TURNS, _TURNS_RETREATING = 60, 8

# First look at the worst head: phases, and offsets.
_PHASES, _OFFSETS = 360, 5

# Then the look narrows: places to either side of the best, rounds, and by how much in each.
_BESIDE, _ROUNDS = 4, 20

# Of edges that retreat, which take some thousand times as long, so many times fewer heads are looked at, and
# places are narrowed to 1e-6.
SPARING = 4


@dataclass(frozen=True)
class Coverage(Result):
    """What heads need, and what is left of them; arrays (n,), a head each.

    Attributes
    ----------
    length_needed : ndarray
        Least length of the edge that cuts all of the head [m]; zero for a head without a disc.
    last_x, last_y : ndarray
        The point that is reached last, from the centre of the head [m].
    uncut_right, uncut_left, uncut_between : ndarray
        Area that is left on the right of the edge, on its left, and between two passes of it [m²]; zero
        without a length.
    """

    length_needed: Floats
    last_x: Floats
    last_y: Floats
    uncut_right: Floats
    uncut_left: Floats
    uncut_between: Floats

    @property
    def uncut(self) -> Floats:
        """Area that is left [m²]."""
        return self.uncut_right + self.uncut_left + self.uncut_between


@dataclass(frozen=True)
class Edge:
    """An edge that goes over heads.

    Attributes
    ----------
    knife : Knife
        How it goes across the row.
    angle : float
        α [rad], |α| < π/2.
    forward_speed : float
        v > 0 [m/s].
    """

    knife: Knife
    angle: float
    forward_speed: float

    @cached_property
    def kernel(self) -> KnifeKernel:
        """The edge in the core's terms."""
        return KnifeKernel(self.knife.way, self.angle, self.forward_speed)

    @property
    def least_advance(self) -> float:
        """Least speed of the edge along its normal [m/s]; zero or less where it retreats."""
        worst = max(speed * np.sin(self.angle) for speed in self.knife.speeds)
        return float(self.forward_speed * np.cos(self.angle) - worst)

    @property
    def retreats(self) -> bool:
        """Whether it runs backwards at times."""
        return self.least_advance <= 0

    @property
    def stands(self) -> bool:
        """Whether it moves along itself for ever, and cuts nothing."""
        mean = self.forward_speed * np.cos(self.angle) - self.knife.drift * np.sin(self.angle)
        return bool(abs(mean) <= 4e-16 * np.hypot(self.forward_speed, self.knife.drift))

    def turns(self, diameter: float, offset: float) -> float:
        """Turns of the law while the edge may be over a head up to the offset from the row."""
        swing = (0.5 * self.knife.stroke + offset) * abs(np.sin(self.angle))
        mean = self.forward_speed * np.cos(self.angle) - self.knife.drift * np.sin(self.angle)
        return float(self.knife.frequency * (diameter + 2 * swing) / abs(mean)) if self.knife.rate else 0.0


def hardly_goes_on(edge: Edge, diameter: float, offset: float) -> str | None:
    """Why an edge cannot be followed: its knife goes to and fro over a head again and again.

    Parameters
    ----------
    edge : Edge
        The edge.
    diameter, offset : float
        d and Δ [m].

    Returns
    -------
    str or None
        A sentence with its numbers; None for an edge that can be followed.
    """
    turns, most = edge.turns(diameter, offset), _TURNS_RETREATING if edge.retreats else _TURNS
    if turns <= most:
        return None
    way = "Set it less aslant" if edge.retreats else "Give it a longer stroke"
    return (
        f"The edge hardly goes on: the knife goes {turns:.3g} times to and fro while it is over one head, "
        f"and is followed for {most}; what it cuts is not computed. {way}, or move the knife more slowly."
    )


def coverage(
    edge: Edge,
    diameter: ArrayLike,
    offset: ArrayLike = 0.0,
    phase: ArrayLike = 0.0,
    *,
    length: float | None = None,
    fine: int = FINE,
) -> Coverage:
    """What an edge cuts of heads.

    Parameters
    ----------
    edge : Edge
        The edge.
    diameter, offset, phase : array_like, shape (n,) or (1,)
        d of the discs [m], their centres to the left of the row [m], phase of the knife when the middle of
        the edge is abreast of the centre [rad]; one, or one a head.
    length : float, optional
        Of the edge [m]; without it, only what is needed is looked at.
    fine : int
        Stations a turn of the law; an edge far aslant takes more.

    Returns
    -------
    Coverage
        Arrays, a head each.

    Raises
    ------
    InputError
        A diameter is negative, a number is not finite.
    """
    radius, place, angle = (
        np.atleast_1d(np.asarray(each, dtype=float)) for each in (diameter, offset, phase)
    )
    if not all(np.isfinite(each).all() for each in (radius, place, angle)) or (radius < 0).any():
        raise InputError("heads: found a negative diameter or a number that is not finite")
    radius = 0.5 * radius
    n = max(len(each) for each in (radius, place, angle))
    discs = np.pi * np.broadcast_to(radius, n) ** 2
    if edge.stands:
        none = np.zeros(n)
        return Coverage(
            np.where(discs > 0, np.inf, 0.0), none, none, none, none, discs * (length is not None)
        )
    stations = _stations(edge, fine, float(2 * radius.max()), float(np.abs(place).max()))
    table = edge.kernel.cover(radius, place, angle, length=length, fine=stations).T
    # A head without a disc has no point to be cut.
    table[:, discs == 0] = 0.0
    return Coverage(*table)


def _stations(edge: Edge, fine: int, diameter: float, offset: float) -> int:
    """Stations a turn: more far aslant; fewer if each stretch between corners has them all."""
    aslant = min(_MOST, int(_ASLANT * abs(np.tan(edge.angle))))
    if edge.knife.corners and not edge.retreats:
        fine = max(2, int(fine / max(1.0, edge.turns(diameter, offset))))
    return max(fine, aslant)


@dataclass(frozen=True)
class Worst:
    """The worst of many heads.

    Attributes
    ----------
    value : float
        What is greatest there.
    phase, offset : float
        Of that head [rad, m].
    edge : Edge
        The edge, of one or two directions.
    """

    value: float
    phase: float
    offset: float
    edge: Edge


def worst_head(
    edges: Sequence[Edge],
    diameter: float,
    offset: float,
    phase: float | None,
    measure: Callable[[Edge, Floats, Floats], Floats],
) -> Worst:
    """The head at which something is greatest, over offsets up to Δ on both sides and over all phases.

    Parameters
    ----------
    edges : sequence of Edge
        One edge, or its two directions.
    diameter : float
        d [m].
    offset : float
        Δ [m].
    phase : float or None
        The only phase [rad]; None for all.
    measure : callable
        Edge, offsets and phases (n,) → what is looked at, (n,).

    Returns
    -------
    Worst
        Value and place.

    Notes
    -----
    A look at many heads, then a look about the best of them that narrows fourfold each round: tops may be
    smooth or edges.
    """
    found = [_worst(edge, offset, phase, measure) for edge in edges]
    return max(found, key=lambda each: each.value)


def _worst(
    edge: Edge, offset: float, phase: float | None, measure: Callable[[Edge, Floats, Floats], Floats]
) -> Worst:
    n, rounds = (_PHASES // SPARING, _ROUNDS // 2) if edge.retreats else (_PHASES, _ROUNDS)
    every: Floats = np.linspace(0.0, 2 * np.pi, n if edge.knife.rate else 1, endpoint=False)
    phases = every if phase is None else np.array([phase], dtype=np.float64)
    offsets: Floats = np.asarray(np.linspace(-offset, offset, _OFFSETS if offset else 1))
    wide = [np.pi / n if len(phases) > 1 else 0.0, offset / (_OFFSETS - 1)]
    best = _best(edge, phases, offsets, measure)
    for _ in range(rounds):
        share = np.arange(-_BESIDE, _BESIDE + 1) / _BESIDE
        phases = best.phase + 2 * wide[0] * share if wide[0] else np.array([best.phase])
        offsets = np.clip(best.offset + 2 * wide[1] * share, -offset, offset) if wide[1] else np.zeros(1)
        best = max(best, _best(edge, phases, offsets, measure), key=lambda each: each.value)
        wide = [0.25 * each for each in wide]
    return Worst(best.value, float(np.mod(best.phase, 2 * np.pi)), best.offset, edge)


def _best(
    edge: Edge, phases: Floats, offsets: Floats, measure: Callable[[Edge, Floats, Floats], Floats]
) -> Worst:
    """The greatest of a grid."""
    phi, delta = (each.ravel() for each in np.meshgrid(phases, offsets, indexing="ij"))
    values = measure(edge, delta, phi)
    at = int(np.argmax(values))
    return Worst(float(values[at]), float(phi[at]), float(delta[at]), edge)
