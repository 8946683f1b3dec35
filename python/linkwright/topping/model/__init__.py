"""Toppers, fields and limits of a knife in a machine file.

| module | |
| --- | --- |
| `field` | The roots of a field that a topper goes over |
| `limits` | What a knife of a topper shall reach, and the bounds within which the best is sought |
| `motion` | How the knife of a topper is moved back and forth across the row |
| `scatter` | Lengths that scatter from one piece to the next |
| `topper` | The topper of a root-crop harvester |
"""
