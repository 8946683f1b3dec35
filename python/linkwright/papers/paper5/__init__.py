"""Paper 5: the knife of a root-crop topper.

| module | |
| --- | --- |
| `conclusions` | What the numbers of paper 5 say, in sentences that carry their numbers |
| `figures` | Figures to paper 5: its figure 3, the step from (4) to (5), and where its result holds |
| `head` | The diameter of the head in paper 5 against the sphere that it is cut from |
| `page` | Paper 5 as one HTML page |
| `paper` | paper 5 computed anew: the length of a topper's knife |
| `rows` | Every formula of paper 5, its ranges and its result, with a verdict |
| `short` | How much the lengths of paper 5 fall short of what a knife of constant speed needs |
| `step` | The step of paper 5 from its condition (4) to its length (5) |
| `surface` | Figure 3 of paper 5 |
| `table` | For which heads the result of paper 5 holds, as tables over the angle of the edge |
| `verdict` | The published 0.25 to 0.30 m of paper 5 |
"""
