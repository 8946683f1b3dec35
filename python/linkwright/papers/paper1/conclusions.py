"""What the numbers of paper 1 say, in sentences that carry their numbers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from linkwright.drive.reduction import Reduction
from linkwright.papers.published import QUANTITIES

if TYPE_CHECKING:
    from linkwright.papers.paper1.paper import Drive, Paper1


def conclusions(paper: Paper1) -> list[str]:
    """What the numbers say.

    Parameters
    ----------
    paper : Paper1
        Published and computed values.

    Returns
    -------
    list of str
        A few sentences each.
    """
    one, two, three, four = paper.drives
    return [
        _about_two(two),
        _about_scheme(paper, two),
        _about_load(two),
        _about_fit(one, three),
        _about_four(paper, four),
        _about_rows(paper.drives),
        _about_ranking(paper),
        _about_motors(paper.drives),
    ]


def load_at_degrees(reduced: Reduction) -> float:
    """Mean resisting torque at the whole degrees of a turn, as a table by degrees gives it [N m].

    Parameters
    ----------
    reduced : Reduction
        With a multiple of 360 intervals.

    Returns
    -------
    float
        The sum of 360 values over 360.
    """
    every = (len(reduced.crank_angle) - 1) // 360
    return float(reduced.torque_load[:-1:every].mean())


def _about_two(two: Drive) -> str:
    exact, row = two.steady, two.published.values
    limit = two.values["limit"]
    return (
        "The published row of the two carts is not the solution of (1). With the printed data (1) gives "
        f"ω = {exact.speed_min:.3f}…{exact.speed_max:.3f} rad/s, δ = {exact.unevenness:.4f} and "
        f"H = {exact.dynamism:.4f}, against {row['unevenness']} and {row['dynamism']} published: the steep "
        "characteristic of the motor halves the fluctuation. Without motor and load, at constant energy, "
        f"δ = {limit['unevenness']:.4f} and H = {limit['dynamism']:.4f}."
    )


def _about_scheme(paper: Paper1, two: Drive) -> str:
    found, row = two.values["scheme"], two.published.values
    steps = ", ".join(f"{step:g}° {100 * off:.3f} %" for step, off in paper.steps.items())
    return (
        "The row arises when the net torque in (4) is divided by the gear ratio and the motor starts along a "
        f"straight line: by steps of 1° ω = {found['speed_min']:.3f}…{found['speed_max']:.3f} rad/s "
        f"({row['speed_min']}…{row['speed_max']} published), δ = {found['unevenness']:.4f}, steady after "
        f"{found['turns']:.0f} turns ({row['turns']} published). Root mean square deviation of the two "
        "speeds "
        f"by step: {steps}. Half a degree and one degree come nearest; one degree alone gives ω_max and the "
        "printed mean of M_0 to all digits, so that is most likely the paper's step."
    )


def _about_load(two: Drive) -> str:
    reduced = two.reduced
    return (
        f"The mean of M_0 over the turn is {reduced.torque_load_mean:.2f} N m. Taken at the whole "
        "degrees, as "
        f"a table by steps of 1° does, it is {load_at_degrees(reduced):.2f} N m, the printed value: the "
        "corners "
        "of the friction at the dead centres cost the sum 0.02 N m. Required power and design speed are "
        "reproduced."
    )


def _about_fit(one: Drive, three: Drive) -> str:
    texts = [
        f"row {each.published.carts} with I_0 i² = {each.fit.inertia:.1f} kg m² to "
        f"{100 * each.fit.misfit:.1g} % ({each.drive_inertia:.1f} with the motor of our file, by which the "
        f"published scheme gives δ = {each.values['scheme']['unevenness']:.4f}, "
        f"{each.published.values['unevenness']} published)"
        for each in (one, three)
    ]
    return f"The constant-energy limit fits {' and '.join(texts)}."


def _about_four(paper: Paper1, four: Drive) -> str:
    J, row, least, opposed = four.reduced, four.published.values, four.fit, paper.opposed
    return (
        f"Row 4 fits no inertia. Four carts at 90° have I = {J.inertia_min:.1f}…{J.inertia_max:.1f} kg "
        "m², and "
        f"even without any inertia of the drive δ = {least.unevenness:.4f}, not {row['unevenness']}. "
        "Four carts "
        f"at 180°, two against two, with I_0 i² = {opposed.inertia:.0f} kg m² would give "
        f"δ = {opposed.unevenness:.3f} and H = {opposed.dynamism:.3f}; other arrangements come as near, "
        "so this "
        "is no proof."
    )


def _about_rows(drives: Sequence[Drive]) -> str:
    wrong = [
        f"row {drive.published.carts}: {QUANTITIES[each.quantity][0]} printed {each.printed:g}, "
        f"{each.formula} of the printed values {each.follows:.4f}"
        for drive in drives
        for each in drive.recomputed
        if not each.agrees
    ]
    return (
        f"The printed table agrees with itself to one in the last digit but for {'; '.join(wrong)}. With δ "
        "before rounding, 0.26555, k_p of row 4 agrees; the means of rows 3 and 4 are not those of the "
        "extremes."
    )


def _about_ranking(paper: Paper1) -> str:
    ways = [f"{way}: {', '.join(map(str, order))}" for way, order in paper.rankings.items()]
    return (
        f"Numbers of carts from the most even drive to the least, by k_p. {'; '.join(ways)}. By every "
        "computation the four carts at 90° are the most even drive by far; the paper puts them third."
    )


def _about_motors(drives: Sequence[Drive]) -> str:
    values = [f"{drive.published.carts}: {drive.steady.motion_coefficient:.4f}" for drive in drives]
    sized = [
        f"{drive.published.carts}: {drive.sized_motor}, {drive.sized.motion_coefficient:.4f}"
        for drive in drives
        if drive.sized
    ]
    return (
        "The motors of one, three and four carts are not printed, and their inertias are estimates. k_p "
        "of (1) "
        f"with motors by rated power is {'; '.join(values)}: two and three carts are equal within that "
        "doubt. "
        "By torque the motors of one, two and three carts are too small (linkwright size); with motors that "
        f"pass all checks k_p is {'; '.join(sized)}."
    )
