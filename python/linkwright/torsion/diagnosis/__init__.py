"""Which cylinder is weak, from a measured speed.

| module | |
| --- | --- |
| `diagnosis` | Which cylinder is weak: factors with their uncertainty, by least squares on orders |
| `engine_diagnosis` | Which cylinder of an engine is weak, late or leaking, and what can be said of it |
| `engine_fit` | Values of cylinders whose speed is closest to a measured one, by Gauss and Newton's method |
| `engine_speed` | Speed of one disc, however strongly each cylinder works; elastic train or rigid |
| `measured_speed` | A speed measured over a cycle, or recorded over the crank angle, as harmonics |
| `record_diagnosis` | Which cylinder of an engine is weak |
"""
