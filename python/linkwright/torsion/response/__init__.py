"""Forced vibration: torques, amplitudes, stresses, speed fluctuation over the speed.

| module | |
| --- | --- |
| `along_shaft` | The torque along a shaft with distributed inertia, and where it counts |
| `crank_bending` | Forces of rods on crank pins, and the bending of a throw |
| `forced` | Forced vibration of a train: amplitudes, shaft torques, heat, speed fluctuation |
| `many_trains` | Vibration of many trains of one structure at once |
| `mesh_torque` | Torque in the gear stages of a train, and where their teeth lose contact |
| `speed_control` | Where speed controllers would reach their limit of torque |
| `stress` | Shear stress in the shafts of a train, and what is permitted there |
| `unevenness_along` | The measure N over the cylinders, at every disc |
"""
