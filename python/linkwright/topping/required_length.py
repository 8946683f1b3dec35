r"""Required length of the edge: exact at constant speed and for every phase, and by the published formulas.

**A knife that keeps its speed over the head.** The edge, along :math:`(\sin\alpha, \cos\alpha)`, moves with
the velocity :math:`(v, \pm v_h)`. It sweeps a band whose width is its length seen along the way:

.. math:: w = L\,\frac{|v\cos\alpha \mp v_h\sin\alpha|}{\sqrt{v^2 + v_h^2}}.

Heads of diameter d whose centres lie up to Δ to either side of the row take the width
:math:`d + 2\Delta\,v/\sqrt{v^2 + v_h^2}` of it. With the middle of the band over the row all of them are
cut if

.. math:: L \ge \frac{d\sqrt{v^2 + v_h^2} + 2\Delta v}{|v\cos\alpha \mp v_h\sin\alpha|}.

The worse direction is that in which the knife moves towards its leading end. The edge hardly advances there
if :math:`v_h\tan|\alpha|` comes near v: no length does for equality, and beyond it the edge runs backwards
over the head.

**Every phase of a knife that goes back and forth.** Heads meet the knife as they may. A point of a head lies
within d/2 + Δ of the axis of the row, the middle of the edge within half of the stroke S; where the edge
crosses the point, both differ by the way from the middle of the edge, seen across the row. If the edge never
retreats it crosses each point once, and at some head the knife is at one end of its stroke just as it crosses
the point farthest to the other side:

.. math:: L = \frac{S + d + 2\Delta}{\cos\alpha}.

The speeds do not count. A retreating edge never needs more.

Both are derived here.

**Paper 5, and the bound that its own condition gives.** While the machine goes on, the knife has to travel
across the head; it must not be done before the head has been cut along the row, :math:`t_y \ge t_x` (1). With

.. math:: S_x = b(\cos\alpha + \sin^2\alpha), \qquad S_y = (L - b\sin\alpha)\cos\alpha,

(2), where b = d for a root on the row's axis and b = d + 2Δ for roots up to Δ off it, (8), this is
:math:`S_y/v_h \ge S_x/v` (3, 4). The paper goes on to

.. math:: L \ge b\left(\frac{v_h}{v}\cos\alpha + \sin\alpha\right),

(5, 9, 10). But (4) divided by cos α has :math:`S_x/\cos\alpha = b(1 + \tan\alpha\sin\alpha)`, not b cos α:
what follows from it is

.. math:: L \ge b\left(\frac{v_h}{v}(1 + \tan\alpha\sin\alpha) + \sin\alpha\right).

Neither says enough: for a knife at rest across the row both are zero, though its edge must be as long as the
band of the heads.

The paper's angle has no sign; a knife whose other end leads is its mirror image. Its knife speed is constant.

References
----------
.. [1] Paper 5, (1) to (10).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result

# Normal speed over the speed of the edge below which it moves along itself: the rounding of its terms.
ALONG_ITSELF = 4e-16


def constant_speed_lengths(
    diameter: Any, offset: Any, edge_angle: Any, forward_speed: Any, knife_speed: Any
) -> Any:
    """Minimum length for each direction of the knife, to the left and to the right, (2, ...) [m].

    d of the head and maximum offset Δ [m], α [rad], v > 0 and v_h ≥ 0 [m/s] broadcast. Infinite where the
    edge moves along itself.
    """
    v, speed = forward_speed, np.hypot(forward_speed, knife_speed)
    along, across = v * np.cos(edge_angle), knife_speed * np.sin(edge_angle)
    wanted = diameter * speed + 2 * offset * v
    ways = []
    for advance in (np.abs(along - across), np.abs(along + across)):
        with np.errstate(divide="ignore", invalid="ignore"):
            ways.append(np.where(advance > ALONG_ITSELF * speed, wanted / advance, np.inf))
    return np.stack(ways)


def every_phase_length(diameter: Any, offset: Any, edge_angle: Any, stroke: Any) -> Any:
    """Minimum length of an edge that never retreats, (...) [m]; d, Δ, S [m] and α [rad] broadcast."""
    return (stroke + (diameter + 2 * offset)) / np.cos(edge_angle)


@dataclass(frozen=True)
class PublishedLengths(Result):
    """Travels and lengths by the paper."""

    travel_along: Annotated[float, Label("travel along the row", "S_x", "m")]
    travel_across: Annotated[float, Label("travel across the row", "S_y", "m")]
    time_along: Annotated[float, Label("time of the travel along the row", "t_x", "s")]
    time_across: Annotated[
        float, Label("time of the travel across the row", "t_y", "s", "Infinite for a knife at rest.")
    ]
    holds: Annotated[bool, About("Whether t_y ≥ t_x, condition (1), for the length of the edge.")]
    length_published: Annotated[float, Label("minimum length by the paper's (10)", "", "m")]
    length_consistent: Annotated[float, Label("minimum length that follows from the paper's (4)", "", "m")]


def published_lengths(
    band: Any, edge_angle: Any, edge_length: Any, forward_speed: Any, knife_speed: Any
) -> PublishedLengths:
    """Travels, condition and lengths by paper 5, (1) to (10).

    `band`: b, diameter d of the head, with offset d + 2Δ [m]; α between −π/2 and π/2 [rad]; L [m]; v > 0 and
    v_h ≥ 0 [m/s].
    """
    sin, cos = np.abs(np.sin(edge_angle)), np.cos(edge_angle)
    along, across = band * (cos + sin**2), (edge_length - band * sin) * cos
    time_along = along / forward_speed
    at_rest = np.inf if across >= 0 else -np.inf
    time_across = across / knife_speed if knife_speed > 0 else at_rest
    return PublishedLengths(
        travel_along=along,
        travel_across=across,
        time_along=time_along,
        time_across=time_across,
        holds=bool(time_across >= time_along),
        length_published=length_published(band, edge_angle, knife_speed / forward_speed),
        length_consistent=length_consistent(band, edge_angle, knife_speed / forward_speed),
    )


def length_published(band: Any, edge_angle: Any, ratio: Any) -> Any:
    """Minimum length as printed, paper 5 (5), (9), (10), (...) [m]; d + 2Δ [m], α [rad], v_h/v [–]."""
    return band * (ratio * np.cos(edge_angle) + np.abs(np.sin(edge_angle)))


def length_consistent(band: Any, edge_angle: Any, ratio: Any) -> Any:
    """Minimum length that follows from paper 5 (4), (...) [m]. d + 2Δ [m], α [rad], v_h/v [–] broadcast."""
    sin = np.abs(np.sin(edge_angle))
    return band * (ratio * (1 + sin * np.abs(np.tan(edge_angle))) + sin)
