r"""Derivatives of the torque of the gearbox of a pumping unit: peaks, means, work and counterbalance.

An extreme has the derivative of the curve at its angle, at an end of the stroke and at a corner of the table
of the load along with it. Torque and load times torque factor are continuous over the revolution, so that an
integral has that of what is integrated,

.. math:: \frac{\mathrm d}{\mathrm dp}\int T\,\mathrm d\theta
    = \int \frac{\partial T}{\partial p}\,\mathrm d\theta,

between the angles at which the load has a corner or the gears change flanks. The counterbalance of equal
peaks moves so that both stay equal.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.numerics.implicit import solution_along
from linkwright.kernel.numerics.tangent import Tangent, lifted, numbers, on_lines, primal
from linkwright.kernel.numerics.turn_fit import turn_curve
from linkwright.pumping.gear_torque import GearTorque, StrokeLoad, Strokes, effect_of_weights, stroke_load
from linkwright.pumping.unit import PolishedRod, end_angles

# A place this near to a corner of the table of the load, as a share of the stroke or in radians, is on it.
_ON_CORNER = 1e-6

# Longest piece of a revolution for Gauss's rule [rad], and its nodes: torque factors are smooth functions of
# the angle, and over 15° rounding is left of them.
_PIECE, _NODES = np.pi / 12, 12


def gear_scalars(
    rod: PolishedRod, along: Any, gear: GearTorque | None
) -> tuple[dict[str, Any], dict[str, str]]:
    """Scalars of the gearbox with their derivatives; ties by name of the response."""
    load = rod.unit.load
    if load is None or gear is None:
        return {}, {}
    is_air = rod.unit.geometry == "air_balanced"
    name = "counterbalance_effect" if is_air else "counterbalance"
    size = float(getattr(gear, name))
    strokes = Strokes(rod.unit, load, rod.motion, (rod.bottom, rod.top))
    up, down = strokes.curves(size)
    lowest = min((up.extreme(-1), up), (down.extreme(-1), down), key=lambda pair: pair[0])
    heaviest = max((up.extreme(+1, 1), up), (down.extreme(+1, 1), down), key=lambda pair: pair[0])
    places = {
        "torque_net_up": (up.extreme(+1), up),
        "torque_net_down": (down.extreme(+1), down),
        "torque_net_min": lowest,
        "load_max": heaviest,
    }
    at = {
        name: _at_place(rod, along, where[1], rising=curve is up) for name, (where, curve) in places.items()
    }
    given = getattr(along.unit.load, name)
    is_sought = given is None or isinstance(given, str)
    balanced = _balanced(at, size) if is_sought else given
    scalars = {name: stroke.net(balanced)[0] for name, stroke in at.items() if name != "load_max"}
    scalars |= {"load_max": at["load_max"].load[0], name: balanced}
    scalars |= _means(along, _kinks(strokes, size if is_air else 0.0), balanced)
    scalars |= _shares(scalars, gear)
    if not is_air and gear.counterbalance_effect is not None:
        scalars["counterbalance_effect"] = effect_of_weights(along.unit, along.motion, balanced)
    still = "a peak occurs at an end of the stroke, where the load table has a corner that moves"
    return scalars, {
        f"gear.{name}": still for name, number in scalars.items() if np.isnan(lifted(number, 1).d).any()
    }


def _at_place(rod: PolishedRod, along: Any, angle: float, *, rising: bool) -> StrokeLoad:
    """Load and torques at a crank angle of a stroke, with derivatives; at its ends and corners with these."""
    place, load = np.array([angle % (2 * np.pi)]), along.unit.load
    motion = along.motion(place)
    travel, factor, bend = motion
    end, corner = _end(rod, angle), _corner(rod, float(place[0]))
    heights = load.force if load.angle is not None else load.up if rising else load.down
    if end is not None:
        late = _one(end_angles(along.unit)[end], travel) - place
        moved: Any = place + Tangent(np.zeros(1), late.d)
        force = _one(heights[-end], travel)
        if load.angle is not None:
            force = on_lines(moved, load.angle, heights, period=2 * np.pi)
    elif corner is not None:
        knots = load.position if load.angle is None else load.angle
        late = _one(knots[corner], travel) - place
        if load.angle is None:
            away = _one(knots[corner], travel) - travel / along.unit.stroke
            late = away / (factor.value / rod.stroke)
        moved, force = place + Tangent(np.zeros(1), late.d), _one(heights[corner], travel)
    else:
        return stroke_load(along.unit, load, motion, place)
    return StrokeLoad(along.unit, force, factor + bend.value * (moved - place), np.sin(moved + load.phase))


def _one(number: Any, like: Any) -> Any:
    """A number as an array with derivatives."""
    return lifted(numbers((number,)), like.d.shape[-1])


def _balanced(at: dict[str, StrokeLoad], size: float) -> Any:
    """The counterbalance that keeps both peaks equal: it moves by what they differ over their slopes."""
    up, down = at["torque_net_up"], at["torque_net_down"]
    excess: Any = up.net(size)[0] - down.net(size)[0]
    slope = float(primal(up.net_slope(size)[0] - down.net_slope(size)[0]))
    return solution_along(size, excess, slope)


def _shares(scalars: dict[str, Any], gear: GearTorque) -> dict[str, Any]:
    """What is made of peaks and means."""
    shares = {}
    if gear.cyclic_load_factor is not None:
        shares["cyclic_load_factor"] = scalars["torque_net_rms"] / scalars["torque_net_mean"]
    if gear.torque_rated is not None:
        peak: Any = np.maximum(scalars["torque_net_up"], scalars["torque_net_down"])
        shares["gear_load"] = peak / gear.torque_rated
    return shares


def _means(along: Any, kinks: Floats, balanced: Any) -> dict[str, Any]:
    """Mean and root mean square of the torque and work of the rod, by Gauss's rule between kinks."""
    parts = np.ceil(np.diff(kinks) / _PIECE).astype(int)
    ends = [np.linspace(*span, n + 1)[:-1] for span, n in zip(pairwise(kinks), parts, strict=True)]
    pieces = np.append(np.concatenate(ends), kinks[-1])
    x, w = np.polynomial.legendre.leggauss(_NODES)
    half = 0.5 * np.diff(pieces)
    angles = (pieces[:-1, None] + np.multiply.outer(half, x + 1)).ravel() % (2 * np.pi)
    weights = np.multiply.outer(half, w).ravel() / (2 * np.pi)
    stroke = stroke_load(along.unit, along.unit.load, along.motion(angles), angles)
    net: Any = stroke.net(balanced)
    return {
        "torque_net_mean": (net * weights).sum(),
        "torque_net_rms": np.sqrt((net * net * weights).sum()),
        "work": (stroke.load * stroke.factor * weights).sum() * (2 * np.pi),
    }


