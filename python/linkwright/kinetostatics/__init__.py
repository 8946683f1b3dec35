"""Forces in a mechanism whose motion is given: Newton and Euler for every member, all crank angles at once.

| module | responsibility |
| --- | --- |
| `motion` | crank angle, speed, acceleration and time at which forces are asked for |
| `scene` | where members, points and guides are, and how they move |
| `wrench` | forces and couples on members |
| `inertia` | what the accelerated masses do |
| `applied` | what each load does |
| `pairs` | what each pair can do: directions of its unknown forces, and its friction |
| `friction` | friction in pins, guides and slots, as given by the user |
| `formula_load` | what a load by a formula does |
| `equilibrium` | the linear system, its solution, and the iteration over friction |
| `result` | the forces by name |
| `collect` | from the unknowns to the result |

Indices of arrays: crank angle first, then member, then coordinate.
"""
