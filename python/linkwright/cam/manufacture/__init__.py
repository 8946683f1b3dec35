"""Drawings and tables for manufacture.

| module | |
| --- | --- |
| `arcs` | A closed curve as arcs or chords, division with equal errors |
| `curve` | The closed curve of a cam, and points on it by arc length |
| `deviation` | The largest distance between a path and the curve, both ways |
| `drawing` | Drawings of a cam: outlines, marks and notes |
| `dxf` | Drawings as DXF (AutoCAD 2010), in millimetres |
| `fit` | Any of these forms within a tolerance |
| `outline` | Outlines of arcs and chords, and the geometry of their sides |
| `spline` | A closed curve as a B-spline |
| `step` | The cam as a solid in a STEP file (AP214, millimetres) |
| `svg` | Drawings as SVG at true scale: one unit is a millimetre, on paper too |
| `table` | Tables of an outline |
| `write` | Write a drawing, read it back, compare it with the profile |
"""
