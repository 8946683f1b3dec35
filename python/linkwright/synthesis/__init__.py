"""Synthesis: from what a linkage shall do to its lengths, as a machine verified by analysis.

| module | |
| --- | --- |
| `commands` | ``linkwright synthesise``: the kinds of synthesis |
| `dead_centre` | Dead-centre design |
| `expression` | A function y(x) given as text, read as an expression and nothing else |
| `four_bar` | A four-bar linkage in the plane of complex numbers: what its lengths say without moving it |
| `freudenstein` | Freudenstein's equation |
| `function_fit` | The linkages that come nearest to more points of a function than a four-bar can meet |
| `function_generator` | Function generation |
| `function_refine` | Least squares of the structural error itself, for many linkages of a function at once |
| `line_kinds` | Straight-line linkages in unit size |
| `path` | Path generation: a four-bar linkage whose coupler point passes given points as its crank turns |
| `path_model` | Path generation as numbers |
| `path_search` | Search for a path: where it begins, and its refinement by Levenberg and Marquardt |
| `pose` | Motion generation: a linkage whose coupler passes through two or three given poses |
| `slider_pose` | Points of a body that stay on a straight line through three poses |
| `straight_line` | Straight lines from a catalogue |
| `stroke` | Dead-centre design of a slider-crank |
| `tables` | What was found of one linkage, and the catalogue of straight-line linkages |
| `task` | What a linkage shall do, as a file says it |
| `verification` | What a synthesis returns, analysed again |
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

# The tasks, which a user writes; they are imported when they are used.
__all__ = ["Box", "FixedPivot", "FunctionTask", "MovingPoint", "PathTask", "PoseTask", "Poses"]


def __getattr__(name: str) -> Any:
    """A task by its name."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module("linkwright.synthesis.task"), name)


if TYPE_CHECKING:
    from linkwright.synthesis.task import Box as Box
    from linkwright.synthesis.task import FixedPivot as FixedPivot
    from linkwright.synthesis.task import FunctionTask as FunctionTask
    from linkwright.synthesis.task import MovingPoint as MovingPoint
    from linkwright.synthesis.task import PathTask as PathTask
    from linkwright.synthesis.task import Poses as Poses
    from linkwright.synthesis.task import PoseTask as PoseTask
