"""Forces and torques of constant size, and weight."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import Field

from linkwright.kernel.units import ACCELERATION, Angle, Force, Torque, not_negative
from linkwright.kinetostatics.model.loads.base import Load


class ConstantForce(Load):
    """A force of constant size, fixed in direction or turning with a link."""

    kind: Literal["force"]
    on: str = Field(description="Moving point or slider that it acts on.")
    force: Force = Field(description="Its size.")
    direction: Angle = Field(0.0, description="Its direction, from the x axis, or from the link `along`.")
    along: str | None = Field(None, description="Link that it turns with. Default: it keeps its direction.")


class ConstantTorque(Load):
    """A torque of constant size."""

    kind: Literal["torque"]
    on: str = Field(description="Link that it acts on.")
    torque: Torque = Field(description="Counter-clockwise.")


class Gravity(Load):
    """The weight of all bodies."""

    kind: Literal["gravity"]
    acceleration: Annotated[float, not_negative(ACCELERATION)] = Field(
        9.81, description="Acceleration of free fall."
    )
    direction: Angle = Field(-math.pi / 2, description="Direction of gravity, from the x axis.")
