"""Free vibration: frequencies, mode shapes, damping, the Campbell diagram, equivalent schemes.

| module | |
| --- | --- |
| `campbell` | Critical speeds and how severe they are |
| `damped` | Modes with damping, and what damps them |
| `damped_modes` | Modes with damping, and what damps them |
| `free` | Natural frequencies, mode shapes, nodes, energy, and what changes them |
| `holzer` | What a train needs to swing at any frequency |
| `modes_over_speed` | Critical speeds and how severe they are |
| `resonance` | What is asked, at which speeds, and where it is not kept |
| `scheme` | Inertias, stiffnesses and equivalent lengths, own and referred |
"""
