"""Synthesis: from what a linkage shall do to its lengths, as a machine verified by analysis.

| module | |
| --- | --- |
| `commands/` | ``linkwright synthesise`` |
| `dead_centre` | Crank-rocker and slider-crank for swing or stroke and time ratio |
| `expression` | Four-bar for a function y(x) |
| `four_bar` | What the lengths say; whether positions can be reached one after another |
| `freudenstein` | Four-bar for a function y(x) |
| `function_fit` | The same for more points than can be met |
| `function_refine` | The same for more points than can be met |
| `function_generator` | Four-bar for a function y(x) |
| `function_scale` | Four-bar for a function y(x) |
| `line_kinds` | Linkages for straight lines from a catalogue |
| `path` | Four-bar for points of a path, by global search |
| `path_model` | Four-bar for points of a path, by global search |
| `path_refine` | Four-bar for points of a path, by global search |
| `path_starts` | Where the search for a path begins |
| `pose` | Four-bar and slider-crank for two or three poses of the coupler |
| `slider_pose` | Four-bar and slider-crank for two or three poses of the coupler |
| `straight_line` | Linkages for straight lines from a catalogue |
| `stroke` | Crank-rocker and slider-crank for swing or stroke and time ratio |
| `task` | What a linkage shall do, as a file says it |
| `transmission` | The transmission angle that a linkage should keep, and what to say where it does not |
| `travel` | What the lengths say; whether positions can be reached one after another |
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
