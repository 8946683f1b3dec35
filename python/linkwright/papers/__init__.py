"""Papers: published numbers against computed ones, cell by cell, with the reason where they differ.

| module | |
| --- | --- |
| `cell` | One published value beside a computed one, and the verdict |
| `claim` | One printed claim beside what comes out, judged |
| `page` | What the pages of all papers share |
| `paper` | What all five have in common; the papers that there are |
| `paper1/` | Paper 1: evenness of motion of crank drives with one to four carts |
| `paper2/` | Paper 2: a cart moved by a cam with a combined motion law |
| `paper3/` | Paper 3: torsional vibration of V-type engines |
| `paper4/` | Paper 4: the lever mechanism of a sucker-rod rotator |
| `paper5/` | Paper 5: the knife of a root-crop topper |
| `published` | The published values, read from ``paper1.toml`` and the like; the papers that there are |
| `row` | One printed statement beside what comes out, in words |
| `sheet` | A paper as one HTML page |
| `words` | Templates of texts, filled with numbers |
"""
