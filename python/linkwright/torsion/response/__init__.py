"""Forced vibration: torques, amplitudes, stresses, speed fluctuation over the speed.

| module | |
| --- | --- |
| `along_shaft` | The torque along a shaft with distributed inertia, and where it counts |
| `crank_bending` | Forces of rods on crank pins, and the bending of a throw |
| `drive_line` | The train of a driveline, and how its mechanism excites it |
| `engine_torques` | Torques of an engine on its throws: gas, inertia, weight; its data |
| `excited_train` | A train made ready for forced vibration: its torques, and what it is at each speed |
| `forced` | Forced vibration of a train: amplitudes, shaft torques, heat, speed fluctuation |
| `harmonics` | Torques on discs as harmonics, and what harmonics add up to in phase |
| `mesh_torque` | Torque in the gear stages of a train, and where their teeth lose contact |
| `stress` | Shear stress in the shafts of a train, and what is permitted there |
| `survey` | A train at its speeds, resonances and peaks: limits and largest torques |
| `unevenness_along` | The measure N over the cylinders, at every disc |
"""
