r"""The head that needs the longest edge, with derivatives: where it is, and the point that is reached last.

In all phases the knife is at an end of its stroke, :math:`\dot y = 0`, where it crosses that point, at
:math:`p = s r\sin\alpha` from the centre, s = +1 for the end of the chord that lies behind along the edge
and −1 for that ahead; in one phase the point has

.. math:: s\dot q - \frac{p\dot p}{c} = 0 .

The offset is the largest on one side: for every chord one of both is worse.

References
----------
.. [1] Derived here.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.numerics.extreme import TIE, common
from linkwright.kernel.numerics.implicit import solution_along
from linkwright.kernel.numerics.tangent import Tangent, lifted, primal
from linkwright.topping.coverage import coverage
from linkwright.topping.edge import Edge
from linkwright.topping.model.topper import Topper
from linkwright.topping.topper import TopperStudy
from linkwright.topping.uncut_along import EdgeAlong, Heads, passes
from linkwright.topping.worst_head import CURVE_OFFSETS

_TURN = 2 * np.pi

# Steps of Newton's method from a place that is good to 1e-6 of the head.
_STEPS = 4

# Phases this near are the same.
_NEAR = 1e-5

# Phases that are compared.
_STATIONS = 12

_NOT_ALONE = "several heads need the same length; the one shown is arbitrary"
_ON_AXIS = "all roots stand on the row; with an offset, the worst head may lie on either side"

# Names of the place of the worst head, and why it ties.
PLACES = ("worst_phase", "worst_offset", "last_x", "last_y")
OTHER_END = (
    "the head at the other end of the stroke needs the same length; the derivative is that of the one shown"
)


@dataclass(frozen=True)
class Needs:
    """What heads need: the topper and its edges, without and with derivatives by n variables."""

    described: Topper
    topper: Topper
    edges: Sequence[Edge]
    along: Sequence[EdgeAlong]
    diameter: Any  # d of the heads [m]
    n: int


@dataclass(frozen=True)
class _Last:
    """The point of a head that is reached last: of edge, on side s, at a time, with p and half chord c."""

    nth: int
    side: float
    t: Any
    p: Any
    chord: Any
    q: Any

    @property
    def needed(self) -> Any:
        return 2 * (self.side * self.q + self.chord)


def needs_along(needs: Needs, study: TopperStudy) -> tuple[dict[str, Any], dict[str, str]]:
    """Length that the worst head needs, where it is, and the length in the best phase; those without."""
    worst, missing = _worst(needs, study)
    best = _best_phase(needs, study)
    return worst | {"length_best_phase": best}, missing


def _worst(needs: Needs, study: TopperStudy) -> tuple[dict[str, Any], dict[str, str]]:
    missing = {} if needs.described.offset else {"worst_offset": _ON_AXIS}
    offset = _at_end(needs, np.sign(study.worst_offset))
    last = _last_of(needs, study.worst_phase, study.worst_offset, study.length_exact)
    edge, along = needs.edges[last[0]], needs.along[last[0]]
    turns = bool(edge.knife.rate) and needs.described.motion.phase is None
    if turns:
        point, phase, why = _at_stroke_end(needs, along, edge, last, offset)
        if why or _apart(float(phase.value[0]), study.worst_phase) > _NEAR:
            missing["worst_phase"] = why or _NOT_ALONE
    else:
        given = needs.topper.motion.phase
        phase = _lift(study.worst_phase if given is None else given, needs.n)
        point = _in_phase(needs, last, phase, offset)
    sin, cos = np.sin(needs.topper.edge_angle), np.cos(needs.topper.edge_angle)
    reach = -point.side * point.chord
    numbers = {
        "length_exact": point.needed,
        "worst_phase": phase,
        "worst_offset": offset,
        "last_x": point.p * cos + reach * sin,
        "last_y": reach * cos - point.p * sin,
    }
    return {name: _number(number) for name, number in numbers.items()}, missing


def _number(x: Any) -> Any:
    """One number with derivatives, of an array of one or none."""
    return x.reshape(-1)[0] if hasattr(x, "reshape") else x


def _lift(number: Any, n: int) -> Any:
    """A number as an array of one, with derivatives."""
    return lifted(np.zeros(1), n) + number


def _apart(one: float, other: float) -> float:
    return float(abs((one - other + np.pi) % _TURN - np.pi))


def _at_end(needs: Needs, side: float) -> Any:
    return _lift(needs.topper.offset * float(side), needs.n)


def _last_of(needs: Needs, phase: float, offset: float, length: float) -> tuple[int, float, float]:
    """Edge, side s and place p of the point of a head that is reached last."""
    d = float(primal(needs.diameter))
    cuts = [coverage(edge, d, offset, phase) for edge in needs.edges]
    nth = int(np.argmin([abs(cut.length_needed[0] - length) for cut in cuts]))
    x, y, alpha = cuts[nth].last_x[0], cuts[nth].last_y[0], needs.described.edge_angle
    side = -1.0 if x * np.sin(alpha) + y * np.cos(alpha) >= 0 else 1.0
    return nth, side, float(x * np.cos(alpha) - y * np.sin(alpha))


def _at_stroke_end(
    needs: Needs, along: EdgeAlong, edge: Edge, last: tuple[int, float, float], offset: Any
) -> tuple[_Last, Any, str]:
    """The point that is reached last at an end of the stroke, and the phase of its head."""
    nth, side, _ = last
    alpha, v, r = _lift(along.edge.angle, needs.n), along.edge.forward_speed, _lift(along.radius, needs.n)
    sin, cos = np.sin(alpha), np.cos(alpha)
    law, fixed = along.edge.knife.law, edge.knife.law
    extreme = fixed.extremes()[1 if side > 0 else 0]
    y = _lift(law.extremes()[1 if side > 0 else 0].value, needs.n)
    p, chord = side * r * sin, r * cos
    t = (p + (y - offset) * sin) / (v * cos)
    q = t * v * sin + (y - offset) * cos
    psi, why = _turning(along, edge, extreme.at, needs.n)
    return _Last(nth, side, t, p, chord, q), psi - t * along.edge.knife.rate, why


def _turning(along: EdgeAlong, edge: Edge, at: float, n: int) -> tuple[Any, str]:
    """The phase at which the knife turns back, by y′ = 0; at a corner along with it."""
    psi, law, fixed = _lift(at, n), along.edge.knife.law, edge.knife.law
    joints = [k for k, x in enumerate(fixed.breaks) if abs(x - at) < _NEAR]
    if joints and abs(float(fixed.value(at, 1))) > _NEAR * abs(fixed.peak(1).value):
        return _lift(law.breaks[joints[0]], n), ""
    bend = float(fixed.value(at, 2))
    if abs(bend) <= _NEAR * abs(fixed.peak(2).value):
        return psi, _NOT_ALONE
    slope = law.value(at, 1)
    return solution_along(at, _lift(slope, n), bend), ""


def _in_phase(needs: Needs, last: tuple[int, float, float], phase: Any, offset: Any) -> _Last:
    nth, side, p0 = last
    edge, along = needs.edges[nth], needs.along[nth]
    r = float(primal(along.radius))
    head = Heads(r, offset.value, phase.value)
    t = passes(edge, head, float(np.clip(p0, -r * (1 - 1e-12), r * (1 - 1e-12))))
    corner = _corner_time(edge, along, phase, t)
    if corner is not None:
        time = corner
    else:
        for _ in range(_STEPS):
            slope, bend = _climb(edge, head, side, t)
            t = t - slope / bend
        # How the condition moves at a fixed time: worked out in tangents.
        moved = _condition(along, side, lifted(t, needs.n), phase, offset, _lift(along.radius, needs.n))
        time = solution_along(t, moved, _climb(edge, head, side, t)[1])
    q, p = along.edge.place(time, phase, offset)
    radius = _lift(along.radius, needs.n)
    return _Last(nth, side, time, p, np.sqrt(radius * radius - p * p), q)


def _corner_time(edge: Edge, along: EdgeAlong, phase: Any, t: Floats) -> Any:
    """The time of the corner of the law that a time is at; None if it is at none."""
    knife = edge.knife
    if not knife.rate:
        return None
    psi = float(phase.value[0] + knife.rate * t[0])
    for corner in knife.corners:
        if _apart(psi, corner) < _NEAR:
            k = int(np.argmin(np.abs(np.array(knife.law.breaks) - corner)))
            turns = round((psi - corner) / _TURN)
            return (along.edge.knife.law.breaks[k] + _TURN * turns - phase) / along.edge.knife.rate
    return None


def _climb(edge: Edge, head: Heads, side: float, t: Floats) -> tuple[Floats, Floats]:
    p = edge.place(t, head.phase, head.offset)[1]
    qt, pt = edge.velocity(t, head.phase)
    bend = edge.knife.at(t, head.phase, 2)
    qtt, ptt = bend * np.cos(edge.angle), -bend * np.sin(edge.angle)
    chord = np.sqrt(head.radius**2 - p**2)
    lean = p * pt / chord
    return side * qt - lean, side * qtt - (pt**2 + p * ptt + lean**2) / chord


def _condition(along: EdgeAlong, side: float, t: Any, phase: Any, offset: Any, radius: Any) -> Any:
    """s q̇ − p ṗ/c with derivatives, at fixed times."""
    p = along.edge.place(t, phase, offset)[1]
    qt, pt = along.edge.velocity(t, phase)
    return side * qt - p * pt / np.sqrt(radius * radius - p * p)


def _best_phase(needs: Needs, study: TopperStudy) -> Any:
    """Length that the worst of the offsets needs in the best phase; of several as bad if they agree."""
    offset, d = needs.described.offset, needs.diameter
    shares = np.linspace(-1.0, 1.0, CURVE_OFFSETS if offset else 1)
    best = study.length_best_phase
    points = []
    for station in study.phase[study.length_by_phase <= best * (1 + TIE)][:_STATIONS].tolist():
        length = [
            coverage(edge, float(primal(d)), shares * offset, station).length_needed for edge in needs.edges
        ]
        for nth, k in np.argwhere(np.array(length) >= best * (1 - TIE)).tolist():
            share = float(shares[k]) if offset else 0.0
            one = replace(needs, edges=[needs.edges[nth]])
            last = _last_of(one, station, share * offset, length[nth][k])
            place = _at_end(needs, share)
            points.append(_in_phase(needs, (nth, *last[1:]), _lift(station, needs.n), place).needed)
    d_of = np.array([_number(x).d for x in points])
    return Tangent(best, common(d_of))
