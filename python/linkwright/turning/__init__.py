"""Turning-moment diagrams: torques of driver and load over a shaft's angle, and the flywheel between them.

| module | |
| --- | --- |
| `analyses` | Its analyses, as study, report, studio, studies and derivatives read them |
| `check` | What can be seen without solving, and what a machine consists of |
| `diagram` | Fluctuation of energy over a cycle, and the flywheel that evens the motion |
| `gradient` | Derivatives of a diagram by its entries |
| `figures` | The diagram, the energy and the speed over a cycle |
| `model` | Torques and the turning-moment diagram in a file |
| `rim` | The rim of a flywheel: speed, hoop stress, mass and cross-section |
| `tables` | The diagram as tables, headline and formulas |
"""
