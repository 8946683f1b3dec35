"""Torsionally flexible drivelines with the mechanism that they drive: its inertia and loads at every angle.

| module | |
| --- | --- |
| `analyses` | Its analyses, as study, report, studio and studies read it |
| `chain` | The driveline as masses and links, referred to the crank |
| `commands` | `linkwright transient` |
| `elastic_motion` | Steady motion: torques of shafts, motion of every station, Floquet multipliers |
| `figures` | Torques of the shafts and speeds of the stations over the crank angle |
| `figures_in_time` | Torques and speeds over time |
| `in_time` | Motion in time: start, stop, load steps |
| `permitted` | Torques of shafts against what is permitted |
| `run_up` | Run-up: time, peak torques, losses |
| `study` | The analysis in the study of a machine, its check and its warnings |
| `tables` | A row a shaft, a row a station, energy and stability; time and energy of a motion in time |
| `words` | Formulas, sources and assumptions |
"""
