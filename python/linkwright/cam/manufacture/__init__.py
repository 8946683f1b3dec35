"""Drawings and tables for manufacture.

| module | |
| --- | --- |
| `arcs` | The curve approximated by arcs without kinks, by chords |
| `cam` | Outlines on layers; those of a cam |
| `curve` | What is to be manufactured: a closed curve over the cam angle, its smooth stretches |
| `deviation` | The largest distance between a path and the curve, both ways |
| `drawing` | Outlines on layers; those of a cam |
| `dxf` | Write a format, and read it |
| `fit` | Any of these forms within a tolerance |
| `found` | An outline as it was found in a file |
| `hermite` | A B-spline; the curve approximated by one |
| `mesh` | Where to cut a stretch so that few pieces keep a tolerance |
| `outline` | Arcs and lines; a closed outline of them |
| `polyline` | The curve approximated by arcs without kinks, by chords |
| `read_back` | Is in a file what is to be in it? |
| `sides` | Arcs and lines; a closed outline of them |
| `spline` | A B-spline; the curve approximated by one |
| `step` | Write a format, and read it |
| `svg` | Write a format, and read it |
| `table` | Write a format, and read it |
| `track` | The curve without its standstills; the nearest place on it |
| `write` | Write files that are read back first |
"""
