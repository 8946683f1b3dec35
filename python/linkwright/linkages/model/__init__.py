"""Elements of a mechanism, how they refer to each other, and in which order they are built.

| module | |
| --- | --- |
| `assembly` | In which order a mechanism is built; what is missing or too much |
| `cylinder` | Hydraulic cylinders: drivers by length or flow, or forces |
| `drawing` | Lengths and places that follow from coordinates of points |
| `dxf_points` | Points of a drawing from the layers of a DXF file |
| `element` | Cranks, dyads, gears, cables, joints and bars |
| `guide_faults` | What is wrong with guides and gears |
| `mechanism` | All elements by name |
| `mobility` | How many independent motions a mechanism has by the count of its links and pairs |
| `path_points` | Points of a path in their order, with crank angles or without |
| `structure` | The structure of a mechanism |
| `topology` | Names in a mechanism: what refers to what, in which order it is built |
"""
