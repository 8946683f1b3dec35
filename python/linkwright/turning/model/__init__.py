"""The turning-moment diagram of a machine file.

| module | |
| --- | --- |
| `torque` | Torques on a shaft by its angle: constant, a table, a formula |
| `turning_moment` | What drives, what resists, and what speed fluctuation is asked for |
"""
