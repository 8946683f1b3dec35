"""Torsionally flexible drivelines with the mechanism that they drive: its inertia and loads at every angle.

| module | |
| --- | --- |
| `analyses` | Its analyses, as study, report, studio and studies read it |
| `batch` | Many drivelines at once |
| `branch_tables` | Branches of steady motions as a table and a figure |
| `branches` | Steady motions over a number of the file, through folds |
| `carried` | What of a train its steady motion does not carry, and the analysis that does |
| `chain` | The driveline as masses and links, referred to the crank |
| `coexisting` | Further steady motions, from other beginnings |
| `commands` | `linkwright transient`, `linkwright elastic` |
| `elastic_motion` | Steady motion: torques of shafts, motion of every station, Floquet multipliers |
| `figures_in_time` | Torques and speeds over time |
| `figures` | Torques of the shafts and speeds of the stations over the crank angle |
| `gradient` | Derivatives of the steady motion by entries of the machine |
| `in_time` | Motion in time: start, stop, load steps |
| `parametric` | Estimate of parametric resonance by the linear modes |
| `permitted` | Torques of shafts against what is permitted |
| `run_up` | Run-up: time, peak torques, losses |
| `solving` | Checks, where the search begins, and why it fails |
| `study` | The analysis in the study of a machine, its check and its warnings |
| `tables` | A row a shaft, a row a station, energy and stability; time and energy of a motion in time |
| `tangents` | Derivatives by all entries, those of mounted mechanisms among them |
| `train_chain` | A train with motors and mechanisms as masses and links |
| `words` | Formulas, sources and assumptions |
"""
