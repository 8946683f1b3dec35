"""Toppers of root crops: the knife over the head of a root.

| module | answers |
| --- | --- |
| `head` | the disc that is cut, and what lies above it |
| `published` | working lengths of the paper, and the bound that follows from its (4) |
| `knife` | the law of the knife, given or that of a member of the mechanism |
| `edge` | where the edge is and how fast it goes, seen from a head |
| `coverage` | what heads need, what an edge leaves of them |
| `worst_head`, `every_head` | the worst over offsets and phases; what it and all others need |
| `slicing` | draw-cut ratio, cutting speed, use of the edge |
| `knife_drive` | inertia force of the knife, torque of its drive |
| `topper`, `cautions` | all of these as one; what it does not do |
| `roots`, `passes` | the roots of a field; an edge over all of them |
| `field`, `field_verdict` | share of heads cut, haulm left, loss; limits that are not kept |
| `intervals`, `share_curve` | what holds the true shares and means; share against length |
| `constant_speed` | the exact length for a knife that does not turn back over a head |
| `every_phase` | the exact length for one that does, met in every phase |
| `head_pass` | one pass over a head, and the outline of what is left of it |
| `length_chart` | lengths over root diameter and knife speed, for some forward speeds |
| `verdict` | for which heads lengths that are said to do for ranges of speeds do |
| `verdict_chart` | the same about a machine's own angle, cut and offset |
"""
