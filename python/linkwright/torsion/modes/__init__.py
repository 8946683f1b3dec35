"""Free vibration: frequencies, mode shapes, damping, the Campbell diagram, equivalent schemes.

| module | |
| --- | --- |
| `campbell` | Campbell's diagram of a train: natural frequencies over the speed, and where orders meet them |
| `check` | What can be seen without solving, and what a machine consists of |
| `damped` | Free vibration of a train with damping: how fast each mode dies out |
| `free` | Natural frequencies, mode shapes, nodes, energy, and what changes them |
| `holzer` | What a train needs to swing at any frequency |
| `modes_over_speed` | Modes of a train at any speed |
| `phase_vectors` | Phase vectors of the orders at the modes: star diagrams and vector sums |
| `scheme` | Inertias, stiffnesses and equivalent lengths, own and referred |
"""
