"""The load on the polished rod of a pumping unit, and what balances it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any, Literal, Self

import numpy as np
from pydantic import BeforeValidator, Field, WithJsonSchema, model_validator
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import Description, fault, raise_faults, wrong
from linkwright.kernel.description.curve import curve_faults
from linkwright.kernel.errors import UnitError, show
from linkwright.kernel.units.kinds import FORCE, RATIO, TORQUE
from linkwright.kernel.units.marks import FRACTION, Angle, Angles, Forces, Quantity, QuantityList
from linkwright.kernel.units.reading import parse

_OPTIMAL = '"optimal", or a torque (N m) such as "20 kN m"'


def _counterbalance(value: object) -> object:
    """The moment of the counterweights: a torque, or the word for the best one."""
    if value is None or value == "optimal":
        return value
    try:
        return parse(value, TORQUE)
    except UnitError:
        raise wrong(show(value), _OPTIMAL) from None


_COUNTERBALANCE_SCHEMA: dict[str, Any] = {
    "anyOf": [
        {"const": "optimal"},
        {"type": "number"},
        {"type": "string", "description": "torque with its unit"},
    ]
}


class PolishedRodLoad(Description):
    """Load on the polished rod over a stroke, and what balances it."""

    angle: Angles | None = Field(
        None, description="Crank angles of the table, increasing, within one revolution."
    )
    force: Forces | None = Field(None, description="Load at each crank angle.")
    position: Annotated[tuple[float, ...], QuantityList(RATIO)] | None = Field(
        None, description="Positions of the rod, increasing, from 0 at the bottom to 1 at the top."
    )
    up: Forces | None = Field(None, description="Load at each position on the upstroke.")
    down: Forces | None = Field(None, description="Load at each position on the downstroke.")
    counterbalance: Annotated[
        Annotated[float, Quantity(TORQUE)] | Literal["optimal"] | None,
        BeforeValidator(_counterbalance),
        WithJsonSchema(_COUNTERBALANCE_SCHEMA),
    ] = Field(
        "optimal",
        description='Maximum moment of the counterweights about the crankshaft, or "optimal" for equal '
        "peak torques in both strokes. With an air cylinder, use counterbalance_effect.",
    )
    phase: Angle = Field(0.0, description="Angle τ by which the counterweights lead the crank.")
    counterbalance_effect: Annotated[float, Quantity(FORCE)] | None = Field(
        None,
        description="Force of an air cylinder at the polished rod. Default: equal peak torques in "
        "both strokes.",
    )
    efficiency: Annotated[float, Quantity(RATIO, FRACTION)] = Field(
        1.0, description="Efficiency of the structure between polished rod and crankshaft."
    )

    @property
    def is_given(self) -> bool:
        """Whether the load is given: that of a rod string is computed."""
        return any(getattr(self, key) is not None for key in ("angle", "force", "position", "up", "down"))

    @model_validator(mode="after")
    def _entries_fit(self) -> Self:
        raise_faults("PolishedRodLoad", self._faults())
        return self

    def _faults(self) -> Iterator[InitErrorDetails]:
        if not self.is_given:
            return
        by_angle = self.angle is not None or self.force is not None
        by_position = any(values is not None for values in (self.position, self.up, self.down))
        if by_angle == by_position:
            found = "both" if by_angle else None
            yield fault(found=found, expected="either angle and force, or position, up and down")
            return
        names = ("angle", "force") if by_angle else ("position", "up", "down")
        missing = [name for name in names if getattr(self, name) is None]
        for name in missing:
            yield fault(name, expected=f"a list; {', '.join(names)} belong together")
        if not missing:
            yield from curve_faults(self, names[0], names[1:])
            yield from _range_faults(self)


def _range_faults(load: PolishedRodLoad) -> Iterator[InitErrorDetails]:
    if load.position and not (load.position[0] >= 0 and load.position[-1] <= 1):
        yield fault("position", found="positions outside the stroke", expected="positions from 0 to 1")
    if load.angle and load.angle[-1] - load.angle[0] > 2 * np.pi * (1 + 1e-9):
        yield fault("angle", found="more than a revolution", expected="angles within one revolution")
