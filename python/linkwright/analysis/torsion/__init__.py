"""Torsional vibration of trains.

| module | answers |
| --- | --- |
| `free` | natural frequencies, mode shapes, nodes, energy, and what changes them |
| `holzer` | what a train needs to swing at any frequency |
"""
