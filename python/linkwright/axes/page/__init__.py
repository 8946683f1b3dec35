"""The choice of motors for axes on a page.

| module | |
| --- | --- |
| `choice` | Pairs of motor and gearbox as tables, and all of them as CSV |
| `ratio_chart` | Accelerating factors of motors against the load factor |
"""
