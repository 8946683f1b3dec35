"""Paper 4: the lever mechanism of a sucker-rod rotator.

| module | |
| --- | --- |
| `figures` | Figures 3 to 6 of paper 4, computed anew |
| `formulas` | the closed forms of paper 4, a second way beside the core |
| `paper` | paper 4 computed anew: the rotator in both regimes |
"""
