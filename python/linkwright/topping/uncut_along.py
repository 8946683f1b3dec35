r"""Derivatives of the area that an edge leaves of heads, if it never retreats.

With s = +1 for the end of the chord that lies behind along the edge and −1 for that ahead, what is left is

.. math:: A = \sum_s \int \bigl([s q + c - h]_+ - [s q - c - h]_+\bigr)\,\mathrm dp,
    \qquad c = \sqrt{r^2 - p^2},

h half of the edge's length, q and p as in `edge`. What is integrated is zero where it begins and ends, so
that a number μ moves the integral by that of the derivative at fixed p alone, and over the time all of them
are known in closed form: with [·] the sum over ends less that over starts of the times in which a bracket is
positive,

.. math:: \int (\partial_\mu q\,\dot p - \partial_\mu p\,\dot q)\,\mathrm dt =
    v \int \partial_\mu y\,\mathrm dt, \quad -[t y] + \int y\,\mathrm dt, \quad
    \tfrac12 [p^2 + q^2], \quad -v [t]

for a number of the law, the speed v, the angle α and the offset δ; :math:`\pm r [\arcsin p/r]` for the
radius and :math:`-[p]` for h.

References
----------
.. [1] Derived here; O. Reynolds' transport theorem.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.kernel.arrays import Bools, Floats, Indices
from linkwright.kernel.numerics.implicit import solution_along
from linkwright.kernel.numerics.tangent import Tangent, lifted
from linkwright.kernel.numerics.zeros import brackets, zeros
from linkwright.topping.edge import Edge

_TURN = 2 * np.pi

# Places of a pass at which the ends of the edge are examined: what enters and leaves between two of them is
# some 1e-5 of a head.
_PLACES = 160

# What the ends of a pass are sought beyond, as a share of the radius: rounding.
_SPARE = 1e-9


@dataclass(frozen=True)
class Heads:
    """Heads, (n,) each: radius r [m], offset δ [m], phase θ [rad]."""

    radius: float
    offset: Any
    phase: Any


@dataclass(frozen=True)
class Ends:
    """Ends of the times in which brackets are positive, (k,) each."""

    head: Indices
    time: Floats  # [s]
    p: Floats  # [m]
    q: Floats  # [m]
    sign: Floats  # +1 where a bracket ends to be positive, −1 where it begins
    side: Floats  # s: +1 behind along the edge, on its right, −1 ahead
    chord: Floats  # +1 for s q + c − h, −1 for s q − c − h, which is subtracted
    is_rim: Bools  # at the rim of the head, else where the bracket is zero


def exposed(edge: Edge, heads: Heads, half: float) -> Ends:
    """Ends of the times in which chords reach beyond an edge of some half length [m]."""
    enter, leave = (passes(edge, heads, level) for level in (-heads.radius, heads.radius))
    middle, width = 0.5 * (enter + leave), 0.5 * (leave - enter)
    u = np.linspace(-0.5 * np.pi, 0.5 * np.pi, _PLACES)
    parts = []
    for side in (1.0, -1.0):
        for chord in (1.0, -1.0):

            def beyond(at: Floats, head: Any, side: float = side, chord: float = chord) -> Floats:
                t = middle[head] + width[head] * np.sin(at)
                q, p = edge.place(t, heads.phase[head], heads.offset[head])
                rest = np.sqrt(np.clip(heads.radius**2 - p**2, 0.0, None))
                return np.asarray(side * q + chord * rest - half)

            parts += _ends(beyond, len(middle), u, side, chord)
    head, at, sign, side_of, chord_of, is_rim = (np.concatenate(part) for part in zip(*parts, strict=True))
    time = middle[head] + width[head] * np.sin(at)
    q, p = edge.place(time, heads.phase[head], heads.offset[head])
    return Ends(head, time, np.clip(p, -heads.radius, heads.radius), q, sign, side_of, chord_of, is_rim)


def _ends(
    beyond: Callable[[Floats, Any], Floats], n: int, u: Floats, side: float, chord: float
) -> list[tuple[Any, ...]]:
    """Ends of one bracket, (k,) each: those at the rim, then its zeros."""
    every = np.arange(n)
    values = beyond(u[None, :], every[:, None])
    parts: list[tuple[Any, ...]] = []
    for place, sign in ((0, -1.0), (-1, 1.0)):
        at_rim = np.flatnonzero(values[:, place] >= 0)
        parts.append((at_rim, np.full(len(at_rim), u[place]), sign, True))
    head, before = brackets(values)
    if len(head):
        zero = zeros(lambda x: beyond(x, head), u[before], u[before + 1])[0]
        parts.append((head, zero, np.where(values[head, before] < 0, -1.0, 1.0), False))
    return [
        (head, at, *(np.broadcast_to(x, at.shape) for x in (sign, side, chord, is_rim)))
        for head, at, sign, is_rim in parts
    ]


def passes(edge: Edge, heads: Heads, level: float) -> Floats:
    """When the edge comes to a level p of heads, (n,) [s]; it never retreats."""
    sin = np.sin(edge.angle)
    reach = max(abs(extreme.value) for extreme in edge.knife.law.extremes())
    middle = (level - heads.offset * sin) / edge.mean_advance
    spare = (abs(reach * sin) + _SPARE * heads.radius) / edge.mean_advance

    def missing(t: Floats) -> Floats:
        return np.asarray(edge.place(t, heads.phase, heads.offset)[1] - level)

    return zeros(missing, middle - spare, middle + spare)[0]


@dataclass(frozen=True)
class EdgeAlong:
    """An edge over heads, with derivatives by n variables: half length h and radius r [m]."""

    n: int
    edge: Edge
    half: Any
    radius: Any


def uncut_slopes(edge: Edge, along: EdgeAlong, heads: Heads, ends: Ends, moved: Heads) -> Floats:
    """Derivatives of the area that is left on the right and on the left, (n, 2, variables).

    `moved`: the heads with derivatives of offset and phase.
    """
    n, side = len(heads.phase), (ends.side < 0).astype(int)
    weight = ends.sign * ends.chord
    total: Any = 0.0
    for term, d in _terms(edge, along, heads, ends, moved):
        sums = np.zeros((n, 2, *np.shape(term)[1:]))
        np.add.at(sums, (ends.head, side), (weight * term.T).T)
        total = total + (sums * d if sums.ndim == 3 else sums[..., None] * d)
    return np.asarray(total)


def _terms(edge: Edge, along: EdgeAlong, heads: Heads, ends: Ends, moved: Heads) -> list[tuple[Floats, Any]]:
    """What each number gives at the ends, (k,) or by variable (k, variables), and its derivatives."""
    v, s, t, r = edge.forward_speed, ends.side, ends.time, heads.radius
    knife = edge.knife
    psi = heads.phase[ends.head] + knife.rate * t
    law = knife.law.at(np.mod(psi, _TURN))
    way = _way(knife.law, psi) / knife.rate if knife.rate else law * t
    aside = v * law / knife.rate if knife.rate else v * knife.law.at(np.mod(psi, _TURN), 1) * t
    lag = (
        v * (t * law - way) / knife.rate
        if knife.rate
        else 0.5 * v * knife.law.at(np.mod(psi, _TURN), 1) * t**2
    )
    d: Any = slopes
    return [
        (ends.chord * r * np.arcsin(np.clip(ends.p / r, -1.0, 1.0)), d(along.radius)),
        (-ends.p, d(along.half)),
        (0.5 * s * (ends.p**2 + ends.q**2), d(along.edge.angle)),
        (s * (way - t * law - 0.5 * knife.drift * t**2), d(along.edge.forward_speed)),
        (s * lag, d(along.edge.knife.rate)),
        (0.5 * s * v * t**2, d(along.edge.knife.drift)),
        (-s * v * t, moved.offset.d[:, None]),
        (s * aside, moved.phase.d[:, None]),
        ((s * v * _law_way(along.edge.knife.law, knife.rate, psi, t).T).T, 1.0),
    ]


def slopes(number: Any) -> Any:
    """Derivatives of a number; zero if it has none."""
    return number.d if isinstance(number, Tangent) else 0.0


def _way(law: MotionLaw, psi: Floats) -> Any:
    """Integral of a law over its phase from zero, over as many revolutions as there are."""
    rising = law.integral()
    turns = np.floor(psi / _TURN)
    within, turn = rising.at(psi - _TURN * turns), rising.value(law.end, 0, "before")
    return within + turns * (turn if law.variables is None else lifted(turn, law.variables))


def _law_way(law: MotionLaw, rate: float, psi: Floats, t: Floats) -> Floats:
    """Derivatives of the integral of a law over the time, (k, variables), at a fixed phase and rate."""
    if law.variables is None:
        return np.zeros((len(t), 1))
    if not rate:
        return np.asarray(law.at(np.mod(psi, _TURN)).d * t[:, None])
    return np.asarray(_way(law, psi).d / rate)


def end_times(edge: Edge, along: EdgeAlong, heads: Heads, ends: Ends, moved: Heads) -> Any:
    """The times of the ends with their derivatives, (k,): those of p = ±r, or of a bracket that is zero."""
    t, r, at_rim = ends.time, along.radius, ends.is_rim
    qt, pt = edge.velocity(t, heads.phase[ends.head])
    q, p = along.edge.place(lifted(t, along.n), moved.phase[ends.head], moved.offset[ends.head])
    with np.errstate(divide="ignore", invalid="ignore"):
        rest = np.sqrt(r * r - p * p)
        bracket = ends.side * q + ends.chord * rest - along.half
        rate = ends.side * qt - ends.chord * (p.value / rest.value) * pt
        residual = np.where(at_rim, p - np.sign(ends.p) * r, bracket)
    return solution_along(t, residual, np.where(at_rim, pt, rate))
