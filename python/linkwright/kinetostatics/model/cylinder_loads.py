"""What a cylinder does to the two points that it joins, as loads like any other.

| entry | load |
| --- | --- |
| `pressure`, `pressure_rod` | a constant push p₁A₁ − p₂A₂ between the points |
| `stiffness`, `free_length`, `preload` | a spring between the points |
| `damping` | a damper between the points |
| `friction` | dry friction of the rod in the barrel |
"""

from __future__ import annotations

from typing import Any

from linkwright.kernel.numerics.tangent import moves
from linkwright.kinetostatics.model.loads.between import Damper, Spring
from linkwright.kinetostatics.model.loads.force import DryFriction
from linkwright.linkages.model.cylinder import Cylinder


def cylinder_loads(name: str, cylinder: Cylinder) -> dict[str, Any]:
    """Loads of a cylinder by name, unchecked: their numbers may be arrays, or carry derivatives."""
    loads, between = dict[str, Any](), (cylinder.start, cylinder.end)
    if cylinder.pressure is not None or cylinder.pressure_rod is not None:
        # A spring without stiffness pushes with the same force at any length.
        push = push_of(cylinder, cylinder.pressure or 0.0, cylinder.pressure_rod or 0.0)
        loads[f"{name}.pressure"] = _spring(between, 0.0, 0.0, -push)
    if cylinder.stiffness is not None or moves(cylinder.preload):
        stiffness, free = cylinder.stiffness or 0.0, cylinder.free_length or 0.0
        loads[f"{name}.spring"] = _spring(between, stiffness, free, cylinder.preload)
    if cylinder.damping is not None:
        loads[f"{name}.damper"] = Damper.model_construct(
            kind="damper", between=between, damping=cylinder.damping, velocity=None, force=None
        )
    if moves(cylinder.friction):
        loads[f"{name}.friction"] = DryFriction.model_construct(
            kind="dry", on=name, force=cylinder.friction, torque=None
        )
    return loads


def push_of(cylinder: Cylinder, bore_side: Any, rod_side: Any) -> Any:
    """Force of the pressures of both chambers on the rod, positive outwards [N]."""
    assert cylinder.areas is not None
    return bore_side * cylinder.areas[0] - rod_side * cylinder.areas[1]


def _spring(between: tuple[str, str], stiffness: Any, free_length: Any, preload: Any) -> Spring:
    return Spring.model_construct(
        kind="spring",
        between=between,
        stiffness=stiffness,
        free_length=free_length,
        preload=preload,
        length=None,
        force=None,
    )
