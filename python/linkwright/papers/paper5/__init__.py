"""Paper 5: the knife of a root-crop topper.

| module | |
| --- | --- |
| `figures` | Figures to paper 5: its figure 3, the step from (4) to (5), and where its result holds |
| `paper` | paper 5 computed anew: the length of a topper's knife |
| `steps` | Step of the knife, short strokes, and the surface of lengths of paper 5 |
"""
