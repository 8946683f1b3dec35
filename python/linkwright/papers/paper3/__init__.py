"""Paper 3: torsional vibration of V-type engines.

| module | |
| --- | --- |
| `checks` | Checks of weak couplings and of speed fluctuation in paper 3 |
| `crank_train` | Crank throw, swing of the connecting rod, and inertia of the crank train by paper 3 |
| `figures` | Figures to paper 3: the train and its modes, discs and what formulas make of them, vibration |
| `paper` | paper 3 computed anew: its formulas on a V-12 with articulated rods |
"""
