"""A servo axis over the cycle: motion and torque of its driver, duty of its motor, checks."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Annotated, Any

import numpy as np

from linkwright.axes.cycle import AxesCycle, axes_cycle, continued, start_cycle
from linkwright.axes.driver_cycle import DriverCycle, Peak
from linkwright.axes.duty import (
    MotorDuty,
    Numbers,
    inertia_at_motor,
    motor_course,
    motor_duty,
    root_mean_square,
)
from linkwright.axes.inertia import driver_inertias
from linkwright.axes.model.axis import Axis
from linkwright.axes.model.follower import family_of
from linkwright.axes.model.servo_motor import ServoMotor
from linkwright.kernel.arrays import Floats
from linkwright.kernel.check import Check
from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import InputError, show
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.kinetostatics.motion import Motion
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine
from linkwright.machine.program.core import Channel
from linkwright.machine.program.places import angle_name

# Checks of a start or stop of the master, which has no root mean square.
_OF_STARTS = ("speed", "torque_peak", "gearbox_torque_peak", "gearbox_speed")

# Units of a driver that moves along a line, by those of one that turns.
_ALONG = {"rad": "m", "rad/s": "m/s", "rad/s²": "m/s²", "N m": "N"}


@dataclass(frozen=True)
class ServoAxis(Result):
    """A servo axis over the cycle."""

    crank_angle: Annotated[
        Floats, Label("master angle", "φ", "rad", "Ends of sections occur twice, once for each side.")
    ]
    time: Annotated[Floats, Label("time", "t", "s")]
    position: Annotated[Floats, Label("position of the driver", "q", "rad or m")]
    velocity: Annotated[Floats, Label("velocity of the driver", "dq/dt", "rad/s or m/s")]
    acceleration: Annotated[Floats, Label("acceleration of the driver", "d²q/dt²", "rad/s² or m/s²")]
    torque: Annotated[
        Floats, Label("torque at the driver", "M_q", "N m or N", "A force where it moves along a line.")
    ]
    power: Annotated[Floats, Label("power at the driver", "P_q", "W")]
    torque_rms: Annotated[float, Label("root mean square torque at the driver", "M_q,rms", "N m or N")]
    inertia_mean: Annotated[
        float | None,
        Label("mean inertia at the driver", "J_q", "kg m² or kg", "All others held; None without masses."),
    ]
    name: Annotated[str, About("Of the axis.")]
    driver: Annotated[str, About("Crank, linear driver, cylinder or cam that it drives.")]
    turns: Annotated[bool, About("Whether the driver turns; else it moves along a line.")]
    motor: Annotated[
        MotorDuty, About("Speed and torque at the motor, and the checks; without a motor, without its rotor.")
    ]
    start: Annotated[MotorDuty | None, About("The same while the master starts; None without its time.")]
    stop: Annotated[MotorDuty | None, About("The same while the master stops; None without its time.")]
    axis: Annotated[Axis, About("The description.")]
    cycle: Annotated[DriverCycle, About("What the driver asks of its drive over the cycle.")]

    @property
    def torque_max(self) -> Annotated[float, Label("peak torque at the driver", "M_q,max", "N m or N")]:
        """With its sign."""
        return Peak(self.time, self.torque).value

    @property
    def torque_max_angle(self) -> Annotated[float, Label("master angle of the peak torque", "", "rad")]:
        """Of the first, if there are several."""
        time = Peak(self.time, self.torque).places(0.0)[0].time
        return float(np.interp(time, self.time, self.crank_angle))

    @property
    def velocity_max(self) -> Annotated[float, Label("peak velocity of the driver", "", "rad/s or m/s")]:
        """With its sign."""
        return Peak(self.time, self.velocity).value

    @property
    def acceleration_max(
        self,
    ) -> Annotated[float, Label("peak acceleration of the driver", "", "rad/s² or m/s²")]:
        """With its sign."""
        return Peak(self.time, self.acceleration).value

    @property
    def advance(self) -> Annotated[float, Label("advance per cycle", "h", "rad or m")]:
        """From the start to the end of a revolution of the master."""
        turns = max(1, round(float(self.crank_angle[-1]) / (2 * np.pi)))
        return float(self.position[-1] - self.position[0]) / turns

    @property
    def checks(self) -> tuple[Check, ...]:
        """Checks of motor, gearbox and resistor, over the cycle, at start and stop; none without a motor."""
        if self.axis.motor is None:
            return ()
        return (
            *self.motor.checks,
            *_of_start(self.start, "while the master starts"),
            *_of_start(self.stop, "while the master stops"),
        )

    @property
    def utilisation(self) -> Annotated[float | None, Label("utilisation", "", "")]:
        """Largest share of a limit over all checks: at most 1 if the axis passes.

        None without a motor, or where a check cannot be made.
        """
        if not self.checks or any(check.passed is None for check in self.checks):
            return None
        return max(check.utilisation or 0.0 for check in self.checks)

    @property
    def passes(self) -> bool | None:
        """Whether all checks are made and passed; None without a motor."""
        return None if self.axis.motor is None else all(check.passed for check in self.checks)

    @public
    def unit_of(self, name: str) -> str:
        """SI unit of an attribute: that of an angle, or of a driver that moves along a line."""
        return _unit(super().unit_of(name), self.turns)

    @public
    def word_of(self, name: str, word: str) -> str:
        """A driver that moves along a line is pushed by a force."""
        return _word(word, self.turns)

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """Scalars, what the motor stands, and the checks, ready for JSON."""
        parts = {"motor": self.motor, "start": self.start, "stop": self.stop}
        duties = {name: None if duty is None else duty.to_dict(curves=curves) for name, duty in parts.items()}
        return (
            super().to_dict(curves=curves) | duties | {"checks": [check.to_dict() for check in self.checks]}
        )


def _unit(unit: str, turns: bool) -> str:
    """Of the units of a driver that turns, and of one that moves along a line, that of this one."""
    return unit.split(" or ")[0 if turns else -1]


def _word(word: str, turns: bool) -> str:
    return word if turns else word.replace("torque", "force").replace("inertia", "mass")


def mark_of(machine: Machine, name: str | None, mark: Label) -> Label:
    """A quantity with the word and the unit that it has for an axis."""
    name = name or next(iter(machine.axes), None)
    axis = machine.axes.get(name or "")
    turns = axis is None or turns_about(machine, axis.driver or str(name))
    return mark._replace(word=_word(mark.word, turns), unit=_unit(mark.unit, turns))


def _of_start(duty: MotorDuty | None, when: str) -> Iterator[Check]:
    """Checks of a start or stop, each saying so."""
    for check in () if duty is None else duty.checks:
        if check.name in _OF_STARTS:
            yield replace(check, note=f"{check.note}, {when}" if check.note else when)


@public
def servo_axis(machine: Machine, name: str | None = None, *, speed: float | None = None) -> ServoAxis:
    """Motion and torque of a servo axis over the cycle, and what its motor must stand.

    Parameters
    ----------
    machine : Machine
    name : str, optional
        Name of the axis; may be left out if there is one.
    speed : float, optional
        Speed of the master [rad/s]. Without it the steady motion of the crankshaft where that has a motor,
        else the speed that the file gives.

    Returns
    -------
    ServoAxis

    Raises
    ------
    InputError
        There is no such axis, or no speed.
    FindingError
        The mechanism does not close over the cycle, or crankshaft and axis move a part together.

    Notes
    -----
    Kinetostatics with one unknown for each driver, by the exact derivatives of the laws; peaks are found
    between 720 angles a revolution, and on both sides of all ends of sections.
    """
    name = the_axis(machine, name)
    return servo_axes(machine, speed=speed, names=(name,))[name]


def the_axis(machine: Machine, name: str | None) -> str:
    """Name of an axis, which may be left out if there is one."""
    if not machine.axes:
        raise InputError("the machine has no axis: give a driver one as [axes.NAME]")
    if name is None and len(machine.axes) > 1:
        raise InputError(f"the machine has several axes: name one of {', '.join(machine.axes)}")
    chosen = next(iter(machine.axes)) if name is None else name
    if chosen not in machine.axes:
        raise InputError(f"{show(chosen)}: the machine has no such axis; {suggestion(chosen, machine.axes)}")
    return chosen


def servo_axes(
    machine: Machine, *, speed: float | None = None, names: tuple[str, ...] | None = None
) -> dict[str, ServoAxis]:
    """All axes of a machine by name, or some of them."""
    cycle = axes_cycle(machine, speed)
    omega = float(np.max(cycle.forces.speed))
    turns = max(1, round(float(cycle.angle[-1]) / (2 * np.pi)))
    inertias = _inertias(machine, turns)
    starts = _starts(machine, omega)
    return {
        name: _axis(machine, name, cycle, inertias, starts)
        for name in machine.axes
        if names is None or name in names
    }


def _inertias(machine: Machine, turns: int) -> dict[str, float]:
    """Mean inertia at each driver, worked out once."""
    kept = compile_machine(machine).kept
    if "driver_inertias" not in kept:
        kept["driver_inertias"] = driver_inertias(machine, turns)
    known: dict[str, float] = kept["driver_inertias"]
    return known


def _starts(machine: Machine, speed: float) -> tuple[AxesCycle | None, AxesCycle | None]:
    """Start and stop of the master, as far as the file has their times; kept with the machine."""
    master, kept = machine.master, compile_machine(machine).kept
    key = f"starts_at_{speed}"
    if key not in kept:
        times = (None, None) if master is None else (master.start_time, master.stop_time)
        kept[key] = tuple(
            None if time is None else start_cycle(machine, time, speed, stops=stops)
            for time, stops in zip(times, (False, True), strict=True)
        )
    known: tuple[AxesCycle | None, AxesCycle | None] = kept[key]
    return known


def _axis(
    machine: Machine,
    name: str,
    cycle: AxesCycle,
    inertias: dict[str, float],
    starts: tuple[AxesCycle | None, AxesCycle | None],
) -> ServoAxis:
    axis = machine.axes[name]
    driver = axis.driver or name
    turns = turns_about(machine, driver)
    inertia = inertias.get(driver)
    position, velocity, acceleration = driver_motion(machine, driver, cycle)
    torque = continued(cycle.angle, velocity, driver_torque(machine, driver, cycle))
    asked = driver_cycle(axis, cycle.time, velocity, acceleration, torque, inertia)
    duties = [
        None
        if start is None
        else _duty(
            axis,
            driver_cycle(
                axis,
                start.time,
                *driver_motion(machine, driver, start)[1:],
                driver_torque(machine, driver, start),
                inertia,
            ),
        )
        for start in starts
    ]
    return ServoAxis(
        crank_angle=cycle.angle,
        time=cycle.time,
        position=position,
        velocity=velocity,
        acceleration=acceleration,
        torque=torque,
        power=torque * velocity,
        torque_rms=float(root_mean_square(asked.weights(), torque, asked.period)),
        inertia_mean=inertia,
        name=name,
        driver=driver,
        turns=turns,
        motor=_duty(axis, asked),
        start=duties[0],
        stop=duties[1],
        axis=axis,
        cycle=asked,
    )


def axis_inertia(axis: Axis) -> Any:
    """Inertia of all that turns at the speed of the motor [kg m²]."""
    coupling = 0.0 if axis.coupling is None else axis.coupling.inertia
    return inertia_at_motor(axis.motor or _NO_MOTOR, axis.gearbox, coupling)


def axis_numbers(
    axis: Axis, time: Any, velocity: Any, acceleration: Any, torque: Any, inertia: Any
) -> Numbers:
    """Means and peaks of an axis and its motor by the attribute of the result, in any number.

    All but the time are those of the driver.
    """
    asked = driver_cycle(axis, time, velocity, acceleration, torque, inertia)
    rotor = 0.0 if axis.motor is None else axis.motor.rotor
    course = motor_course(asked.divided(), axis_inertia(axis), rotor, axis.gearbox)
    own = {"torque_max": torque, "velocity_max": velocity, "acceleration_max": acceleration}
    means = {f"motor.{name}": mean for name, mean in course.means.items()}
    means |= {"motor.inertia_ratio": course.inertia_ratio, "inertia_mean": inertia}
    means |= {"torque_rms": root_mean_square(asked.weights(), torque, asked.period)}
    peaks = {name: Peak(asked.time, curve) for name, curve in own.items()}
    return Numbers(means, peaks | {f"motor.{name}": peak for name, peak in course.peaks.items()})


def driver_cycle(
    axis: Axis, time: Any, velocity: Any, acceleration: Any, torque: Any, inertia: Any
) -> DriverCycle:
    """What a driver asks of its drive, referred to the pinion or screw where it moves along a line."""
    if axis.gearbox.per_turn is None:
        return DriverCycle(time, velocity, acceleration, torque, inertia)
    return DriverCycle.of_line(time, velocity, acceleration, torque, axis.gearbox.per_turn, inertia)


def _duty(axis: Axis, asked: DriverCycle) -> MotorDuty:
    """What an axis asks of its motor; without a motor, of one without rotor."""
    resistor = axis.resistor
    return motor_duty(
        asked,
        axis.motor or _NO_MOTOR,
        axis.gearbox,
        coupling=0.0 if axis.coupling is None else axis.coupling.inertia,
        resistor=(None, None) if resistor is None else (resistor.power_rated, resistor.power_max),
    )


_NO_MOTOR = ServoMotor.model_construct(inertia=0.0)


def turns_about(machine: Machine, driver: str) -> bool:
    """Whether a driver of the file turns: a crank or a camshaft; else it moves along a line."""
    return family_of(machine.mechanism, driver) != "lift"


def slide_of(machine: Machine, driver: str) -> int | None:
    """Place of a driver's position in the program; None for what turns with the master."""
    slides = compile_machine(machine).slides
    if driver in machine.mechanism.cams:
        return None
    return slides.get(angle_name(driver) if turns_about(machine, driver) else driver)


def driver_motion(machine: Machine, driver: str, cycle: AxesCycle) -> tuple[Floats, Floats, Floats]:
    """Position, velocity and acceleration of a driver; a camshaft turns with the master."""
    compiled, motion, slide = compile_machine(machine), cycle.forces.motion, slide_of(machine, driver)
    if slide is None:
        crank = machine.mechanism.cranks.get(driver)
        start = 0.0 if crank is None else float(crank.phase)
        return cycle.angle + start, motion.speed, motion.acceleration
    (rows,) = compiled.motion([Channel.Slide(slide)], motion.crank_angle)
    position, d1, d2 = rows
    return (position, *rates_in_time(d1, d2, motion))


def rates_in_time(d1: Any, d2: Any, motion: Motion) -> tuple[Any, Any]:
    """Velocity and acceleration by the derivatives over the master angle."""
    return d1 * motion.speed, d2 * motion.speed**2 + d1 * motion.acceleration


def driver_torque(machine: Machine, driver: str, cycle: AxesCycle) -> Floats:
    """Torque or force of a driver; of a cam the torque on its camshaft."""
    is_cam = driver in machine.mechanism.cams
    torque: Floats = (cycle.forces.shaft_torques if is_cam else cycle.forces.drives)[driver]
    return torque
