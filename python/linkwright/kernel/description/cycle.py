"""Cycles of several revolutions: the angle after which a torque or a load repeats."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated

from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import fault
from linkwright.kernel.units.kinds import ANGLE
from linkwright.kernel.units.marks import positive

CycleAngle = Annotated[float, positive(ANGLE)]

# Revolutions that a cycle may take: two of a four-stroke engine, more where several machines share a shaft.
TURNS_MAX = 24

# A cycle given in degrees is a whole number of revolutions to rounding.
_WHOLE = 1e-9

ONE_TURN = 2 * math.pi


def cycle_turns(cycle: float) -> int:
    """Revolutions of a cycle [rad]."""
    return round(cycle / ONE_TURN)


def cycle_faults(cycle: float) -> Iterator[InitErrorDetails]:
    """What is wrong with a cycle [rad] that is not a whole number of revolutions."""
    turns = cycle / ONE_TURN
    if not 1 <= round(turns) <= TURNS_MAX or abs(turns - round(turns)) > _WHOLE * turns:
        expected = f"1 to {TURNS_MAX} whole revolutions, such as 360 deg or 720 deg"
        yield fault("cycle", found=f"{math.degrees(cycle):.6g} deg", expected=expected)
