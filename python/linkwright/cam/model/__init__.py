"""Cams, their followers and motion programmes in a machine file.

| module | |
| --- | --- |
| `cam` | A cam on the crankshaft and the follower that it moves |
| `flow_law` | The extension of a hydraulic cylinder by the flow of its pump |
| `follower` | The follower of a cam in the mechanism |
| `follower_motion` | The motion of a follower: sections as one law, and the lift of its elastic train |
| `motion_law` | The motion law of a section, as it is written in a machine file |
| `motion_section` | A motion programme as it is written in a machine file |
| `point_law` | Laws through points, as they are written in a machine file: splines and tables |
"""
