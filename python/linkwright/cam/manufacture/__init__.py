"""Drawings and tables for manufacture.

| module | |
| --- | --- |
| `arcs` | A closed curve as arcs or chords, division with equal errors |
| `curve` | The closed curve of a cam, and points on it by arc length |
| `fit` | A curve as arcs, spline or polygon within a tolerance; the distance of the two, measured both ways |
| `drawing` | Drawings of a cam: outlines, marks and notes |
| `dxf` | Drawings as DXF (AutoCAD 2010), in millimetres |
| `fit` | A curve as arcs, spline or polygon within a tolerance; the distance of the two, measured both ways |
| `outline` | Outlines of arcs and chords, and the geometry of their sides |
| `spline` | A closed curve as a B-spline |
| `step` | The cam as a solid in a STEP file (AP214, millimetres) |
| `svg` | Drawings as SVG at true scale: one unit is a millimetre, on paper too |
| `table` | Tables of an outline |
| `write` | Write a drawing, read it back, compare it with the profile |
"""
