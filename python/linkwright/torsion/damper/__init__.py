"""The best damper for a mode.

| module | |
| --- | --- |
| `damper_design` | The best damper, in closed form and for a mode |
| `damper_rules` | The best damper, in closed form and for a mode |
| `ring_on_train` | The best damper for a train |
"""
