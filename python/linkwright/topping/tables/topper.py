"""Results of toppers as tables of text."""

from __future__ import annotations

import math
from collections.abc import Iterator

from linkwright.kernel.page.table import Row, Table, columns_csv, head, row, rows_in, rows_of
from linkwright.kernel.quantities import shown
from linkwright.kernel.reader.numbers import degrees, number, quantity
from linkwright.papers.published_lengths import PAPER, WAYS, Demand, Stroke, length_verdict
from linkwright.topping.model.topper import Topper
from linkwright.topping.topper import TopperStudy, leaves

_HEADS = ("quantity", "", "value", "remark")

# A length that exceeds the edge by less than this share is the edge's: rounding.
_SAME = 1e-12

# A draw-cut ratio beyond this is that of an edge that moves along itself, within rounding.
_NO_BOUND = 1e9


def topper_tables(described: Topper, study: TopperStudy) -> Iterator[Table]:
    """Tables of lengths, what is left, motion and drive of the knife, slicing, and published lengths."""
    yield _lengths(study, described)
    yield _head(study, described)
    yield _motion(study)
    yield _slicing(study)
    if study.knife_mass is not None:
        yield _drive(study)
    yield _verdict(study, described)


def edge_csv(study: TopperStudy) -> str:
    """The use of a topper's edge along its length as CSV: a curve of its own length."""
    return columns_csv({head(study, name): getattr(study, name) for name in ("edge_place", "edge_use")})


def mm(value: float) -> str:
    """A length in millimetres."""
    return quantity(value, "m", usual="mm")


def percent(share: float) -> str:
    """A share in percent."""
    return f"{number(100 * share, 3)} %"


def stroke_of(study: TopperStudy) -> Stroke | None:
    """The knife's stroke, as lengths for every phase need it; None if it has none, or rests."""
    if not study.stroke or not study.knife_speed:
        return None
    return Stroke(study.stroke, study.knife_speed_max / study.knife_speed)


def _lengths(study: TopperStudy, described: Topper) -> Table:
    own = described.edge_length
    steady = study.length_exact_constant_speed
    listed = [
        ("printed in paper 5", "(10)", study.length_published, "compares times, not the swept area"),
        ("by its condition (4)", "(4)", study.length_consistent, "step from (4) to (5) corrected"),
        ("knife at rest", "v_h = 0", study.length_at_rest, "(d + 2Δ)/cos α"),
        ("exact at constant speed", "", steady, "no reversal over a head, worse direction"),
        *(() if study.obstacle else _moved(study, described)),
    ]
    rows: list[Row] = [
        (word, symbol, _length(value), _is_met(own, value), remark) for word, symbol, value, remark in listed
    ]
    if study.obstacle:
        rows.append(("exact", "L", "–", "–", "not computed: too many strokes over a head"))
    title = f"Required length of the edge; given length {mm(own)}"
    return Table("topper_lengths", title, ("minimum length", "", "value", "is met", "remark"), rows)


def _moved(study: TopperStudy, described: Topper) -> Iterator[tuple[str, str, float, str]]:
    if not study.stroke:
        yield "exact", "L", study.length_exact, "worst offset"
        return
    best = f"φ = {degrees(study.best_phase)}"
    yield "exact, best phase", best, study.length_best_phase, "worst offset"
    word = "exact, every phase" if described.motion.phase is None else "exact, phase given"
    yield word, "L", study.length_exact, f"worst offset, phase {degrees(study.worst_phase)}"


def _length(value: float) -> str:
    return mm(value) if math.isfinite(value) else "none does"


def _is_met(own: float, value: float) -> str:
    return "yes" if value <= own * (1 + _SAME) else "no"


def shown_head(study: TopperStudy) -> tuple[float, float]:
    """Offset and phase of the head of which most is left, or else of that which needs most."""
    if leaves(study):
        return study.uncut_offset, study.uncut_phase
    return study.worst_offset, study.worst_phase


def _head(study: TopperStudy, described: Topper) -> Table:
    volume = f"{number(1e6 * study.cap_volume)} cm³"
    rows: list[Row] = [
        _text_row("head_diameter", mm(study.head_diameter), "in the plane of the cut"),
        _text_row("cap_volume", volume, "of the root above the cut"),
        ("band of the heads", "d + 2Δ", mm(study.head_diameter + 2 * described.offset), ""),
    ]
    if leaves(study):
        rows += _left(study, described)
    elif not study.obstacle:
        is_free = study.stroke and described.motion.phase is None
        rows.append(
            (
                "maximum uncut share of a head",
                "",
                "nothing",
                "at every offset" + (" and phase" if is_free else ""),
            )
        )
        x, y = (mm(_without_rounding(place, study)) for place in (study.last_x, study.last_y))
        at = f"x = {x}, y = {y}"
        rows.append(("point farthest from the edge's middle", "", at, "from the head's centre"))
    return Table("topper_head", "Head and cut", _HEADS, rows)


def _without_rounding(value: float, study: TopperStudy) -> float:
    """A place without what rounding leaves of zero."""
    return 0.0 if abs(value) < 1e-6 * study.head_diameter else value


