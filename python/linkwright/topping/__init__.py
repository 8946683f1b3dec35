"""Toppers of root crops: the knife over the heads of a row.

| module | |
| --- | --- |
| `analyses` | Its analyses, as study, report, studio, studies and derivatives read them |
| `best/` | The best knife of a topper within its limits |
| `warnings` | Findings and warnings on a topper and on its field |
| `charts` | Curves of required length over speed and diameter |
| `check` | What can be seen without solving, and what a machine consists of |
| `commands` | ``linkwright topper``: field, sweep, best knife |
| `core` | The core's knife of a topper over many heads |
| `coverage` | What a head leaves uncut, of one pass and of many roots |
| `drive_along` | Derivatives of the force and torque that a knife takes from its drive |
| `edge` | Where the edge is and how fast it goes, seen from a head |
| `field` | A field of roots under the knife |
| `figures/` | Figures of toppers |
| `gradient` | Derivatives of what the knife does by the entries of its machine |
| `head_pass` | One pass over a head, and the outline of what is left of it |
| `intervals` | Confidence intervals of clustered samples, and of the share of roots over a limit |
| `knife` | Motion of a knife, and the force and power that drive it |
| `knife_along` | A knife whose law and speeds carry derivatives |
| `last_point` | The head that needs the longest edge, with derivatives |
| `model/` | Toppers, fields and limits of a knife in a machine file |
| `required_length` | Required edge length: published formulas, constant speed, every phase |
| `roots` | A field of roots, drawn once; head diameter and volume |
| `scene` | The knife of a topper over a row of heads, to be moved |
| `slicing` | Draw-cut ratio, cutting speed, use of the edge |
| `sweep` | A topper over a field of roots, with the length, angle or speeds of its knife varied |
| `tables/` | Tables of toppers, and what reports say of them |
| `topper` | The knife of a topper over the heads of a row |
| `uncut_along` | Derivatives of the area that an edge leaves of heads |
| `uncut_head` | The head of which most is left, and the mean that is left, with derivatives |
| `worst_head` | The worst place of a head, and all heads of the range |
"""

from linkwright import exports

__getattr__ = exports(globals())
