"""Toppers of root crops: the knife over the heads of a row.

| module | |
| --- | --- |
| `best/` | The best knife of a topper within its limits |
| `cautions` | What a topper cannot do, and what its user should know: sentences with numbers |
| `commands/` | ``linkwright topper`` |
| `constant_speed` | The exact length for a knife that does not turn back over a head |
| `core` | The core's knife of a topper over many heads |
| `coverage` | What heads need, what an edge leaves of them |
| `edge` | Where the edge is and how fast it goes, seen from a head |
| `every_head` | One edge over all heads that it may meet: what they need, and what it leaves of them |
| `every_phase` | The exact length for one that does, met in every phase |
| `field` | A field of roots under the knife |
| `field_verdict` | What speaks against a topper over its field |
| `figures/` | Figures of toppers |
| `head` | The disc that is cut, and what lies above it |
| `head_pass` | One pass over a head, and the outline of what is left of it |
| `intervals` | Shares and means of a sample in clusters, and the intervals that hold the true ones |
| `knife` | The law of the knife, given or that of a member of the mechanism |
| `knife_drive` | Inertia force of the knife, torque of its drive |
| `knife_look` | Whether an edge is long enough, seen at few heads |
| `length_chart` | Lengths over root diameter and knife speed, for some forward speeds |
| `model/` | Toppers, fields and limits of a knife in a machine file |
| `passes` | One pass of an edge over many roots, in portions, so that somebody may watch |
| `published` | Working lengths of the paper, and the bound that follows from its (4) |
| `roots` | The roots of a field, one by one, and in which phases of the knife they stand |
| `scene` | The knife of a topper over a row of heads, to be moved |
| `share_curve` | The share of heads that are cut right through, against the length of the edge |
| `slicing` | Draw-cut ratio, cutting speed, use of the edge |
| `sweep` | A topper over a field of roots, with the length, angle or speeds of its knife varied |
| `tables/` | Tables of toppers, and what reports say of them |
| `topper` | The knife of a topper over the heads of a row |
| `verdict` | For which heads lengths that are said to do for ranges of speeds do |
| `verdict_chart` | The same about a machine's own angle, cut and offset |
| `worst_head` | The worst of the heads that a knife may meet |
"""
