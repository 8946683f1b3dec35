"""Responses that follow from places of points: coordinates of a motion, distances from a path.

They need no drive, and the core places the points of many machines at once.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import FindingError
from linkwright.kernel.quantities import shown
from linkwright.linkages.kinematics import motions
from linkwright.linkages.path_error import PathError, places_near
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine
from linkwright.studies.model import Response, StudyPath
from linkwright.studies.study_response import MOTION, PATH, StudyResponse, taken, wrong

# Crank angles per revolution at which a motion is sampled for its extremes: an extreme between them is missed
# by at most (half a step)²/2 of the second derivative, 4e-5 of a harmonic motion's amplitude.
SAMPLES = 360

# What a row says whose mechanism does not close.
OPEN = "The links do not close at every required crank angle."
OPEN_PATH = (
    "The links do not close at every crank angle, or the curve does not close after one revolution: for a "
    "path without crank_angle they have to."
)

# Distances of all points of a path, and scalars of them: what is taken.
_CURVE, _TAKEN = "error", {"error_rms": "rms", "error_max": "max"}


def of_motion(machine: Machine, name: str, key: str, text: str, response: Response) -> StudyResponse:
    """A coordinate of a point; a `MachineError` if there is none, or no number of it is asked for."""
    point, _, coordinate = text.removeprefix(MOTION).removeprefix(".").rpartition(".")
    points = compile_machine(machine).points
    if coordinate not in ("x", "y") or point not in points:
        raise wrong(name, key, text, "motion.POINT.x or motion.POINT.y", suggestion(point, points))
    if response.curve is None:
        remedy = f'{{ curve = "{text}", extreme = "max" }} or {{ curve = "{text}", at = "30 deg" }}'
        raise wrong(name, key, f"{text}, which is a curve", "one number", remedy)
    if response.index is not None:
        raise wrong(name, "index", str(response.index), "extreme or at, of a motion")
    _refuse_options(name, response, "a motion")
    word = f"{coordinate} of {point}"
    return StudyResponse(name, MOTION, (point,), coordinate, word, "m", response.extreme, at=response.at)


def of_path(
    paths: Mapping[str, StudyPath], name: str, key: str, text: str, response: Response
) -> StudyResponse:
    """A distance from a path of the study; a `MachineError` if there is none, or it is no number."""
    path, _, quantity = text.removeprefix(PATH).removeprefix(".").rpartition(".")
    if path not in paths:
        remedy = suggestion(path, paths) or f"describe it: [paths.{path or 'NAME'}] with point, x, y"
        raise wrong(name, key, text, f"{PATH}.NAME.QUANTITY with NAME of the table paths", remedy)
    known = (*_TAKEN, _CURVE)
    if quantity not in known:
        expected = f"one of {', '.join(known)} of a path"
        raise wrong(name, key, text, expected, suggestion(quantity, known))
    if response.curve is None and quantity == _CURVE:
        remedy = f'"{PATH}.{path}.error_rms" or {{ curve = "{text}", index = 0 }}'
        raise wrong(name, key, f"{text}, which is a list", "one number", remedy)
    if response.curve is not None and quantity != _CURVE:
        raise wrong(name, key, f"{text}, which is a number", "a list", f'write "{text}" alone')
    n = len(paths[path].x)
    if response.index is not None and response.index >= n:
        raise wrong(name, "index", str(response.index), f"0 to {n - 1}: the path has {n} points")
    _refuse_options(name, response, "a path")
    picked = (response.extreme or _TAKEN.get(quantity), response.index)
    word, unit = (getattr(shown(PathError, quantity), key) for key in ("word", "unit"))
    return StudyResponse(name, PATH, (path,), quantity, word, unit, *picked, path=paths[path])


def _refuse_options(name: str, response: Response, what: str) -> None:
    for key in ("level", "otherwise"):
        if getattr(response, key) is not None:
            raise wrong(name, key, f"{getattr(response, key):g}", f"nothing beside {what}")


def point_numbers(machines: Machine, wanted: Sequence[StudyResponse]) -> dict[str, Floats]:
    """Responses of one or many machines by name, (rows,); NaN where a machine does not close."""
    distances: dict[str, Floats] = {}
    numbers = {}
    for asked in wanted:
        if asked.path is None:
            numbers[asked.name] = _coordinates(machines, asked)
            continue
        (name,) = asked.of
        if name not in distances:
            distances[name] = _distances(machines, asked.path)
        numbers[asked.name] = picked(asked, distances[name])
    return numbers


def require_numbers(machine: Machine, wanted: Sequence[StudyResponse]) -> dict[str, float]:
    """Responses of one machine by name; a `FindingError` if it does not close."""
    numbers = {name: float(column[0]) for name, column in point_numbers(machine, wanted).items()}
    for asked in wanted:
        if not np.isfinite(numbers[asked.name]):
            raise FindingError(why_open(asked))
    return numbers


def why_open(asked: StudyResponse) -> str:
    """What a row says that has no such response."""
    return OPEN_PATH if asked.path is not None and asked.path.crank_angle is None else OPEN


def sampled_angles(asked: StudyResponse) -> Floats:
    """Crank angles at which a motion is examined, (n,) [rad]."""
    return np.linspace(0.0, 2 * np.pi, SAMPLES, endpoint=False) if asked.at is None else np.array([asked.at])


def picked(asked: StudyResponse, curve: Floats) -> Floats:
    """The number of each row of a curve, (rows, n) → (rows,)."""
    if asked.extreme is not None:
        return np.asarray(taken(curve, asked.extreme))
    return curve[:, asked.index or 0]


def _coordinates(machines: Machine, asked: StudyResponse) -> Floats:
    """A number of the motion of a point, (rows,)."""
    table = motions(machines, sampled_angles(asked), points=asked.of)
    return picked(asked, table[:, "xy".index(asked.quantity), :])


def _distances(machines: Machine, path: StudyPath) -> Floats:
    """Distances of a point from the points of a path, (rows, n)."""
    targets = np.array(path.x) + 1j * np.array(path.y)
    angles = None if path.crank_angle is None else np.array(path.crank_angle)
    places, _ = places_near(machines, path.point, targets, angles)
    return np.abs(places - targets)
