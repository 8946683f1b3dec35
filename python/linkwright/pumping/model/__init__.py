"""Pumping units and rotators in a machine file; the mechanism that they are.

| module | |
| --- | --- |
| `expansion` | The mechanism that a pumping unit is, with its rotator: elements like any other |
| `polished_rod_load` | Beam pumping units, and the rotator of the rod string |
| `rod_rotator` | Beam pumping units, and the rotator of the rod string |
| `rotator_lengths` | Link and lever of a rod rotator, made for its unit and its regime |
| `unit` | Beam pumping units, and the rotator of the rod string |
| `unit_catalogue` | Published pumping units |
"""
