"""How the vibration of a train follows the numbers of its file.

| module | |
| --- | --- |
| `train` | Derivatives of inertias, stiffnesses and dampings by entries |
| `modes` | Derivatives of natural frequencies and mode shapes |
| `forced` | Derivatives of the torques that shafts carry in forced vibration |
"""
