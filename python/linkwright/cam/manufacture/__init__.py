"""Drawings and tables for manufacture.

| module | |
| --- | --- |
| `arcs` | A curve as circular arcs and lines that meet without kinks |
| `cam` | The drawings of a cam: one for each part that is made |
| `curve` | What is to be manufactured: a closed curve over the cam angle, its smooth stretches |
| `deviation` | The largest distance between a path and the curve, both ways |
| `drawing` | What is drawn of a cam, and what was measured of a written file |
| `dxf` | Drawings as DXF (AutoCAD 2010), in millimetres |
| `fit` | Any of these forms within a tolerance |
| `file_outline` | An outline as a file holds it |
| `hermite` | The B-spline of a curve, from Hermite pieces over the cam angle |
| `mesh` | Where to cut a stretch so that few pieces keep a tolerance |
| `outline` | A closed outline of arcs and lines, by vertices and bulges as drawings keep it |
| `polyline` | A curve as a polygon with its corners on the curve: a chord of length s errs by κ s²/8 |
| `read_back` | Is in a file what is to be in it? |
| `sides` | Arcs and lines by start, chord and bulge |
| `spline` | A closed B-spline in the plane: degree, knots, control points |
| `step` | The cam as a solid in a STEP file (AP214, millimetres) |
| `svg` | Drawings as SVG at true scale: one unit is a millimetre, on paper too |
| `table` | Tables of an outline |
| `track` | The curve without its standstills; the nearest place on it |
| `write` | Write files that are read back first |
"""
