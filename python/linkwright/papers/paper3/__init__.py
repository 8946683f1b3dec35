"""Paper 3: torsional vibration of V-type engines.

| module | |
| --- | --- |
| `engine` | the V-12, and what another inertia or stiffness does to its frequencies |
| `figures` | Figures to paper 3: the train and its modes, discs and what formulas make of them, vibration |
| `inertia` | The disc of a throw by (1) to (12) of paper 3 against the exact motion of master |
| `paper` | paper 3 computed anew: its formulas on a V-12 with articulated rods |
| `swing` | Formulas (13) to (15) of paper 3, tried on a rod that swings as the exact laws have it |
| `throw` | Formulas (16) and (17) of paper 3: inertia and compliance of a throw from its geometry |
| `uneven` | Speed fluctuation along the shaft of the V-12: rigid, with torsion, with weak cylinders |
| `weak` | Which cylinder is weak, told from the speed of a disc |
"""
