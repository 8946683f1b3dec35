"""Which followers touch which cam, the curves that follow, and what is wrong with them.

| module | |
| --- | --- |
| `checks` | Inputs that make no sense, told by name |
| `contact` | Which followers touch which cam, and the curves that follow from it |
| `faults` | Is it undercut, pointed, crossed, too hollow for its cutter, too steep? |
| `least_base` | How small may the base circle be, how large the roller? |
| `least_sizes` | The smallest base circle for its limits, and the largest roller |
| `lift_steps` | Which derivatives of a lift jump, and where? |
| `opposite` | Do two followers touch one cam at every angle? |
| `profile` | A cam over one revolution: lift, pressure angle, curvature, and their extremes |
"""
