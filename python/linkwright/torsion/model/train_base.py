"""Quantities that several parts of a train have."""

from __future__ import annotations

from typing import Annotated

from linkwright.kernel.units.kinds import RATIO, SPEED, TORQUE, TORSIONAL_DAMPING, TORSIONAL_STIFFNESS
from linkwright.kernel.units.marks import not_negative, positive

PositiveStiffness = Annotated[float, positive(TORSIONAL_STIFFNESS)]
PositiveTorque = Annotated[float, positive(TORQUE)]
PositiveSpeed = Annotated[float, positive(SPEED)]
Damping = Annotated[float, not_negative(TORSIONAL_DAMPING)]
LossFactor = Annotated[float, not_negative(RATIO)]

# The end of a shaft that is held.
GROUND = "ground"
