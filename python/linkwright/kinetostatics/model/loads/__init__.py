"""Loads: forces and torques of the work, of friction, of weight, of springs.

| kind | on | is | module |
| --- | --- | --- | --- |
| `dry` | point or link | `force` or `torque` of constant size against the motion | `friction` |
| `viscous` | point or link | `damping` or `damping_torsional` times the speed, against it | `friction` |
| `force` | moving point | a force of fixed direction, or one that turns with a link | `force` |
| `torque` | link | a torque, counter-clockwise | `force` |
| `gravity` | all bodies | their weight | `force` |
| `spring` | two points | `stiffness` times the stretch, or a curve over the length | `between` |
| `damper` | two points | `damping` times the speed of parting, or a curve over it | `between` |
| `gas_spring` | two points | a push by the law of a gas | `between` |
| `torsional_spring` | link, against another | `stiffness` times the turning from the free angle | `between` |
| `torsional_damper` | link, against another | `damping_torsional` times the relative speed | `between` |
| `force_position` | slider | a force against the motion, by position, forward and return | `table` |
| `torque_angle` | crankshaft | a resisting torque by crank angle | `table` |
| `torque_speed` | crankshaft | a resisting torque by its speed | `table` |
| `formula` | point or link | a force or torque by a formula | `formula` |

The name of a crank means its pin for `force` and `damping`, its link for `torque` and `damping_torsional`.
`references` holds loads against the names of the mechanism.
"""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from linkwright.kinetostatics.model.loads.base import Load
from linkwright.kinetostatics.model.loads.between import (
    BetweenPoints,
    Damper,
    GasSpring,
    Spring,
    TorsionalDamper,
    TorsionalSpring,
)
from linkwright.kinetostatics.model.loads.force import ConstantForce, ConstantTorque, Gravity
from linkwright.kinetostatics.model.loads.formula import FormulaLoad
from linkwright.kinetostatics.model.loads.friction import DryFriction, ViscousFriction
from linkwright.kinetostatics.model.loads.table import ForcePosition, TorqueAngle, TorqueSpeed

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
    | TorqueAngle
    | TorqueSpeed
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
    "ForcePosition",
    "FormulaLoad",
    "GasSpring",
    "Gravity",
    "Load",
    "Spring",
    "TorqueAngle",
    "TorqueSpeed",
    "TorsionalDamper",
    "TorsionalSpring",
    "ViscousFriction",
]
