"""Paper 2 computed anew: a cart moved by a cam of constant diameter with a combined motion law.

Stroke and time of the worked case are printed, the distance b of the followers is not: it is that of the
machine in the library, ``roller_cam``.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from linkwright.cam.profile.profile import CamProfile, cam_profile
from linkwright.papers.claim import tolerance
from linkwright.papers.paper import Paper, printed_values
from linkwright.papers.paper2.alternatives import Alternative, alternatives
from linkwright.papers.paper2.cam_motion import Course, Rollers, Start, course, rollers, starts, two_cams
from linkwright.papers.paper2.formulas import Formulas, breadth_of, checks

# Cam angles per revolution of the curves.
_ANGLES = 1440

# Share of a force up to which another is nothing beside it: that of sums of products of some hundred numbers.
_NOTHING = 1e-9


@dataclass(frozen=True)
class Paper2(Paper):
    """Paper 2, published against computed."""

    formulas: Formulas  # the printed formulas
    profile: CamProfile  # the cam by the general synthesis
    starts: dict[str, Start]  # the start section, and those of minimum ∫ jerk²
    rollers: Rollers  # rollers on the printed profile
    pair: dict[str, float]  # forces of one cam against two [N]
    alternatives: tuple[Alternative, ...]  # the printed law, the crank drive, other laws
    course: Course  # the cart in steady motion

    def quantities(self) -> dict[str, Any]:
        """Checks of the formulas, drives by name, and one beside another [–]."""
        checked = checks(self.formulas, self.profile)
        return {"checks": checked, **self._of_formulas(checked), **self._of_starts(), **self._of_drives()}

    def _of_formulas(self, checked: dict[str, Any]) -> dict[str, Any]:
        formulas, profile, printed = self.formulas, self.profile, self.starts["printed"]
        differences = [*checked["motion"], *checked["chain"].values()]
        differences += [checked[name] for name in ("mirror", "joint", "radius", "radius_joint", "diameter")]
        sides = np.flatnonzero(np.diff(np.sign(profile.curvature_radius)))
        return {
            "breadth": breadth_of(profile),
            "factors": {
                "acceleration": _fraction(printed.acceleration_max),
                "jerk": _fraction(printed.jerk_max),
                "steady": _fraction(formulas.travels["steady"] / formulas.stroke),
            },
            "peaks": {"acceleration": formulas.peak(2), "jerk": formulas.peak(3)},
            "hollows": profile.angle[sides].reshape(-1, 2).tolist(),
            "formulas_agree": max(differences) <= tolerance("rounding").reproduced,
            "diameter_is_constant": profile.opposite is not None and profile.opposite.is_constant,
            "rollers_need_offset": self.rollers.play > _NOTHING * self.rollers.radius,
            "pair_cancels": self.pair["left_over"] < _NOTHING * self.pair["side_force"],
        }

    def _of_starts(self) -> dict[str, Any]:
        printed, fixed, free, turn = self.starts.values()
        share = self.formulas.times["start"] / self.formulas.time
        same = tolerance("rounding").reproduced
        exceeds = {name: printed.cost / start.cost - 1 for name, start in (("fixed", fixed), ("free", free))}
        return {
            "saved": 1 - free.over_stroke(share) / printed.over_stroke(share),
            "cost_share": turn.cost / printed.cost,
            "jerk_step": 2 * printed.jerk_max,
            "is_minimum": exceeds["free"] <= same,
            "is_minimum_for_travel": abs(exceeds["fixed"]) <= same,
            "is_no_minimum": exceeds["free"] > same and abs(exceeds["fixed"]) <= same,
            "is_smooth": bool(printed.law.at(0.0, 2) == 0) and bool(printed.law.at(0.0, 3) == 0),
            "is_soft": bool(printed.law.at(0.0, 2) == 0) and bool(printed.law.at(0.0, 3) != 0),
        }

    def _of_drives(self) -> dict[str, Any]:
        laws = {alternative.short: alternative for alternative in self.alternatives}
        cam, crank = laws["as printed"], laws["crank"]
        free, smooth = laws["free at the reversal"], laws["continuous jerk"]
        smoothest = [law for law in laws.values() if law.steady_share < _NOTHING and law is not crank]
        low, high = self.course.steady_range
        peaks = ("velocity_max", "acceleration_max", "jerk_max", "torque_max")
        lower = all(getattr(free, name) < getattr(cam, name) for name in peaks)
        return {
            "laws": laws,
            "over_crank": {name: getattr(cam, name) / getattr(crank, name) for name in peaks},
            "torque_saved": 1 - cam.torque_max / crank.torque_max,
            "force_added": cam.force_max / crank.force_max - 1,
            "dynamism_over_crank": cam.steady.dynamism / crank.steady.dynamism,
            "smooth_added": {name: getattr(smooth, name) / getattr(cam, name) - 1 for name in peaks},
            "smooth_jerk": smooth.jerk_max / cam.jerk_max,
            "turn_is_better": lower and free.steady.unevenness < cam.steady.unevenness,
            "cam_beside_crank": cam.torque_max < crank.torque_max and cam.jerk_max > crank.jerk_max,
            "other_laws_cost": all(drive.torque_max > cam.torque_max for drive in (smooth, *smoothest)),
            "faster": self.course.speed_mean / self.course.speed_design - 1,
            "kept": 0.5 * (low + high),
            "kept_within": high - low,
            "holds_speed": high - low < 1 - low,
            "deviates_at_start": 2 * self.course.deviation_time / self.course.period % 1 < 0.5,
        }

    def entries(self) -> dict[str, Any]:
        """Computed values, ready for JSON."""
        rolled = {name: value for name, value in vars(self.rollers).items() if name != "offset"}
        return {
            "cam": self.profile.to_dict(),
            "start_section": {name: start.to_dict() for name, start in self.starts.items()},
            "rollers": rolled | {"cam": self.rollers.offset.to_dict()},
            "two_cams": self.pair,
            "alternatives": [alternative.to_dict() for alternative in self.alternatives],
            "steady_motion": self.course.to_dict(),
        }


def _fraction(value: float) -> str:
    return str(Fraction(value).limit_denominator(100))


def paper2() -> Paper2:
    """Compute paper 2 anew. Source: Paper 2, whole."""
    data = printed_values(2)
    formulas, name = Formulas(data), data["given"]["machine"]
    drives = alternatives(formulas)
    profile = cam_profile(drives[0].machine, n=_ANGLES)
    return Paper2(
        data,
        formulas=formulas,
        profile=profile,
        starts=starts(formulas),
        rollers=rollers(profile, name, data["chosen"]["roller_radius"]),
        pair=two_cams(name, profile.name),
        alternatives=drives,
        course=course(drives[0], formulas),
    )
