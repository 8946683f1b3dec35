r"""Exact derivatives of responses that follow from places of points, by entries of the machine.

The core differentiates places at fixed crank angles (`linkwright.linkages.path_error.places_along`). A
distance d from a point of a path has

.. math:: dd = \operatorname{Re}\, \overline{(P - w)}\, dP / d,

where the crank angle is given, and where it is that of the nearest place, across which the curve passes.
Points that share an angle in order not to pass each other are nearest together only: their root mean square
has this derivative, single distances are left to differences.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from linkwright.kernel.arrays import Complexes, Floats
from linkwright.kernel.numerics.tangent import Tangent
from linkwright.linkages.kinematics import motions
from linkwright.linkages.path_error import places_along, places_near
from linkwright.machine.machine import Machine
from linkwright.machine.tangents import Directions, directions
from linkwright.studies.model import StudyPath
from linkwright.studies.point_responses import require_numbers, sampled_angles
from linkwright.studies.study_response import MOTION, PATH, StudyResponse

# Slope along the curve over speed times distance that is rounding: the place is the foot of its point.
_ACROSS = 1e-6

# Distances over the size of the path that are rounding, so that they have no direction; shares by which
# maxima differ that are equal.
_NOTHING, _EQUAL = 1e-9, 1e-6

_ON_PATH = "the point lies on the path, where the distance has no derivative"
_TWO = "two points of the path have the same {}"


def point_tangents(
    machine: Machine, wanted: Sequence[StudyResponse], entries: Sequence[str]
) -> tuple[dict[str, Tangent], dict[str, str]]:
    """Responses of points with derivatives or NaN, and which have a kink; `FindingError`: does not close."""
    own = [asked for asked in wanted if asked.analysis in (MOTION, PATH)]
    if not own:
        return {}, {}
    values = require_numbers(machine, own)
    ways = directions(machine, tuple(entries))
    tangents, ties = {}, {}
    for asked in own:
        slopes = _by_path(machine, asked, ways) if asked.path else _by_motion(machine, asked, ways)
        known = dict(zip(ways.variables, slopes, strict=True))
        d = np.array([known.get(entry, np.nan) for entry in entries])
        tangents[asked.name] = Tangent(values[asked.name], d)
        if asked.path and (reason := _kink(machine, asked, asked.path)):
            ties[asked.name] = reason
    return tangents, ties


def _by_motion(machine: Machine, asked: StudyResponse, ways: Directions) -> Floats:
    """Derivatives of a number of the motion of a point, (variables,)."""
    (point,), angles = asked.of, sampled_angles(asked)
    part = "xy".index(asked.quantity)
    along = places_along(machine, point, angles, ways.values)
    slopes: Floats = along.imag if part else along.real
    if asked.extreme is None:
        return np.asarray(slopes[0])
    return _weights(asked, motions(machine, angles, points=[point])[0, part]) @ slopes


def _by_path(machine: Machine, asked: StudyResponse, ways: Directions) -> Floats:
    """Derivatives of distances from a path, (variables,); NaN where only differences can tell."""
    path = asked.path
    assert path is not None
    off, angles = _off(machine, path)
    weights = _weights(asked, np.abs(off))
    if (
        path.crank_angle is None
        and asked.extreme != "rms"
        and not _is_across(machine, path, off, angles, weights)
    ):
        return np.full(len(ways.variables), np.nan)
    along = places_along(machine, path.point, angles, ways.values)
    way = off / np.maximum(np.abs(off), 1e-300)
    return np.asarray(weights @ (np.conj(way)[:, None] * along).real)


def _off(machine: Machine, path: StudyPath) -> tuple[Complexes, Floats]:
    """From the points of a path to the places of the machine's point, and the crank angles, (n,) each."""
    targets = np.array(path.x) + 1j * np.array(path.y)
    angles = None if path.crank_angle is None else np.array(path.crank_angle)
    places, phi = places_near(machine, path.point, targets, angles)
    return places[0] - targets, np.ascontiguousarray(phi[0])


def _is_across(machine: Machine, path: StudyPath, off: Complexes, angles: Floats, weights: Floats) -> bool:
    table = motions(machine, angles, points=[path.point])[0]
    rate = table[2] + 1j * table[3]
    slope, most = np.abs((np.conj(rate) * off).real), np.abs(rate) * np.abs(off)
    size = np.abs(rate).max() * (np.ptp(path.x) + np.ptp(path.y))
    return bool((slope <= _ACROSS * most + _NOTHING * size)[weights != 0].all())


def _weights(asked: StudyResponse, curve: Floats) -> Floats:
    """Derivatives of the number of a curve by its samples, (n,)."""
    n = len(curve)
    ends = np.zeros(n)
    match asked.extreme:
        case "rms":
            rms = float(np.sqrt((curve**2).mean()))
            return curve / (n * rms) if rms > 0 else ends
        case "mean":
            return np.full(n, 1 / n)
        case None:
            ends[asked.index or 0] = 1.0
            return ends
    for place, sign in _ends(asked.extreme, curve):
        ends[place] += sign
    return ends


def _ends(extreme: str, curve: Floats) -> Iterator[tuple[int, float]]:
    if extreme in ("max", "range"):
        yield int(curve.argmax()), 1.0
    if extreme in ("min", "range"):
        yield int(curve.argmin()), 1.0 if extreme == "min" else -1.0


def _kink(machine: Machine, asked: StudyResponse, path: StudyPath) -> str:
    """Why a distance from a path has only one-sided derivatives; empty otherwise."""
    distances = np.abs(_off(machine, path)[0])
    if asked.extreme is None:
        distances = distances[[asked.index or 0]]
    size = max(np.ptp(path.x), np.ptp(path.y), float(distances.max()))
    if distances.max() <= _NOTHING * size:
        return _ON_PATH
    ordered = np.sort(distances)
    if asked.extreme in ("max", "range") and (ordered[-2:-1] >= (1 - _EQUAL) * ordered[-1]).any():
        return _TWO.format("maximum distance")
    if asked.extreme in ("min", "range") and (ordered[1:2] <= (1 + _EQUAL) * ordered[0]).any():
        return _TWO.format("minimum distance")
    return ""
