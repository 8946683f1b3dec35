"""Figures of toppers.

| module | |
| --- | --- |
| `captions` | The figures of toppers with their captions |
| `field` | A topper over a field of roots |
| `lengths` | Lengths of their edges, and for which heads published ones do |
| `phase` | Toppers over the phase of the knife |
| `sweep` | A topper over a field of roots with its knife varied: curves, maps, and the best knife |
| `view` | The knife of a topper from above: its edge over a head, the area it sweeps, and what it leaves |
"""
