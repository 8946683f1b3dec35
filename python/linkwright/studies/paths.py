"""Path generation as a study: the linkage of a task, and the error of its path to be made small.

The variables are those of the search (`linkwright.synthesis.path_model`) as entries of the machine: lengths,
pivots, the place of the coupler point and, with given crank angles, the direction of the crank at angle zero.
The limits follow from the lengths in closed form, so that they have exact derivatives.
"""

from __future__ import annotations

import math
from typing import Any

from linkwright.linkages.model.path_points import PathPoints
from linkwright.studies.plan import StudyPlan
from linkwright.studies.read import new_study
from linkwright.synthesis.path import PathGenerator
from linkwright.synthesis.path_model import SPARE, PathModel
from linkwright.synthesis.task import PathTask

# Shortest link over the longest that is allowed: beyond all ratios that are asked for.
_SHORTEST = 1e-3

# Rows of a sweep, unless others are asked for: a power of two.
_ROWS = 1024

# Lengths as entries of the machine that is synthesised.
_LENGTHS = {
    "crank": "mechanism.cranks.A.radius",
    "coupler": "mechanism.rockers.B.coupler",
    "rocker": "mechanism.rockers.B.rocker",
}
_POINT = {key: f"mechanism.rigid_points.P.{key}" for key in ("along", "across")}
_PHASE = "mechanism.cranks.A.phase"

# Grashof's condition, ratio of lengths and minimum transmission angle in closed form; the crank turns fully
# if coupler and rocker meet at both ends of the range of the distance that they span.
_COSINE = (
    "max(abs(coupler^2 + rocker^2 - (frame - crank)^2), abs(coupler^2 + rocker^2 - (frame + crank)^2))"
    "/(2*coupler*rocker)"
)
_OF_LENGTHS = {
    "rotation_margin": (
        "min(coupler + rocker - frame - crank, abs(frame - crank) - abs(coupler - rocker))/frame"
    ),
    "crank_over_frame": "crank/frame",
    "length_ratio": "max(frame, crank, coupler, rocker)/min(frame, crank, coupler, rocker)",
    # The cosine is limited: where the crank does not turn fully it is above 1, and leads back.
    "transmission_cosine_max": _COSINE,
    "transmission_angle_min": f"acos(min(1, {_COSINE}))",
}


def path_study(task: PathTask, generator: PathGenerator) -> StudyPlan:
    """A study of path generation about the linkage that was found, for `optimise`, `sweep` and `tolerance`.

    Its assembly mode is kept. Variables are the lengths, the coupler point, the pivots ``A0_x`` to ``B0_y``
    where they are free and, with crank angles, ``phase``; goal is ``error_rms`` [m] within the task's limits.
    """
    path = {key: getattr(task, key) for key in PathPoints.model_fields if getattr(task, key) is not None}
    tables: dict[str, Any] = {
        "name": f"Path of {generator.machine.name}",
        "variables": _variables(task, generator),
        "derived": {"frame": _frame(task)},
        "paths": {"given": {"point": "P", **path}},
        "responses": {
            "error_rms": "path.given.error_rms",
            "error_max": "path.given.error_max",
            **{name: {"formula": formula} for name, formula in (_OF_LENGTHS | _of_frame(task)).items()},
        },
        "constraints": _limits(task),
        "goals": {"error_rms": "minimise"},
        "sweep": {"method": "sobol", "rows": _ROWS},
    }
    return new_study(generator.machine, tables)


def _variables(task: PathTask, generator: PathGenerator) -> dict[str, Any]:
    """Lengths, the coupler point, pivots and the direction of the crank, within the limits of the task."""
    model = PathModel(task)
    longest = model.longest
    ranges = {name: (address, _SHORTEST * longest, longest) for name, address in _LENGTHS.items()}
    ranges |= {name: (address, -longest, longest) for name, address in _POINT.items()}
    if task.crank_pivot is None:
        for pivot in ("A0", "B0"):
            for axis, ends in zip("xy", model.region, strict=True):
                ranges[f"{pivot}_{axis}"] = (f"mechanism.points.{pivot}.{axis}", *ends)
    if task.crank_angle is not None:
        phase = generator.machine.mechanism.cranks["A"].phase
        ranges["phase"] = (_PHASE, phase - math.pi, phase + math.pi)
    return {name: {"address": address, "range": [low, high]} for name, (address, low, high) in ranges.items()}


def _frame(task: PathTask) -> dict[str, str]:
    if task.crank_pivot is None or task.rocker_pivot is None:
        return {"formula": "sqrt((B0_x - A0_x)^2 + (B0_y - A0_y)^2)"}
    crank, rocker = task.crank_pivot, task.rocker_pivot
    return {"formula": repr(math.hypot(rocker.x - crank.x, rocker.y - crank.y))}


def _of_frame(task: PathTask) -> dict[str, str]:
    return {"frame_length": "frame"} if task.length_max is not None and task.crank_pivot is None else {}


def _limits(task: PathTask) -> dict[str, Any]:
    limits: dict[str, Any] = {
        "rotation_margin": {"min": SPARE},
        "length_ratio": {"max": task.length_ratio_max},
    }
    limits |= {name: {"max": task.length_max} for name in _of_frame(task)}
    if task.transmission_angle_min > 0:
        limits["transmission_cosine_max"] = {"max": math.cos(task.transmission_angle_min)}
    if task.linkage != "any":
        is_double = task.linkage == "double-crank"
        limits["crank_over_frame"] = {"min": 1 + 2 * SPARE} if is_double else {"max": 1 - 2 * SPARE}
    return limits