def _left(study: TopperStudy, described: Topper) -> Iterator[Row]:
    side = "left" if study.uncut_offset > 0 else "right"
    at = f"head {mm(abs(study.uncut_offset))} to the {side}" if study.uncut_offset else "head on the row"
    moves = f", phase {degrees(study.uncut_phase)}" if study.stroke else ""
    yield "maximum uncut share of a head", "", percent(study.uncut_share), at + moves
    sides = (
        ("of that, to the right of the edge", study.uncut_right),
        ("of that, to the left of the edge", study.uncut_left),
        ("of that, between two passes of it", study.uncut_between),
    )
    # An edge that moves along itself has no sides.
    for word, share in sides if math.isfinite(study.length_exact) else ():
        if share > 0:
            yield word, "", percent(share), "of the head"
    yield "mean uncut share of a head", "", percent(study.uncut_share_mean), _mean_over(study, described)


def _mean_over(study: TopperStudy, described: Topper) -> str:
    if study.stroke:
        return "over even offsets" + (" and phases" if described.motion.phase is None else "")
    return "over even offsets" + (" and both directions" if study.knife_speed else "")


def _way(study: TopperStudy) -> str:
    if not study.knife_speed:
        return "at rest"
    return "over the time" if study.stroke else "one direction over the head"


def _motion(study: TopperStudy) -> Table:
    rows: list[Row] = []
    if study.stroke:
        rows.append(_text_row("stroke", mm(study.stroke), ""))
        rows += rows_of(study, "frequency")
        rows.append(row(study, "strokes_per_head", "while the edge passes a head on the row"))
    rows.append(row(study, "knife_speed", _way(study)))
    if study.stroke:
        rows += rows_of(study, "knife_speed_max")
        jumps = not math.isfinite(study.knife_acceleration_max)
        reach = _text_row("knife_acceleration_max", "no bound", "it turns back at once")
        rows.append(reach if jumps else row(study, "knife_acceleration_max"))
    holds = "not less than along it: (1) holds" if study.condition_holds else "less than along it: (1) fails"
    rows += [row(study, name, "paper 5 (2), (8)") for name in ("travel_along", "travel_across")]
    rows.append(row(study, "time_along"))
    is_endless = math.isinf(study.time_across)
    rows.append(
        _text_row("time_across", "no bound", holds) if is_endless else row(study, "time_across", holds)
    )
    return Table("topper_motion", "Motion of the knife", _HEADS, rows)


def _slicing(study: TopperStudy) -> Table:
    words = "speed along the edge over speed normal to it"
    rows = [row(study, "slicing_ratio_min", words), _ratio(study, "slicing_ratio_mean", "over what is cut")]
    rows.append(_ratio(study, "slicing_ratio_max", ""))
    rows += rows_of(study, "cutting_speed_min", "cutting_speed_max")
    rows.append(_advance(study))
    return Table("topper_slicing", "Slicing", _HEADS, rows)


def _advance(study: TopperStudy) -> Row:
    if abs(study.least_advance) * _NO_BOUND < study.cutting_speed_max:
        return _text_row("least_advance", "0 m/s", "it moves along itself")
    return row(
        study, "least_advance", "its back meets the head" if study.edge_retreats else "it never retreats"
    )


def _ratio(study: TopperStudy, name: str, remark: str) -> Row:
    if getattr(study, name) < _NO_BOUND:
        return row(study, name, remark)
    return _text_row(name, "no bound", "the edge moves along itself")


def _text_row(name: str, value: str, remark: str) -> Row:
    mark = shown(TopperStudy, name)
    return mark.word, mark.symbol, value, remark


def _drive(study: TopperStudy) -> Table:
    rows = rows_in(study, "topper_drive", {"drive_torque_max": "at the crank"})
    # Without losses the means are zero within rounding.
    if abs(study.drive_torque_mean or 0.0) * _NO_BOUND < abs(study.drive_torque_max or 0.0):
        means = ("drive_torque_mean", "drive_power_mean")
        rows = rows_in(study, "topper_drive", {"drive_torque_max": "at the crank"}, without=means)
        rows += [_text_row(name, f"0 {study.unit_of(name)}", "nothing is lost") for name in means]
    return Table("topper_drive", "Drive of the knife at the design speed", _HEADS, rows)


def _verdict(study: TopperStudy, described: Topper) -> Table:
    verdict = length_verdict(
        PAPER, described.edge_angle, study.head_diameter, described.offset, stroke_of(study)
    )
    rows = [_judged(demand) for demand in verdict.demands]
    low, high = PAPER.lengths
    title = f"Published {low:.2f} to {high:.2f} m, for the paper's speeds and this machine's heads"
    heads = ("length", "", "over the speeds", "within", "holds for d + 2Δ of")
    return Table("topper_verdict", title, heads, rows)


def _judged(demand: Demand) -> Row:
    word = WAYS[demand.way]
    greatest = mm(demand.length_greatest) if math.isfinite(demand.length_greatest) else "no bound"
    spread = f"{mm(demand.length_least)} to {greatest}"
    if not math.isfinite(demand.length_least):
        spread = "none does"
    elif math.isclose(demand.length_least, demand.length_greatest, rel_tol=_SAME):
        spread = mm(demand.length_greatest)
    bands = f"{mm(demand.band_low)} to {mm(demand.band_high)}" if demand.band_high > 0 else "none"
    holds = "yes" if demand.holds_throughout else "longest only" if demand.holds else "no"
    return word, "", spread, holds, bands
