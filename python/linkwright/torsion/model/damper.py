"""A torsional damper: a ring that turns with a disc, held by a fluid or by rubber.

References
----------
.. [1] Den Hartog, Mechanical Vibrations, 4th ed. 1956, sections 3.3 and 5.6: dampers with and without spring.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, fault
from linkwright.kernel.units import INERTIA, POWER, positive
from linkwright.torsion.model.train_base import Damping, LossFactor, PositiveStiffness


class Damper(CheckedDescription):
    """A damper on a disc: viscous (Lanchester, Houde), or tuned by a spring or rubber."""

    on: str = Field(description="The disc that it sits on; its housing counts with the disc.")
    kind: Literal["viscous", "tuned"] = Field("viscous", description="Without or with a spring.")
    ring_inertia: Annotated[float, positive(INERTIA)] = Field(description="Of the ring, about the axis.")
    damping: Damping = Field(0.0, description="Torque per speed between ring and disc.")
    stiffness: PositiveStiffness | None = Field(None, description="Of the spring, of a tuned damper.")
    loss_factor: LossFactor = Field(0.0, description="Hysteresis of the spring, of a tuned damper.")
    heat_permitted: Annotated[float, positive(POWER)] | None = Field(
        None, description="Heat that it can give off."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.kind == "tuned" and self.stiffness is None:
            yield fault("stiffness", expected="the stiffness of the spring of a tuned damper")
        if self.kind == "viscous":
            if self.stiffness is not None or self.loss_factor:
                remedy = 'make it kind = "tuned", or leave it out'
                name = "stiffness" if self.stiffness is not None else "loss_factor"
                yield fault(
                    name, found=getattr(self, name), expected="no spring in a viscous damper", remedy=remedy
                )
            if not self.damping:
                found = self.damping if "damping" in self.model_fields_set else None
                yield fault("damping", found=found, expected="the damping of a viscous damper, above 0")
