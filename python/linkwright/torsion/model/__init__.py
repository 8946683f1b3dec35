"""Trains in a machine file: discs, shafts, gears, couplings, dampers, engines, manoeuvres.

| module | |
| --- | --- |
| `clutch` | Parts with dry friction: clutches, brakes and bits, freewheels |
| `coupling` | Elastic couplings, torsional dampers and centrifugal pendulums |
| `drive_shaft` | Shafts of a drive: linear, by a torque curve, with backlash |
| `drive_train` | Gearbox, coupling, flywheel, brake; a driveline whose shafts twist, as a train |
| `engine/` | Reciprocating engines: descriptions of their parts, and what follows from them in closed form |
| `ice_impacts` | Ice impacts on a propeller, by ice classes |
| `measured_response` | A measured response over the speed |
| `permitted_stress` | Vibratory stress permitted by IACS UR M68 and by the Korean Register |
| `shaft_flexibility` | Closed forms for the twist of cones and of steps |
| `shaft_limit` | The permitted stress of the shaft: where its stress counts, and what is permitted there |
| `shaft_row` | Sections of a shaft in a row: their flexibilities with those of the steps between them |
| `shaft_section` | Sections of a shaft |
| `train` | A torsional train: discs, shafts, gear stages; speeds and orders of its forced vibration |
| `train_base` | Quantities that several parts of a train have |
| `train_faults` | What is wrong with a train as a whole |
| `train_mechanism` | A mechanism on a disc, with a machine file of its own |
| `train_torques` | Torques on a train from outside: what it drives, and what makes it pulsate |
| `train_transient` | A manoeuvre of a train, followed in time, and its events |
| `whole_train` | Engine, couplings and dampers written out as discs and shafts; how fast each disc turns |
"""
