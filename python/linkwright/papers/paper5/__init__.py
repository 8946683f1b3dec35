"""Paper 5: the knife of a root-crop topper.

| module | |
| --- | --- |
| `figures` | Figures to paper 5: its figure 3, the step from (4) to (5), and where its result holds |
| `paper` | paper 5 computed anew: the length of a topper's knife |
| `short` | How much the lengths of paper 5 fall short of what a knife of constant speed needs |
| `step` | The step of paper 5 from its condition (4) to its length (5) |
| `surface` | Figure 3 of paper 5 |
| `verdict` | The published 0.25 to 0.30 m of paper 5 |
"""
