"""The drive line: motor, coupling, brake and gearbox, and the flywheel, on the way to the crankshaft.

Inertias of the motor, of the coupling and of the gearbox are given at the motor shaft; that is how catalogues
give them. At the crankshaft they count with the square of the ratio.
"""

from __future__ import annotations

from numbers import Real
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, WithJsonSchema

from linkwright.machine.base import Description, wrong
from linkwright.machine.motor import AnyMotor
from linkwright.units import (
    FRACTION,
    INERTIA,
    RATIO,
    SPEED,
    TORQUE,
    Quantity,
    not_negative,
    positive,
    show,
)

Shaft = Literal["motor", "crank"]

_REVERSE = '"same", or a number greater than 0'


def _reverse(value: object) -> object:
    """The torque factor of the gearbox when the load drives the motor."""
    number = isinstance(value, Real) and not isinstance(value, bool)
    if value is None or value == "same" or (number and 0 < float(value) < float("inf")):  # type: ignore[arg-type]
        return value
    raise wrong(show(value), _REVERSE)


_REVERSE_SCHEMA: dict[str, Any] = {"anyOf": [{"const": "same"}, {"type": "number", "exclusiveMinimum": 0}]}


class Gearbox(Description):
    """Gears between the motor and the crankshaft; a ratio of 1 stands for a direct drive."""

    ratio: Annotated[float, positive(RATIO)] = Field(1.0, description="Motor speed over crankshaft speed.")
    efficiency: Annotated[float, Quantity(RATIO, FRACTION)] = Field(
        1.0, description="Torque at the crankshaft over motor torque times ratio, while the motor drives."
    )
    reverse: Annotated[
        float | Literal["same"] | None, BeforeValidator(_reverse), WithJsonSchema(_REVERSE_SCHEMA)
    ] = Field(
        None,
        description="The same factor while the load drives the motor: a number, or "
        '"same" for the efficiency in both directions. Without it, 1/efficiency.',
    )
    inertia: Annotated[float, not_negative(INERTIA)] = Field(0.0, description="At the motor shaft.")


class Coupling(Description):
    """Coupling between the motor and the gearbox."""

    inertia: Annotated[float, not_negative(INERTIA)] = Field(description="At the motor shaft.")


class Flywheel(Description):
    """Disc that evens out the motion."""

    inertia: Annotated[float, not_negative(INERTIA)] = Field(description="About its own shaft.")
    on: Shaft = Field("crank", description="The shaft that it sits on.")


class Brake(Description):
    """Brake of constant torque, which opposes the motion."""

    torque: Annotated[float, not_negative(TORQUE)] = Field(description="At its own shaft.")
    inertia: Annotated[float, not_negative(INERTIA)] = Field(0.0, description="About its own shaft.")
    on: Shaft = Field("motor", description="The shaft that it sits on.")


class Drive(Description):
    """What turns the crankshaft."""

    speed: Annotated[float, positive(SPEED)] | None = Field(
        None, description="Speed of the crankshaft that the machine is designed for."
    )
    motor: AnyMotor | None = Field(None, description="The motor.")
    gearbox: Gearbox = Field(default_factory=Gearbox, description="Gears between motor and crankshaft.")
    coupling: Coupling | None = Field(None, description="Coupling at the motor shaft.")
    flywheel: Flywheel | None = Field(None, description="Flywheel.")
    brake: Brake | None = Field(None, description="Brake.")
