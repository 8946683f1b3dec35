"""``linkwright cam search``: many variants of a cam, and the smallest that keep their limits."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any

from linkwright.kernel.command.answer import Answer
from linkwright.kernel.command.common import Json, Output, belong_to
from linkwright.kernel.command.out import Force
from linkwright.kernel.command.parameter import Group, Option
from linkwright.kernel.command.value import option_value, stepped
from linkwright.kernel.errors import InputError, require_within
from linkwright.kernel.limits import CAM_VARIANTS, SHOWN
from linkwright.kernel.units.kinds import ANGLE, LENGTH, RATIO
from linkwright.machine.file_argument import File
from linkwright.studies.commands.study_file import ToStudy, hand_over_study

if TYPE_CHECKING:
    from linkwright.cam.search import Cams
    from linkwright.kernel.arrays import Bools
    from linkwright.kernel.page.table import Table
    from linkwright.studies.cams import Levels
    from linkwright.studies.plan import StudyPlan

Vary = Annotated[
    list[str] | None,
    Option(
        "--vary",
        "NAME=LOW:HIGH:N",
        'Variable, such as base_radius="20 mm":"60 mm":200 or lift_factor=1:1.2:5: base_radius, '
        "roller_radius, offset, arm_length, face_tilt, lift_factor. Repeatable: all combinations.",
    ),
]
Laws = Annotated[
    list[str] | None,
    Option(
        "--law",
        "NAME",
        "A law of `linkwright cam laws` for all moving sections. Repeatable. Default: those of the file.",
    ),
]
CamName = Annotated[str | None, Option("--cam", "NAME", "Name of the cam, if there are several.")]
Steep = Annotated[
    str | None,
    Option("--pressure-angle", "ANGLE", "Maximum permitted pressure angle. Default: that of the cam."),
]
Tight = Annotated[
    str | None,
    Option("--curvature-radius", "LENGTH", "Minimum permitted convex radius of the profile."),
]
Count = Annotated[int, Option("--count", "N", "Number of cams to show, the smallest first.", min=1)]

To = Annotated[Output, Group(Output, {"json": Json, "force": Force})]

# Cams that are computed exactly at once.
_PORTION = 16


def search(
    file: File,
    vary: Vary = None,
    law: Laws = None,
    cam: CamName = None,
    pressure_angle: Steep = None,
    curvature_radius: Tight = None,
    count: Count = 10,
    study: ToStudy = None,
    *,
    to: To,
) -> None:
    """Find the smallest cams within their limits.

    All cams are compared at the same angles; those shown are analysed exactly and keep their limits at all
    angles. Exit code 1 if none does.
    """
    from linkwright.cam.model.cam import Cam
    from linkwright.cam.profile.profile import the_cam
    from linkwright.cam.search import search_cams
    from linkwright.kernel.description.schema_walk import quantity_of
    from linkwright.studies.cams import cam_search_study, search_entries

    require_within(SHOWN, count, "--count", "show fewer")
    machine = file.read()
    name, chosen = the_cam(machine, cam)
    steep, tight = chosen.limit, chosen.curvature_limit or 0.0
    if pressure_angle is not None:
        steep = option_value("--pressure-angle", pressure_angle, quantity_of(Cam, "pressure_angle_limit"))
    if curvature_radius is not None:
        tight = option_value("--curvature-radius", curvature_radius, quantity_of(Cam, "curvature_limit"))
    plan = cam_search_study(
        machine,
        name,
        over=_levels(vary or []),
        laws=law or [],
        pressure_angle=steep,
        curvature_radius=tight,
    )
    if study is None:
        belong_to("--study", "force")
    else:
        hand_over_study(plan, study, file, machine, to)
    columns = plan.rows(0, plan.n_rows)
    cams = search_cams(
        machine, name, entries=search_entries(plan, columns), laws=law or [], law=columns.get("law")
    )
    keeps = cams.keeps(steep, tight)
    best = _smallest(plan, cams, keeps, count)
    counts = {"n_cams": len(keeps), "n_sound": int(cams.is_sound.sum()), "n_kept": int(keeps.sum())}
    answer = Answer(
        machine=machine,
        results={"cam_search": counts | {"smallest": best}},
        findings=_findings(keeps, best),
        head=f"{len(keeps)} cams evaluated, {counts['n_sound']} sound, {counts['n_kept']} keep the limits",
        tables=partial(_tables, cams, best),
    )
    to.hand_over(answer)


def _levels(wanted: list[str]) -> dict[str, Levels]:
    from linkwright.cam.search import ENTRIES
    from linkwright.studies.cams import Levels

    kinds = {name: LENGTH for name in ENTRIES if name != "distance"}
    kinds |= {"face_tilt": ANGLE, "lift_factor": RATIO}
    example = "base_radius=20mm:60mm:200 for 200 values from 20 to 60 mm"
    axes = stepped("--vary", wanted, kinds, "a size of the cam", example, CAM_VARIANTS)
    if not axes:
        raise InputError(
            "--vary: found nothing that varies, expected such as --vary base_radius=0.02:0.06:200"
        )
    total = math.prod(float(axis.number) for axis in axes.values())
    require_within(CAM_VARIANTS, total, "--vary", "reduce the ranges, or use coarser steps")
    return {name: Levels(*axis) for name, axis in axes.items()}


def _smallest(plan: StudyPlan, cams: Cams, keeps: Bools, count: int) -> list[dict[str, Any]]:
    """The smallest cams that keep the limits exactly: between the angles of a search they may not."""
    import numpy as np

    from linkwright.studies.cams import kept
    from linkwright.studies.engine import evaluate

    order = cams.smallest(keeps, SHOWN.most)
    best: list[dict[str, Any]] = []
    for start in range(0, len(order), _PORTION):
        part = order[start : start + _PORTION]
        drawn = [plan.rows(i, i + 1) for i in part.tolist()]
        rows = evaluate(plan, {name: np.concatenate([row[name] for row in drawn]) for name in drawn[0]})
        for place in np.flatnonzero(kept(plan, rows)).tolist():
            exact = {name: float(column[place]) for name, column in rows.columns.items()}
            best.append(_row(cams, int(part[place]), exact))
        if len(best) >= count:
            break
    return best[:count]


def _row(cams: Cams, i: int, exact: dict[str, float]) -> dict[str, Any]:
    law = cams.laws[int(cams.law[i])] if cams.laws else None
    entries = {key: float(column[i]) for key, column in cams.entries.items()}
    convex = exact["convex_radius"]
    return {
        "law": law,
        **entries,
        "pressure_angle_max": exact["pressure_angle"],
        "curvature_radius_convex_min": convex if math.isfinite(convex) else None,
        "acceleration_max": exact.get("acceleration"),
    }


def _findings(keeps: Bools, best: list[dict[str, Any]]) -> list[str]:
    if best:
        return []
    if not keeps.any():
        return ["No cam keeps the limits: widen the ranges or the limits."]
    looked = min(int(keeps.sum()), SHOWN.most)
    return [
        f"None of the {looked} smallest cams keeps the limits between the sampled angles: widen the "
        "ranges or the limits."
    ]


def _tables(cams: Cams, best: list[dict[str, Any]]) -> list[Table]:
    from linkwright.kernel.page.table import Table
    from linkwright.kernel.reader.numbers import quantity

    units = {"face_tilt": ("rad", "deg"), "lift_factor": ("", "")}
    rows = []
    for nth, cam in enumerate(best, start=1):
        entries = []
        for key in cams.entries:
            unit, usual = units.get(key, ("m", "mm"))
            entries.append(quantity(cam[key], unit, usual=usual))
        convex = cam["curvature_radius_convex_min"]
        rows.append(
            (
                cam["law"] or f"{nth}",
                "",
                *entries,
                quantity(cam["pressure_angle_max"], "rad", usual="deg"),
                "–" if convex is None else quantity(convex, "m", usual="mm"),
            )
        )
    entries = [name.replace("_", " ") for name in cams.entries]
    heads = ("law" if cams.laws else "cam", "", *entries, "pressure angle", "radius of curvature")
    return [Table("cam_search", "The smallest cams", heads, rows)] if rows else []
