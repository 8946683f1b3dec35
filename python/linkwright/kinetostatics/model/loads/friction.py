"""Resistances: dry and viscous friction on a point, a slider or a link."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.units import DAMPING, FORCE, TORQUE, TORSIONAL_DAMPING, not_negative
from linkwright.kinetostatics.model.loads.base import Load, one_of


class DryFriction(Load):
    """Resistance of constant size that always opposes the motion."""

    kind: Literal["dry"]
    on: str = Field(description="Moving point, slider or link that it acts on.")
    force: Annotated[float, not_negative(FORCE)] | None = Field(None, description="On a point or a slider.")
    torque: Annotated[float, not_negative(TORQUE)] | None = Field(None, description="On a link.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        return one_of(self, "force", "torque")


class ViscousFriction(Load):
    """Resistance in proportion to the speed, against the motion."""

    kind: Literal["viscous"]
    on: str = Field(description="Moving point, slider or link that it acts on.")
    damping: Annotated[float, not_negative(DAMPING)] | None = Field(
        None, description="Force per velocity, on a point or a slider."
    )
    damping_torsional: Annotated[float, not_negative(TORSIONAL_DAMPING)] | None = Field(
        None, description="Torque per angular speed, on a link."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        return one_of(self, "damping", "damping_torsional")
