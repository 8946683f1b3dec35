"""Torsional vibration of trains: modes, response, motion in time, limits, diagnosis, dampers.

| module | |
| --- | --- |
| `analyses` | Its analyses, as study, report, studio, studies and derivatives read them |
| `commands/` | ``linkwright torsion`` |
| `core/` | Trains in the terms of the core |
| `damper/` | The best damper for a mode |
| `diagnosis/` | Which cylinder is weak, from a measured speed |
| `excitation/` | What excites a train: engines, mechanism, drivers and loads, as harmonics |
| `figures/` | Figures of trains |
| `gradient/` | How frequencies, shapes and torques follow the numbers of the file |
| `in_time/` | Manoeuvres of trains, followed in time |
| `limits/` | Check of a train against its limits |
| `model/` | Trains in a machine file: discs, shafts, gears, couplings, dampers, engines, manoeuvres |
| `modes/` | Free vibration: frequencies, mode shapes, damping, the Campbell diagram, equivalent schemes |
| `page` | The page of a study of torsional vibration, from the template of all reports |
| `response/` | Forced vibration: torques, amplitudes, stresses, speed fluctuation over the speed |
| `study` | All of these as one |
| `tables/` | Tables of trains |
"""

from linkwright import exports

__getattr__ = exports(globals())
