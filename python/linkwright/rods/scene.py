"""A rod string under its polished rod, as the moving drawing shows it.

Displacements are to the scale of the unit, the depth is shortened; colours are stresses of the rods.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import LinkwrightError
from linkwright.machine.machine import Machine
from linkwright.pumping.model.unit import ROD
from linkwright.rods.along import along_rods
from linkwright.rods.check import no_motion
from linkwright.rods.diagnosis import CardDiagnosis
from linkwright.rods.model.rod_string import RodString
from linkwright.rods.prediction import RodStringMotion, rod_string

# Pieces of the string that are drawn, and instants of a stroke without a unit.
_PIECES, _INSTANTS = 12, 180

# Depth as it is drawn, over the stroke; room of the plunger in its barrel, and width of the well, over it.
_DEPTH, _ROOM, _WIDTH = 2.0, 0.15, 0.3

# Stress over the highest that is no compression, but the samples of a load that falls at once.
_ROUNDING = 1e-4


def string_shown(machine: Machine) -> RodStringMotion | None:
    """The motion of a machine's rod string for its drawing; None where there is none."""
    if machine.rod_string is None or no_motion(machine) is not None:
        return None
    try:
        return rod_string(machine)
    except LinkwrightError:
        # silent: it is a finding of the analysis, and the unit is drawn without its string
        return None


def with_string(scene: dict[str, Any], string: RodString, motion: RodStringMotion) -> dict[str, Any]:
    """The scene of a pumping unit with the string below its polished rod."""
    assert motion.crank_angle is not None
    return _added(scene, string, motion, np.asarray(motion.crank_angle), scene["angles"])


def string_scene(string: RodString, result: RodStringMotion | CardDiagnosis) -> dict[str, Any]:
    """The scene of a string without a unit, or of one whose card was measured."""
    angles = np.linspace(0.0, 2 * np.pi, _INSTANTS + 1)
    own = 2 * np.pi * result.time / result.period
    rise = np.interp(angles, own, result.rod_position, period=2 * np.pi)
    hanger = np.stack([np.zeros_like(rise), rise], axis=-1)
    scene = {
        "angles": angles,
        "times": angles / (2 * np.pi) * result.period,
        "speeds": np.full_like(angles, 2 * np.pi / result.period),
        "points": {ROD: hanger},
        "headings": {},
        "parts": [{"kind": "point", "name": ROD, "slides": False, "series": 0}],
        "box": [0.0, 0.0, 0.0, float(rise.max())],
        "swings": False,
        "true_speed": True,
        "motion": None,
    }
    return _added(scene, string, result, own, angles)


def _added(
    scene: dict[str, Any],
    string: RodString,
    result: RodStringMotion | CardDiagnosis,
    own: Floats,
    angles: Floats,
) -> dict[str, Any]:
    """A scene with the string; `own`: angles of the samples of the result, `angles`: those of the scene."""
    along, hanger = along_rods(string, result, _PIECES), scene["points"][ROD]
    order = np.argsort(own % (2 * np.pi))

    def at(values: Floats) -> Floats:
        turn = np.asarray(own % (2 * np.pi))[order]
        return np.array([np.interp(angles, turn, row[order], period=2 * np.pi) for row in values])

    rises = at(along.position)
    stroke, foot = float(np.ptp(hanger[:, 1])), float(hanger[:, 1].min())
    moved = rises - rises[0].min()
    # Longer rods by what they stretch: no rod passes the one below.
    drawn = _DEPTH * stroke + float(np.abs(rises - rises[0]).max())
    heights = foot + moved - (drawn / along.depth[-1] * along.depth)[:, None]
    heights[0] = hanger[:, 1]
    low, high = float(along.stress.min()), float(along.stress.max())
    # Rods bear no compression, but for rounding.
    low = low if low < -_ROUNDING * high else 0.0
    room, x = _ROOM * stroke, float(hanger[0, 0])
    barrel = [float(heights[-1].min()) - room, float(heights[-1].max()) + room]
    diameters = string.columns.area**0.5
    part = {
        "kind": "rods",
        "name": "rod string",
        "x": x,
        "half": 0.5 * _WIDTH * stroke,
        "top": foot - room,
        "barrel": barrel,
        "range": [low, high],
        "wide": (diameters / diameters.max())[along.section].tolist(),
    }
    box = scene["box"]
    return scene | {
        "parts": [part, *scene["parts"]],
        "rods": {"heights": heights, "shares": (at(along.stress) - low) / (high - low)},
        "box": [
            min(box[0], x - _WIDTH * stroke),
            min(box[1], barrel[0]),
            max(box[2], x + 2 * _WIDTH * stroke),
            box[3],
        ],
    }
