"""Synthesis: from what a linkage shall do to its lengths, as a machine verified by analysis.

| module | finds |
| --- | --- |
| `pose`, `slider_pose` | four-bar and slider-crank for two or three poses of the coupler |
| `dead_centre`, `stroke` | crank-rocker and slider-crank for swing or stroke and time ratio |
| `function_generator`, `function_scale`, `freudenstein`, `expression` | four-bar for a function y(x) |
| `function_fit`, `function_refine` | the same for more points than can be met |
| `path`, `path_starts`, `path_model`, `path_refine` | four-bar for points of a path, by global search |
| `straight_line`, `line_kinds` | linkages for straight lines from a catalogue |
| `task` | what a linkage shall do, as a file says it |
| `four_bar`, `travel` | what the lengths say; whether positions can be reached one after another |
"""

from linkwright.synthesis.dead_centre import CrankRocker, crank_rocker
from linkwright.synthesis.function_generator import FunctionGenerator, function_generator
from linkwright.synthesis.function_scale import chebyshev_points
from linkwright.synthesis.path import PathGenerator, path_generator
from linkwright.synthesis.pose import PoseGuide, pose_guide
from linkwright.synthesis.straight_line import StraightLine, straight_line, straight_lines
from linkwright.synthesis.stroke import StrokeCrank, slider_crank
from linkwright.synthesis.task import Box, FunctionTask, MovingPoint, PathTask, Poses, PoseTask

__all__ = [
    "Box",
    "CrankRocker",
    "FunctionGenerator",
    "FunctionTask",
    "MovingPoint",
    "PathGenerator",
    "PathTask",
    "PoseGuide",
    "PoseTask",
    "Poses",
    "StraightLine",
    "StrokeCrank",
    "chebyshev_points",
    "crank_rocker",
    "function_generator",
    "path_generator",
    "pose_guide",
    "slider_crank",
    "straight_line",
    "straight_lines",
]
