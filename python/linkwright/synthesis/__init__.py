"""Synthesis: from what a linkage shall do to its lengths, as a machine verified by analysis.

| module | finds |
| --- | --- |
| `pose`, `slider_pose` | four-bar and slider-crank for two or three poses of the coupler |
| `dead_centre`, `stroke` | crank-rocker and slider-crank for swing or stroke and time ratio |
| `function_generator`, `function_scale`, `freudenstein`, `expression` | four-bar for a function y(x) |
| `path`, `path_model`, `path_refine`, `evolution` | four-bar for points of a path, by global search |
| `straight_line`, `line_kinds` | linkages for straight lines from a catalogue |
| `task` | what a linkage shall do, as a file says it |
| `four_bar`, `travel` | what the lengths say; whether positions can be reached one after another |
"""
