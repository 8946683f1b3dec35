"""What a load by a formula does: the formula at all crank angles, and where its force acts."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.description.formula import NUMBERS, parse
from linkwright.kernel.errors import FindingError
from linkwright.kernel.numerics.formula_value import value
from linkwright.kinetostatics.model.loads.formula import FormulaLoad
from linkwright.kinetostatics.places import Scene, unit
from linkwright.kinetostatics.wrench import Wrenches

Floats = NDArray[np.float64]


def formula_wrenches(scene: Scene, load: FormulaLoad) -> Wrenches:
    """What a load by a formula does. Raises FindingError: the formula has no value at some crank angle."""
    with np.errstate(all="ignore"):
        found = value(parse(load.text), _names(scene, load)) * np.ones(scene.n)
    if not np.isfinite(found).all():
        at = np.degrees(scene.motion.crank_angle[int(np.argmin(np.isfinite(found)))])
        raise FindingError(f'the formula "{load.text}" on {load.on} has no value at crank angle {at:.4g}°')
    if load.torque is not None:
        return Wrenches(scene).couple(load.on, found)
    if load.direction is None and load.along is None:
        return Wrenches(scene).along_slide(load.on, found)
    direction = unit(scene.angle(load.along) + (load.direction or 0.0))
    return Wrenches(scene).at_point(load.on, found[:, None] * direction)


def _names(scene: Scene, load: FormulaLoad) -> dict[str, Any]:
    """Variables and constants of a formula (docs/loads.md)."""
    motion = scene.motion
    turn = 2 * np.pi
    names: dict[str, Any] = {
        **NUMBERS,
        "phi": motion.crank_angle % turn,
        "omega": motion.speed,
        "t": motion.time,
    }
    link = load.on if load.torque is not None else load.along
    if link is not None:
        psi = scene.angle(link)
        names |= {"psi": np.arctan2(np.sin(psi), np.cos(psi)), "psi_dot": scene.angle(link, 1) * motion.speed}
    if load.torque is None:
        place, velocity = scene.point(load.on), scene.point(load.on, 1) * motion.speed[:, None]
        names |= {"x": place[:, 0], "y": place[:, 1], "vx": velocity[:, 0], "vy": velocity[:, 1]}
        names["v"] = np.hypot(velocity[:, 0], velocity[:, 1])
        if load.direction is None and load.along is None:
            slide = scene.kinematics.slides[load.on]
            names |= {"s": slide.position, "v": slide.d1 * motion.speed}
    return names | dict(load.constants)
