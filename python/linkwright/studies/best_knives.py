"""The best knife of a topper as a study: shortest edge, or fastest along the row, within `[topper.limits]`.

`linkwright.topping.best` knows that the draw-cut ratio does not depend on the length, and that one pass gives
the minimum length; the study has the same variables, limits and goal, for
`optimise`, and takes further ones.
"""

from __future__ import annotations

from typing import Any, Literal

import numpy as np

from linkwright.machine.machine import Machine
from linkwright.studies.axes import between
from linkwright.studies.knives import Knob, knob_of, with_field
from linkwright.studies.plan import StudyPlan
from linkwright.studies.read import new_study
from linkwright.topping.best.knife_search import knife_bounds
from linkwright.topping.edge import require_topper
from linkwright.topping.model.topper import Topper
from linkwright.topping.roots import draw_roots

# The longest edge of a study over the longest that a knife at rest needs, without a limit; the shortest over
# the longest.
_LONGER, _SHORTER = 2.0, 0.01


def best_knife_study(
    machine: Machine, *, objective: Literal["shortest", "fastest"] = "shortest", seed: int | None = None
) -> StudyPlan:
    """A study of the best knife within its limits, for `optimise`.

    The shortest edge at the forward speed of the file; or the maximum forward speed, with an edge of at most
    ``length_max``, without it that of the file. `seed` replaces that of the field.
    """
    fitted = with_field(machine, seed, needed=False)
    topper = require_topper(fitted)
    limits, is_fastest = topper.limits, objective == "fastest"
    low, high = knife_bounds(topper)
    knob = knob_of(fitted, "knife_speed")
    variables: dict[str, Any] = {
        "edge_angle": _between("topper.edge_angle", low[0], high[0]),
        knob.variable: _speeds(knob, low[1], high[1]),
    }
    longest = limits.length_max or (topper.edge_length if is_fastest else _longest(topper))
    variables["edge_length"] = _between("topper.edge_length", _SHORTER * longest, longest)
    responses: dict[str, Any] = {"length": {"formula": "edge_length"}}
    if is_fastest:
        speeds = (limits.forward_speed_min, limits.forward_speed_max)
        variables["forward_speed"] = _between("topper.forward_speed", *speeds)
        responses = {"speed": {"formula": "forward_speed"}}
    if knob.variable != "knife_speed":
        responses["knife_speed"] = {"formula": knob.formula}
    responses |= {
        "share_complete": "topper_field.share_complete",
        "haulm_mean": "topper_field.haulm_mean",
        "slicing_ratio_mean": "topper_field.slicing_ratio_mean",
        "least_advance": "topper.least_advance",
    }
    kept: dict[str, Any] = {"share_complete": {"min": limits.complete_min}, "least_advance": {"min": 0.0}}
    if limits.haulm_max is not None:
        kept["haulm_mean"] = {"max": limits.haulm_max}
    if limits.slicing_min is not None:
        kept["slicing_ratio_mean"] = {"min": limits.slicing_min}
    tables = {
        "variables": variables,
        "responses": responses,
        "constraints": kept,
        "goals": {"speed": "maximise"} if is_fastest else {"length": "minimise"},
    }
    return new_study(fitted, tables)


def _speeds(knob: Knob, low: float, high: float) -> dict[str, Any]:
    ends = knob.values(np.array([low, high])).tolist()
    return _between(knob.address, ends[0], ends[1])


def _between(address: str, low: float, high: float) -> dict[str, Any]:
    return {"address": address, **between(float(low), float(high))}


def _longest(topper: Topper) -> float:
    """An edge that is longer than any that the roots need [m]."""
    roots = draw_roots(topper)
    width = float(roots.diameter.max()) + 2 * float(np.abs(roots.offset).max())
    steepest = max(abs(topper.limits.angle_min), abs(topper.limits.angle_max))
    return _LONGER * width / float(np.cos(steepest))
