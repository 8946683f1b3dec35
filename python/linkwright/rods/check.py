"""What can be seen of a rod string without solving, and what it consists of."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.kernel.findings import Findings
from linkwright.kernel.reader.numbers import quantity
from linkwright.machine.analysis import Obstacle
from linkwright.machine.machine import Machine
from linkwright.rods.model.rod_string import RodString
from linkwright.rods.polished_rod import polished_rod_of


def no_motion(machine: Machine) -> Obstacle | None:
    """A rod string whose polished rod nothing moves: it takes measured cards alone."""
    string = machine.rod_string
    if string is None:
        return Obstacle("No [rod_string]")
    if machine.pumping_unit is None and string.stroke is None:
        return Obstacle("No [pumping_unit] and no rod_string.stroke moves the polished rod")
    has_motor = machine.drive is not None and machine.drive.motor is not None
    speed = string.speed if machine.drive is None else machine.drive.speed
    if speed is None and not has_motor:
        return Obstacle("No pumping speed: neither drive.speed nor a motor")
    return None


def check_string(machine: Machine, findings: Findings) -> Iterator[str]:
    """Whether the polished rod has a motion; a string for measured cards needs none."""
    if machine.rod_string is not None and no_motion(machine) is None:
        findings.of(polished_rod_of, machine, machine.rod_string)
    yield "rod string: sections down to the pump, motion of the polished rod"


def string_summary(machine: Machine) -> Iterator[tuple[str, str]]:
    """Sections and pump."""
    string = machine.rod_string
    if string is None:
        return
    parts = (f"{s.rod or quantity(s.body, 'm')} × {quantity(s.length, 'm')}" for s in string.sections)
    yield "rod string", ", ".join(parts)
    yield "pump", f"plunger {quantity(string.pump.plunger, 'm')} at {quantity(string.length, 'm')}"


def string_assumptions(string: RodString) -> Iterator[str]:
    """What the wave equation of the rods and the valves of the pump leave out."""
    yield (
        "The well is vertical, its rods do not rub on the tubing. They are damped in proportion to their "
        "velocity; the fluid in the tubing has no inertia."
    )
    yield (
        "The valves of the pump open and shut without delay, at equal pressure on both sides. The plunger "
        "has no friction."
    )
    yield (
        "Rods weigh as in the fluid; the weight of the links of a pumping unit counts by its structural "
        "unbalance and its counterbalance."
    )
    if string.pump.tubing_diameter is None:
        yield "The tubing is anchored at the pump."
