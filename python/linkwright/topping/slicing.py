r"""How the edge slices: draw-cut ratio, cutting speed, and which part of the edge cuts how much.

All points of the edge move alike, with u_t along it and u_n normal to it (`edge`). The draw-cut ratio is

.. math:: \frac{|u_t|}{u_n} = |\tan(\alpha + \beta)|, \qquad \tan\beta = \dot y/v.

Heads meet the knife in all phases; a chord of a head is swept the faster the greater u_n, so that over what
is cut the mean of the ratio is :math:`\langle|u_t|\rangle/\langle u_n\rangle` with means over the time, and
:math:`\langle u_n\rangle = v\cos\alpha` for a knife that turns back.

References
----------
.. [1] V. P. Goryachkin, *Collected Works*, theory of cutting with sliding: the ratio of tangential to normal
   speed. The mean over heads is derived here.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.kernel.arrays import Floats
from linkwright.kernel.numerics.extreme import greatest, least, size
from linkwright.kernel.numerics.tangent import primal
from linkwright.topping.edge import Edge

# Times of a pass and places of the edge at which its use is counted.
_TIMES, _PLACES = 400, 201

# Phases and offsets of heads over which the use of the edge is averaged; without a stroke, offsets alone.
_HEADS, _OFFSETS, _OFFSETS_ALONE = 72, 6, 240


@dataclass(frozen=True)
class Slicing:
    """How an edge slices, heads in all phases.

    Attributes
    ----------
    ratio_min, ratio_mean, ratio_max : float
        Draw-cut ratio [–]; the maximum is infinite where the edge retreats.
    speed_min, speed_max : float
        Speed of the edge against the head [m/s].
    """

    ratio_min: Any
    ratio_mean: Any
    ratio_max: Any
    speed_min: Any
    speed_max: Any


def slicing(edges: Sequence[Edge]) -> Slicing:
    """Extremes and mean of draw-cut ratio and cutting speed of an edge, half of the time each way."""
    slow, fast = zip(*(_speeds(edge) for edge in edges), strict=True)
    low, high = zip(*(_ratios(edge) for edge in edges), strict=True)
    along, normal = (sum(mean_sizes(edge)[k] for edge in edges) for k in (0, 1))
    # An edge that moves along itself has no speed normal to it.
    mean = np.inf if any(edge.stands for edge in edges) else along / normal
    return Slicing(least(*low), mean, greatest(*high), least(*slow), greatest(*fast))


def mean_sizes(edge: Edge) -> tuple[Any, Any]:
    """Mean size of the speed along the edge and of that normal to it, over the time [m/s]."""
    knife, v, sin, cos = edge.knife, edge.forward_speed, np.sin(edge.angle), np.cos(edge.angle)
    along = mean_size(knife.law, v * sin + knife.drift * cos, knife.rate * cos)
    return along, mean_size(knife.law, v * cos - knife.drift * sin, -knife.rate * sin)


def mean_size(law: MotionLaw, level: Any, slope: Any) -> Any:
    """Mean of |level + slope y′| over the law y, between the zeros of what is in the bars."""
    fixed = law.primal
    speeds = fixed.derivative().scaled(float(primal(slope)), float(primal(level)))
    cuts = np.array(sorted({*fixed.breaks, *speeds.zeros()}))
    low, high = cuts[:-1], cuts[1:]
    ways = level * (high - low) + slope * (law.at(high, 0, "before") - law.at(low))
    return (ways * np.sign(speeds.at(0.5 * (low + high)))).sum() / fixed.length


def slicing_over_phase(edge: Edge, phases: Floats) -> tuple[Floats, Floats]:
    """Draw-cut ratio and cutting speed in each phase of the knife.

    ``phases`` (n,): [rad] → ratio, speed: [–], NaN where the edge retreats; speed against the head [m/s],
    (n,).
    """
    along, normal = edge.velocity(0.0, phases)
    ahead = np.where(normal > 0, normal, np.nan)
    return np.abs(along) / ahead, np.hypot(along, normal)


def _ratios(edge: Edge) -> tuple[Any, Any]:
    leans = edge.leans
    reaches = [size(np.tan(lean)) for lean in leans]
    low = 0.0 if primal(leans[0]) * primal(leans[1]) <= 0 else least(*reaches)
    return low, np.inf if edge.retreats else greatest(*reaches)


def _speeds(edge: Edge) -> tuple[Any, Any]:
    low, high = edge.knife.speeds
    sizes = size(low), size(high)
    slowest = 0.0 if low <= 0 <= high else least(*sizes)
    slow, fast = (np.hypot(edge.forward_speed, speed) for speed in (slowest, greatest(*sizes)))
    return slow, fast


def edge_use(edges: Sequence[Edge], diameter: float, offset: float) -> tuple[Floats, Floats]:
    """How much of a head each place of the edge cuts, on average, at d and Δ [m]: place and width, (n,) each.

    Position along the edge from its middle [m], and the way that it goes, normal to the edge, through a head
    [m]: its integral over all places is the area of the head, but for an edge that retreats. Offsets and
    phases are taken evenly, directions alike.
    """
    places, widths = zip(*(_use(edge, diameter, offset) for edge in edges), strict=True)
    reach = max(float(place[-1]) for place in places)
    place = np.linspace(-reach, reach, _PLACES)
    return place, np.mean(
        [np.interp(place, at, width) for at, width in zip(places, widths, strict=True)], axis=0
    )


def _use(edge: Edge, diameter: float, offset: float) -> tuple[Floats, Floats]:
    if edge.stands:
        return np.array([-0.5, 0.5]) * diameter, np.zeros(2)
    knife, radius = edge.knife, 0.5 * diameter
    heads, offsets = (_HEADS, _OFFSETS) if knife.rate else (1, _OFFSETS_ALONE)
    # Amid even steps, so that all count alike.
    phase = (np.arange(heads) + 0.5)[:, None, None] * (2 * np.pi / heads)
    delta = offset * ((2 * np.arange(offsets) + 1) / offsets - 1)[:, None]
    end = edge.half_pass(diameter, offset)
    step = 2 * end / _TIMES
    t = -end + (np.arange(_TIMES) + 0.5) * step
    q, p = edge.place(t, phase, delta)
    pace = np.abs(edge.velocity(t, phase)[1]) * step / (heads * offsets)
    chord = np.sqrt(np.clip(radius**2 - p**2, 0.0, None))
    reach = float((np.abs(q) + chord)[chord > 0].max(initial=radius))
    place = np.linspace(-reach, reach, _PLACES)
    # Each chord adds its speed to the places between its ends.
    weight = np.broadcast_to(pace, chord.shape)[chord > 0]
    bounds = [np.searchsorted(place, (sign * chord - q)[chord > 0]) for sign in (-1, 1)]
    ends = [np.bincount(bound, weight, _PLACES + 1)[:_PLACES] for bound in bounds]
    return place, np.cumsum(ends[0] - ends[1])
