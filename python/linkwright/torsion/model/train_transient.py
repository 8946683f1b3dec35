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
from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.drive.model.motor import (
    ConstantSpeedMotor,
    ConstantTorqueMotor,
    DcMotor,
    InductionMotor,
    TableMotor,
)
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
from linkwright.kernel.units.kinds import RATIO, SPEED, TIME, TORSIONAL_DAMPING
from linkwright.kernel.units.marks import (
    Angle,
    QuantityList,
    Speed,
    Speeds,
    Torque,
    Torques,
    not_negative,
    positive,
)
from linkwright.torsion.model.clutch import EngagedPart
from linkwright.torsion.model.ice_impacts import IceImpacts
from linkwright.torsion.model.train_base import PositiveSpeed, PositiveTorque

if TYPE_CHECKING:
    from linkwright.torsion.model.train import Train


Instant = Annotated[float, not_negative(TIME)]
Instants = Annotated[tuple[float, ...], QuantityList(TIME)]
Share = Annotated[float, not_negative(RATIO)]


class _TimedEvent(CheckedDescription):
    """An event that may end."""

    time: Instant = Field(description="Time at which the event begins.")
    until: Instant | None = Field(None, description="Time at which the event ends. Default: never.")

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
    time: Instant = Field(description="Time at which the event begins.")
    load: str = Field(description="Name of the load.")
    factor: Share = Field(description="Factor on the torque from then on; 0 is a load rejection.")
    over: Instant = Field(0.0, description="Duration of the change.")


class MotorSwitch(Description):
    """A motor is switched on or off."""

    kind: Literal["motor_on", "motor_off"]
    time: Instant = Field(description="Time of the event.")
    motor: str = Field(description="Name of the motor.")


class ClutchSwitch(Description):
    """A clutch is engaged or disengaged."""

    kind: Literal["clutch_on", "clutch_off"]
    time: Instant = Field(description="Time at which the event begins.")
    clutch: str = Field(description="Name of the clutch.")
    over: Instant = Field(0.0, description="Duration of the change.")


class BrakeSwitch(Description):
    """A brake is applied or released."""

    kind: Literal["brake_on", "brake_off"]
    time: Instant = Field(description="Time at which the event begins.")
    brake: str = Field(description="Name of the brake.")
    over: Instant = Field(0.0, description="Duration of the change.")


class FuelSwitch(Description):
    """The combustion in all cylinders sets in or ends."""

    kind: Literal["fuel_on", "fuel_off"]
    engine: str | None = Field(None, description="Engine, if there are several. Default: all.")
    time: Instant = Field(description="Time at which the event begins.")
    over: Instant = Field(0.0, description="Duration of the change.")


class Misfire(_TimedEvent):
    """Cylinders do without combustion, or with part of it."""

    kind: Literal["misfire"]
    engine: str | None = Field(None, description="Engine, if there are several.")
    cylinders: tuple[Annotated[int, Field(ge=1)], ...] = Field(description="Numbers of the cylinders.")
    factor: Share = Field(0.0, description="Remaining share of the combustion.")


class TorqueStep(_TimedEvent):
    """A constant torque on a disc."""

    kind: Literal["torque"]
    on: str = Field(description="Disc on which the torque acts.")
    torque: Torque = Field(description="Positive if it drives.")


