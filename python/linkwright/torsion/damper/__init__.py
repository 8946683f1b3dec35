"""The best damper for a mode.

| module | |
| --- | --- |
| `damper_design` | The best damper for a mode of a train |
| `damper_rules` | Dampers of one mass on a spring in closed form |
| `ring_on_train` | The best damper for a train |
"""
