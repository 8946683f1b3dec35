"""Axes in the study of a machine: what is made of them, what their motors cannot do, what is assumed."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from linkwright.axes.axis import ServoAxis, servo_axes
from linkwright.axes.bus import DcBus, bus_of
from linkwright.axes.cycle import axes_cycle, master_speed
from linkwright.axes.timing import Track, moved_drivers, tracks_of
from linkwright.drive.study import has_motor
from linkwright.kernel.findings import Findings
from linkwright.kinetostatics.motion import has_speed
from linkwright.machine.analysis import Obstacle, Results
from linkwright.machine.machine import Machine
from linkwright.machine.program.drive_line import reverse_factor

# Share of the energy that an axis turns over, below which a gain of its gears is not warned of.
_SMALL = 1e-3

# The common timing diagram of fewer drivers than these is that of the one.
_SEVERAL = 2


def has_axes(machine: Machine) -> bool:
    """Whether a machine has servo axes."""
    return bool(machine.axes)


def has_timing(machine: Machine) -> bool:
    """Whether drivers with laws of their own have a common timing: axes, or several cams at a known speed."""
    if not machine.has_crank:
        return False
    return bool(machine.axes) or (has_speed(machine) and len(moved_drivers(machine)) >= _SEVERAL)


def axis_names(machine: Machine) -> tuple[str, ...]:
    """Names of the axes."""
    return tuple(machine.axes)


def made_axes(known: Results, findings: Findings) -> dict[str, ServoAxis]:
    """All axes by name; none where the cycle time is unknown, which is a warning."""
    if not has_speed(known.machine):
        findings.warn(
            ["The cycle time is unknown, so that axes have no torque: add [master] with cycle_time or speed"]
        )
        return {}
    return findings.of(servo_axes, known.machine) or {}


def made_bus(known: Results, findings: Findings) -> DcBus | None:
    """The bus of the axes."""
    axes = {axis.name: axis for axis in known.each("axis")}
    return bus_of(known.machine, axes, axes_cycle(known.machine)) if axes else None


def made_timing(known: Results, findings: Findings) -> dict[str, Track]:
    """Tracks of all cams and axes, as far as their cycle can be computed."""
    if known.machine.axes and not known.each("axis"):
        return {}
    cycle = findings.beside_of(axes_cycle, known.machine)
    tracks = () if cycle is None else tracks_of(known.machine, cycle)
    return {track.name: track for track in tracks}


def axis_findings(axes: Sequence[ServoAxis]) -> Iterator[str]:
    """Checks that motors, gearboxes and resistors fail."""
    for axis in axes:
        for check in axis.checks:
            if check.passed is False:
                yield f"axis {axis.name}: {check.words}"


def axis_warnings(axes: Sequence[ServoAxis]) -> Iterator[str]:
    """Checks that cannot be made, and gears that gain power in reverse."""
    for axis in axes:
        yield from _gear_gain(axis)
        for check in axis.checks:
            if check.passed is None:
                yield f"axis {axis.name}: {check.title} {check.note}"


def _gear_gain(axis: ServoAxis) -> Iterator[str]:
    """A factor below 1 in reverse hands the motor more energy than the driver returns."""
    factor, cycle = float(reverse_factor(axis.axis.gearbox)), axis.cycle.divided()
    power = cycle.torque * cycle.speed
    returned, turned_over = (cycle.period * cycle.mean(part) for part in (np.maximum(-power, 0), abs(power)))
    gained = returned * (1 / factor - 1)
    if gained > _SMALL * turned_over and not axis.axis.gearbox.locks:
        yield (
            f"axis {axis.name}: while the load drives the motor, the gearbox factor {factor:.4g} "
            f"(axes.{axis.name}.gearbox.reverse) gives the motor {gained:.4g} J per cycle more than the "
            "driver returns; a gearbox with losses has a factor above 1"
        )


def check_axes(machine: Machine, findings: Findings) -> Iterator[str]:
    """Whether axes can be followed, and their motors stand it."""
    if has_speed(machine):
        axes = findings.of(servo_axes, machine) or {}
        findings.add(axis_findings(list(axes.values())))
        findings.warn(axis_warnings(list(axes.values())))
        yield "axes: torque and speed over the cycle against motor, gearbox and resistor"


def no_axes(machine: Machine) -> Obstacle | None:
    """A machine without axes, or without a cycle time."""
    if not machine.axes:
        return Obstacle("The machine has no servo axis.")
    if has_speed(machine):
        return None
    return Obstacle("The cycle time is unknown.", "Add a master", {"master": {"cycle_time": "1 s"}})


def axes_summary(machine: Machine) -> Iterator[tuple[str, str]]:
    """Names of the axes, and the cycle time of the master."""
    yield "servo axes", ", ".join(machine.axes)
    if machine.design_speed is not None and not has_motor(machine):
        yield "cycle time", f"{2 * math.pi / master_speed(machine):.6g} s"


def axis_assumptions(machine: Machine) -> Iterator[str]:
    """What is taken for granted of axes."""
    if has_motor(machine):
        yield "Axes follow the angle of the crankshaft exactly, also where its speed fluctuates."
    else:
        yield "The master turns at constant speed; axes follow their laws exactly."
    yield (
        "Couplings, gearboxes and shafts of axes are rigid; losses of a gearbox go the way that the power "
        "goes. Root mean square torques are compared with the continuous torque at the mean absolute speed."
    )
    yield "Powers and regenerated energies of axes are those at the motor shafts."