class TorqueCourse(CheckedDescription):
    """A torque on a disc over time."""

    kind: Literal["torque_course"]
    on: str = Field(description="Disc on which the torque acts.")
    times: Instants = Field(description="Times from the start of the motion, increasing.")
    torque: Torques = Field(description="Torque at these times, positive if it drives; linear between them.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from curve_faults(self, "times", ("torque",))


class SpeedCourse(CheckedDescription):
    """A governor or test bench that leads the speed of a disc."""

    kind: Literal["speed_course"]
    on: str = Field(description="Disc on which the torque acts.")
    times: Instants = Field(description="Times from the start of the motion, increasing.")
    speed: Speeds = Field(description="Required speed at these times; linear between them.")
    gain: Annotated[float, positive(TORSIONAL_DAMPING)] = Field(
        description="Gain of the controller: torque per speed deviation."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from curve_faults(self, "times", ("speed",))


class ShortCircuit(_TimedEvent):
    """The terminals of a generator are short-circuited, at the worst instant."""

    kind: Literal["short_circuit"]
    on: str = Field(description="Disc of the generator.")
    torque: PositiveTorque = Field(description="Rated torque: apparent power over speed.")
    speed: PositiveSpeed = Field(description="Speed of the rotor.")
    pole_pairs: Whole = Field(ge=1, description="Number of pole pairs of the rotor.")
    reactance: Annotated[float, positive(RATIO)] = Field(description="Subtransient reactance, per unit.")
    decay: Annotated[float, positive(TIME)] = Field(description="Time constant of the torque.")
    phases: Literal[2, 3] = Field(3, description="Number of short-circuited phases.")


AnyTrainEvent = Annotated[
    LoadStep
    | MotorSwitch
    | ClutchSwitch
    | BrakeSwitch
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
    InductionMotor | DcMotor | TableMotor | ConstantTorqueMotor | ConstantSpeedMotor,
    Field(discriminator="kind"),
]


# A motor of constant speed gives whatever torque a motion asks for.
_IN_TIME = 'one of "induction", "dc", "table", "constant_torque", to move in time'


class TrainMotor(Description):
    """A motor that drives a disc of a train."""

    on: str = Field(description="Disc that rotates at the speed of the motor.")
    motor: TrainDrive = Field(description="Characteristic of the motor. Its inertia is included in the disc.")
    on_at_start: bool = Field(True, description="Motor on from the start.")


class TrainTransient(CheckedDescription):
    """A manoeuvre: start, stop, change of speed or load, short circuit."""

    duration: Annotated[float, positive(TIME)] = Field(description="Duration of the manoeuvre.")
    speed: Annotated[float, not_negative(SPEED)] = Field(
        0.0, description="Speed of the first disc at the start; 0 is a start from rest."
    )
    speeds: dict[Name, Speed] = Field(
        default_factory=dict,
        description="Speeds at the start of parts that clutches and freewheels separate, each by one of its "
        "discs; the others follow from speed.",
    )
    angle: Angle = Field(0.0, description="Angle of the first disc at the start.")
    balanced: bool = Field(
        True,
        description="Balance the mean torques at the start, as in steady running, with the loads as "
        "given: a motor starts at the speed of balance near the given one; the combustion of an engine is "
        "scaled; without engine or motor, disc 1 supplies the load torque. A start from rest is never "
        "balanced. With clutches, brakes or freewheels only where this key is given, with engaged "
        "clutches.",
    )
    loads_follow: bool = Field(
        False,
        description="Scale the loads instead, at the given speed, to balance the mean torques.",
    )
    loaded: bool = Field(
        True,
        description="Start with the shafts twisted by the mean torques; a start from rest is without twist.",
    )
    twists: dict[Name, Angle] = Field(
        default_factory=dict,
        description="Twists of shafts, couplings and elastic meshes at the start, by name, such as for a "
        "free vibration; the others start without twist, and nothing is balanced or settles.",
    )
    settle: Instant | None = Field(
        None,
        description="Settling time before the start, not recorded. Default: 1 s for a balanced and loaded "
        "start, otherwise none.",
    )
    fuel: Share = Field(1.0, description="Share of the combustion in all cylinders at the start.")
    gas_speed: PositiveSpeed | None = Field(
        None,
        description="Speed for which the gas torques over the crank angle are computed. Default: the "
        "initial speed, or the service speed.",
    )
    motors: dict[Name, TrainMotor] = Field(
        default_factory=dict, description="Motors of the manoeuvre alone, beside those of [train.motors]."
    )
    events: tuple[AnyTrainEvent, ...] = Field((), description="Events of the manoeuvre.")
    sample_time: Annotated[float, positive(TIME)] | None = Field(
        None, description="Sampling interval of the result. Default: at most 0.5 ms."
    )
    loss_by: Literal["shaft", "mode"] = Field(
        "shaft",
        description="Equivalent damping of hysteresis: per shaft (exact at one frequency) or per mode "
        "(exact at each natural frequency).",
    )
    loss_mode: Annotated[int, Field(ge=1)] | None = Field(
        None,
        description="Mode in which the viscous damping dissipates as much as the hysteresis. Default: for "
        "each shaft, the lowest mode in which it stores at least 5 % of the strain energy.",
    )
    accuracy: Annotated[float, Field(ge=1e-13, le=1e-3)] = Field(
        1e-8, description="Relative accuracy of a step, at its end and within it."
    )
    method: Literal["auto", "explicit", "implicit"] = Field(
        "auto",
        description="Method of integration; implicit steps do not resolve the vibration of very "
        "stiff shafts.",
    )
    steps_max: Whole = Field(5_000_000, ge=1, description="Maximum number of steps.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        for name in ("loaded", "settle"):
            if self.twists and name in self.model_fields_set and getattr(self, name):
                yield fault(name, found=getattr(self, name), expected="none beside twists at the start")
        if self.sample_time is not None and self.duration / self.sample_time > SAMPLES.most:
            expected = f"at least {self.duration / SAMPLES.most:.6g} s, for {SAMPLES.most} samples at most"
            yield fault("sample_time", found=self.sample_time, expected=expected)
        for n, event in enumerate(self.events):
            time = getattr(event, "time", 0.0)
            if time >= self.duration:
                expected = f"less than the duration, {self.duration:.6g} s"
                yield fault("events", n, "time", found=time, expected=expected)


def transient_faults(train: Train, discs: tuple[str, ...]) -> Iterator[InitErrorDetails]:
    """Names of a manoeuvre that its train does not have, each with its keys from the machine down."""
    manoeuvre = train.transient
    if manoeuvre is None:
        return
    motors = {**train.motors, **manoeuvre.motors}
    for name, motor in manoeuvre.motors.items():
        yield from _unknown(motor.on, discs, "disc", "motors", name, "on")
        if isinstance(motor.motor, ConstantSpeedMotor):
            place, expected = ("train", "transient", "motors", name, "motor", "kind"), _IN_TIME
            yield fault(*place, found=motor.motor.kind, expected=expected)
    twisting = [name for table in (train.shafts, train.couplings) for name in table]
    twisting += [name for name, gear in train.gears.items() if gear.stiffness is not None]
    twisting += [mesh for name, stage in train.planetaries.items() for mesh in stage.meshes(name)]
    twisting += [crank for engine in train.installed for crank in engine.cranks]
    twisting += [wheel.parts(name)[1] for name, wheel in train.freewheels.items() if wheel.stiffness]
    for name in manoeuvre.twists:
        yield from _unknown(name, twisting, "shaft, coupling or elastic mesh", "twists", name)
    for name in manoeuvre.speeds:
        yield from _unknown(name, discs, "disc", "speeds", name)
        if not train.rubs:
            expected = "no other speeds in a train without clutches, brakes and freewheels"
            yield fault("train", "transient", "speeds", name, found=name, expected=expected)
    for n, event in enumerate(manoeuvre.events):
        match event:
            case LoadStep(load=load):
                yield from _unknown(load, train.loads, "load", "events", n, "load")
            case MotorSwitch(motor=name):
                yield from _unknown(name, motors, "motor", "events", n, "motor")
            case ClutchSwitch(clutch=name):
                yield from _switch_faults(name, train.clutches, "clutch", n)
            case BrakeSwitch(brake=name):
                yield from _switch_faults(name, train.brakes, "brake", n)
            case Misfire() | FuelSwitch():
                yield from _engine_faults(train, event, n)
            case _:
                yield from _unknown(event.on, discs, "disc", "events", n, "on")


def _unknown(name: str, known: Iterable[str], word: str, *place: str | int) -> Iterator[InitErrorDetails]:
    listed = tuple(known)
    if name not in listed:
        remedy = close_match(name, listed) or suggestion(name, listed) or f"there is no {word}"
        yield fault("train", "transient", *place, found=name, expected=f"the name of a {word}", remedy=remedy)


def _switch_faults(
    name: str, parts: Mapping[str, EngagedPart], word: str, n: int
) -> Iterator[InitErrorDetails]:
    yield from _unknown(name, parts, word, "events", n, word)
    if name in parts and parts[name].times is not None:
        expected = f"a {word} without times and engagement"
        yield fault("train", "transient", "events", n, word, found=name, expected=expected)


def _engine_faults(train: Train, event: Misfire | FuelSwitch, n: int) -> Iterator[InitErrorDetails]:
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
