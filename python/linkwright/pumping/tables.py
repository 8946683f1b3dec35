"""Results of pumping units and of rotators as tables of text."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.kernel.page.quantities import degrees, number
from linkwright.kernel.page.table import Row, Table, row, rows_of, with_unit
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


def _angle(word: str, symbol: str, angle: float) -> Row:
    return word, symbol, degrees(angle), ""


def _polished_rod(unit: PumpingUnitMotion) -> Table:
    rows = rows_of(unit, "stroke")
    rows += rows_of(unit, "stroke_nominal") if unit.stroke_nominal is not None else []
    rows += [
        _angle("bottom of the stroke", "θ_b", unit.bottom_angle),
        _angle("top of the stroke", "θ_t", unit.top_angle),
    ]
    rows += rows_of(unit, "stroke_ratio")
    for name in ("torque_factor_max", "torque_factor_min"):
        rows.append(row(unit, name, f"at θ = {degrees(getattr(unit, f'{name}_angle'))}"))
    if unit.speed is not None:
        rows += rows_of(
            unit, "rod_velocity_max", "rod_velocity_min", "rod_acceleration_max", "rod_acceleration_min"
        )
    return Table("pumping_unit", "Polished rod", _HEADS, rows)


def _torque_factors(unit: PumpingUnitMotion) -> Table:
    """As API tabulates them."""
    n = len(unit.torque_factors)
    rows: list[Row] = [
        (f"{360 * k / n:g}°", "", number(unit.rod_positions[k], 4), with_unit(unit.torque_factors[k], "m"))
        for k in range(n)
    ]
    return Table(
        "torque_factors", "Positions of rods and torque factors", ("crank angle", "", "position", "TF"), rows
    )


def _gear(gear: GearTorque) -> Table:
    balance = "counterbalance" if gear.counterbalance is not None else "counterbalance_effect"
    rated, structure = (
        with_unit(value, unit) for value, unit in ((gear.torque_rated, "N m"), (gear.load_rated, "N"))
    )
    rows = rows_of(gear, balance)
    rows.append(row(gear, "torque_net_up", f"rated {rated}"))
    rows += rows_of(
        gear, "torque_net_down", "torque_net_min", "torque_net_mean", "torque_net_rms", "cyclic_load_factor"
    )
    rows += [row(gear, "load_max", f"rated {structure}"), *rows_of(gear, "work")]
    return Table("gear_torque", "Torque of the gearbox", ("quantity", "", "value", "rating"), rows)


def _rotator(rotator: RodRotatorMotion) -> Table:
    rows = rows_of(rotator, "link_length", "lever_length", "lever_turns_per_cycle")
    rows.append(_angle("range of the lever's angle", "", rotator.lever_swing))
    rows += rows_of(rotator, "transfer_min", "transfer_max", "worm_turns_per_cycle")
    rows += rows_of(rotator, "string_turn_days") if rotator.string_turn_days is not None else []
    rows += rows_of(rotator, "worm_torque") if rotator.worm_torque is not None else []
    rows += rows_of(rotator, "link_force_max") if rotator.link_force_max is not None else []
    where = " and ".join(degrees(each) for each in rotator.change_points)
    rows += [("change points", "", where or "none", "")]
    return Table("rotator", f"Rotator: the lever {rotator.verdict.split(':')[0]}", _HEADS, rows)
