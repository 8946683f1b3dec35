"""From a machine's description to the program of the core.

| module | |
| --- | --- |
| `change_points` | Change points of a dyad, of one machine or of each of a batch |
| `compiled` | A machine in the core's terms, and what it is asked for |
| `core` | The compiled core, refused if it was built from other sources |
| `drive_line` | Motor, gearbox, and the inertia that turns with the crank |
| `elements` | Drivers, dyads, gears, racks, cables and rigid points, one by one |
| `initial_assembly` | What must be known of the motion before the first revolution |
| `loads` | Bodies and loads |
| `mechanism` | Program of a whole mechanism: fixed points, then elements in build order |
| `motion` | Motion of points, links and slides of one machine, by name |
| `numbers` | Parameters, tables, formulas, motion laws |
| `places` | Indices of points, links, slides and dyads by name; guides and sums |
| `smooth_laws` | Laws without jumps |
"""
