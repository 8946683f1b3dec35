"""Reciprocating engines: descriptions of their parts, and what follows from them in closed form.

| module | |
| --- | --- |
| `any_gas` | The gas in the cylinders of an engine: measured or calculated |
| `burnt_gas` | Ratio of the specific heats of air and of what burns in it, by temperature |
| `closed_cycle` | The gas between closing and opening: compression, release of heat, expansion |
| `combustion` | A working cycle by calculation |
| `cycle_mesh` | Crank angles of a cycle for integrals |
| `cycle_pressure` | The pressure in a cylinder over its working cycle, at many speeds |
| `cylinder` | The working space of a cylinder: its volume and the piston's motion as Fourier series |
| `dead_centres` | Dead centres and strokes of the pistons of a throw |
| `engine` | A reciprocating engine: throws, banks, rods, gas, and the order in which its cylinders fire |
| `engine_motion` | The moving parts of an engine |
| `equivalent_inertia` | The disc that stands for a throw, as published |
| `firing` | When each cylinder fires: from the angles of throws and banks and the firing order |
| `gas` | What all descriptions of the gas in a cylinder share |
| `gas_load` | The load map of an engine: indicated mean effective pressure against speed |
| `gas_torque` | The torque of the gas on the crank, and its harmonics |
| `indicator` | A measured indicator diagram: pressure in the cylinder over the crank angle of a whole cycle |
| `indicator_faults` | What can be wrong with an indicator diagram |
| `mean_inertia` | The disc that stands for a throw, exactly: means of J(φ) over one revolution |
| `pendulum` | Moments of inertia of a rod from how fast it swings on a knife edge |
| `periodic_cubic` | The periodic monotone cubic through points of a cycle |
| `polygon` | Closed polygons: area and its moments by Green's theorem, crossings, points inside |
| `rod` | Connecting rods: length, mass, and how the mass is spread along them |
| `rod_motion` | Motion of a rod and its piston over the crank angle, exact |
| `running_gear` | The running gear of one throw |
| `speed_points` | A few speeds for many |
| `swing_test` | Pendulum tests of a rod: how fast it swings on a knife edge in its heads |
| `throw` | The geometry of one crank throw: main journal, crank pin, two webs, drillings, counterweights |
| `throw_compliance` | Compliance of a crank throw by a formula of choice |
| `throw_formulas` | Twist of one crank throw under a torque |
| `throw_inertia` | What turns with one crank throw |
| `throw_reduction` | Inertia and weight of one throw with all its rods and pistons, reduced to the crank |
| `valves` | Valve or port timing, and the pressure while the cylinder is open |
| `wall_heat` | Heat that the gas loses to the walls of the cylinder |
| `wiebe` | Wiebe's function: how much of the heat is released at a crank angle |
| `working_cycle` | A whole working cycle at n operating points: the closed gas, then the gas exchange |
"""
