"""Forced vibration: torques, amplitudes, stresses, unevenness over the speed.

| module | |
| --- | --- |
| `carried` | Torque and heat of shafts; amplitudes and unevenness of discs |
| `drive_line` | The train of a drive line, and how its mechanism excites it |
| `engine_data` | What an engine is in a train |
| `engine_torques` | What makes a train vibrate |
| `excited` | What makes a train vibrate |
| `forced` | Torque and heat of shafts; amplitudes and unevenness of discs |
| `mechanism_torques` | What makes a train vibrate |
| `mesh_torque` | Stresses in shafts, with those permitted; torque of gear stages |
| `peaks` | The largest torques of shafts over all speeds, also at resonances between the speeds of a run |
| `stress` | Stresses in shafts, with those permitted; torque of gear stages |
| `survey` | What is asked, at which speeds, and where it is not kept |
| `synthesis` | Orders added up in phase |
| `torques` | What makes a train vibrate |
| `unevenness_along` | The measure N over the cylinders, at every disc |
"""
