"""The extension of a hydraulic cylinder by the flow of its pump, as a motion law.

Where the flow is straight over time the length is a square of it: the law is exact.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.cam.laws.piece import Piece
from linkwright.kernel.numerics.tangent import primal
from linkwright.linkages.model.cylinder import Cylinder


class Lift(NamedTuple):
    """What the travel of a driver follows over the cycle, as a follower does its cam."""

    lift: MotionLaw
    phase: float = 0.0  # crank angle at which it begins [rad]
    advance: float = 0.0  # per cycle [m]


class FlowDrivenCylinder(Cylinder):
    """A cylinder whose extension follows the flow."""

    def follows(self) -> Lift:
        """The law of its extension."""
        return Lift(extension(self))


def flow_driven(cylinder: Cylinder) -> FlowDrivenCylinder:
    """The driver that a cylinder with a flow is, unchecked: its numbers may be arrays."""
    return FlowDrivenCylinder.model_construct(**dict(cylinder))


def extension(cylinder: Cylinder) -> MotionLaw:
    """Extension over the crank angle of a cycle [m]."""
    assert cylinder.areas is not None
    bore, rod = cylinder.areas
    out, back = cylinder.travels()
    # The digits of a file may leave the cycle open; the way back then takes the difference.
    rates = cylinder.cycle / bore, cylinder.cycle / rod * (out / back)
    at: Any = 0.0 * out
    pieces = list[tuple[Any, Piece]]()
    for length, q, r in cylinder.stretches():
        rate = length * rates[0 if primal(q) + primal(r) > 0 else 1]
        pieces.append((2 * math.pi * length, Piece((at, rate * q, 0.5 * rate * (r - q)))))
        at = at + 0.5 * rate * (q + r)
    return MotionLaw.of(0.0, *pieces)
