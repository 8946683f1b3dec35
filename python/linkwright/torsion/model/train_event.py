"""What happens to a train while it moves: loads, motors and cylinders switched, torques, short circuits.

| kind | is |
| --- | --- |
| `load_step` | a load grows or falls |
| `motor_on`, `motor_off` | a motor is switched |
| `fuel_on`, `fuel_off` | the combustion in all cylinders sets in or ends |
| `misfire` | single cylinders do without combustion |
| `torque`, `torque_course` | a torque on a disc, constant or over time |
| `speed_course` | a governor or test bench leads the speed of a disc |
| `short_circuit` | the terminals of a generator are short-circuited |
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, Description, fault
from linkwright.kernel.description.curve import curve_faults
from linkwright.kernel.units import (
    RATIO,
    TIME,
    TORSIONAL_DAMPING,
    QuantityList,
    Speeds,
    Torque,
    Torques,
    not_negative,
    positive,
)
from linkwright.torsion.model.train_base import PositiveSpeed, PositiveTorque

Instant = Annotated[float, not_negative(TIME)]
Instants = Annotated[tuple[float, ...], QuantityList(TIME)]
Share = Annotated[float, not_negative(RATIO)]


class _Passing(CheckedDescription):
    """An event that may end."""

    time: Instant = Field(description="When it begins.")
    until: Instant | None = Field(None, description="When it ends. Without it, it lasts.")

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
    time: Instant = Field(description="When it begins.")
    load: str = Field(description="Name of the load.")
    factor: Share = Field(description="Of its torque from then on; 0 throws it off.")
    over: Instant = Field(0.0, description="Time that it takes.")


class MotorSwitch(Description):
    """A motor is switched on or off."""

    kind: Literal["motor_on", "motor_off"]
    time: Instant = Field(description="When.")
    motor: str = Field(description="Name of the motor.")


class FuelSwitch(Description):
    """The combustion in all cylinders sets in or ends."""

    kind: Literal["fuel_on", "fuel_off"]
    time: Instant = Field(description="When it begins.")
    over: Instant = Field(0.0, description="Time that it takes.")


class Misfire(_Passing):
    """Cylinders do without combustion, or with part of it."""

    kind: Literal["misfire"]
    cylinders: tuple[Annotated[int, Field(ge=1)], ...] = Field(description="Their numbers.")
    factor: Share = Field(0.0, description="Share of the combustion that is left.")


class TorqueStep(_Passing):
    """A constant torque on a disc."""

    kind: Literal["torque"]
    on: str = Field(description="The disc.")
    torque: Torque = Field(description="Positive if it drives.")


class TorqueCourse(CheckedDescription):
    """A torque on a disc over time."""

    kind: Literal["torque_course"]
    on: str = Field(description="The disc.")
    times: Instants = Field(description="From the start of the motion, increasing.")
    torque: Torques = Field(description="At these times, positive if it drives; straight between them.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from curve_faults(self, "times", ("torque",))


class SpeedCourse(CheckedDescription):
    """A governor or test bench that leads the speed of a disc."""

    kind: Literal["speed_course"]
    on: str = Field(description="The disc.")
    times: Instants = Field(description="From the start of the motion, increasing.")
    speed: Speeds = Field(description="Wanted at these times; straight between them.")
    gain: Annotated[float, positive(TORSIONAL_DAMPING)] = Field(description="Torque per missing speed.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from curve_faults(self, "times", ("speed",))


class ShortCircuit(_Passing):
    """The terminals of a generator are short-circuited, at the worst instant."""

    kind: Literal["short_circuit"]
    on: str = Field(description="Disc of the generator.")
    torque: PositiveTorque = Field(description="Its apparent power over its speed.")
    speed: PositiveSpeed = Field(description="Of its rotor.")
    pole_pairs: int = Field(ge=1, description="Of its rotor.")
    reactance: Annotated[float, positive(RATIO)] = Field(description="Subtransient, per unit.")
    decay: Annotated[float, positive(TIME)] = Field(description="Time constant of the torque.")
    phases: Literal[2, 3] = Field(3, description="How many are short-circuited.")


AnyTrainEvent = Annotated[
    LoadStep | MotorSwitch | FuelSwitch | Misfire | TorqueStep | TorqueCourse | SpeedCourse | ShortCircuit,
    Field(discriminator="kind"),
]
