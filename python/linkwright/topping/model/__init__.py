"""Toppers, fields and limits of a knife in a machine file.

| module | |
| --- | --- |
| `field` | Roots of a field, lengths that scatter; limits of a knife |
| `limits` | Roots of a field, lengths that scatter; limits of a knife |
| `motion` | Knives of root-crop toppers, and how they move |
| `scatter` | Roots of a field, lengths that scatter; limits of a knife |
| `topper` | Knives of root-crop toppers, and how they move |
"""
