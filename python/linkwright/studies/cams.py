"""Studies of cams: a grid of sizes, lift and laws, of which the smallest that keep their limits are sought.

| varied | entry of the cam |
| --- | --- |
| `base_radius`, `roller_radius`, `offset`, `arm_length`, `face_tilt` | the same |
| `lift_factor` | the largest lift or swing; those of the other sections follow in proportion |
| a law | the law of all sections that move |
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from linkwright.cam.model.cam import Cam
from linkwright.cam.model.motion_section import ENDS
from linkwright.cam.profile.profile import the_cam
from linkwright.cam.search import require_law, useful_entries
from linkwright.kernel.arrays import Bools, Floats
from linkwright.kernel.errors import InputError
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.units.kinds import ANGLE, LENGTH
from linkwright.kernel.units.marks import not_negative, positive
from linkwright.machine.machine import Machine
from linkwright.studies.axes import between
from linkwright.studies.plan import StudyPlan
from linkwright.studies.read import new_study
from linkwright.studies.responses import entry_number
from linkwright.studies.rows import SOLVED, Rows

# Share by which a cam may pass a limit by rounding.
_ROUNDING = 1e-12


class Levels(NamedTuple):
    """Values of a variable in a grid: `steps` of them from `low` to `high` [SI]."""

    low: float
    high: float
    steps: int


def cam_search_study(
    machine: Machine,
    name: str | None = None,
    *,
    over: Mapping[str, Levels],
    laws: Sequence[str] = (),
    pressure_angle: float,
    curvature_radius: float = 0.0,
) -> StudyPlan:
    """A study of the smallest cam of a grid within its limits, for `sweep` and `optimise`.

    `over`: what varies, by the names of `linkwright.cam.search.ENTRIES` without ``distance``; `laws`: names
    of laws, one of which all moving sections follow, and which vary slowest. Permitted are a pressure angle
    [rad] and a convex radius [m]. Raises `InputError` where there is no such cam, entry, law or lift.
    """
    in_range(
        pressure_angle=(pressure_angle, positive(ANGLE)),
        curvature_radius=(curvature_radius, not_negative(LENGTH)),
    )
    name, cam = the_cam(machine, name)
    place = f"mechanism.cams.{name}"
    variables: dict[str, Any] = {}
    derived: dict[str, Any] = {}
    responses: dict[str, Any] = {}
    if laws:
        variables["law"] = _laws(cam, place, laws)
    for entry, levels in over.items():
        useful_entries(cam, entry)
        if entry == "lift_factor":
            variables["lift"], derived, responses[entry] = _lifts(cam, place, levels)
        else:
            variables[entry] = {"address": f"{place}.{entry}", **_levels(levels)}
    # Without a design speed there are none over time.
    has_speed = machine.drive is not None and machine.drive.speed is not None
    acceleration = {"acceleration": f"cam.{name}.acceleration_max"} if has_speed else {}
    base = {"formula": "base_radius"} if "base_radius" in over else {"entry": f"{place}.base_radius"}
    responses |= {
        "size": base,
        "pressure_angle": f"cam.{name}.pressure_angle_max",
        "convex_radius": {"quantity": f"cam.{name}.curvature_radius_convex_min", "otherwise": np.inf},
        **acceleration,
        "faults": f"cam_check.{name}.n_faults",
    }
    limits = {
        "pressure_angle": {"max": pressure_angle},
        "convex_radius": {"min": curvature_radius},
        "faults": {"max": 0.0},
    }
    tables = {
        "variables": variables,
        "derived": derived,
        "responses": responses,
        "constraints": limits,
        "goals": {"size": "minimise"},
        "sweep": {"method": "grid"},
    }
    return new_study(_with_base(machine, name, cam, over), tables)


def kept(plan: StudyPlan, rows: Rows) -> Bools:
    """Which rows have an answer within all limits, to rounding, (n,)."""
    keeps: Bools = rows.status == SOLVED
    for name, (low, high) in plan.limits.items():
        column = rows.columns[name]
        keeps &= (column <= high * (1 + _ROUNDING)) & (column >= low * (1 - _ROUNDING))
    return keeps


def search_entries(plan: StudyPlan, rows: Mapping[str, Floats]) -> dict[str, Floats]:
    """Columns of `linkwright.cam.search.search_cams` by those of the variables of a study of cams."""
    entries = {name: column for name, column in rows.items() if name not in ("law", "lift")}
    if "lift" in rows:
        (reference,) = (axis.addresses[0] for axis in plan.axes if axis.name == "lift")
        entries["lift_factor"] = rows["lift"] / entry_number(plan.machine, reference)
    return {name: entries[name] for name in _asked(plan) if name in entries}


def _asked(plan: StudyPlan) -> list[str]:
    return ["lift_factor" if axis.name == "lift" else axis.name for axis in plan.axes]


def _levels(levels: Levels, factor: float = 1.0) -> dict[str, Any]:
    """Values of a variable: its levels times a factor above zero."""
    return between(factor * levels.low, factor * levels.high, levels.steps)


def _laws(cam: Cam, place: str, laws: Sequence[str]) -> dict[str, Any]:
    for law in laws:
        require_law(law)
    moving = [
        f"{place}.sections.{nth}.law"
        for nth, section in enumerate(cam.sections)
        if not (section.is_dwell or section.is_steady)
    ]
    if not moving:
        raise InputError(f"{place}: found no section with a law, expected one that moves")
    return {"address": moving, "values": list(laws)}


def _lifts(cam: Cam, place: str, levels: Levels) -> tuple[dict[str, Any], dict[str, Any], dict[str, Any]]:
    entries = dict(_motions(cam))
    first = max(
        entries, key=lambda key: entries[key] if key[1] in ("lift", "swing") else -np.inf, default=None
    )
    if first is None or entries[first] <= 0:
        raise InputError(f"{place}: found no lift in its sections, expected one for lift_factor")
    reference = entries.pop(first)
    derived = {
        f"{key}_{nth}": {
            "formula": f"lift*{value / reference!r}",
            "address": f"{place}.sections.{nth}.{key}",
        }
        for (nth, key), value in entries.items()
    }
    variable = {"address": f"{place}.sections.{first[0]}.{first[1]}", **_levels(levels, reference)}
    return variable, derived, {"formula": f"lift/{reference!r}"}


def _motions(cam: Cam) -> Iterator[tuple[tuple[int, str], float]]:
    ends = [f"{kind}{end}" for kind in ("", "swing_") for end in ENDS]
    for nth, section in enumerate(cam.sections):
        for key in ("lift", "swing", *ends):
            value = getattr(section, key)
            if value:
                yield (nth, key), float(value)


def _with_base(machine: Machine, name: str, cam: Cam, over: Mapping[str, Levels]) -> Machine:
    """The machine whose cam has a base radius, and no breadth that would give it, if that varies."""
    if "base_radius" not in over or cam.breadth is None:
        return machine
    own = cam.with_entries({"breadth": None, "base_radius": over["base_radius"].low})
    mechanism = machine.mechanism
    cams = {**mechanism.cams, name: own}
    return machine.with_entries({"mechanism": mechanism.with_entries({"cams": cams})})
