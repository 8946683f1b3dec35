"""The figures of pumping units and rotators with their captions."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.kernel.figure.captioned import Captioned
from linkwright.kernel.page.numbers import degrees, number
from linkwright.pumping.figures.unit import gear_torque_figure, polished_rod_figure, rotator_figure
from linkwright.pumping.rod_rotator import RodRotatorMotion
from linkwright.pumping.unit import PumpingUnitMotion


def unit_figures(unit: PumpingUnitMotion | None, rotator: RodRotatorMotion | None) -> Iterator[Captioned]:
    """The figures of the polished rod, of the gearbox, and of the rotator."""
    if unit is not None:
        yield from _unit(unit)
    if rotator is not None:
        yield from _rotator(rotator)


def _unit(unit: PumpingUnitMotion) -> Iterator[Captioned]:
    gear = unit.gear
    caption = (
        f"The polished rod rises {number(unit.stroke)} m while the crank turns "
        f"{degrees(unit.upstroke_angle)}. The torque factor runs from {number(unit.torque_factor_min)} to "
        f"{number(unit.torque_factor_max)} m."
    )
    yield Captioned("polished_rod", "Polished rod over one revolution", caption, polished_rod_figure(unit))
    if gear is not None:
        caption = (
            "Torque at the crank by the polished rod and by its counterbalance; their sum peaks at "
            f"{number(max(gear.torque_net_up, gear.torque_net_down))} N m."
        )
        yield Captioned("gear_torque", "Torque of the gearbox", caption, gear_torque_figure(gear))


def _rotator(rotator: RodRotatorMotion) -> Iterator[Captioned]:
    caption = f"The lever {rotator.verdict}."
    yield Captioned("rotator", "Lever of the rotator", caption, rotator_figure(rotator))
