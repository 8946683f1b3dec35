"""What the numbers of paper 4 say, in sentences that carry their numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from linkwright.papers.paper4.paper import Paper4


def conclusions(paper: Paper4) -> list[str]:
    """What the numbers say.

    Parameters
    ----------
    paper : Paper4
        Published and computed values.

    Returns
    -------
    list of str
        A few sentences each.
    """
    return [
        _about_unit(paper),
        _about_places(paper),
        _about_turning(paper),
        _about_change_points(paper),
        _about_printed(paper),
        _about_swing(paper),
    ]


def _deg(angle: float) -> str:
    return f"{np.degrees(angle):.2f}°".replace("-", "−")


def _about_unit(paper: Paper4) -> str:
    unit, (l_4, l_5) = paper.unit, paper.rounded
    (_, top), (_, bottom) = unit.ends()
    printed = paper.published["continuous"]
    return (
        f"The printed l_4 = {printed['l_4']} m and l_5 = {printed['l_5']} m mean extremes of the diagonal of "
        f"{unit.extremes()[0]:.3f} and {unit.extremes()[1]:.3f} m. With the stroke S = 3 m, (5) and (6) then "
        f"give k_1 = {unit.k_1:.4f} m, φ_3max = {_deg(top)} and φ_3min = {_deg(bottom)}. With k_1 = 3 m and "
        f"a beam so placed that l_4 = {l_4:.3f} m comes out, l_5 = {l_5:.4f} m, 0.3 m to the digit printed: "
        "k_1 = 3 m serves as well."
    )


def _about_places(paper: Paper4) -> str:
    chosen, other = paper.places
    texts = [
        f"({each.unit.x:.3f}, {each.unit.y:.3f}) m, least angle between pitman and beam "
        f"{_deg(each.least_angle)}"
        for each in (chosen, other)
    ]
    return (
        (
            "With r, L and k as printed, crank and pitman in line at both ends of the stroke put the "
            f"crankshaft at {' or at '.join(texts)}, from the saddle bearing. The second would jam; the "
            f"machine files take the first, with the upstroke over {_deg(chosen.upstroke)} of the crank, "
            "slow under load."
        )
        .replace("(-", "(−")
        .replace(", -", ", −")
    )


def _about_turning(paper: Paper4) -> str:
    turning = paper.continuous
    return (
        f"Continuous regime: the lever makes {turning.lever_turns_per_cycle:.0f} turn in a turn of the "
        f"crank, with dφ_5/dφ_1 = {turning.transfer_min:.4f}…{turning.transfer_max:.4f}: one sign, never "
        f"zero, as printed. φ_5 stays within {_deg(paper.straightness)} of a straight line."
    )


def _about_change_points(paper: Paper4) -> str:
    turning = paper.continuous
    angles = " and ".join(_deg(each) for each in turning.change_points)
    return (
        f"At crank angles {angles} link and lever are in line: change points, where (11) to (17) give 0/0. "
        "Without friction the lever goes on in its sense; but the link has no arm there, so a string torque "
        "can be overcome only by the lever's momentum, of which the paper says nothing."
    )


def _about_printed(paper: Paper4) -> str:
    printed = paper.printed_intermittent
    least, greatest = printed.unit.extremes()
    edges = " and ".join(_deg(each) for each in paper.closing)
    return (
        f"The printed lengths of the intermittent regime, l_4 = {printed.l_4} m and l_5 = {printed.l_5} m, "
        f"reach {printed.l_4 + printed.l_5:.1f} m, the diagonal {greatest:.3f} m. They close between crank "
        f"angles {edges} (from 12 o'clock, counter-clockwise) and not in the lower part of the stroke. "
        f"Rocking needs l_4 + l_5 > {greatest:.3f} m and l_4 − l_5 < {least:.3f} m, hence l_5 > "
        f"{0.5 * (greatest - least):.3f} m."
    )


def _about_swing(paper: Paper4) -> str:
    rocking = paper.intermittent
    return (
        f"Lengths that rock the lever through {_deg(rocking.lever_swing)}: l_4 = {rocking.link_length:.4f} "
        f"m, l_5 = {rocking.lever_length:.4f} m, with dφ_5/dφ_1 = "
        f"{rocking.transfer_min:.4f}…{rocking.transfer_max:.4f}."
    ).replace("= -", "= −")
