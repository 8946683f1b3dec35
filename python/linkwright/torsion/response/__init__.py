"""Forced vibration: torques, amplitudes, stresses, speed fluctuation over the speed.

| module | |
| --- | --- |
| `torsion_response` | Vibratory torques in the shafts of a train, their extremes over all orders, heat |
| `drive_line` | The train of a driveline, and how its mechanism excites it |
| `engine_data` | What an engine is in a train |
| `engine_torques` | Torques of an engine on its throws: gas, inertia, weight |
| `excited_train` | A train made ready for forced vibration: its torques, and what it is at each speed |
| `forced` | Forced vibration of a train: amplitudes, shaft torques and speed fluctuation at every speed |
| `mechanism_torques` | What a mechanism does to its driveline |
| `mesh_torque` | Torque in the gear stages of a train, and where their teeth lose contact |
| `peaks` | The largest torques of shafts over all speeds, also at resonances between the speeds of a run |
| `stress` | Shear stress in the shafts of a train, and what is permitted there |
| `survey` | What is asked, at which speeds, and where it is not kept |
| `synthesis` | Orders added up in phase |
| `torques` | Torques on the discs of a train as harmonics of the angle of its first disc |
| `unevenness_along` | The measure N over the cylinders, at every disc |
"""
