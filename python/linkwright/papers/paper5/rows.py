"""Every formula of paper 5, its ranges and its result, with a verdict."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from linkwright.papers.row import Row

if TYPE_CHECKING:
    from linkwright.papers.paper5.paper import Paper5


def rows_of(paper: Paper5) -> tuple[Row, ...]:
    """Every formula and range.

    Parameters
    ----------
    paper : Paper5
        What was computed.
    """
    return (*_given(paper), *_travels(paper), *_lengths(paper), *_limits(paper), *_result(paper))


def millimetres(low: float, high: float) -> str:
    """A range of lengths in millimetres, what is negative left out."""
    if not high > 0:
        return "none"
    return f"{1e3 * max(low, 0.0):.0f}…{1e3 * high:.0f} mm"


def times(low: float, high: float) -> str:
    """A range of ratios."""
    return f"{low:.2f}…{high:.2f} times"


def _given(paper: Paper5) -> list[Row]:
    """Speeds, and what is not printed."""
    given, chosen = paper.published["given"], paper.published["chosen"]
    speeds = ", ".join(f"{v:g}" for v in given["forward_speeds"])
    low, high = given["knife_speeds"]
    small, large = (1e3 * D for D in chosen["root_diameters"])
    ours = (
        f"α = {chosen['edge_angle']:g}°, h_p = {1e3 * chosen['cut_height']:g} mm, "
        f"Δ = {1e3 * chosen['offset']:g} mm, D = {small:g}…{large:g} mm"
    )
    return [
        Row.taken("forward speed v", f"1.6…2.2 m/s, plotted {speeds} m/s"),
        Row.taken("knife speed v_h", f"{low:g}…{high:g} m/s"),
        Row("α, h_p, Δ and D of figure 3", "not printed", ours, "chosen here", "none"),
    ]


def _travels(paper: Paper5) -> list[Row]:
    """Head, travels, conditions."""
    step = paper.step
    least = float(step.travels.min())
    degrees = np.degrees(step.angles[[int(step.travels.argmin())]])[0]
    because = "the discs do not fill the cap of the sphere"
    return [
        Row.agreement("head diameter", "d = 2√(h_p(D − h_p))", paper.head, because),
        Row(
            "(1) condition",
            "t_y ≥ t_x",
            "met by every edge with L ≥ d sin α whose knife rests, however little of the head it covers",
            "needed but not enough: nothing in it asks that the edge be as long as the head is wide",
            "far",
        ),
        Row(
            "(2) travel along the row",
            "S_x = d(cos α + sin² α)",
            f"the edge passes the head in d/cos α, knife at rest: S_x is [1 − sin² α (1 − cos α)] of it, "
            f"{least:.3f} at {degrees:.0f}°",
            "exact at α = 0 only, short of the head elsewhere",
            "near",
        ),
        Row(
            "(3), (4) condition by travels",
            "(L − d sin α) cos α/v_h ≥ S_x/v",
            "breaks a hair below L = d[(v_h/v)(1 + tan α sin α) + sin α], holds a hair above",
            "follows from (1) and (2)" if step.flips else "does not follow from (1) and (2)",
            "reproduced" if step.flips else "far",
        ),
    ]


def _lengths(paper: Paper5) -> list[Row]:
    """(5), (9), (10)."""
    step, at = paper.step, _chosen_angle(paper)
    factor, longer, time = (float(each[at]) for each in (step.factors, step.longer, step.times))
    degrees = np.degrees(step.angles[at])
    why = (
        "S_x/cos α = d(1 + tan α sin α) is (cos α + sin² α)/cos² α of d cos α: "
        f"{factor:.3f} at {degrees:.0f}°"
    )
    rho = f"{paper.verdict.claim.ratios[1]:g}"
    return [
        Row(
            "(5) length, from (4)",
            "L ≥ d[(v_h/v) cos α + sin α]",
            f"{why}; length by (4) {longer:.3f} of (5) at v_h/v = {rho}",
            "does not follow from (4) but for α = 0",
            "far",
        ),
        Row(
            "(5) put into (1)",
            "t_y ≥ t_x",
            f"t_y = {time:.3f} t_x at {degrees:.0f}°, cos² α/(cos α + sin² α) of it at any speed",
            "an edge as long as (5) says breaks the paper's own condition",
            "far",
        ),
        Row(
            "(7)–(9) with offset",
            "L ≥ (d + 2Δ)[(v_h/v) cos α + sin α]",
            "d + 2Δ in place of d, the bracket as in (5)",
            "does not follow from (4) but for α = 0",
            "far",
        ),
        Row(
            "(10) working length",
            "L_h ≥ 2(√(D h_p − h_p²) + Δ)[(v_h/v) cos α + sin α]",
            "(9) with the head diameter put in",
            "follows from (9); too short, see below",
            "near",
        ),
    ]


def _chosen_angle(paper: Paper5) -> int:
    """Where the angle chosen stands in the table."""
    chosen = np.radians(paper.published["chosen"]["edge_angle"])
    return int(np.abs(paper.step.angles - chosen).argmin())


def _limits(paper: Paper5) -> list[Row]:
    """(10) at rest across the row, and against the exact length."""
    short = paper.short
    ratio, angle, _ = short.least_at
    return [
        Row(
            "(10) for v_h = 0, α = 0",
            f"L_h ≥ {short.across_published:g}",
            f"exact {short.across:.4g} · (d + 2Δ)",
            "not the limit: an edge at rest across the row must be as long as the band of the heads",
            "far",
        ),
        Row(
            "(10) against the exact length",
            "L_h, v and v_h as printed",
            f"exact at least {short.least:.2f} times (10), whatever α, d, Δ (at v_h/v = {ratio:g}, α = "
            f"{np.degrees(angle):.0f}°, all band offset), {short.least_axis:.2f} times without offset",
            f"too short everywhere, by {times(*short.chosen)} for the angle and roots chosen",
            "far",
        ),
    ]


def _result(paper: Paper5) -> list[Row]:
    """Figure 3 and the result."""
    slow = paper.surfaces[0]
    least = f"{1e3 * paper.verdict.least_band:.0f} mm"
    return [
        Row(
            "figure 3, L_h over D and v_h",
            "α, h_p, Δ not printed",
            f"with those chosen, at {slow.forward_speed:g} m/s: (10) "
            f"{millimetres(float(slow.published.min()), float(slow.published.max()))}, exact "
            f"{millimetres(float(slow.exact.min()), float(slow.exact.max()))}",
            "no value: the curves cannot be compared",
            "none",
        ),
        _of_result("result by (10)", paper, "published", f"; at no angle below {least}"),
        _of_result("result by the exact length", paper, "constant_speed"),
    ]


def _of_result(name: str, paper: Paper5, way: str, more: str = "") -> Row:
    """The result in one way, at the angle chosen."""
    found = paper.verdict
    (demand,) = (each for each in found.chosen.demands if each.way == way)
    low, high = found.claim.lengths
    return Row(
        name,
        f"L_h = {low:.2f}…{high:.2f} m",
        f"at {np.degrees(found.chosen.edge_angle):g}° for d + 2Δ = "
        f"{millimetres(demand.band_low, demand.band_high)}{more}; the roots chosen have "
        f"{1e3 * found.chosen.band:.0f} mm and need {demand.length_greatest:.3f} m",
        "holds for the roots chosen" if demand.holds else "does not hold for the roots chosen",
        "near" if demand.holds else "far",
    )
