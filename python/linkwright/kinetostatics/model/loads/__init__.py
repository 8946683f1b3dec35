"""Loads: forces and torques of the work, of friction, of weight, of springs.

The name of a crank means its pin for `force` and `damping`, its link for `torque` and `damping_torsional`.
`references` holds loads against the names of the mechanism.

| module | |
| --- | --- |
| `between` | Springs and dampers: between two points, and between two links or a link and the frame |
| `force` | What all loads have in common; constant forces, weight, friction, formulas on a point or link |
| `references` | What is wrong between the loads and the mechanism |
| `table` | Loads by tables: over position, over the angle of a link, over crank angle or speed |
"""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from linkwright.kinetostatics.model.loads.between import (
    BetweenPoints,
    Damper,
    GasSpring,
    Spring,
    TorsionalDamper,
    TorsionalSpring,
)
from linkwright.kinetostatics.model.loads.force import (
    ConstantForce,
    ConstantTorque,
    DryFriction,
    FormulaLoad,
    Gravity,
    Load,
    ViscousFriction,
)
from linkwright.kinetostatics.model.loads.table import (
    ForceAngle,
    ForcePosition,
    OverCrankAngle,
    TorqueAngle,
    TorqueSpeed,
    TorqueSwing,
)

AnyLoad = Annotated[
    DryFriction
    | ViscousFriction
    | ConstantForce
    | ConstantTorque
    | Gravity
    | Spring
    | Damper
    | GasSpring
    | TorsionalSpring
    | TorsionalDamper
    | ForcePosition
    | ForceAngle
    | TorqueAngle
    | TorqueSpeed
    | TorqueSwing
    | FormulaLoad,
    Field(discriminator="kind"),
]

__all__ = [
    "AnyLoad",
    "BetweenPoints",
    "ConstantForce",
    "ConstantTorque",
    "Damper",
    "DryFriction",
    "ForceAngle",
    "ForcePosition",
    "FormulaLoad",
    "GasSpring",
    "Gravity",
    "Load",
    "OverCrankAngle",
    "Spring",
    "TorqueAngle",
    "TorqueSpeed",
    "TorqueSwing",
    "TorsionalDamper",
    "TorsionalSpring",
    "ViscousFriction",
]
