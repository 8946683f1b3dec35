"""Paper 1: evenness of motion of crank drives with one to four carts.

| module | |
| --- | --- |
| `conclusions` | what its numbers say; its page |
| `figures` | the figures of paper 1, computed anew |
| `limit` | the constant-energy limit of a drive, and the inertia that would fit a published row |
| `page` | what its numbers say; its page |
| `paper` | paper 1 computed anew: the four drives in three ways, and what follows |
| `scheme` | the published scheme of paper 1, with its factor 1/i |
"""
