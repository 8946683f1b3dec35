"""A manoeuvre of a train, followed in time: from which state, how long, and what happens on the way.

| kind | is |
| --- | --- |
| `load_step` | a load grows or falls |
| `motor_on`, `motor_off` | a motor is switched |
| `fuel_on`, `fuel_off` | the combustion in all cylinders sets in or ends |
| `misfire` | single cylinders do without combustion |
| `torque`, `torque_course` | a torque on a disc, constant or over time |
| `speed_course` | a governor or test bench leads the speed of a disc |
| `short_circuit` | the terminals of a generator are short-circuited |
| `ice_impacts` | the blades of a propeller mill ice |
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.drive.model.motor import ConstantTorqueMotor, DcMotor, InductionMotor, TableMotor
from linkwright.kernel.description.base import (
    CheckedDescription,
    Description,
    Name,
    Whole,
    close_match,
    fault,
    suggestion,
)
from linkwright.kernel.description.curve import curve_faults
from linkwright.kernel.limits import SAMPLES
from linkwright.kernel.units import (
    RATIO,
    SPEED,
    TIME,
    TORSIONAL_DAMPING,
    Angle,
    QuantityList,
    Speeds,
    Torque,
    Torques,
    not_negative,
    positive,
)
from linkwright.torsion.model.ice_impacts import IceImpacts
from linkwright.torsion.model.train_base import PositiveSpeed, PositiveTorque

if TYPE_CHECKING:
    from linkwright.torsion.model.train import Train


Instant = Annotated[float, not_negative(TIME)]
Instants = Annotated[tuple[float, ...], QuantityList(TIME)]
Share = Annotated[float, not_negative(RATIO)]


class _TimedEvent(CheckedDescription):
    """An event that may end."""

    time: Instant = Field(description="Time at which it begins.")
    until: Instant | None = Field(None, description="Time at which it ends. Default: never.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.until is not None and self.until <= self.time:
            yield fault("until", found=self.until, expected=f"more than time, {self.time:.6g} s")

    @property
    def end(self) -> float:
        """When it ends, infinite if it lasts [s]."""
        return math.inf if self.until is None else self.until


class LoadStep(Description):
    """A load of the train grows or falls."""

    kind: Literal["load_step"]
    time: Instant = Field(description="Time at which it begins.")
    load: str = Field(description="Name of the load.")
    factor: Share = Field(description="Of its torque from then on; 0 throws it off.")
    over: Instant = Field(0.0, description="Duration of the change.")


class MotorSwitch(Description):
    """A motor is switched on or off."""

    kind: Literal["motor_on", "motor_off"]
    time: Instant = Field(description="When.")
    motor: str = Field(description="Name of the motor.")


class FuelSwitch(Description):
    """The combustion in all cylinders sets in or ends."""

    kind: Literal["fuel_on", "fuel_off"]
    engine: str | None = Field(None, description="Which of several engines. Default: all.")
    time: Instant = Field(description="Time at which it begins.")
    over: Instant = Field(0.0, description="Duration of the change.")


class Misfire(_TimedEvent):
    """Cylinders do without combustion, or with part of it."""

    kind: Literal["misfire"]
    engine: str | None = Field(None, description="Which of several engines.")
    cylinders: tuple[Annotated[int, Field(ge=1)], ...] = Field(description="Their numbers.")
    factor: Share = Field(0.0, description="Remaining share of the combustion.")


class TorqueStep(_TimedEvent):
    """A constant torque on a disc."""

    kind: Literal["torque"]
    on: str = Field(description="The disc.")
    torque: Torque = Field(description="Positive if it drives.")


class TorqueCourse(CheckedDescription):
    """A torque on a disc over time."""

    kind: Literal["torque_course"]
    on: str = Field(description="The disc.")
    times: Instants = Field(description="From the start of the motion, increasing.")
    torque: Torques = Field(description="Torque at these times, positive if it drives; linear between them.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from curve_faults(self, "times", ("torque",))


class SpeedCourse(CheckedDescription):
    """A governor or test bench that leads the speed of a disc."""

    kind: Literal["speed_course"]
    on: str = Field(description="The disc.")
    times: Instants = Field(description="From the start of the motion, increasing.")
    speed: Speeds = Field(description="Required speed at these times; linear between them.")
    gain: Annotated[float, positive(TORSIONAL_DAMPING)] = Field(
        description="Torque per deviation of the speed."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from curve_faults(self, "times", ("speed",))


class ShortCircuit(_TimedEvent):
    """The terminals of a generator are short-circuited, at the worst instant."""

    kind: Literal["short_circuit"]
    on: str = Field(description="Disc of the generator.")
    torque: PositiveTorque = Field(description="Its apparent power over its speed.")
    speed: PositiveSpeed = Field(description="Of its rotor.")
    pole_pairs: Whole = Field(ge=1, description="Of its rotor.")
    reactance: Annotated[float, positive(RATIO)] = Field(description="Subtransient, per unit.")
    decay: Annotated[float, positive(TIME)] = Field(description="Time constant of the torque.")
    phases: Literal[2, 3] = Field(3, description="How many are short-circuited.")


AnyTrainEvent = Annotated[
    LoadStep
    | MotorSwitch
    | FuelSwitch
    | Misfire
    | TorqueStep
    | TorqueCourse
    | SpeedCourse
    | ShortCircuit
    | IceImpacts,
    Field(discriminator="kind"),
]


TrainDrive = Annotated[
    InductionMotor | DcMotor | TableMotor | ConstantTorqueMotor, Field(discriminator="kind")
]


class TrainMotor(Description):
    """A motor that drives a disc of a train."""

    on: str = Field(description="The disc, which turns at the speed of the motor.")
    motor: TrainDrive = Field(
        description="Its torque over its speed. Its inertia counts with the disc already."
    )
    on_at_start: bool = Field(True, description="Whether it drives from the start.")


class TrainTransient(CheckedDescription):
    """A manoeuvre: start, stop, change of speed or load, short circuit."""

    duration: Annotated[float, positive(TIME)] = Field(description="Duration of the manoeuvre.")
    speed: Annotated[float, not_negative(SPEED)] = Field(
        0.0, description="Of the first disc at the start; 0 is at rest."
    )
    angle: Angle = Field(0.0, description="Of the first disc at the start.")
    balanced: bool = Field(
        True,
        description="Whether mean torques balance at the start, as in steady running. Loads are as given: "
        "a motor that drives has the speed at which they balance, near that given; the combustion of an "
        "engine counts as much as they ask for; a train without engine and motor is driven by what they "
        "need. From rest nothing is balanced.",
    )
    loads_follow: bool = Field(
        False,
        description="Whether loads are scaled instead, at the speed given, so that mean torques balance.",
    )
    loaded: bool = Field(
        True,
        description="Whether shafts are twisted by the mean torques at the start. From rest they are not.",
    )
    settle: Instant | None = Field(
        None,
        description="Time before the start in which it swings in, unrecorded. Default: 1 s for a motion "
        "that starts in balance and loaded, else none.",
    )
    fuel: Share = Field(1.0, description="Share of the combustion in all cylinders at the start.")
    gas_speed: PositiveSpeed | None = Field(
        None,
        description="At which the gas torques over the crank angle are taken. Default: the speed of the "
        "start, or that of service.",
    )
    motors: dict[Name, TrainMotor] = Field(default_factory=dict, description="Motors by name.")
    events: tuple[AnyTrainEvent, ...] = Field((), description="Events of the manoeuvre.")
    sample_time: Annotated[float, positive(TIME)] | None = Field(
        None, description="Between the samples of the result. Default: at most 0.5 ms."
    )
    loss_by: Literal["shaft", "mode"] = Field(
        "shaft",
        description="Whether hysteresis counts as viscous damping of each shaft, right at one frequency, or "
        "as damping ratio of each mode, right at each natural frequency.",
    )
    loss_mode: Annotated[int, Field(ge=1)] | None = Field(
        None,
        description="Mode of vibration in which viscous damping loses what hysteresis would. Default: for "
        "each shaft the lowest mode of whose energy it stores a twentieth or more.",
    )
    accuracy: Annotated[float, Field(ge=1e-13, le=1e-3)] = Field(
        1e-8, description="Relative, of a step, at its end and on the way there."
    )
    method: Literal["auto", "explicit", "implicit"] = Field(
        "auto", description="Of integration; implicit steps do not follow the swings of very stiff shafts."
    )
    steps_max: Whole = Field(5_000_000, ge=1, description="Maximum number of steps.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.sample_time is not None and self.duration / self.sample_time > SAMPLES.most:
            expected = f"at least {self.duration / SAMPLES.most:.6g} s, for {SAMPLES.most} samples at most"
            yield fault("sample_time", found=self.sample_time, expected=expected)
        for n, event in enumerate(self.events):
            time = getattr(event, "time", 0.0)
            if time >= self.duration:
                expected = f"less than the duration, {self.duration:.6g} s"
                yield fault("events", n, "time", found=time, expected=expected)


def transient_faults(train: Train, discs: tuple[str, ...]) -> Iterator[InitErrorDetails]:
    """Faults between a manoeuvre and its train: names that mean nothing.

    Each with its keys from the machine down.
    """
    manoeuvre = train.transient
    if manoeuvre is None:
        return
    for name, motor in manoeuvre.motors.items():
        yield from _unknown(motor.on, discs, "disc", "motors", name, "on")
    for n, event in enumerate(manoeuvre.events):
        match event:
            case LoadStep(load=load):
                yield from _unknown(load, train.loads, "load", "events", n, "load")
            case MotorSwitch(motor=name):
                yield from _unknown(name, manoeuvre.motors, "motor", "events", n, "motor")
            case Misfire() | FuelSwitch():
                yield from _engine_faults(train, event, n)
            case _:
                yield from _unknown(event.on, discs, "disc", "events", n, "on")


def _unknown(name: str, known: Iterable[str], word: str, *place: str | int) -> Iterator[InitErrorDetails]:
    """The fault of a name that is not known."""
    listed = tuple(known)
    if name not in listed:
        remedy = close_match(name, listed) or suggestion(name, listed) or f"there is no {word}"
        yield fault("train", "transient", *place, found=name, expected=f"the name of a {word}", remedy=remedy)


def _engine_faults(train: Train, event: Misfire | FuelSwitch, n: int) -> Iterator[InitErrorDetails]:
    """Combustion without an engine, or cylinders that it has not."""
    place = ("train", "transient", "events", n)
    engines = {one.name: one.engine for one in train.installed}
    if not engines:
        remedy = "describe it as [train.engine]"
        yield fault(
            *place, "kind", found=event.kind, expected="an event of a train with an engine", remedy=remedy
        )
    elif event.engine is not None and event.engine not in engines:
        expected = "the name of one of [train.engines]"
        yield fault(
            *place, "engine", found=event.engine, expected=expected, remedy=suggestion(event.engine, engines)
        )
    elif isinstance(event, Misfire) and event.engine is None and len(engines) > 1:
        yield fault(
            *place, "engine", expected="the engine whose cylinders they are", remedy=suggestion("", engines)
        )
    elif isinstance(event, Misfire):
        cylinders = engines[event.engine or next(iter(engines))].n_cylinders
        for k, number in enumerate(event.cylinders):
            if number > cylinders:
                expected = f"the number of a cylinder, 1 to {cylinders}"
                yield fault(*place, "cylinders", k, found=number, expected=expected)
