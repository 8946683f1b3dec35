"""Paper 4: the lever mechanism of a sucker-rod rotator.

| module | |
| --- | --- |
| `conclusions` | what its numbers say; its figures; its page |
| `figures` | what its numbers say; its figures; its page |
| `formulas` | the closed forms of paper 4, a second way beside the core |
| `page` | what its numbers say; its figures; its page |
| `paper` | paper 4 computed anew: the rotator in both regimes |
| `rows` | every printed number of paper 4 with its verdict |
| `unit` | the pumping unit of paper 4, as far as its numbers leave it open |
"""
