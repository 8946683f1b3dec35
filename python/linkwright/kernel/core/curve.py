"""A curve through points, as the core takes it: cubics between them, with slopes before and after each."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from linkwright.kernel.arrays import Floats

Beyond = Literal["held", "straight"]


@dataclass(frozen=True)
class Curve:
    """Points with the slopes at both their sides; two points at one place are a step."""

    # (points,): places, never decreasing, and values.
    x: Floats
    y: Floats
    # (points,): slopes just before and just after each point; the first and the last go on outside.
    before: Floats
    after: Floats


def straight(x: ArrayLike, y: ArrayLike, beyond: Beyond = "held") -> Curve:
    """Straight lines between points (x never decreasing; equal places are a step), (points,) each.

    Outside the end values are held, or the end lines go on. There is a kink at each point.
    """
    places, values = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    width = np.diff(places)
    chord = np.divide(np.diff(values), width, out=np.zeros_like(width), where=width > 0)
    ends = (chord[:1], chord[-1:]) if beyond == "straight" and len(chord) else ([0.0], [0.0])
    return Curve(places, values, np.concatenate([ends[0], chord]), np.concatenate([chord, ends[1]]))


def smooth(x: ArrayLike, y: ArrayLike, slope: ArrayLike, beyond: Beyond = "straight") -> Curve:
    """Cubics between points with values and slopes, (points,) each, x increasing.

    Outside the end values are held, which makes kinks, or straight lines go on with the end slopes.
    """
    places, values, slopes = (np.asarray(values, dtype=float) for values in (x, y, slope))
    before, after = slopes.copy(), slopes.copy()
    if beyond == "held":
        before[0] = after[-1] = 0.0
    return Curve(places, values, before, after)


def odd(x: ArrayLike, y: ArrayLike, slope: ArrayLike) -> Curve:
    """A curve from x = 0, y = 0 upwards, turned about zero, as of a coupling's torque; straight beyond."""
    places, values, slopes = (np.asarray(values, dtype=float) for values in (x, y, slope))
    return smooth(
        np.concatenate([-places[:0:-1], places]),
        np.concatenate([-values[:0:-1], values]),
        np.concatenate([slopes[:0:-1], slopes]),
    )


def switched(changes: Iterable[tuple[float, float, float]], start: float = 1.0) -> Curve:
    """A factor over time that changes now and then: straight lines and steps.

    `changes`: time [s], factor from then on, and time over which it comes to it [s], zero for a step. A
    change that is still on its way when the next begins stays where it is then. `start`: factor until the
    first.
    """
    listed = sorted(changes, key=lambda change: change[0])
    times, factors = [0.0], [start]
    for n, (time, factor, over) in enumerate(listed):
        follows = listed[n + 1][0] if n + 1 < len(listed) else np.inf
        reached = factor
        if time + over > follows:
            reached = factors[-1] + (factor - factors[-1]) * (follows - time) / over
        times += [time, min(time + over, follows)]
        factors += [factors[-1], reached]
    return straight(times, factors)


def product(first: Curve, second: Curve) -> Curve:
    """The product of two factors over time, straight lines and steps with ends held, one of them level."""
    places = np.union1d(first.x, second.x)
    left, right = (_at(first, places, side) * _at(second, places, side) for side in ("left", "right"))
    return straight(np.repeat(places, 2), np.column_stack([left, right]).ravel())


def _at(curve: Curve, places: Floats, side: Literal["left", "right"]) -> Floats:
    """Piecewise linear or constant values on one side of places, constant beyond the ends."""
    place = np.searchsorted(curve.x, places, side=side)
    a, b = np.clip(place - 1, 0, None), np.clip(place, None, len(curve.x) - 1)
    width = curve.x[b] - curve.x[a]
    share = np.divide(places - curve.x[a], width, out=np.zeros_like(places), where=width > 0)
    value: Floats = curve.y[a] + np.clip(share, 0.0, 1.0) * (curve.y[b] - curve.y[a])
    return value
