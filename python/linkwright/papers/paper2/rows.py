"""Every printed number and formula of paper 2 with a verdict."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkwright.papers.cell import Cell
from linkwright.papers.paper2 import checks
from linkwright.papers.paper2.formulas import SECTIONS, Formulas
from linkwright.papers.row import Row

if TYPE_CHECKING:
    from linkwright.cam.profile.profile import CamProfile
    from linkwright.papers.paper2.start import Starts

_TRAVELS = {"start": "S_p = 3/5 v t_p", "steady": "S_y = v t_y", "stop": "S_g = 3/5 v t_g"}


def rows_of(formulas: Formulas, profile: CamProfile, starts: Starts) -> tuple[Row, ...]:
    """Every printed number and formula.

    Parameters
    ----------
    formulas : Formulas
        As printed.
    profile : CamProfile
        By the general synthesis.
    starts : Starts
        The printed start section, and those of least ∫ jerk².
    """
    return (
        Row.taken("Δx, t_3", f"{formulas.stroke} m, {formulas.time} s"),
        Row.taken("t_p : t_y : t_g", "1/6 : 2/3 : 1/6 of t_3"),
        *_numbers(formulas, profile),
        *_motion(formulas, profile),
        *_profile(formulas, profile),
        *_statements(starts),
    )


def _numbers(formulas: Formulas, profile: CamProfile) -> list[Row]:
    """(4) to (10), and what (1) to (3) say of the extremes."""
    law = profile.cam.lift
    places = [float(law.at(x)) for x in (0.0, *law.breaks[1:4])]
    rows = [_row("v = 15 Δx/(13 t_3)", "m/s", formulas.speed, profile.speed_constant)]
    for section, low, high in zip(SECTIONS, places, places[1:], strict=False):
        rows.append(_row(_TRAVELS[section], "m", formulas.travels[section], high - low))
    travel, stroke = formulas.printed["travel"], formulas.stroke
    for words, key, place in (
        ("3/26 Δx, where constant speed begins", "steady_from", places[1]),
        ("23/26 Δx, where it ends", "steady_to", places[2]),
    ):
        rows.append(_row(words, "m", travel[key][0] / travel[key][1] * stroke, place))
    rows.append(_row("ẍ_max = 16/9 v/t_p by (1)", "m/s²", checks.peak(formulas, 2), profile.acceleration_max))
    rows.append(_row("jerk_max = 12 v/t_p² by (1)", "m/s³", checks.peak(formulas, 3), profile.jerk_max))
    return rows


def _row(name: str, unit: str, printed: float, computed: float | None) -> Row:
    """A number against that of the machine's law."""
    shown = "" if computed is None else f"{computed:.10g} {unit}"
    return Row.number(name, unit, Cell(printed, computed, "the machine has another law"), shown)


def _motion(formulas: Formulas, profile: CamProfile) -> list[Row]:
    """(1) to (3) against the law, and against one another."""
    rows = [
        Row.agreement(
            f"(1)–(3), {name}",
            "there and back",
            checks.motion_difference(formulas, profile, order),
            "the law of the machine is another",
        )
        for order, name in enumerate(checks.NAMES)
    ]
    for section, equation in zip(SECTIONS, ("(1)", "(2)", "(3)"), strict=True):
        off = checks.chain_difference(formulas, section)
        rows.append(
            Row.agreement(f"{equation} by itself", "each line the derivative", off, "a line does not follow")
        )
    off = checks.mirror_difference(formulas)
    rows.append(Row.agreement("(3) from (1)", "the mirror image", off, "they differ"))
    off = checks.joint_difference(formulas)
    rows.append(Row.agreement("(1), (2), (3) at their joints", "ẋ and ẍ continuous", off, "there is a step"))
    return rows


def _profile(formulas: Formulas, profile: CamProfile) -> list[Row]:
    """(17) to (22)."""
    return [
        Row.agreement(
            "(17)–(22), ρ(φ)",
            "six branches",
            checks.radius_difference(formulas, profile),
            "the profile of the machine is another",
        ),
        Row.agreement(
            "(17)–(22) at their joints",
            "one closed curve",
            checks.radius_joint_difference(formulas),
            "there is a step",
        ),
        Row.agreement(
            "ρ(φ) + ρ(φ + π)", "b", checks.diameter_difference(formulas, profile), "it is not constant"
        ),
    ]


def _statements(starts: Starts) -> list[Row]:
    """What is said of the start section in words."""
    printed, free = starts.printed, starts.free_travel
    return [
        Row(
            "(1), least ∫ jerk²",
            "the minimum under the end conditions",
            f"{printed.cost:.4g} v²/t_p³; {free.cost:.4g} v²/t_p³ with free travel",
            f"holds for the fixed travel {printed.travel:.4g} v t_p only",
            "near",
        ),
        Row(
            "start and braking without impact",
            "ẍ continuous",
            f"jerk at the stroke ends from +{printed.jerk_max:.4g} to −{printed.jerk_max:.4g} v/t_p²",
            f"ẍ is continuous; the jerk has a step of {2 * printed.jerk_max:.4g} v/t_p²",
            "near",
        ),
    ]
