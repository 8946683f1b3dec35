"""Torsional vibration of trains.

| module | answers |
| --- | --- |
| `free` | natural frequencies, mode shapes, nodes, energy, and what changes them |
| `drive_line` | the train of a drive line, and how its mechanism excites it |
| `scheme` | inertias, stiffnesses and equivalent lengths, own and referred |
| `damper_rules`, `damper_design`, `ring_on_train` | the best damper: for one mass, a mode, a train |
| `holzer` | what a train needs to swing at any frequency |
"""
