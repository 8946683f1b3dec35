"""Figures of toppers.

| module | |
| --- | --- |
| `captions` | The figures of toppers with their captions |
| `field` | Figures of a field, of sweeps and of the best knife |
| `lengths` | Figures of required lengths, phases, slicing and use of the edge |
| `view` | The knife of a topper from above: its edge over a head, the area it sweeps, and what it leaves |
"""
