"""Papers: published numbers against computed ones, cell by cell, with the reason where they differ.

| module | holds |
| --- | --- |
| `published` | the published values, read from ``paper1.toml`` |
| `cell` | one published value beside a computed one, and the verdict |
| `paper1` | paper 1 computed anew: the four drives in three ways, and what follows |
| `paper1_scheme` | the published scheme of paper 1, with its factor 1/i |
| `paper1_limit` | the constant-energy limit of a drive, and the inertia that would fit a published row |
| `paper1_figures` | the figures of paper 1, computed anew |
| `page` | all of it as one HTML page |
"""
