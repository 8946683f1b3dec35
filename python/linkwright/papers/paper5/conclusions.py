"""What the numbers of paper 5 say, in sentences that carry their numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from linkwright.papers.paper5.rows import millimetres

if TYPE_CHECKING:
    from linkwright.papers.paper5.paper import Paper5


def conclusions(paper: Paper5) -> list[str]:
    """What the numbers say.

    Parameters
    ----------
    paper : Paper5
        Published and computed values.

    Returns
    -------
    list of str
        A few sentences each.
    """
    return [
        _about_step(paper),
        _about_condition(paper),
        _about_short(paper),
        _about_printed_result(paper),
        _about_exact_result(paper),
        _about_throughout(paper),
        _about_figure(paper),
    ]


def _about_step(paper: Paper5) -> str:
    step = paper.step
    told = ", ".join(
        f"{factor:.3f} at {np.degrees(angle):.0f}°"
        for angle, factor in zip(step.angles.tolist(), step.factors.tolist(), strict=True)
        if angle > 0
    )
    worst = float(step.longer.max())
    return (
        "(5) does not follow from (4). Divided by cos α, (4) has S_x/cos α = d(1 + tan α sin α) before "
        f"v_h/v, (5) has d cos α: the first is (cos α + sin² α)/cos² α times the second, {told}, and 1 at α "
        "= 0 only. The length by (4) is longer by (d + 2Δ)(v_h/v)(1 − cos α)(1 + 2 cos α)/cos α; at v_h/v = "
        f"{paper.verdict.claim.ratios[1]:g} that makes it up to {worst:.2f} times (10) between 0 and "
        f"{np.degrees(step.angles[-1]):.0f}°."
    )


def _about_condition(paper: Paper5) -> str:
    short = paper.short
    return (
        "Condition (1) asks that the knife be not done before the edge has gone over the head; it does not "
        "ask that the edge reach over the head's width. A knife at rest, set straight across the row, shows "
        f"it: both lengths of the paper are {short.across_published:g} there, while the edge must be as long "
        "as the band of the heads, d + 2Δ."
    )


def _about_short(paper: Paper5) -> str:
    short = paper.short
    ratio, angle, _ = short.least_at
    low, high = short.chosen
    return (
        "(10) is too short wherever v_h ≤ v: with tan θ = v_h/v the exact length for constant speed is at "
        "least 2 cos² θ times as long, for every angle, head and offset. For the speeds of the paper that "
        f"is {short.bound:.2f} (the scan finds {short.least:.2f}, at v_h/v = {ratio:g}, α = "
        f"{np.degrees(angle):.0f}°, the band all offset; {short.least_axis:.2f} without offset), for the "
        f"roots and the angle chosen here {low:.2f} to {high:.2f}. The length by (4) is too short as well, "
        f"by a factor of at least {short.least_consistent:.2f}."
    )


def _about_printed_result(paper: Paper5) -> str:
    found, chosen = paper.verdict, paper.published["chosen"]
    low, high = found.claim.lengths
    return (
        f"By (10) the longest edge over all speeds printed lies in {low:.2f}…{high:.2f} m if d + 2Δ = "
        f"{_bands(paper, 'published')}, and whatever the angle no band below {1e3 * found.least_band:.0f} mm "
        f"gives {low:.2f} m. Roots up to D = {1e3 * chosen['root_diameters'][1]:g} mm cut at h_p = "
        f"{1e3 * chosen['cut_height']:g} mm (d = {1e3 * found.diameters[1]:.0f} mm) would have to stand up "
        f"to {_offsets(paper, 'published')} off the row. By (4) the bands are {_bands(paper, 'consistent')}."
    )


def _about_exact_result(paper: Paper5) -> str:
    found = paper.verdict
    need = {each.way: each.length_greatest for each in found.chosen.demands}
    low, high = found.claim.lengths
    return (
        f"By the exact length for constant speed {low:.2f}…{high:.2f} m hold for d + 2Δ = "
        f"{_bands(paper, 'constant_speed')}; the same roots then stand up to "
        f"{_offsets(paper, 'constant_speed')} off the row. For every phase of a harmonic stroke of "
        f"{1e3 * found.stroke.length:g} mm the bands are {_bands(paper, 'every_phase')}. With the roots and "
        f"Δ = {1e3 * found.offset:g} mm chosen here the edge needs {need['constant_speed']:.3f} m at "
        f"constant speed and {need['every_phase']:.3f} m for every phase of the stroke; (10) gives "
        f"{need['published']:.3f} m. So the published length is one that such a machine needs; (10) gives it "
        f"only if heads stand {_offsets(paper, 'published')} off the row, with a half width of "
        f"{0.5e3 * found.diameters[1]:.0f} mm."
    )


def _bands(paper: Paper5, way: str) -> str:
    """Bands of a way at the angles of the table that fields have."""
    told = []
    for verdict in paper.verdict.angles:
        (demand,) = (each for each in verdict.demands if each.way == way)
        told.append(
            f"{millimetres(demand.band_low, demand.band_high)} at {np.degrees(verdict.edge_angle):.0f}°"
        )
    return ", ".join(told[::2])


def _offsets(paper: Paper5, way: str) -> str:
    """Offsets of a way at the angle chosen."""
    found = paper.verdict
    at = int(np.abs([each.edge_angle - found.chosen.edge_angle for each in found.angles]).argmin())
    return f"{millimetres(*found.offsets[way][at])} (at {np.degrees(found.angles[at].edge_angle):.0f}°)"


def _about_throughout(paper: Paper5) -> str:
    found = paper.verdict
    names = {"published": "(10)", "consistent": "(4)", "constant_speed": "the exact length"}
    told = []
    for way, name in names.items():
        ends = (f"{np.degrees(each):.1f}°" for each in found.throughout.get(way, ()))
        told.append(f"by {name} {'for α = ' if way in found.throughout else 'at no angle'}{'…'.join(ends)}")
    retreats = np.degrees(np.arctan(1 / found.claim.ratios[1]))
    return (
        "If instead all lengths over the speeds printed are meant to lie in the range, for one size of "
        f"root, that can be {', '.join(told)}; at {retreats:.1f}° the edge ceases to advance at the greatest "
        "v_h/v."
    )


def _about_figure(paper: Paper5) -> str:
    chosen = paper.published["chosen"]
    told = "; ".join(
        f"{millimetres(float(each.published.min()), float(each.published.max()))} and "
        f"{millimetres(float(each.exact.min()), float(each.exact.max()))} at {each.forward_speed:g} m/s"
        for each in paper.surfaces
    )
    return (
        f"Figure 3 with α = {chosen['edge_angle']:g}°, h_p = {1e3 * chosen['cut_height']:g} mm and Δ = "
        f"{1e3 * chosen['offset']:g} mm, by (10) and exact: {told}. Both grow with D and v_h and fall with v."
    )
