"""Tables of limits (normal firing, misfiring, manoeuvre) and of measured curves beside the computed ones."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from linkwright.kernel.page.table import Cell, Row, Table, part_table
from linkwright.kernel.reader.numbers import measured, parted, quantity
from linkwright.kernel.reader.out_units import reader
from linkwright.kernel.units.kinds import PRESSURE, Kind
from linkwright.torsion.limits.barred_range import BarredRange
from linkwright.torsion.limits.crank_fatigue import ACCEPTABLE, CrankshaftFatigue
from linkwright.torsion.limits.critical_response import CriticalResponse
from linkwright.torsion.limits.overlay import Overlay, PeakComparison
from linkwright.torsion.study import TorsionStudy

_STATES = {"ok": "within limit", "bar": "barred speed range required", "exceeds": "limit exceeded"}


def limit_tables(study: TorsionStudy) -> Iterator[Table]:
    """Each limit and whether it is kept."""
    if study.verdict is not None and study.verdict.judgements:
        heads, cells = ("by", "at {rpm}", "verdict"), (lambda row: row.rule or "–", "speed [rad/s]", _state)
        yield _limits("limits", "Limits", study.verdict.judgements, heads, *cells)
        if study.verdict.barred:
            yield _barred(study.verdict.barred)
    if study.misfire is not None and study.misfire.judgements:
        title, heads = "Limits with one cylinder misfiring, worst case", ("at {rpm}", "cylinder", "verdict")
        yield _limits(
            "misfire", title, study.misfire.judgements, heads, "speed [rad/s]", "cylinder", _restricted
        )
    if study.transient is not None and study.transient.judgements:
        judgements = study.transient.judgements
        yield _limits(
            "manoeuvre_limits", "Limits in the manoeuvre", judgements, ("at", "verdict"), "time [s]", _kept
        )


def _state(row: Any) -> str:
    return _STATES[row.state]


def _kept(row: Any) -> str:
    return _STATES["ok" if row.is_kept else "exceeds"]


def _restricted(row: Any) -> str:
    return "within limit" if row.is_kept else "restricted operation"


def _limits(name: str, title: str, judgements: Sequence[Any], heads: Row, *cells: Cell) -> Table:
    heads = ("limit", "", "found", "permitted", *heads)
    both = (of_kind("found"), of_kind("permitted"))
    return part_table(
        name, title, judgements, heads, lambda row: f"{row.part}: {row.what}", "", *both, *cells
    )


def _barred(ranges: Sequence[BarredRange]) -> Table:
    """Ranges of speeds in which a shaft is stressed more than it may be in continuous operation."""
    heads = ("shaft", "", f"barred [{per_minute()}]", "critical {rpm}", "order", "τ_C", "τ_T", "passage")
    return part_table(
        "barred",
        "Barred speed ranges",
        ranges,
        heads,
        "shaft",
        "",
        lambda one: " to ".join(map(rpm, one.barred)),
        "critical_speed",
        lambda one: "–" if one.order is None else f"{one.order:.4g}",
        of_kind("continuous", PRESSURE),
        of_kind("transient", PRESSURE),
        _passage,
    )


def _passage(one: BarredRange) -> str:
    if one.is_passable is None:
        return "no limit given"
    if not one.is_passable:
        return "not permitted"
    return "quick passage" if one.may_be_barred else "speeds may not be barred"


def critical_table(responses: Sequence[CriticalResponse]) -> Table:
    """The critical order alone and all in phase at its peak, or at the critical speed without one."""
    heads = ("critical speed", "", "{rpm}", f"peaks at {per_minute()}")
    return part_table(
        "synthesis",
        "Synthesis at the most severe critical speeds",
        responses,
        (*heads, "shaft", "order alone", "all orders", "permitted"),
        lambda one: f"mode {one.mode}, order {one.order:.4g}",
        "",
        "critical_speed",
        lambda one: rpm(one.speed) if one.is_peak else "–",
        "shaft",
        *map(of_kind, ("single", "total", "permitted")),
    )


def fatigue_table(fatigue: CrankshaftFatigue) -> Table:
    """Each place of a throw by IACS UR M53: stresses with their concentration, fatigue strength, Q."""
    name = f"Crankshaft {fatigue.engine}".rstrip()
    return part_table(
        f"fatigue_{fatigue.engine}".rstrip("_"),
        f"{name}: fatigue by IACS UR M53, alternating stresses with their concentration",
        fatigue.places,
        ("place", "", "bending", "torsion", "σ_v", "σ_DW", "Q", "Q ≥ 1.15"),
        "place",
        "",
        *(of_kind(name, PRESSURE) for name in ("bending", "torsion", "equivalent", "strength")),
        lambda one: f"{one.acceptability:.3f}",
        lambda one: "sufficient" if one.acceptability >= ACCEPTABLE else "not sufficient",
    )


def nominal_table(fatigue: CrankshaftFatigue) -> Table:
    """Nominal stresses and concentration factors of a throw."""
    misfire = f", cylinder {fatigue.cylinder} misfiring" if fatigue.cylinder else ""
    rows: list[Row] = [
        (
            f"vibratory torque, {fatigue.shaft} at {rpm(fatigue.speed)} {per_minute()}{misfire}",
            "M_TN",
            quantity(fatigue.torque, "N m"),
        ),
        ("torsion of the crank pin", "τ_N", shown(fatigue.torsion_pin, PRESSURE)),
        ("torsion of the journal", "", shown(fatigue.torsion_journal, PRESSURE)),
        ("bending of the web", "σ_BFN", shown(fatigue.bending_nominal, PRESSURE)),
        ("radial force in the web", "σ_QFN", shown(fatigue.shear_nominal, PRESSURE)),
    ]
    if fatigue.bore_nominal is not None:
        rows.append(("bending at the oil bore", "σ_BON", shown(fatigue.bore_nominal, PRESSURE)))
    rows += [
        ("stress concentration factor", symbol, f"{value:.4f}") for symbol, value in fatigue.factors.items()
    ]
    name = f"Crankshaft {fatigue.engine}".rstrip()
    title = f"{name}: nominal alternating stresses and concentration factors"
    return Table(f"fatigue_nominal_{fatigue.engine}".rstrip("_"), title, ("quantity", "", "value"), rows)


def shown(value: float | None, kind: Kind) -> str:
    """A quantity for people: stresses in MPa and angles in degrees unless another unit is wanted."""
    if value is not None and np.isinf(value):
        return "unbounded"
    return measured(value, kind.unit, usual={"Pa": "MPa", "rad": "deg"}.get(kind.unit, ""))


def rpm(speed: float | None) -> str:
    """A speed in revolutions per minute, unless another unit is wanted."""
    return "–" if speed is None else parted(speed, "rad/s", usual="rpm")[0]


def per_minute() -> str:
    """The unit of speeds."""
    return reader().shown("rad/s", "rpm")[0]


def of_kind(attribute: str, kind: Kind | None = None) -> Cell:
    """A column of a kind of quantity, which each row has of its own if it is not given."""
    return lambda one: shown(getattr(one, attribute), kind or one.kind)


def measured_tables(overlays: Sequence[Overlay]) -> Iterator[Table]:
    """Each measured peak beside the computed one."""
    heads = ("peak", "", f"measured {per_minute()}", "computed", "differs", "measured", "computed", "differs")
    rows: list[Row] = [
        (
            f"{one.name}: {words(one)}" if one.name != one.part else words(one),
            "",
            rpm(peak.speed),
            rpm(peak.speed_computed),
            percent(peak.speed_difference),
            shown(peak.value, one.kind),
            shown(peak.value_computed, one.kind),
            percent(peak.value_difference),
        )
        for one in overlays
        for peak in one.peaks
    ]
    if rows:
        yield Table("measured", "Measured and computed peaks", heads, rows)


def words(one: Overlay) -> str:
    """A measured record."""
    order = "" if one.order is None else f", order {one.order:.4g}"
    return f"{one.what} of {one.part}{order}"


def percent(share: float | None) -> str:
    """A difference."""
    return "–" if share is None else f"{100 * share:+.1f} %".replace("-", "−")


def measured_words(one: Overlay) -> str:
    """What the comparison says, in a sentence."""
    highest = max(one.peaks, key=lambda peak: peak.value)
    what, value = words(one), shown(highest.value, one.kind)
    text = f"{what[0].upper()}{what[1:]}: highest measured {value} at {rpm(highest.speed)} {per_minute()}"
    return f"{text}, {_beside(one, highest)}{_permitted(one)}."


def _beside(one: Overlay, peak: PeakComparison) -> str:
    if peak.speed_computed is None or peak.value_computed is None:
        return "no computed peak within 15 % of its speed"
    value, at = shown(peak.value_computed, one.kind), rpm(peak.speed_computed)
    speed, size = percent(peak.speed_difference), percent(peak.value_difference)
    return f"computed {value} at {at} {per_minute()}: speed {speed}, amplitude {size}"


def _permitted(one: Overlay) -> str:
    if one.permitted is None:
        return ""
    over = one.speeds[one.measured > one.permitted]
    if not len(over):
        return "; the measured stress is within the limit of continuous operation"
    between = f"{rpm(float(over[0]))} to {rpm(float(over[-1]))} {per_minute()}"
    return f"; the measured stress exceeds the limit of continuous operation within {between}"
