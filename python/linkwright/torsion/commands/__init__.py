"""``linkwright torsion``.

| module | |
| --- | --- |
| `damper` | `linkwright torsion damper FILE`: the best damper for a mode of a train |
| `diagnose` | `linkwright torsion diagnose FILE CSV`: which cylinder is weak, from a measured speed |
| `torsion` | `linkwright torsion FILE`: torsional vibration of a train |
"""
