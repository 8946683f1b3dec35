"""How the vibration of a train follows the numbers of its file.

| module | |
| --- | --- |
| `train` | Derivatives of inertias, stiffnesses and dampings by entries |
| `torques` | Derivatives of the torques that act on a train, and of couplings under their mean |
| `distributed` | Derivatives of the dynamic stiffness where inertia is distributed |
| `distributed_modes` | Derivatives of the modes of such a train |
| `modes` | Derivatives of natural frequencies and mode shapes |
| `mean_torques` | Derivatives of the mean torques of shafts |
| `joints` | Derivatives of what Hooke's joints do |
| `shaft_torques` | Derivatives of the torque of a shaft at each order |
| `forced` | Derivatives of the torques that shafts carry in forced vibration |
"""
