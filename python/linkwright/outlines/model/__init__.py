"""From the curves of a DXF file to the section of a link.

| module | |
| --- | --- |
| `curves` | Lines, arcs and splines of a drawing |
| `entities` | Curves of a DXF file |
| `loops` | Closed outlines, and their integrals by Green's theorem |
| `region` | One outline with its holes |
| `section` | The section of a link in its axes; plates of a machine file |
"""
