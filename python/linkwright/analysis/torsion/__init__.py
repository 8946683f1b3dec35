"""Torsional vibration of trains.

| module | answers |
| --- | --- |
| `free` | natural frequencies, mode shapes, nodes, energy, and what changes them |
| `drive_line` | the train of a drive line, and how its mechanism excites it |
| `holzer` | what a train needs to swing at any frequency |
"""
