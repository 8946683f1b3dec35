"""A curve as arcs, spline or polygon within a tolerance: the largest distance both ways, measured.

The corners of the path are projected on the curve. They must follow one another along it, once round; then
each side of the path belongs to the part of the curve between its ends, and both are compared with each
other: places of the side with the nearest of the curve, places of the curve with the nearest of the side.
Where the distance is largest, it is looked for closer. The nearest is looked for between those ends only, so
that at the places examined the result is never less than the distance of the two sets (Hausdorff).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, NamedTuple, Protocol

import numpy as np

from linkwright.cam.manufacture.arcs import arcs, polyline
from linkwright.cam.manufacture.curve import Track, size
from linkwright.cam.manufacture.outline import Outline
from linkwright.cam.manufacture.spline import Spline, spline
from linkwright.kernel.arrays import Floats, Indices
from linkwright.kernel.errors import ConvergenceError, ExchangeError, InputError

# Sides (k,) and shares (k, m) of them → distances and τ, (k, m) each.
Distances = Callable[[Indices, Floats], tuple[Floats, Floats]]

# Intervals of a side, and rounds of looking closer round its largest distance, each eight times finer. At a
# smooth largest distance the error falls with the square: (1/16 · 1/8 · 1/8)² of the distance is left.
_INTERVALS, _CLOSER = 16, 2

# Sides are examined closer whose largest distance found is at least this share of the largest of all:
# between the samples of sides as smooth as arcs it is off by less.
_WORTH = 0.9

# Corners within this angle of each other may stand in either order: it is rounding of their places [rad].
_ORDER = 1e-6

# Sides compared at a time, so that the tables fit into memory.
_BLOCK = 4096


class Path(Protocol):
    """A closed path of sides that begin at its vertices."""

    @property
    def vertices(self) -> Floats:
        """Where the sides begin, (n, 2) [m]."""

    def at(self, which: Indices, u: Floats) -> Floats:
        """Places on sides (k,) at shares (k, m) of them, (k, m, 2) [m]."""

    def distances(self, which: Indices, places: Floats) -> Floats:
        """Distance of places (k, m, 2) from sides (k,), (k, m) [m]."""


@dataclass(frozen=True)
class Deviation:
    """The largest distance between a path and a curve.

    Attributes
    ----------
    path_to_curve : float
        Of a place of the path from the curve [m].
    curve_to_path : float
        Of a place of the curve from the path [m].
    angle : float
        Cam angle at the larger of them [rad].
    sides : int
        How many arcs, lines or pieces of a spline were compared.
    """

    path_to_curve: float
    curve_to_path: float
    angle: float
    sides: int

    @property
    def largest(self) -> float:
        """The larger of both [m]."""
        return max(self.path_to_curve, self.curve_to_path)


def deviation(path: Path, track: Track) -> Deviation:
    """The largest distance between a path and a curve, both ways."""
    low, high = _intervals(path.vertices, track)

    def from_path(which: Indices, u: Floats) -> tuple[Floats, Floats]:
        tau, distance = track.project(path.at(which, u), *_between(low[which], high[which], u))
        return distance, tau

    def from_curve(which: Indices, u: Floats) -> tuple[Floats, Floats]:
        tau, _, end = _between(low[which], high[which], u)
        return path.distances(which, track.points(tau, end)), tau

    forth, at_forth = _largest(from_path, len(low))
    back, at_back = _largest(from_curve, len(low))
    at = track.angles(np.array([at_forth if forth >= back else at_back]) % track.period)
    return Deviation(forth, back, float(at[0]), len(low))


def _intervals(vertices: Floats, track: Track) -> tuple[Floats, Floats]:
    """τ between which each side belongs to the curve, (n,) each [rad]; the last may end beyond the period."""
    tau, _ = track.nearest(vertices)
    step = (np.roll(tau, -1) - tau + _ORDER) % track.period - _ORDER
    turns = step.sum() / track.period
    if not abs(turns - 1) < 0.5:
        raise ExchangeError(
            f"its {len(vertices)} corners go {turns:.0f} times round the curve, not once along it: "
            "corners are missing, displaced or in another order"
        )
    return tau, tau + np.maximum(step, 0)


def _between(low: Floats, high: Floats, u: Floats) -> tuple[Floats, Floats, Floats]:
    """τ at shares of intervals, (k, m), and the ends of the intervals, (k, 1)."""
    low, high = low[:, None], high[:, None]
    return np.where(u < 1, low + u * (high - low), high), low, high


def _largest(distances: Distances, n: int) -> tuple[float, float]:
    """The largest distance of all sides, and its τ."""
    blocks = [_sampled(distances, block) for block in np.array_split(np.arange(n), max(1, n // _BLOCK))]
    most, share, tau = (np.concatenate(block) for block in zip(*blocks, strict=True))
    top = int(most.argmax())
    best, at = float(most[top]), float(tau[top])
    which = np.flatnonzero(most >= _WORTH * best)[:_BLOCK]
    share, width = share[which], 1 / _INTERVALS
    for _ in range(_CLOSER):
        u = np.clip(share[:, None] + width * np.linspace(-1, 1, _INTERVALS + 1), 0, 1)
        most, share, tau = _most(*distances(which, u), u)
        width *= 2 / _INTERVALS
        if most.max() > best:
            best, at = float(most.max()), float(tau[most.argmax()])
    return best, at


def _sampled(distances: Distances, which: Indices) -> tuple[Floats, Floats, Floats]:
    """The largest distance of each side among its samples, with its share and τ."""
    u = np.broadcast_to(np.linspace(0, 1, _INTERVALS + 1), (len(which), _INTERVALS + 1))
    return _most(*distances(which, u), u)


def _most(distance: Floats, tau: Floats, u: Floats) -> tuple[Floats, Floats, Floats]:
    """The largest of each row, with its share and τ."""
    column = distance.argmax(axis=1)[:, None]
    most, share, at = (np.take_along_axis(values, column, axis=1)[:, 0] for values in (distance, u, tau))
    return most, share, at


class FileOutline(NamedTuple):
    """An outline of a file."""

    path: Path  # to be compared with the curve
    form: str  # how the file holds it, such as ``LWPOLYLINE``


Form = Literal["arcs", "spline", "cubic", "polyline"]
FORMS: tuple[Form, ...] = ("arcs", "spline", "cubic", "polyline")

# A hundredth of what good grinding keeps [m].
TOLERANCE = 1e-6

# Below this share of a curve's size its own places are not known well enough to compare: rounding of
# coordinates in a file, and of directions between neighbouring places.
_FINEST = 1e-12

# Share of the size that is kept back for rounding of the coordinates in a file.
_ROUNDING = 1e-14

# What is aimed at if the tolerance was missed by what samples did not see, and how often.
_LESS, _TRIES = 0.98, 6


def fit(
    track: Track, form: Form = "arcs", tolerance: float = TOLERANCE
) -> tuple[Outline | Spline, Deviation]:
    """Approximate a curve within a tolerance.

    ``tolerance``: largest distance between curve and path, both ways [m].
    """
    extent = size(track.parts[0].curve)
    _refuse(form, tolerance, extent)
    aim = kept = tolerance - _ROUNDING * extent
    for _ in range(_TRIES):
        path = _path(track, form, aim)
        distance = deviation(path, track)
        if distance.largest <= kept:
            return path, distance
        aim *= _LESS * kept / distance.largest
    raise ConvergenceError(
        f"the curve as {form} deviates by {distance.largest:.3g} m, tolerance {tolerance:.3g} m; use a "
        "wider tolerance",
        method="approximating a curve",
        iterations=_TRIES,
        residual=distance.largest,
    )


def _path(track: Track, form: Form, tolerance: float) -> Outline | Spline:
    if form == "arcs":
        return arcs(track, tolerance)
    if form == "polyline":
        return polyline(track, tolerance)
    return spline(track, tolerance, 5 if form == "spline" else 3)


def _refuse(form: Form, tolerance: float, extent: float) -> None:
    if form not in FORMS:
        raise InputError(f'form "{form}": expected {", ".join(FORMS)}')
    finest = _FINEST * extent
    if not finest <= tolerance < float("inf"):
        raise InputError(
            f"tolerance {tolerance:g} m: expected at least {finest:.1g} m (10⁻¹² of the curve's size), "
            "such as 1e-6 m"
        )
