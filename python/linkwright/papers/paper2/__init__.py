"""Paper 2: a cart moved by a cam with a combined motion law.

| module | |
| --- | --- |
| `alternatives` | Other laws at the same stroke and time, and the crank drive, all on the same motor |
| `checks` | The printed formulas of paper 2 against the general synthesis, and against one another |
| `conclusions` | What the numbers of paper 2 say, in sentences that carry their numbers |
| `course` | the cart in steady motion |
| `figures` | Figures 1 and 3 of paper 2, computed anew, and what they do not show |
| `formulas` | The closed forms of paper 2 as printed, a second way beside the motion laws and the core |
| `page` | Paper 2 as one HTML page |
| `pair` | Two cams that turn in opposite directions, one on each side of the cart, against one cam alone |
| `paper` | paper 2 computed anew: the cam drive of a cart |
| `roller` | What rollers do on the printed profile, which is made for points |
| `rows` | every printed number and formula of paper 2 with its verdict |
| `start` | which start section has the least ∫ jerk² |
| `table` | The drives of paper 2 side by side, as texts of a table |
"""
