"""Tables of a manoeuvre: ice, torques of shafts and of gear stages, swings of pendulums."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from linkwright.kernel.page.table import Row, Table, part_table, parts_of
from linkwright.kernel.reader.numbers import quantity
from linkwright.torsion.in_time.transient import TorsionTransient


def manoeuvre_tables(moved: TorsionTransient) -> Iterator[Table]:
    """Ice, then extremes of the torques and when they come."""
    if moved.ice:
        yield _ice(moved)
    if moved.shafts:
        yield _shafts(moved)
    if moved.frictions:
        yield _frictions(moved)
    if moved.stages:
        yield _stages(moved)
    if moved.pendulums:
        yield _pendulums(moved)


def _ice(moved: TorsionTransient) -> Table:
    heads: Row = ("propeller", "", "Q_max", "C_q", "α_i", "impacts", "first at", "last passed at")
    cells = ("on", "", "torque_max [N m]", "amplitude", "duration [rad]", "impacts", "start [s]", "end [s]")
    speeds = ("speed_before [rad/s]", "speed_min [rad/s]")
    heads = (*heads, "{rpm} before", "minimum {rpm}")
    return part_table("ice_impacts", "Ice impacts", moved.ice, heads, *cells, *speeds)


def _shafts(moved: TorsionTransient) -> Table:
    heads = ("shaft", "", "maximum", "at", "minimum", "at")
    cells = ("name", "", "torque_max", "torque_max_time", "torque_min", "torque_min_time")
    title = f"Manoeuvre of {quantity(float(moved.time[-1]), 's')}: torques of the shafts"
    return part_table("manoeuvre", title, parts_of(moved, "shafts"), heads, *cells)


def _frictions(moved: TorsionTransient) -> Table:
    heads = ("part", "", "peak torque", "at", "heat", "peak power", "slipping", "stuck", "engagements")
    cells = (
        *("name", "", "friction_torque_max", "friction_torque_max_time", "friction_heat"),
        *("friction_power_max", "slip_time", "stuck_time", "engagements"),
    )
    title = "Manoeuvre: clutches, brakes and freewheels"
    return part_table("manoeuvre_friction", title, parts_of(moved, "frictions"), heads, *cells)


def _stages(moved: TorsionTransient) -> Table:
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


def _pendulums(moved: TorsionTransient) -> Table:
    rows: list[Row] = []
    for name, row in zip(moved.pendulums, moved.swing, strict=True):
        worst = int(np.abs(row).argmax())
        size = quantity(float(abs(row[worst])), "rad", usual="deg")
        rows.append((name, "", size, quantity(float(moved.time[worst]), "s")))
    heads = ("pendulum", "", "peak swing", "at")
    return Table("manoeuvre_pendulums", "Manoeuvre: swings of the pendulums", heads, rows)
