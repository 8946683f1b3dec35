"""Cams, their followers and motion programmes in a machine file.

| module | |
| --- | --- |
| `cam` | Cams, their followers as drivers, and what vibrates behind them |
| `follower` | Cams, their followers as drivers, and what vibrates behind them |
| `follower_motion` | The motion over a turn; what is wrong with sections |
| `follower_train` | Cams, their followers as drivers, and what vibrates behind them |
| `motion_law` | Sections of a cam's motion, and their laws |
| `motion_section` | Sections of a cam's motion, and their laws |
| `point_law` | Sections of a cam's motion, and their laws |
| `section_faults` | The motion over a turn; what is wrong with sections |
"""
