"""Torsionally flexible drivelines with the mechanism that they drive: its inertia and loads at every angle.

| module | |
| --- | --- |
| `analyses` | Its analysis, as study, report, studio and studies read it |
| `batch` | Many drivelines at once |
| `chain` | The driveline as masses and links, referred to the crank |
| `elastic_motion` | Steady motion: torques of shafts, motion of every station, Floquet multipliers |
| `figures` | Torques of the shafts and speeds of the stations over the crank angle |
| `gradient` | Derivatives of the steady motion by entries of the machine |
| `permitted` | Torques of shafts against what is permitted |
| `study` | The analysis in the study of a machine, its check and its warnings |
| `tables` | A row a shaft, a row a station, energy and stability |
| `words` | Formulas, sources and assumptions |
"""
