"""Trains in a machine file: discs, shafts, gears, couplings, dampers, engines, manoeuvres.

| module | |
| --- | --- |
| `coupling` | Couplings, dampers, torques on a train, its run |
| `crankshaft_limit` | What shafts bear, given or by the rules of ships |
| `damper` | Couplings, dampers, torques on a train, its run |
| `drive_train` | Gearbox, coupling, flywheel, brake; a drive line whose shafts twist, as a train |
| `engine/` | Reciprocating engines: descriptions of their parts, and what follows from them in closed form |
| `propulsion_shaft` | What shafts bear, given or by the rules of ships |
| `shaft_flexibility` | Closed forms of cones and rings; what a step adds |
| `shaft_limit` | What shafts bear, given or by the rules of ships |
| `shaft_row` | Sections of a shaft, and several in a row |
| `shaft_section` | Sections of a shaft, and several in a row |
| `shaft_step` | Closed forms of cones and rings; what a step adds |
| `train` | Torsional trains, speeds of their discs, faults |
| `train_base` | Quantities that several parts of a train have |
| `train_event` | Manoeuvres of trains, what happens in them |
| `train_faults` | Torsional trains, speeds of their discs, faults |
| `train_run` | Couplings, dampers, torques on a train, its run |
| `train_speeds` | Torsional trains, speeds of their discs, faults |
| `train_torques` | Couplings, dampers, torques on a train, its run |
| `train_transient` | Manoeuvres of trains, what happens in them |
| `whole_train` | Engine, couplings and dampers written out as discs and shafts |
"""
