"""Results of pumping units and of rotators as tables of text."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.kernel.page.table import Row, Table, known_rows, rows_in
from linkwright.kernel.reader.numbers import degrees, measured, number
from linkwright.pumping.gear_torque import GearTorque
from linkwright.pumping.rod_rotator import RodRotatorMotion
from linkwright.pumping.unit import PumpingUnitMotion


def unit_tables(unit: PumpingUnitMotion | None, rotator: RodRotatorMotion | None) -> Iterator[Table]:
    """Tables of the polished rod, of the torque factors, of the gearbox, and of the rotator."""
    if unit is not None:
        yield _polished_rod(unit)
        yield _torque_factors(unit)
        if unit.gear is not None:
            yield _gear(unit.gear)
    if rotator is not None:
        yield _rotator(rotator)


_HEADS = ("quantity", "", "value", "where")


def _polished_rod(unit: PumpingUnitMotion) -> Table:
    rows = known_rows(unit, "pumping_unit", at=lambda angle: f"at θ = {degrees(angle)}")
    return Table("pumping_unit", "Polished rod", _HEADS, rows)


def _torque_factors(unit: PumpingUnitMotion) -> Table:
    n = len(unit.torque_factors)
    rows: list[Row] = [
        (f"{360 * k / n:g}°", "", number(unit.rod_positions[k]), measured(unit.torque_factors[k], "m"))
        for k in range(n)
    ]
    return Table(
        "torque_factors", "Positions of rods and torque factors", ("crank angle", "", "position", "TF"), rows
    )


def _gear(gear: GearTorque) -> Table:
    beside = {
        "torque_net_up": f"rated {measured(gear.torque_rated, 'N m')}",
        "load_max": f"rated {measured(gear.load_rated, 'N')}",
    }
    without = [name for name in ("counterbalance", "counterbalance_effect") if getattr(gear, name) is None]
    rows = rows_in(gear, "gear_torque", beside, without=tuple(without))
    return Table("gear_torque", "Torque of the gearbox", ("quantity", "", "value", "rating"), rows)


def _rotator(rotator: RodRotatorMotion) -> Table:
    where = " and ".join(degrees(point) for point in rotator.change_points)
    rows = [*known_rows(rotator, "rotator"), ("change points", "", where or "none", "")]
    return Table("rotator", f"Rotator: the lever {rotator.verdict.split(':')[0]}", _HEADS, rows)
