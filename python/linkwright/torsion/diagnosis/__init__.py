"""Which cylinder is weak, from a measured speed.

| module | |
| --- | --- |
| `cylinder_factors` | Factors of the cylinders of an engine with their uncertainty, and whom they accuse |
| `cylinder_response` | Harmonics of the speed of one disc |
| `diagnosis` | Which cylinder is weak: the share of each in a measured speed, by least squares on orders |
| `engine_diagnosis` | Which cylinder of an engine is weak: its factors by Gauss and Newton's method |
| `engine_speed` | What the speed of a disc is, however strongly |
| `measured_speed` | A speed measured over a cycle, as harmonics |
| `record_diagnosis` | Which cylinder of an engine is weak |
| `recorded_speed` | A speed recorded over the crank angle, as harmonics |
"""
