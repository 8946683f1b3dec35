"""Paper 3: torsional vibration of V-type engines.

| module | |
| --- | --- |
| `conclusions` | what its numbers say; its figures; its page |
| `engine` | the V-12, and what another inertia or stiffness does to its frequencies |
| `figures` | what its numbers say; its figures; its page |
| `inertia` | (1) to (12); (13) to (15); (16) and (17) |
| `page` | what its numbers say; its figures; its page |
| `paper` | paper 3 computed anew: its formulas on a V-12 with articulated rods |
| `rows` | every formula with its verdict; what it does to the frequencies as a table |
| `swing` | (1) to (12); (13) to (15); (16) and (17) |
| `table` | every formula with its verdict; what it does to the frequencies as a table |
| `throw` | (1) to (12); (13) to (15); (16) and (17) |
| `uneven` | unevenness along the shaft, rigid and not; which cylinder is weak |
| `weak` | unevenness along the shaft, rigid and not; which cylinder is weak |
"""
