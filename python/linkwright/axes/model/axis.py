"""Master and servo axes in the machine file: which driver follows which law, and what drives it.

The master is the machine's cycle: one revolution of its angle φ, real or virtual, is one cycle. An axis gives
a driver of the mechanism a motor of its own, and with `sections` a law over that angle.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, ClassVar

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.axes.model.axis_gearbox import AxisGearbox
from linkwright.axes.model.servo_motor import ServoMotor
from linkwright.cam.model.motion_section import AxisSection
from linkwright.kernel.description.base import CheckedDescription, Description, fault
from linkwright.kernel.units.kinds import INERTIA, POWER, SPEED, TIME
from linkwright.kernel.units.marks import Angle, Length, not_negative, positive


class Master(CheckedDescription):
    """The machine's cycle: the angle over which all axes and cams move."""

    cycle_time: Annotated[float, positive(TIME)] | None = Field(
        None, description="Duration of a cycle, one revolution of the master."
    )
    speed: Annotated[float, positive(SPEED)] | None = Field(
        None, description="Speed of the master instead. Default: `drive.speed`."
    )
    start_time: Annotated[float, positive(TIME)] | None = Field(
        None,
        description="Time in which the speed of the master rises from rest, evenly, from φ = 0 on, over at "
        "most 120 revolutions. Default: starts are not considered.",
    )
    stop_time: Annotated[float, positive(TIME)] | None = Field(
        None,
        description="Time in which it falls to rest, from φ = 0 on, over at most 120 revolutions. Default: "
        "stops are not considered.",
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.cycle_time is not None and self.speed is not None:
            remedy = "remove one of them"
            yield fault("speed", found="both", expected="either cycle_time or speed", remedy=remedy)


class AxisCoupling(Description):
    """Coupling at the motor shaft of an axis."""

    shown_with_part: ClassVar[bool] = True

    inertia: Annotated[float, not_negative(INERTIA)] = Field(
        description="Moment of inertia, referred to the motor shaft."
    )


class BrakeResistor(Description):
    """Resistor that takes the energy that an axis regenerates."""

    shown_with_part: ClassVar[bool] = True

    power_rated: Annotated[float, positive(POWER)] = Field(description="Continuous power, mean of a cycle.")
    power_max: Annotated[float, positive(POWER)] | None = Field(
        None, description="Peak power. Default: not limited."
    )


class Axis(Description):
    """A servo axis: a driver of the mechanism with a motor of its own."""

    driver: str | None = Field(
        None,
        description="Crank, linear driver, cylinder or cam that it drives. Default: the name of the axis.",
    )
    sections: tuple[AxisSection, ...] = Field(
        (),
        description="Motion over a cycle, as that of cams: `swing` for a crank, `lift` for a linear driver "
        "or cylinder; over an `angle` of the master or a `time`. The rest of the cycle is a dwell. Default: "
        "the driver's own motion.",
    )
    phase: Angle = Field(0.0, description="Angle of the master at which the first section begins.")
    advance: Angle = Field(
        0.0, description="Advance of a crank per cycle: index steps add up. Default: it returns."
    )
    travel: Length = Field(
        0.0, description="Advance of a linear driver per cycle; a cylinder returns. Default: it returns."
    )
    motor: ServoMotor | None = Field(None, description="Servo motor.")
    gearbox: AxisGearbox = Field(
        default_factory=AxisGearbox, description="Gearbox between motor and driver. Default: a direct drive."
    )
    coupling: AxisCoupling | None = Field(None, description="Coupling at the motor shaft.")
    resistor: BrakeResistor | None = Field(None, description="Brake resistor.")
