"""Paper 2: a cart moved by a cam with a combined motion law.

| module | |
| --- | --- |
| `alternatives` | Other laws at the same stroke and time, and the crank drive, all on the same motor |
| `checks` | The printed formulas of paper 2 against the general synthesis, and against one another |
| `course` | the cart in steady motion |
| `figures` | Figures 1 and 3 of paper 2, computed anew, and what they do not show |
| `formulas` | The closed forms of paper 2 as printed, a second way beside the motion laws and the core |
| `paper` | paper 2 computed anew: the cam drive of a cart |
| `roller` | Rollers on the printed profile, which is made for points; two cams against one |
| `start` | which start section has the minimum ∫ jerk² |
"""
