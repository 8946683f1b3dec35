"""What a report says of a topper beside its numbers: headline, formulas, assumptions."""

from __future__ import annotations

import math
from collections.abc import Iterator

from linkwright.kernel.page.formulas import Formula
from linkwright.kernel.reader.numbers import degrees, parted
from linkwright.topping.model.topper import Topper
from linkwright.topping.topper import TopperStudy

_PAPER = (
    "Paper 5: “Кінематичний аналіз переміщення ножа обрізника по головці коренеплоду” (Kinematic analysis of "
    "the movement of a topper's knife over the head of a root)"
)

_DERIVED = "derived for any law of the knife"

_FORMULAS = (
    Formula("Diameter of the head in the plane of the cut", "d = 2 root(h_p ( D − h_p ))", "paper 5"),
    Formula("Condition of a complete cut", "t_y = frac(S_y|v_h) ≥ t_x = frac(S_x|v)", "paper 5 (1), (3)"),
    Formula(
        "Travels, with the band of the heads",
        "S_x = ( d + 2 Δ ) ( cos α + sin^2 α ) , S_y = ( L − ( d + 2 Δ ) sin α ) cos α",
        "paper 5 (2), (8)",
    ),
    Formula("Length of the edge as printed", "L ≥ ( d + 2 Δ ) ( frac(v_h|v) cos α + sin α )", "paper 5 (10)"),
    Formula(
        "Length that follows from the condition",
        "L ≥ ( d + 2 Δ ) [ frac(v_h|v) ( 1 + tan α sin α ) + sin α ]",
        "paper 5 (4), divided by cos α",
    ),
    Formula(
        "Exact length at constant speed, worse direction",
        "L = frac(d root(v^2 + v_h^2) + 2 Δ v|v cos α − v_h sin ∣α∣)",
        "derived: width of the swept band",
    ),
    Formula(
        "Middle of the edge from the head's centre, along the edge and normal to it",
        "q = v t sin α + ( y − δ ) cos α , p = v t cos α − ( y − δ ) sin α",
        _DERIVED,
    ),
    Formula(
        "Exact length while p rises: all chords of the head",
        "L = 2 max [ ∣q∣ + root(frac(d^2|4) − p^2) ]",
        _DERIVED,
    ),
)

_EVERY_PHASE = Formula(
    "The same in every phase of a stroke S, if the edge never retreats",
    "L = frac(S + d + 2 Δ|cos α)",
    _DERIVED,
)

_SLICING = Formula(
    "Draw-cut ratio: speed along the edge over speed normal to it",
    "frac(∣ v sin α + ẏ cos α ∣|v cos α − ẏ sin α)",
    "Goryachkin, Collected Works",
)


def topper_headline(described: Topper, study: TopperStudy) -> Iterator[tuple[str, str, str]]:
    """The few numbers that one looks for first: word, value, unit."""
    yield "head diameter d", *parted(study.head_diameter, "m", usual="mm")
    needed = study.length_exact
    if not study.obstacle:
        yield (
            "required edge length",
            *(parted(needed, "m", usual="mm") if math.isfinite(needed) else ("none does", "")),
        )
    yield "edge length L", *parted(described.edge_length, "m", usual="mm")
    if not study.obstacle:
        yield "maximum uncut share", *parted(100 * study.uncut_share, "%", 3)
    if study.stroke:
        yield "knife frequency", *parted(study.frequency, "1/s", 3)


def topper_formulas(described: Topper, study: TopperStudy) -> list[Formula]:
    """Formulas of the lengths and of slicing."""
    moves = described.motion.phase is None and study.stroke > 0
    return [*_FORMULAS, *([_EVERY_PHASE] if moves else []), _SLICING]


def topper_papers(described: Topper) -> tuple[str]:
    """The paper that formulas are from."""
    return (_PAPER,)


def topper_assumptions(described: Topper) -> Iterator[str]:
    """What was taken for granted about heads and knife."""
    yield (
        "A root is a sphere, and its slice has the height h_p everywhere: the copier keeps the plane of the "
        "cut at that height below the top. The head is the disc in which this plane meets the root."
    )
    yield (
        "The edge is a straight line that moves parallel to itself, at constant speed along the row; in the "
        "middle of its stroke its own middle is over the axis of the row. Roots stand up to Δ beside it."
    )
    yield (
        "A point is cut when the edge crosses it, in either direction: roots do not yield, and nothing "
        "breaks off beside the edge."
    )
    phase = described.motion.phase
    if phase is not None:
        yield f"All heads meet the knife in the phase {degrees(phase)}, and at any offset up to Δ."
    else:
        yield "Heads meet the knife in any phase and at any offset up to Δ; means weight them equally."
    yield (
        "The angle of paper 5 has no sign, and its knife keeps one speed, v_h; for other motions v_h is the "
        "mean speed. α is positive where the left end of the edge leads."
    )
