"""What a pumping unit cannot bear, and what its user should know although it runs: sentences with numbers."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.machine.machine import Machine
from linkwright.pumping.gear_torque import GearTorque
from linkwright.pumping.rod_rotator import RodRotatorMotion
from linkwright.pumping.unit import PumpingUnitMotion

# Strokes of catalogues are up to a few percent off those of the mechanism.
_STROKE_AGREES = 0.05

# A negative torque that is a smaller share of the maximum is not worth a sentence.
_SMALL = 0.01

# Jumps of the beam are avoided by keeping the rods' acceleration well below that of free fall.
_FREE_FALL = 9.81


def unit_warnings(unit: PumpingUnitMotion) -> Iterator[str]:
    """What should be known of a unit."""
    yield from _stroke(unit)
    yield from _fall(unit)
    if unit.gear is not None:
        yield from _flanks(unit.gear)


def unit_findings(unit: PumpingUnitMotion) -> Iterator[str]:
    """Loads of gearbox and structure above the ratings of the designation."""
    gear = unit.gear
    if gear is None:
        return
    peak = max(gear.torque_net_up, gear.torque_net_down)
    if gear.torque_rated is not None and peak > gear.torque_rated:
        yield (
            f"The gearbox is overloaded: its torque reaches {peak:.4g} N m, "
            f"{100 * peak / gear.torque_rated:.0f} % of its rating of {gear.torque_rated:.4g} N m."
        )
    if gear.load_rated is not None and gear.load_max > gear.load_rated:
        yield (
            f"The structure is overloaded: the polished rod carries {gear.load_max:.4g} N, "
            f"{100 * gear.load_max / gear.load_rated:.0f} % of its rating of {gear.load_rated:.4g} N."
        )


def _stroke(unit: PumpingUnitMotion) -> Iterator[str]:
    nominal = unit.stroke_nominal
    if nominal is not None and unit.stroke > (1 + _STROKE_AGREES) * nominal:
        yield (
            f"The stroke of {unit.stroke:.4g} m is {100 * (unit.stroke / nominal - 1):.2g} % longer than "
            f"that of the designation, {nominal:.4g} m: check the dimensions."
        )


def _fall(unit: PumpingUnitMotion) -> Iterator[str]:
    if unit.rod_acceleration_min is not None and unit.rod_acceleration_min <= -_FREE_FALL:
        yield (
            "The horsehead falls away from the rods: its acceleration reaches "
            f"{-unit.rod_acceleration_min:.4g} m/s² downward; reduce the speed."
        )


def _flanks(gear: GearTorque) -> Iterator[str]:
    peak = max(gear.torque_net_up, gear.torque_net_down)
    if gear.torque_net_min < -_SMALL * peak:
        yield (
            f"The torque of the gearbox falls to {gear.torque_net_min:.4g} N m: there the rods or the "
            "counterweights drive, and the gears change flanks."
        )


def rotator_warnings(machine: Machine, rotator: RodRotatorMotion) -> Iterator[str]:
    """What should be known of a rotator."""
    if not rotator.extremes_coincide:
        yield (
            "The distance from the beam's pin to the hanger has an extreme inside the stroke: the lengths "
            "of equations (3) to (7) do not hold."
        )
    if rotator.change_points and rotator.worm_torque:
        yield (
            "Link and lever of the rotator are in line twice per revolution: there the link has no moment "
            "arm, and only the momentum of the lever overcomes the worm torque of "
            f"{rotator.worm_torque:.4g} N m."
        )
