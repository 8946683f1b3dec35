"""Figures of toppers.

| module | |
| --- | --- |
| `captions` | The figures of toppers with their captions |
| `field` | Fields of roots under a topper; its knife varied, the best one |
| `lengths` | Lengths of their edges, and for which heads published ones do |
| `phase` | Knives of toppers over the phase, and from above |
| `sweep` | Fields of roots under a topper; its knife varied, the best one |
| `view` | Knives of toppers over the phase, and from above |
"""
