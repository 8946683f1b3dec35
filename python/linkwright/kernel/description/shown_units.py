"""Units in which tables, figures and CSV of a machine show its numbers: the table ``[units]`` of its file."""

from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import Field
from pydantic_core import CoreSchema, core_schema

from linkwright.kernel.description.base import Description, wrong
from linkwright.kernel.errors import show
from linkwright.kernel.units.kinds import (
    ACCELERATION,
    ANGLE,
    ANGULAR_ACCELERATION,
    ENERGY,
    FORCE,
    FREQUENCY,
    INERTIA,
    LENGTH,
    MASS,
    POWER,
    PRESSURE,
    SPEED,
    STIFFNESS,
    TIME,
    TORQUE,
    TORSIONAL_STIFFNESS,
    VELOCITY,
    Kind,
)
from linkwright.kernel.units.spellings import factor_of, fits, is_energy, other_quantity, unknown


@dataclass(frozen=True, slots=True)
class UnitOf:
    """Mark of a field that holds the unit of a quantity, as a text."""

    kind: Kind

    def read(self, value: str) -> str:
        """A unit that measures the quantity, for pydantic."""
        known = factor_of(value)
        expected = f'a unit of {self.kind.noun}, such as "{self.kind.unit}"'
        if known is None:
            raise wrong(show(value), expected, unknown(value))
        if not fits(known[1], self.kind):
            raise wrong(show(value), expected, other_quantity(value, known[1], self.kind))
        # Torques and energies have one dimension.
        if self.kind in (TORQUE, ENERGY) and is_energy(value) != (self.kind is ENERGY):
            other = TORQUE if self.kind is ENERGY else ENERGY
            raise wrong(show(value), expected, f"{show(value)} is a unit of {other.noun}")
        return value

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> CoreSchema:
        text = core_schema.no_info_after_validator_function(self.read, core_schema.str_schema())
        return core_schema.nullable_schema(text)


class ShownUnits(Description):
    """Units of what is printed, drawn and written as CSV; JSON is always SI."""

    length: Annotated[str | None, UnitOf(LENGTH)] = Field(
        None,
        description="Unit of lengths; also of velocities and accelerations, unless given.",
    )
    angle: Annotated[str | None, UnitOf(ANGLE)] = Field(None, description="Unit of angles. Default: degrees.")
    mass: Annotated[str | None, UnitOf(MASS)] = Field(None, description="Unit of masses.")
    time: Annotated[str | None, UnitOf(TIME)] = Field(None, description="Unit of times.")
    speed: Annotated[str | None, UnitOf(SPEED)] = Field(None, description="Unit of angular speeds.")
    angular_acceleration: Annotated[str | None, UnitOf(ANGULAR_ACCELERATION)] = Field(
        None, description="Unit of angular accelerations."
    )
    velocity: Annotated[str | None, UnitOf(VELOCITY)] = Field(None, description="Unit of velocities.")
    acceleration: Annotated[str | None, UnitOf(ACCELERATION)] = Field(
        None, description="Unit of accelerations."
    )
    force: Annotated[str | None, UnitOf(FORCE)] = Field(None, description="Unit of forces.")
    torque: Annotated[str | None, UnitOf(TORQUE)] = Field(None, description="Unit of torques.")
    energy: Annotated[str | None, UnitOf(ENERGY)] = Field(None, description="Unit of energy and work.")
    power: Annotated[str | None, UnitOf(POWER)] = Field(None, description="Unit of power.")
    inertia: Annotated[str | None, UnitOf(INERTIA)] = Field(None, description="Unit of moments of inertia.")
    pressure: Annotated[str | None, UnitOf(PRESSURE)] = Field(
        None, description="Unit of pressures and stresses."
    )
    stiffness: Annotated[str | None, UnitOf(STIFFNESS)] = Field(
        None, description="Unit of spring stiffnesses."
    )
    torsional_stiffness: Annotated[str | None, UnitOf(TORSIONAL_STIFFNESS)] = Field(
        None, description="Unit of torsional stiffnesses."
    )
    frequency: Annotated[str | None, UnitOf(FREQUENCY)] = Field(None, description="Unit of frequencies.")
