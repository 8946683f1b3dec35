"""Pendulum tests of a rod: how fast it swings on a knife edge in its heads."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, Description, fault
from linkwright.kernel.units import ACCELERATION, LENGTH, TIME, not_negative, positive
from linkwright.linkages.model.element import PositiveNumber
from linkwright.torsion.model.engine.pendulum import FREE_FALL, pendulum_length, swing_period


class Swings(CheckedDescription):
    """How fast a rod swings in one of its heads."""

    swings_per_minute: PositiveNumber | None = Field(
        None, description="Single swings per minute, from one side to the other."
    )
    period: Annotated[float, positive(TIME)] | None = Field(
        None, description="Of a full swing back and forth, in place of the swings per minute."
    )
    edge: Annotated[float, not_negative(LENGTH)] = Field(
        0.0,
        description="Of the knife edge beyond the axis of the head, seen from the centre of mass: the radius "
        "of the bore in which the rod hangs.",
    )
    gravity: Annotated[float, positive(ACCELERATION)] = Field(
        FREE_FALL, description="Acceleration of free fall at the place of the test."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        if (self.swings_per_minute is None) == (self.period is None):
            found = "neither" if self.period is None else "both"
            yield fault(found=found, expected="either swings_per_minute or period")

    @property
    def given(self) -> tuple[str, float]:
        """Key and value of what was measured."""
        if self.period is not None:
            return "period", self.period
        assert self.swings_per_minute is not None
        return "swings_per_minute", self.swings_per_minute

    @property
    def length(self) -> float:
        """A of the thread pendulum that swings as fast [m]."""
        key, value = self.given
        return pendulum_length(value if key == "period" else swing_period(value), self.gravity)


class Swing(Swings):
    """A test in one head; the centre of mass is found by weighing or balancing."""

    about: Literal["small_end", "big_end"] = Field(
        "small_end", description="The head in which the rod hangs."
    )


class TwoPointSwing(Description):
    """A test in both heads one after the other, which finds the centre of mass as well."""

    big_end: Swings = Field(description="Hanging in the big end.")
    small_end: Swings = Field(description="Hanging in the small end.")
