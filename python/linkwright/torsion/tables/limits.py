"""Tables of limits: in normal firing, with a cylinder misfiring, in the manoeuvre."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from linkwright.kernel.page.measured import measured
from linkwright.kernel.page.numbers import parted, quantity
from linkwright.kernel.page.out_units import reader
from linkwright.kernel.page.table import Row, Table
from linkwright.kernel.units import Kind
from linkwright.torsion.study import TorsionStudy

_STATES = {"ok": "within limit", "bar": "barred speed range required", "exceeds": "limit exceeded"}


def limit_tables(study: TorsionStudy) -> Iterator[Table]:
    """Each limit and whether it is kept."""
    heads = ("limit", "", "found", "permitted")
    if study.verdict is not None and study.verdict.judgements:
        rows = [
            _row(row.part, row.what, row.found, row.permitted, row.kind, rpm(row.speed), _STATES[row.state])
            for row in study.verdict.judgements
        ]
        yield Table("limits", "Limits", (*heads, f"at {per_minute()}", "verdict"), rows)
    if study.misfire is not None:
        rows = [
            _row(
                row.part,
                row.what,
                row.found,
                row.permitted,
                row.kind,
                rpm(row.speed),
                row.cylinder,
                "within limit" if row.is_kept else "restricted operation",
            )
            for row in study.misfire.judgements
        ]
        title = "Limits with one cylinder misfiring, worst case"
        yield Table("misfire", title, (*heads, f"at {per_minute()}", "cylinder", "verdict"), rows)
    if study.transient is not None and study.transient.judgements:
        rows = [
            _row(
                row.part,
                row.what,
                row.found,
                row.permitted,
                row.kind,
                quantity(row.time, "s"),
                _STATES["ok" if row.is_kept else "exceeds"],
            )
            for row in study.transient.judgements
        ]
        yield Table("manoeuvre_limits", "Limits in the manoeuvre", (*heads, "at", "verdict"), rows)


def _row(part: str, what: str, found: float, permitted: float, kind: Kind, *rest: str) -> Row:
    """One limit: what, found, permitted, and where."""
    return (f"{part}: {what}", "", shown(found, kind), shown(permitted, kind), *rest)


def shown(value: float, kind: Kind) -> str:
    """A quantity for people: stresses in MPa and angles in degrees unless another unit is wanted."""
    if np.isinf(value):
        return "unbounded"
    return measured(value, kind.unit, usual={"Pa": "MPa", "rad": "deg"}.get(kind.unit, ""))


def rpm(speed: float) -> str:
    """A speed in revolutions per minute, unless another unit is wanted."""
    return parted(speed, "rad/s", usual="rpm")[0]


def per_minute() -> str:
    """The unit of speeds."""
    return reader().shown("rad/s", "rpm")[0]
