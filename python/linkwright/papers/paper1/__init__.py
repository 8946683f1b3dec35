"""Paper 1: evenness of motion of crank drives with one to four carts.

| module | |
| --- | --- |
| `conclusions` | What the numbers of paper 1 say, in sentences that carry their numbers |
| `figures` | the figures of paper 1, computed anew |
| `limit` | the constant-energy limit of a drive, and the inertia that would fit a published row |
| `page` | Paper 1 as one HTML page |
| `paper` | paper 1 computed anew: the four drives in three ways, and what follows |
| `scheme` | the published scheme of paper 1, with its factor 1/i |
"""
