"""Motion and torque of all cams and axes over one revolution of the master: the timing diagram."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from linkwright.axes.axis import driver_motion, driver_torque, turns_about
from linkwright.axes.cycle import AxesCycle, axes_cycle
from linkwright.kernel.arrays import Floats
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.machine.machine import Machine
from linkwright.machine.own_motors import axis_drivers
from linkwright.machine.program.compiled import compile_machine
from linkwright.machine.program.core import Channel

# An end of a revolution is one to this [rad].
_TURN = 2 * np.pi + 1e-9


@dataclass(frozen=True)
class Track(Result):
    """Motion and torque of one driver over a revolution of the master."""

    crank_angle: Annotated[Floats, Label("master angle", "φ", "rad")]
    position: Annotated[Floats, Label("position", "q", "rad or m", "Of a cam the lift.")]
    velocity: Annotated[Floats, Label("velocity", "dq/dt", "rad/s or m/s")]
    acceleration: Annotated[Floats, Label("acceleration", "d²q/dt²", "rad/s² or m/s²")]
    torque: Annotated[
        Floats, Label("torque or force", "M_q", "N m or N", "Of a cam the torque on its shaft.")
    ]
    name: Annotated[str, About("Of the axis, or of the driver.")]
    driver: Annotated[str, About("Crank, linear driver, cylinder or cam.")]
    turns: Annotated[bool, About("Whether it turns; else it moves along a line.")]
    has_shaft: Annotated[bool, About("Whether the torque is that on a camshaft.")]

    @public
    def unit_of(self, name: str) -> str:
        """SI unit of an attribute: that of an angle, or of what moves along a line."""
        both = super().unit_of(name).split(" or ")
        turns = self.turns or (name == "torque" and self.has_shaft)
        return both[0 if turns else -1]


def moved_drivers(machine: Machine) -> tuple[str, ...]:
    """Drivers with a law of their own: cams, axes, formulas; not what rotates with the master."""
    mechanism, own = machine.mechanism, axis_drivers(machine)
    moved = (
        name
        for name, driver in mechanism.drivers().items()
        if name in own or driver.law is not None or getattr(driver, "flow", None) is not None
    )
    return (*moved, *mechanism.cams)


@public
def timing(machine: Machine, *, speed: float | None = None) -> tuple[Track, ...]:
    """Motion and torque of all cams and axes of a machine over one revolution of the master.

    Parameters
    ----------
    machine : Machine
    speed : float, optional
        Speed of the master [rad/s], as for `servo_axis`.

    Returns
    -------
    tuple of Track
        In the order of the file, cams first.
    """
    return tracks_of(machine, axes_cycle(machine, speed))


def tracks_of(machine: Machine, cycle: AxesCycle) -> tuple[Track, ...]:
    """The tracks of a cycle that is known."""
    within = cycle.angle <= _TURN
    # The end of the first revolution is the start of the second as well.
    within[int(within.sum()) - 1] &= int(within.sum()) == len(within) or cycle.angle[within][-2] < 2 * np.pi
    names = axis_drivers(machine)
    found = []
    for driver in moved_drivers(machine):
        is_cam = driver in machine.mechanism.cams
        motion = _follower(machine, driver, cycle) if is_cam else driver_motion(machine, driver, cycle)
        angle, position, velocity, acceleration, torque = (
            curve[within] for curve in (cycle.angle, *motion, driver_torque(machine, driver, cycle))
        )
        turns = machine.mechanism.cams[driver].is_oscillating if is_cam else turns_about(machine, driver)
        name = names.get(driver, driver)
        found.append(Track(angle, position, velocity, acceleration, torque, name, driver, turns, is_cam))
    return tuple(found)


def _follower(machine: Machine, driver: str, cycle: AxesCycle) -> tuple[Floats, Floats, Floats]:
    """Lift of a cam's follower, its velocity and acceleration."""
    compiled, motion = compile_machine(machine), cycle.forces.motion
    (rows,) = compiled.motion([Channel.Slide(compiled.slides[f"{driver}.lift"])], motion.crank_angle)
    lift, d1, d2 = rows
    lift = lift + d1 * (cycle.angle - motion.crank_angle)
    return lift, d1 * motion.speed, d2 * motion.speed**2 + d1 * motion.acceleration
