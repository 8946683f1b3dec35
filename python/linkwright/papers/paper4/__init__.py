"""Paper 4: the lever mechanism of a sucker-rod rotator.

| module | |
| --- | --- |
| `conclusions` | What the numbers of paper 4 say, in sentences that carry their numbers |
| `figures` | Figures 3 to 6 of paper 4, computed anew |
| `formulas` | the closed forms of paper 4, a second way beside the core |
| `page` | Paper 4 as one HTML page |
| `paper` | paper 4 computed anew: the rotator in both regimes |
| `rows` | every printed number of paper 4 with its verdict |
| `unit` | the pumping unit of paper 4, as far as its numbers leave it open |
"""
