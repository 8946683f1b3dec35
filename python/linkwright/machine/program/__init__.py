"""From a machine's description to the program of the core.

| module | |
| --- | --- |
| `core` | The compiled core, refused if it was built from other sources; what a program consists of |
| `compiled` | A machine in the core's terms, and what it is asked for |
| `translator` | A description as plan and parameters |
| `mechanism` | Program of a whole mechanism: fixed points, then elements in build order |
| `elements` | Drivers, dyads, gears, racks, cables and rigid points, one by one |
| `places` | Indices of points, links, slides and dyads by name; guides and sums |
| `pending` | What is left open until the mechanism has been placed once |
| `settle` | What has to be known of a mechanism's motion before it can be computed at any angle |
| `change_points` | Change points of a dyad, of one machine or of each of a batch |
| `driver_law` | Whether the law of a driver can be followed: it has a value everywhere, and no jump |
| `loads` | Bodies and loads |
| `drive_line` | Motor, gearbox, and the inertia that turns with the crank |
| `numbers` | Parameters, tables, formulas, motion laws |
"""
