"""Marks of a description's fields: what a field holds, within which bounds, and how pydantic reads it.

A field marked ``radius: Length`` accepts a bare number (SI) or a text such as ``"200 mm"``, and stores the SI
float. Fields with several values are marked ``Lengths``, ``Torques`` and accept a list of such values, or one
text ``"0, 100, 200 mm"`` with one unit.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from linkwright.kernel.errors import Problem, UnitError, show
from linkwright.kernel.units.kinds import (
    ACCELERATION,
    ANGLE,
    ANGULAR_ACCELERATION,
    DAMPING,
    ENERGY,
    FORCE,
    INERTIA,
    LENGTH,
    MASS,
    MASS_PER_LENGTH,
    POWER,
    PRESSURE,
    RATIO,
    SPEED,
    STIFFNESS,
    TIME,
    TORQUE,
    TORSIONAL_DAMPING,
    TORSIONAL_STIFFNESS,
    VELOCITY,
    VOLUME_FLOW,
    Kind,
    range_words,
)
from linkwright.kernel.units.reading import items, list_words, parse, parse_any

if TYPE_CHECKING:
    from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler


def _reported(problem: Problem, expected: str) -> PydanticCustomError:
    """The same problem in the form that pydantic collects with all others."""
    context = {"found": problem.found, "expected": expected, "remedy": problem.remedy}
    return PydanticCustomError("problem", "found {found}, expected {expected}", context)


@dataclass(frozen=True, slots=True, eq=False)
class Bound:
    """Limits of a quantity: in words, as JSON Schema keywords, and as a test of an SI value."""

    words: str
    schema: Mapping[str, float]
    holds: Callable[[float], bool]


ANY = Bound("", {}, lambda value: True)
POSITIVE = Bound(" greater than 0,", {"exclusiveMinimum": 0}, lambda value: value > 0)
NOT_NEGATIVE = Bound(" of 0 or more,", {"minimum": 0}, lambda value: value >= 0)
SHARE = Bound(" from 0 to 1,", {"minimum": 0, "maximum": 1}, lambda value: 0 <= value <= 1)
FRACTION = Bound(" above 0 and up to 1,", {"exclusiveMinimum": 0, "maximum": 1}, lambda value: 0 < value <= 1)
INSIDE_ONE = Bound(
    " between 0 and 1,", {"exclusiveMinimum": 0, "exclusiveMaximum": 1}, lambda value: 0 < value < 1
)
ACUTE = Bound(
    " between -90 and 90 deg,",
    {"exclusiveMinimum": -math.pi / 2, "exclusiveMaximum": math.pi / 2},
    lambda value: -math.pi / 2 < value < math.pi / 2,
)


@dataclass(frozen=True, slots=True)
class Quantity:
    """Mark of a field that holds one quantity: accepts a number or a text with a unit, stores SI."""

    kind: Kind
    bound: Bound = ANY

    @property
    def expected(self) -> str:
        """What belongs into the field."""
        return f"{self.kind.word}{self.bound.words} {self.kind.forms}"

    def read(self, value: object) -> float:
        """Read one value, for pydantic."""
        try:
            number = parse(value, self.kind)
        except UnitError as error:
            raise _reported(error.problem, self.expected) from None
        if not self.holds(number):
            raise _reported(Problem(found=show(value), remedy=self.remedy(number)), self.expected)
        return 0.0 if self._is_speck(number) else number

    def holds(self, number: float) -> bool:
        """Whether an SI value is such a quantity: finite, within its bound and the range of its kind."""
        in_bound = math.isfinite(number) and self.bound.holds(number)
        return in_bound and abs(number) <= self.kind.most and not self._is_nothing(number)

    def remedy(self, number: float) -> str:
        """The range of the kind, if that is what an SI value is beyond; empty if its bound says it all."""
        if not math.isfinite(number):
            return "the number must be finite"
        beyond = abs(number) > self.kind.most or self._is_nothing(number)
        return range_words(self.kind) if beyond else ""

    def _is_speck(self, number: float) -> bool:
        """Whether a size that cannot be negative is too small to count."""
        return 0 < number < self.kind.least and not self.bound.holds(-number)

    def _is_nothing(self, number: float) -> bool:
        """Whether it is so where zero is no answer either."""
        return self._is_speck(number) and not self.bound.holds(0.0)

    def steps(self) -> CoreSchema:
        """The steps of validation: our reader, then a float."""
        return core_schema.no_info_before_validator_function(self.read, core_schema.float_schema())

    def json_schema(self) -> dict[str, Any]:
        """What an editor may offer for the value."""
        noun, unit = self.kind.noun, self.kind.unit_word
        limits = {"minimum": -self.kind.most, "maximum": self.kind.most, **self.bound.schema}
        number = {"type": "number", "description": f"{noun} in {unit}" if unit else noun, **limits}
        text = {"type": "string", "description": f"{noun} with its unit", "examples": [self.kind.example]}
        return {"anyOf": [number, text]}

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return self.steps()

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        return self.json_schema()


def positive(kind: Kind) -> Quantity:
    """Mark of a field that holds one quantity greater than zero."""
    return Quantity(kind, POSITIVE)


def not_negative(kind: Kind) -> Quantity:
    """Mark of a field that holds one quantity of zero or more."""
    return Quantity(kind, NOT_NEGATIVE)


@dataclass(frozen=True, slots=True)
class QuantityList:
    """Mark of a field that holds several values of one quantity, stored as a tuple of SI floats."""

    kind: Kind

    @property
    def expected(self) -> str:
        """What belongs into the field."""
        return list_words(self.kind)

    def read(self, value: object) -> Sequence[object]:
        """Take a list, or a text with several numbers, apart, for pydantic."""
        try:
            return items(value, self.kind)
        except UnitError as error:
            raise _reported(error.problem, error.problem.expected) from None

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        entries = core_schema.tuple_variable_schema(Quantity(self.kind).steps())
        return core_schema.no_info_before_validator_function(self.read, entries)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        many = {"type": "array", "items": Quantity(self.kind).json_schema()}
        return {
            "anyOf": [
                many,
                {"type": "string", "description": f'several values and one unit: "0, 1 {self.kind.unit}"'},
            ]
        }


@dataclass(frozen=True, slots=True)
class AnyQuantity:
    """Mark of a field that holds a number of whatever quantity: accepts it in any unit, stores SI."""

    @property
    def expected(self) -> str:
        """What belongs into the field."""
        return 'a number, or a text with any unit, such as "200 N/m"'

    def read(self, value: object) -> float:
        """Read one value, for pydantic."""
        try:
            return parse_any(value)
        except UnitError as error:
            raise _reported(error.problem, self.expected) from None

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_before_validator_function(self.read, core_schema.float_schema())

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        text = {"type": "string", "description": "a number with its unit", "examples": ["200 N/m"]}
        return {"anyOf": [{"type": "number", "description": "a number in SI units"}, text]}


Length = Annotated[float, Quantity(LENGTH)]
Angle = Annotated[float, Quantity(ANGLE)]
Mass = Annotated[float, Quantity(MASS)]
Time = Annotated[float, Quantity(TIME)]
Speed = Annotated[float, Quantity(SPEED)]
AngularAcceleration = Annotated[float, Quantity(ANGULAR_ACCELERATION)]
Velocity = Annotated[float, Quantity(VELOCITY)]
Acceleration = Annotated[float, Quantity(ACCELERATION)]
Force = Annotated[float, Quantity(FORCE)]
Torque = Annotated[float, Quantity(TORQUE)]
Energy = Annotated[float, Quantity(ENERGY)]
Power = Annotated[float, Quantity(POWER)]
Inertia = Annotated[float, Quantity(INERTIA)]
MassPerLength = Annotated[float, Quantity(MASS_PER_LENGTH)]
Stiffness = Annotated[float, Quantity(STIFFNESS)]
TorsionalStiffness = Annotated[float, Quantity(TORSIONAL_STIFFNESS)]
Damping = Annotated[float, Quantity(DAMPING)]
TorsionalDamping = Annotated[float, Quantity(TORSIONAL_DAMPING)]
Ratio = Annotated[float, Quantity(RATIO)]

Lengths = Annotated[tuple[float, ...], QuantityList(LENGTH)]
Angles = Annotated[tuple[float, ...], QuantityList(ANGLE)]
Speeds = Annotated[tuple[float, ...], QuantityList(SPEED)]
Velocities = Annotated[tuple[float, ...], QuantityList(VELOCITY)]
Forces = Annotated[tuple[float, ...], QuantityList(FORCE)]
Pressures = Annotated[tuple[float, ...], QuantityList(PRESSURE)]
Torques = Annotated[tuple[float, ...], QuantityList(TORQUE)]
Times = Annotated[tuple[float, ...], QuantityList(TIME)]
Flows = Annotated[tuple[float, ...], QuantityList(VOLUME_FLOW)]
