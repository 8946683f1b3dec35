"""Every formula of paper 3 with a verdict."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from linkwright.papers.cell import NEAR, REPRODUCED
from linkwright.papers.row import ROUNDING, Row

if TYPE_CHECKING:
    from linkwright.papers.paper3.paper import Paper3


def rows_of(paper: Paper3) -> tuple[Row, ...]:
    """Every formula.

    Parameters
    ----------
    paper : Paper3
        What was computed.
    """
    return (*_rod(paper), *_disc(paper), *_articulated(paper), *_swing(paper), *_throw(paper))


def share(value: float) -> str:
    """A deviation with its sign, in percent of two digits, not to be parted at the end of a line."""
    if value == 0:
        return "0\N{NO-BREAK SPACE}%"
    text = f"{100 * value:+.2g}" if abs(value) < 0.1 else f"{100 * value:+.0f}"
    return f"{text}\N{NO-BREAK SPACE}%".replace("-", "−")


def judged(deviation: float, because: str = "") -> tuple[str, str]:
    """Verdict in words, and its kind.

    Parameters
    ----------
    deviation : float
        Formula over exact, less one [–].
    because : str
        Why it deviates.
    """
    off = abs(deviation)
    tail = f": {because}" if because else ""
    if off <= ROUNDING:
        return f"holds exactly{tail}", "reproduced"
    if off > NEAR:
        return f"does not hold{tail}", "far"
    # Up to the next digit that tells it.
    scale = 10.0 ** (math.floor(math.log10(off)) - 1)
    return f"holds within {100 * math.ceil(off / scale) * scale:.2g} %{tail}", (
        "reproduced" if off <= REPRODUCED else "near"
    )


def _rod(paper: Paper3) -> list[Row]:
    """(1) to (3)."""
    found, rod = paper.inertia, paper.trial.engine.rod
    centre = "mass and I_w are kept, the centre of mass is not"
    speed = "terms of the order (R/L)³ are left out"
    return [
        Row(
            "(1), (2) rod as two masses",
            "m_1 = I_w/L², m_2 = m − I_w/L²",
            f"m_1 = {rod.mass_pin:.4g} kg, m_2 = {rod.mass_piston:.4g} kg; centre of mass "
            f"{1e3 * found.centre_split:.0f} mm from the big end, not {1e3 * found.centre:.0f} mm; disc of "
            f"the throw {share(found.split)}",
            *judged(found.split, centre),
        ),
        Row(
            "(3) speed of the piston",
            "v = ωR (sin ωt + R/(2L) sin 2ωt)",
            f"off by up to {100 * found.speed:.2g} % of the greatest speed",
            *judged(found.speed, speed),
        ),
    ]


def _disc(paper: Paper3) -> list[Row]:
    """(4) to (9), with the master rod alone."""
    found, (low, high) = paper.inertia, paper.published["printed"]["k"]
    fourth = "the series of the mean ends with its second term"
    centre_low, centre_high = (1 - math.sqrt(each) for each in (low, high))
    return [
        Row(
            "(4)–(7) disc of equal mean energy",
            "I = I_k + R² [m_1 + ½(m_2 + m_3)(1 + R²/(4L²))] + I_a",
            f"master rod alone: {share(found.series)} against the exact mean of the same two masses, "
            f"{share(found.one_rod)} against that of the rod",
            *judged(found.series, fourth),
        ),
        Row(
            "(8) distribution coefficient",
            f"k = I_w/(mL²), usually {low:g}…{high:g}",
            f"k = {found.share:.2f}; with I_w about the small end k is at least (1 − c/L)², so that "
            f"{low:g}…{high:g} needs a centre of mass c ≥ {centre_low:.2f}…{centre_high:.2f} L from the big "
            "end",
            f"the identity holds; the range printed does not: it fits 1 − k = {1 - found.share:.2f}, the "
            "small end's share",
            "far",
        ),
        Row(
            "(9) the same in kgf, cm, s",
            "I = I_k + I_a + 0.00051 R² [(1 + k)G + G_p]",
            f"0.00051 for 1/(2·981) {share(found.factor)}, {share(found.printed)} of the disc; the last "
            f"factor of (7) taken as 1: {share(found.simple)} against the exact disc",
            *judged((1 + found.simple) * (1 + found.printed) - 1, "λ²/4 is left out of the moving masses"),
        ),
    ]


def _articulated(paper: Paper3) -> list[Row]:
    """(10) to (12)."""
    found, rod = paper.inertia, paper.trial.articulated
    ratio = found.articulated_printed / found.articulated
    literal = found.shifts[0]
    times = found.articulated_printed / found.articulated_share
    return [
        Row(
            "(10)–(12) articulated rod",
            "I_a = I_w G_a/G",
            f"I_a = {found.articulated_printed:.3g} kg m² about its small end, exact "
            f"{found.articulated:.3g} kg m²; k = {found.share:.2f} and {rod.share:.2f} are not equal, nor "
            f"are L = {1e3 * paper.trial.engine.rod.length:.0f} and {1e3 * rod.length:.1f} mm",
            *judged(ratio - 1, "the articulated rod is shorter, and its mass spread otherwise"),
        ),
        Row(
            "(7) with I_a as it is",
            "I = … + I_a",
            f"the rod adds {found.articulated_share:.3g} kg m² to the disc, I_a is {times:.0f} times that; "
            f"disc {share(literal.deviation)}, frequencies {_listed(literal.changes)}",
            *judged(literal.deviation, "I_a is about the small end, and does not turn with the crank"),
        ),
        Row(
            "(7) with I_a reduced to the crank pin",
            "not printed",
            f"disc {share(found.shifts[1].deviation)}, though the stroke is {1e3 * found.strokes[1]:.1f} mm "
            f"and not {1e3 * found.strokes[0]:.1f} mm; frequencies {_listed(found.shifts[1].changes)}",
            *judged(found.shifts[1].deviation, "a lighter moving rod and a longer stroke pull opposite ways"),
        ),
    ]


def _listed(changes: np.ndarray) -> str:
    """Changes of the frequencies, one after the other."""
    return ", ".join(share(each) for each in changes.tolist())


def _swing(paper: Paper3) -> list[Row]:
    """(13) to (15)."""
    found = paper.swing
    factor = "358000 stands for 357826"
    return [
        Row(
            "(13) about the knife edge",
            "I = (G/g) b · 358000/n²",
            f"n = {found.swings[0]:.2f} a minute; {share(found.edge)}",
            *judged(found.edge, factor),
        ),
        Row(
            "(14) about the centre of mass",
            "I_S = (G/g) b (358000/n² − b)",
            share(found.centre),
            *judged(found.centre, f"{factor}, in a difference of large numbers"),
        ),
        Row(
            "centre of mass by two swings",
            "b = L_1(A_1 − L_1)/(A_1 + A_2 − 2L_1)",
            f"exact but for rounding with 357826; {share(found.two_point)} with 358000",
            *judged(found.two_point, factor),
        ),
        Row(
            "(15) about the small end",
            "I_w = (G/981) [358000 b/n² − 2bc + c²]",
            share(found.axis),
            *judged(found.axis, factor),
        ),
    ]


def _throw(paper: Paper3) -> list[Row]:
    """(16), (17)."""
    found = paper.throw
    stiffness = ", ".join(f"{name} {1e-6 * each:.3g}" for name, each in found.stiffness.items())
    return [
        Row(
            "(16) inertia of the throw",
            "damaged",
            f"from hollow cylinders and parallel axes: {share(found.inertia)} against the exact shapes with "
            "oblique drillings",
            "cannot be read: built anew; then it " + judged(found.inertia)[0],
            "near",
        ),
        Row(
            "(17) compliance of the throw",
            "damaged; the chart for k is lost",
            f"k = {found.restraint:.3f} m by Castigliano; stiffness in MN m/rad: {stiffness}",
            f"cannot be read: built anew after its structure; formulas of other authors lie "
            f"{_range(list(found.stiffness.values()))} from it",
            "near",
        ),
    ]


def _range(stiffness: list[float]) -> str:
    """Smallest and largest deviation from the first."""
    first, *rest = stiffness
    return f"{share(min(rest) / first - 1)} to {share(max(rest) / first - 1)}"
