"""Toppers, fields and limits of a knife in a machine file.

| module | |
| --- | --- |
| `field` | The roots of a field that a topper goes over |
| `scatter` | Lengths that scatter from one piece to the next |
| `topper` | The topper in a file: heads, knife, limits |
"""
