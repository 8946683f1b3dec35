"""Springs and dampers: between two points, and between two links or a link and the frame."""

from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import fault
from linkwright.kernel.description.curve import curve_faults
from linkwright.kernel.units.kinds import (
    DAMPING,
    FORCE,
    LENGTH,
    RATIO,
    STIFFNESS,
    TORSIONAL_DAMPING,
    TORSIONAL_STIFFNESS,
)
from linkwright.kernel.units.marks import (
    Angle,
    Bound,
    Force,
    Forces,
    Lengths,
    Quantity,
    Velocities,
    not_negative,
    positive,
)
from linkwright.kinetostatics.model.loads.force import Load, number_or_curve

_ABOVE_ONE = Bound(" above 1,", {"exclusiveMinimum": 1}, lambda value: value > 1)
_FROM_ONE = Bound(" of 1 or more,", {"minimum": 1}, lambda value: value >= 1)


class BetweenPoints(Load):
    """A load that pulls or pushes two points along the line between them."""

    between: tuple[str, str] = Field(description="The two points that it connects.")


class Spring(BetweenPoints):
    """A spring between two points, linear or by a curve of its force over its length."""

    kind: Literal["spring"]
    stiffness: Annotated[float, not_negative(STIFFNESS)] | None = Field(
        None, description="Spring rate: force per extension."
    )
    free_length: Annotated[float, not_negative(LENGTH)] | None = Field(
        None, description="Free length, at which only the preload acts."
    )
    preload: Force = Field(0.0, description="Preload: tension at the free length.")
    length: Lengths | None = Field(None, description="Lengths of a spring curve, increasing.")
    force: Forces | None = Field(None, description="Tension at each length.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from number_or_curve(self, "stiffness", "length", "force")
        if self.stiffness is not None and self.free_length is None:
            yield fault("free_length", expected="a length of 0 or more, which a stiffness counts from")
        if self.length is not None and self.force is not None:
            yield from curve_faults(self, "length", ("force",))
            for key in ("free_length", "preload"):
                if key in self.model_fields_set:
                    expected = "nothing beside length and force, which say it all"
                    yield fault(key, found=getattr(self, key), expected=expected)


class Damper(BetweenPoints):
    """A damper between two points, linear or by a curve of its force over the speed at which they part."""

    kind: Literal["damper"]
    damping: Annotated[float, not_negative(DAMPING)] | None = Field(
        None, description="Damping coefficient: force per velocity."
    )
    velocity: Velocities | None = Field(
        None,
        description="Velocities of a damper curve, increasing; negative while the points approach "
        "each other.",
    )
    force: Forces | None = Field(None, description="Force at each velocity, positive against separation.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from number_or_curve(self, "damping", "velocity", "force")
        if self.velocity is not None and self.force is not None:
            yield from curve_faults(self, "velocity", ("force",))


class GasSpring(BetweenPoints):
    """A gas spring: pushes two points apart, the more the further it is pressed in."""

    kind: Literal["gas_spring"]
    force_extended: Annotated[float, positive(FORCE)] = Field(
        description="Compressive force at the extended length."
    )
    length_extended: Annotated[float, positive(LENGTH)] = Field(description="Extended length.")
    length_compressed: Annotated[float, positive(LENGTH)] = Field(description="Compressed length.")
    progression: Annotated[float, Quantity(RATIO, _ABOVE_ONE)] = Field(
        description="Force at the compressed length over force at the extended length."
    )
    exponent: Annotated[float, Quantity(RATIO, _FROM_ONE)] = Field(
        1.2, description="Polytropic exponent: 1 for slow (isothermal), 1.4 for fast (adiabatic) motion."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.length_compressed >= self.length_extended:
            expected = f"less than length_extended, {self.length_extended:.6g} m"
            yield fault("length_compressed", found=self.length_compressed, expected=expected)


class TorsionalSpring(Load):
    """A torque in proportion to the turning of a link from its free angle."""

    kind: Literal["torsional_spring"]
    on: str = Field(description="Link on which it acts.")
    against: str | None = Field(
        None, description="Link to which the other end is attached. Default: the frame."
    )
    stiffness: Annotated[float, not_negative(TORSIONAL_STIFFNESS)] = Field(
        description="Torsional stiffness: torque per angle."
    )
    free_angle: Angle = Field(
        0.0, description="Angle of zero torque, measured from the other link or from the x axis."
    )


class TorsionalDamper(Load):
    """A torque against the speed of a link relative to another, in proportion to it."""

    kind: Literal["torsional_damper"]
    on: str = Field(description="Link on which it acts.")
    against: str | None = Field(
        None, description="Link to which the other end is attached. Default: the frame."
    )
    damping_torsional: Annotated[float, not_negative(TORSIONAL_DAMPING)] = Field(
        description="Torsional damping coefficient: torque per angular velocity."
    )
