"""Which followers touch which cam, the curves that follow, and what is wrong with them.

| module | |
| --- | --- |
| `check` | How many faults a cam has |
| `contact` | Which followers touch which cam, with their curves; the distance of two on opposite sides |
| `faults` | Is it undercut, pointed, crossed, too hollow for its cutter, too steep? |
| `least_sizes` | Minimum base circle and maximum roller within the limits of a cam |
| `profile` | A cam over one revolution: lift, pressure angle, curvature, and their extremes |
"""
