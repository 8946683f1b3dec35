"""Torsionally flexible drivelines with the mechanism that they drive: its inertia and loads at every angle.

| module | |
| --- | --- |
| `analyses` | Its analysis, as study, report, studio and studies read it |
| `branch_tables` | Branches of steady motions as a table and a figure |
| `branches` | Steady motions over a number of the file, through folds |
| `chain` | The driveline as masses and links, referred to the crank |
| `coexisting` | Further steady motions, from other beginnings |
| `commands` | The command `linkwright elastic` |
| `elastic_motion` | Steady motion: torques of shafts, motion of every station, Floquet multipliers |
| `figures` | Torques of the shafts and speeds of the stations over the crank angle |
| `parametric` | Estimate of parametric resonance by the linear modes |
| `permitted` | Torques of shafts against what is permitted |
| `solving` | Checks, where the search begins, and why it fails |
| `study` | The analysis in the study of a machine, its check and its warnings |
| `tables` | A row a shaft, a row a station, energy and stability |
| `words` | Formulas, sources and assumptions |
"""
