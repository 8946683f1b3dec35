"""Drawings and tables for manufacture.

| module | holds |
| --- | --- |
| `curve` | what is to be manufactured: a closed curve over the cam angle, its smooth stretches |
| `track` | the curve without its standstills; the nearest place on it |
| `mesh` | where to cut a stretch so that few pieces keep a tolerance |
| `sides`, `outline` | arcs and lines; a closed outline of them |
| `arcs`, `polyline` | the curve approximated by arcs without kinks, by chords |
| `spline`, `hermite` | a B-spline; the curve approximated by one |
| `deviation` | the largest distance between a path and the curve, both ways |
| `fit` | any of these forms within a tolerance |
| `drawing`, `cam` | outlines on layers; those of a cam |
| `dxf`, `svg`, `table`, `step` | write a format, and read it |
| `read_back` | is in a file what is to be in it? |
| `write` | write files that are read back first |
"""