def _kinks(strokes: Strokes, effect: float) -> Floats:
    """Crank angles of one revolution between which the torque is smooth, with both of its ends."""
    kinks = [*strokes.spans, *(_flank_changes(strokes, span, effect) for span in strokes.spans)]
    return np.array(sorted(set(np.concatenate(kinks).tolist())))


def _flank_changes(strokes: Strokes, span: Floats, effect: float) -> Floats:
    """Crank angles of a stroke at which the load comes to what balances it, and the gears change flanks."""
    balance = strokes.unit.structural_unbalance + effect

    def excess(angles: Floats) -> Floats:
        at = angles % (2 * np.pi)
        return (stroke_load(strokes.unit, strokes.load, strokes.motion(at), at).load - balance)[None]

    return turn_curve(excess, span, "load of the polished rod").crossings()


def without_derivatives(gear: GearTorque | None) -> dict[str, str]:
    """Numbers of the gearbox that no entry moves, with the reason."""
    if gear is None:
        return {}
    without = dict.fromkeys(("torque_rated", "load_rated"), "it is a number of the designation")
    if gear.cyclic_load_factor is None:
        without["cyclic_load_factor"] = "the mean torque is not positive"
    if gear.torque_rated is None:
        without["gear_load"] = "no designation gives the rating"
    return without


def _end(rod: PolishedRod, angle: float) -> int | None:
    """The end of the stroke that a crank angle is on: 0 the bottom, 1 the top."""
    apart = np.abs((np.array([rod.bottom, rod.top]) - angle + np.pi) % (2 * np.pi) - np.pi)
    return int(apart.argmin()) if apart.min() < _ON_CORNER else None


def _corner(rod: PolishedRod, angle: float) -> int | None:
    """The corner of the table of the load that a crank angle is on."""
    load = rod.unit.load
    assert load is not None
    if load.position is not None:
        position = float(rod.motion(np.array([angle]))[0][0]) / rod.stroke
        apart = np.abs(np.array(load.position) - position)
    else:
        apart = np.abs((np.array(load.angle) - angle + np.pi) % (2 * np.pi) - np.pi)
    return int(apart.argmin()) if apart.min() < _ON_CORNER else None
