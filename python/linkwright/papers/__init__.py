"""Papers: published numbers against computed ones, claim by claim, with the reason where they differ.

Every paper is a folder with ``paperN.toml``: what is printed, as claims that name the quantities which they
are compared with, and templates of all texts. Its modules compute those quantities with the rest of the
package.

| module | |
| --- | --- |
| `claim` | One printed claim beside what comes out, judged within a tolerance that has its reason |
| `page` | Templates of a paper's texts filled with numbers, and its page |
| `paper` | What all five have in common; the papers that there are |
| `paper1/` | Paper 1: speed fluctuation of crank drives with one to four carts |
| `paper2/` | Paper 2: a cart moved by a cam with a combined motion law |
| `paper3/` | Paper 3: torsional vibration of V-type engines |
| `paper4/` | Paper 4: the lever mechanism of a sucker-rod rotator |
| `paper5/` | Paper 5: the knife of a root-crop topper |
| `published_lengths` | For which heads published lengths of a knife suffice: paper 5's claim |
"""
