"""Paper 1: speed fluctuation of crank drives with one to four carts.

| module | |
| --- | --- |
| `drive` | One drive: its printed row, and what comes out in three ways |
| `figures` | the figures of paper 1, computed anew |
| `paper` | paper 1 computed anew: the four drives, and what follows |
| `scheme` | the published scheme of paper 1, with its factor 1/i |
"""
