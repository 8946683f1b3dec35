"""The driveline: motor, coupling, brake and gearbox, and the flywheel, on the way to the crankshaft.

Inertias of the motor, of the coupling and of the gearbox are given at the motor shaft; that is how catalogues
give them. At the crankshaft they count with the square of the ratio.

Shafts and gears are rigid unless their stiffness is given. What steady motion and motion in time do not ask
for, torsional vibration does: `drive_train` makes a train of a torsionally flexible driveline.
"""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import BeforeValidator, Field, WithJsonSchema
from pydantic_core import InitErrorDetails

from linkwright.drive.model.motor import AnyMotor
from linkwright.kernel.description.base import CheckedDescription, Description, fault, wrong
from linkwright.kernel.description.cycle import ONE_TURN
from linkwright.kernel.description.deferred_model import deferred_model
from linkwright.kernel.errors import show
from linkwright.kernel.units.kinds import ANGLE, INERTIA, RATIO, SPEED, TORQUE
from linkwright.kernel.units.marks import FRACTION, Quantity, not_negative, positive
from linkwright.kernel.units.reading import is_number
from linkwright.torsion.model.train_base import Damping, PositiveStiffness

if TYPE_CHECKING:
    from linkwright.torsion.model.drive_shaft import DriveShaft
else:
    DriveShaft = deferred_model("torsion.model.drive_shaft", "DriveShaft")

Shaft = Literal["motor", "crank"]
End = Literal["motor", "gearbox", "crank"]

_REVERSE = '"same", a number greater than 0, or 0 for a self-locking gearbox'


def _reverse(value: object) -> object:
    if value is None or value == "same" or (is_number(value) and 0 <= float(value) < float("inf")):
        return value
    raise wrong(show(value), _REVERSE)


_REVERSE_SCHEMA: dict[str, Any] = {"anyOf": [{"const": "same"}, {"type": "number", "minimum": 0}]}


class Gears(Description):
    """Gears between a motor and a shaft that it drives; a ratio of 1 stands for a direct drive."""

    ratio: Annotated[float, positive(RATIO)] = Field(
        1.0, description="Motor speed over speed of the driven shaft."
    )
    efficiency: Annotated[float, Quantity(RATIO, FRACTION)] = Field(
        1.0, description="Torque at the driven shaft over motor torque times ratio, while the motor drives."
    )
    reverse: Annotated[
        float | Literal["same"] | None, BeforeValidator(_reverse), WithJsonSchema(_REVERSE_SCHEMA)
    ] = Field(
        None,
        description="The same factor while the load drives the motor: 1/η for the back-driving efficiency η, "
        '"same" for the value of `efficiency`, or 0 for a self-locking gearbox, which holds any load that '
        "drives (worm, screw). Default: 1/efficiency.",
    )
    inertia: Annotated[float, not_negative(INERTIA)] = Field(
        0.0, description="Moment of inertia, referred to the motor shaft."
    )

    @property
    def locks(self) -> bool:
        """Whether it is self-locking: no load drives the motor through it."""
        return is_number(self.reverse) and float(self.reverse) == 0


class Gearbox(Gears, CheckedDescription):
    """Gears between the motor and the crankshaft."""

    wheel_inertia: Annotated[float, not_negative(INERTIA)] = Field(
        0.0,
        description="Moment of inertia of the last wheel or pulley, about the crankshaft, if "
        "`inertia` excludes it.",
    )
    stiffness: PositiveStiffness | None = Field(
        None,
        description="Stiffness of teeth or belt, referred to the motor shaft: torque per angle. Default: "
        "rigid.",
    )
    damping: Damping = Field(
        0.0, description="Damping of elastic teeth, referred to the motor shaft: torque per angular velocity."
    )
    backlash: Annotated[float, not_negative(ANGLE)] = Field(
        0.0,
        description="Backlash of elastic teeth, from flank to flank, as angle of the motor shaft; damping "
        "acts in contact only.",
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        for name in ("damping", "backlash"):
            if self.stiffness is None and getattr(self, name):
                remedy = "give the stiffness of the teeth"
                yield fault(name, found=getattr(self, name), expected="none with rigid teeth", remedy=remedy)


class Coupling(Description):
    """Coupling between the motor and the gearbox."""

    inertia: Annotated[float, not_negative(INERTIA)] = Field(
        description="Moment of inertia, referred to the motor shaft."
    )
    beside: Literal["motor", "gearbox"] | None = Field(
        None,
        description="End of a flexible motor shaft that carries the coupling. Default: half at each end.",
    )


class _OnShaft(CheckedDescription):
    """A part on one of the two shafts, which may twist."""

    def _faults(self) -> Iterator[InitErrorDetails]:
        beside, on = getattr(self, "beside", None), getattr(self, "on", "")
        if beside not in (None, on, "gearbox"):
            remedy = f'it is on the {on} shaft; to move it to the other, change "on" as well'
            yield fault("beside", found=beside, expected=f'"{on}" or "gearbox"', remedy=remedy)


class Flywheel(_OnShaft):
    """Disc that evens out the motion."""

    inertia: Annotated[float, not_negative(INERTIA)] = Field(
        description="Moment of inertia about its own shaft."
    )
    on: Shaft = Field("crank", description="Shaft that carries it.")
    beside: End | None = Field(
        None,
        description="End of its shaft, if the shaft is flexible. Default: the end away from the gearbox.",
    )


class Brake(_OnShaft):
    """Brake of constant torque, which opposes the motion."""

    torque: Annotated[float, not_negative(TORQUE)] = Field(description="Braking torque at its own shaft.")
    inertia: Annotated[float, not_negative(INERTIA)] = Field(
        0.0, description="Moment of inertia about its own shaft."
    )
    on: Shaft = Field("motor", description="Shaft that carries it.")
    beside: End | None = Field(
        None,
        description="End of its shaft, if the shaft is flexible. Default: the end away from the gearbox.",
    )


class Drive(Description):
    """Drive of the crankshaft."""

    speed: Annotated[float, positive(SPEED)] | None = Field(
        None, description="Design speed of the crankshaft."
    )
    motor: AnyMotor | None = Field(None, description="Motor of the drive.")
    gearbox: Gearbox = Field(default_factory=Gearbox, description="Gearbox between motor and crankshaft.")
    coupling: Coupling | None = Field(None, description="Coupling at the motor shaft.")
    flywheel: Flywheel | None = Field(None, description="Flywheel.")
    brake: Brake | None = Field(None, description="Brake.")
    motor_shaft: DriveShaft | None = Field(
        None, description="Flexible shaft and coupling between motor and gearbox."
    )
    crankshaft: DriveShaft | None = Field(None, description="Flexible shaft between gearbox and mechanism.")

    @property
    def twists(self) -> bool:
        """Whether a shaft, or the gears, are elastic."""
        return not (self.motor_shaft is None and self.crankshaft is None and self.gearbox.stiffness is None)


def design_speed(master: Any, drive: Drive | None) -> Any:
    """Speed of the crankshaft [rad/s]: that of its master, else the drive's; None without either."""
    if master is not None and master.speed is not None:
        return master.speed
    if master is not None and master.cycle_time is not None:
        return ONE_TURN / master.cycle_time
    return None if drive is None else drive.speed
