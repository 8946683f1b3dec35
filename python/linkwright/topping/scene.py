"""The knife of a topper over the heads of a row, to be moved by the page.

Only what the page cannot know is given: the law of the knife over its phase, the edge, and where the heads
stand. The machine goes along x; the middle of the edge is at x = v t, y = law(phase + rate t) + drift t.

The head in the middle, at x = 0, is the worst one. Where heads come in any phase, the others stand at a
distance that lets the knife meet them in other phases; where they come in one phase alone, a whole number of
strokes apart. A knife that does not turn back over a head is shown over one head: over a row it would go
away.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.machine.machine import Machine
from linkwright.topping.edge import Edge, edges_of
from linkwright.topping.head_pass import worse_edge
from linkwright.topping.model.topper import Topper
from linkwright.topping.tables.topper import shown_head
from linkwright.topping.topper import TopperStudy

Scene = dict[str, Any]

# Places of the law in one revolution of its phase: half a degree, so that ends of strokes at quarters are
# among them.
_PLACES = 720

# Minimum and maximum distance of two heads of a row, over their diameter.
_APART = 1.9, 2.6

# Where phases are free, the distance keeps so far from whole half strokes, or all heads would be met alike.
_CLEAR = 0.1

# Heads farther apart than this are not in one picture.
_FAR = 8.0

# Room before and behind the heads, over the diameter.
_ROOM = 0.6

# What is farther from the heads than this is not seen, over the diameter.
_SEEN = 8.0

# Seconds on the page for the way over one head.
_SECONDS = 2.0

# Last digit of lengths, over the diameter.
_FINE = 1e-5


def topper_scene(machine: Machine, described: Topper, study: TopperStudy) -> Scene | None:
    """All that the moving top view needs, ready for JSON."""
    if study.obstacle:
        return None
    offset, phase = shown_head(study)
    edges = edges_of(machine, described)
    edge = worse_edge(edges, study.head_diameter, offset, phase, described.edge_length)
    places = np.linspace(0.0, 2 * math.pi, (_PLACES if edge.knife.rate else 1) + 1)
    heads = _row(edge, study, described, offset)
    reach = _reach(edge, study, described)
    x = [head[0] for head in heads]
    ends = (x[0] - reach, x[-1] + reach)
    d = study.head_diameter
    return {
        "law": _rounded(edge.knife.law.at(places), _FINE * d),
        "rate": edge.knife.rate,
        "drift": edge.knife.drift,
        "phase": phase,
        "angle": described.edge_angle,
        "length": described.edge_length,
        "speed": described.forward_speed,
        "diameter": d,
        "offset": described.offset,
        "heads": [_rounded(np.array(head), _FINE * d) for head in heads],
        "span": [end / described.forward_speed for end in ends],
        "box": _box(edge, study, described, ends, x),
        "seconds": _SECONDS * len(heads),
    }


def _row(edge: Edge, study: TopperStudy, described: Topper, offset: float) -> list[tuple[float, float]]:
    delta, pitch = described.offset, _pitch(edge, study, described)
    if edge.knife.drift or pitch > _FAR * study.head_diameter:
        return [(0.0, offset)]
    other = -math.copysign(delta, offset)
    sides = [-0.5 * offset, other, offset, other, 0.5 * offset]
    return [((nth - len(sides) // 2) * pitch, y) for nth, y in enumerate(sides)]


def _pitch(edge: Edge, study: TopperStudy, described: Topper) -> float:
    d = study.head_diameter
    if not edge.knife.rate:
        return _APART[0] * d
    stroke: float = described.forward_speed / edge.knife.frequency
    if described.motion.phase is not None:
        return math.ceil(_APART[0] * d / stroke) * stroke
    for pitch in np.linspace(*_APART, 41) * d:
        halves = 2 * float(pitch) / stroke
        if abs(halves - round(halves)) > _CLEAR:
            return float(pitch)
    return _APART[0] * d


def _reach(edge: Edge, study: TopperStudy, described: Topper) -> float:
    """How far before the first head the edge starts, so that it has not met it yet."""
    half = 0.5 * study.head_diameter
    aside = 0.5 * edge.knife.stroke + described.offset
    along = half * (1 + 2 * _ROOM) + aside * abs(math.sin(described.edge_angle))
    if edge.stands:
        return 4 * half
    return float(along * edge.forward_speed / abs(edge.mean_advance))


def _box(
    edge: Edge, study: TopperStudy, described: Topper, ends: tuple[float, float], heads: list[float]
) -> list[float]:
    """Minimum x, minimum y, maximum x, maximum y of the edge over its way, and of the heads."""
    lean, across = (
        0.5 * described.edge_length * share
        for share in (abs(math.sin(described.edge_angle)), math.cos(described.edge_angle))
    )
    drifts = abs(edge.knife.drift) * ends[1] / described.forward_speed
    knife = across + 0.5 * edge.knife.stroke + drifts
    high = max(knife, 0.5 * study.head_diameter + described.offset)
    far = _SEEN * study.head_diameter
    least, greatest = max(ends[0] - lean, heads[0] - far), min(ends[1] + lean, heads[-1] + far)
    return [least, -min(high, far), greatest, min(high, far)]


def _rounded(values: Floats, fineness: float) -> list[float]:
    """Values rounded to the digits that can be seen."""
    digits = max(0, math.ceil(-math.log10(fineness)))
    return [round(float(value), digits) for value in values]
