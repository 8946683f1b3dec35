"""Papers: published numbers against computed ones, cell by cell, with the reason where they differ.

| module | holds |
| --- | --- |
| `published` | the published values, read from ``paper1.toml``; the papers that there are |
| `cell` | one published value beside a computed one, and the verdict |
| `paper1` | paper 1 computed anew: the four drives in three ways, and what follows |
| `paper1_scheme` | the published scheme of paper 1, with its factor 1/i |
| `paper1_limit` | the constant-energy limit of a drive, and the inertia that would fit a published row |
| `paper1_figures` | the figures of paper 1, computed anew |
| `page` | paper 1 as one HTML page |
| `paper4` | paper 4 computed anew: the rotator in both regimes |
| `paper4_unit` | the pumping unit of paper 4, as far as its numbers leave it open |
| `paper4_rows` | every printed number of paper 4 with its verdict |
| `paper4_formulas` | the closed forms of paper 4, a second way beside the core |
| `paper4_conclusions`, `paper4_figures`, `paper4_page` | what its numbers say; its figures; its page |
"""
