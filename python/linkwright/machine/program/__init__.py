"""From a machine's description to the program of the core.

| module | |
| --- | --- |
| `change_points` | Change points of a dyad, of one machine or of each of a batch |
| `compiled` | From a machine's description to the arrays of the core |
| `driver_law` | Whether the law of a driver can be followed: it has a value everywhere, and no jump |
| `elements` | Rows of the core's program for the elements of a mechanism |
| `numbers` | Numbers of a machine as they cross the border |
| `settle` | What has to be known of a mechanism's motion before it can be computed at any angle |
"""
