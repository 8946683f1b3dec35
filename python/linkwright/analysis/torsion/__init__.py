"""Torsional vibration of trains.

| module | answers |
| --- | --- |
| `free` | natural frequencies, mode shapes, nodes, energy, and what changes them |
| `drive_line` | the train of a drive line, and how its mechanism excites it |
| `scheme` | inertias, stiffnesses and equivalent lengths, own and referred |
| `damper_rules`, `damper_design` | the best damper, in closed form and for a mode |
| `ring_on_train` | the best damper for a train |
| `holzer` | what a train needs to swing at any frequency |
| `damped`, `damped_modes` | modes with damping, and what damps them |
| `campbell`, `modes_over_speed` | critical speeds and how severe they are |
| `excited`, `torques`, `engine_torques`, `mechanism_torques` | what makes a train vibrate |
| `transient`, `moving_train`, `moving_engine`, `moving_drive`, `loaded_start` | motion in time |
| `waterfall` | amplitudes over speed and order |
| `synthesis` | orders added up in phase |
| `study` | all of these as one |
| `stress`, `mesh_torque` | stresses in shafts, with those permitted; torque of gear stages |
| `barred_range` | speeds barred from continuous operation |
| `verdict` | whether all limits are kept |
| `criteria`, `survey`, `exceedance`, `resonance` | what is asked, at which speeds, and where it is not kept |
| `carried`, `forced` | torque and heat of shafts; amplitudes and unevenness of discs |
| `unevenness_along` | the measure N over the cylinders, at every disc |
| `diagnosis`, `engine_diagnosis` | which cylinder is weak, from a `measured_speed` |
| `recorded_speed`, `record_diagnosis` | a speed recorded over the crank angle, and what it says |
"""
