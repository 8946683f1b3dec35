"""Trains in a machine file: discs, shafts, gears, couplings, dampers, engines, manoeuvres.

| module | |
| --- | --- |
| `coupling` | An elastic coupling: linear, or with a torque that grows faster than the twist |
| `crankshaft_limit` | Vibratory stress that the Korean Register permits in crankshafts of main engines |
| `damper` | A torsional damper: a ring that turns with a disc, held by a fluid or by rubber |
| `drive_train` | Gearbox, coupling, flywheel, brake; a driveline whose shafts twist, as a train |
| `engine/` | Reciprocating engines: descriptions of their parts, and what follows from them in closed form |
| `propulsion_shaft` | Vibratory stress that classification societies permit in propulsion shafts |
| `shaft_flexibility` | Closed forms for the twist of cones |
| `shaft_limit` | The permitted stress of the shaft: where its stress counts, and what is permitted there |
| `shaft_row` | Sections of a shaft in a row: their flexibilities with those of the steps between them |
| `shaft_section` | Sections of a shaft |
| `shaft_step` | What a step of a shaft adds to its thinner side |
| `train` | A torsional train: discs that turn, elastic shafts between them, gear stages |
| `train_base` | Quantities that several parts of a train have |
| `train_event` | What happens to a train while it moves |
| `train_faults` | What is wrong with a train as a whole |
| `train_run` | Speeds and orders at which the forced vibration of a train is looked at |
| `train_speeds` | How fast each disc of a train turns against the others |
| `train_torques` | Torques on a train from outside: what it drives, and what makes it pulsate |
| `train_transient` | A manoeuvre of a train, followed in time |
| `whole_train` | Engine, couplings and dampers written out as discs and shafts |
"""
