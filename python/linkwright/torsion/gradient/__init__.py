"""How the vibration of a train follows the numbers of its file.

| module | |
| --- | --- |
| `train` | Derivatives of inertias, stiffnesses and dampings by entries |
| `torques` | Derivatives of the torques that act on a train, and of couplings under their mean |
| `modes` | Derivatives of natural frequencies and mode shapes |
| `forced` | Derivatives of the torques that shafts carry in forced vibration |
"""
