"""Tables of a manoeuvre: ice that the propeller met, torques of shafts and of gear stages."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from linkwright.kernel.page.numbers import quantity
from linkwright.kernel.page.table import Row, Table
from linkwright.torsion.in_time.ice_impacts import IceMilling
from linkwright.torsion.in_time.transient import TorsionTransient
from linkwright.torsion.tables.limits import per_minute, rpm


def manoeuvre_tables(moved: TorsionTransient) -> Iterator[Table]:
    """Ice, then extremes of the torques and when they come."""
    if moved.ice:
        yield _ice(moved)
    yield _shafts(moved)
    if moved.stages:
        yield _stages(moved)


def _ice(moved: TorsionTransient) -> Table:
    """Each sequence of impacts, and how the propeller slows down in it."""
    rows: list[Row] = [_ice_row(one) for one in moved.ice]
    speed = per_minute()
    heads: Row = ("propeller", "", "Q_max", "C_q", "α_i", "impacts", "first at", "last passed at")
    return Table("ice_impacts", "Ice impacts", (*heads, f"{speed} before", f"minimum {speed}"), rows)


def _ice_row(one: IceMilling) -> Row:
    return (
        one.on,
        "",
        quantity(one.torque_max, "N m"),
        f"{one.amplitude:.4g}",
        quantity(one.duration, "rad", usual="deg"),
        str(one.impacts),
        quantity(one.start, "s"),
        "–" if one.end is None else quantity(one.end, "s"),
        rpm(one.speed_before),
        rpm(one.speed_min),
    )


def _shafts(moved: TorsionTransient) -> Table:
    columns = (moved.torque_max, moved.torque_max_time, moved.torque_min, moved.torque_min_time)
    units = ("N m", "s") * 2
    rows: list[Row] = [
        (name, "", *(quantity(*column) for column in zip(values, units, strict=True)))
        for name, values in zip(
            moved.shafts, zip(*(column.tolist() for column in columns), strict=True), strict=True
        )
    ]
    heads = ("shaft", "", "maximum", "at", "minimum", "at")
    title = f"Manoeuvre of {quantity(float(moved.time[-1]), 's')}: torques of the shafts"
    return Table("manoeuvre", title, heads, rows)


def _stages(moved: TorsionTransient) -> Table:
    """Extremes at the samples; a torque that changes its sign parts the teeth."""
    rows: list[Row] = []
    for name, row in zip(moved.stages, moved.stage_torque, strict=True):
        if not np.isfinite(row).all():
            rows.append((name, "", *("–",) * 4, "statically indeterminate"))
            continue
        cells = []
        for place in (int(row.argmax()), int(row.argmin())):
            cells += [quantity(float(row[place]), "N m"), quantity(float(moved.time[place]), "s")]
        sides = "both signs" if row.max() > 0 > row.min() else "one sign"
        rows.append((name, "", *cells, sides))
    heads = ("stage", "", "maximum", "at", "minimum", "at", "torque")
    return Table("manoeuvre_gears", "Manoeuvre: torques of the gear stages at the first wheel", heads, rows)
