"""The best damper for a mode.

| module | |
| --- | --- |
| `damper_design` | The best damper for a mode of a train, by the mode alone and for the whole train |
| `damper_rules` | Dampers of one mass on a spring in closed form |
"""
