"""Toppers of root crops: the knife over the head of a root.

| module | answers |
| --- | --- |
| `head` | the disc that is cut, and what lies above it |
| `published` | working lengths of the paper, and the bound that follows from its (4) |
| `constant_speed` | the exact length for a knife that does not turn back over a head |
| `verdict` | for which heads lengths that are said to do for ranges of speeds do |
"""
