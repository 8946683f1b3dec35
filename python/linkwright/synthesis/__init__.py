"""Synthesis: from what a linkage shall do to its lengths, as a machine verified by analysis.

| module | |
| --- | --- |
| `commands/` | ``linkwright synthesise`` |
| `dead_centre` | Dead-centre design |
| `expression` | A function y(x) given as text, read as an expression and nothing else |
| `four_bar` | A four-bar linkage in the plane of complex numbers: what its lengths say without moving it |
| `freudenstein` | Freudenstein's equation |
| `function_fit` | The linkages that come nearest to more points of a function than a four-bar can meet |
| `function_refine` | Least squares of the structural error itself, for many linkages of a function at once |
| `function_generator` | Function generation |
| `function_scale` | A function y(x) on the scales of crank and rocker |
| `line_kinds` | Straight-line linkages in unit size |
| `path` | Path generation: a four-bar linkage whose coupler point passes given points as its crank turns |
| `path_model` | Path generation as numbers |
| `path_refine` | Least squares on many linkages of a path at once, by the method of Levenberg and Marquardt |
| `path_starts` | Where the search for a path begins |
| `pose` | Motion generation: a linkage whose coupler passes through two or three given poses |
| `slider_pose` | Points of a body that stay on a straight line through three poses |
| `straight_line` | Straight lines from a catalogue |
| `stroke` | Dead-centre design of a slider-crank |
| `task` | What a linkage shall do, as a file says it |
| `transmission` | The transmission angle that a linkage should keep, and what to say where it does not |
| `travel` | Whether a linkage can be driven through given crank angles, one after another |
| `turning_shape` | Shapes of four-bar linkages whose crank turns round, as three numbers without bounds |
| `verify` | What a synthesis returns is analysed again, and must be what was asked for |
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

# The tasks, which a user writes; they are imported when they are used.
__all__ = ["Box", "FunctionTask", "MovingPoint", "PathTask", "PoseTask", "Poses"]


def __getattr__(name: str) -> Any:
    """A task by its name."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module("linkwright.synthesis.task"), name)


if TYPE_CHECKING:
    from linkwright.synthesis.task import Box as Box
    from linkwright.synthesis.task import FunctionTask as FunctionTask
    from linkwright.synthesis.task import MovingPoint as MovingPoint
    from linkwright.synthesis.task import PathTask as PathTask
    from linkwright.synthesis.task import Poses as Poses
    from linkwright.synthesis.task import PoseTask as PoseTask
