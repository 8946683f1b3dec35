"""Paper 2: a cart moved by a cam with a combined motion law.

| module | |
| --- | --- |
| `alternatives` | Other laws at the same stroke and time, and the crank drive, all on the same motor |
| `cam_motion` | Start, course and roller of the cam of paper 2 |
| `figures` | Figures 1 and 3 of paper 2, computed anew, and what they do not show |
| `formulas` | The closed forms of paper 2 as printed, a second way beside the motion laws and the core |
| `paper` | paper 2 computed anew: the cam drive of a cart |
"""
