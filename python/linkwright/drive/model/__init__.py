"""Motors, gearbox, coupling, brake, flywheel.

| module | |
| --- | --- |
| `catalogue` | Published motors |
| `drive` | Gearbox, coupling, flywheel, brake; a driveline whose shafts twist, as a train |
| `motor_file` | Motors of one's own from a file |
| `motor` | The kinds of motor, and how their entries follow from one another |
"""
