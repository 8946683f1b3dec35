"""Reciprocating engines: descriptions of their parts, and what follows from them in closed form.

| module | |
| --- | --- |
| `closed_cycle` | The gas between closing and opening, and its specific heats |
| `combustion` | A working cycle by calculation, at many speeds |
| `crank_concentration` | Stress concentration in fillets and oil bores of a throw |
| `crank_fatigue` | What the fatigue of a crankshaft asks of the file; fatigue strength |
| `cycle_pressure` | The pressure in a cylinder over its working cycle, and the angles of integrals |
| `cylinder` | A cylinder: volume, motion of the piston, torque of the gas |
| `engine` | A reciprocating engine: throws, banks, rods, gas, firing order |
| `engine_motion` | The moving parts of an engine |
| `equivalent_inertia` | The disc that stands for a throw: exact means, and as published |
| `gas` | What all descriptions of the gas in a cylinder share; load maps |
| `heat` | Release of heat by Wiebe's function, loss of heat to the walls |
| `indicator` | A measured indicator diagram: pressure in the cylinder over the crank angle of a whole cycle |
| `pendulum` | Moments of inertia of a rod from pendulum tests |
| `polygon` | Closed polygons: area and its moments by Green's theorem, crossings, points inside |
| `rod` | Connecting rods: length, mass, and how the mass is spread along them |
| `rod_motion` | Motion of a rod and its piston over the crank angle, exact |
| `running_gear` | Rods and pistons of one throw: motion, dead centres, reduction to the crank |
| `throw` | The geometry of one crank throw: main journal, crank pin, two webs, drillings, counterweights |
| `throw_compliance` | Compliance of a crank throw by five formulas |
| `throw_inertia` | What turns with one crank throw |
| `working_cycle` | A whole working cycle at n operating points, with valve timing |
"""
