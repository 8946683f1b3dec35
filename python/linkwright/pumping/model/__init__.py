"""Pumping units and rotators in a machine file; the mechanism that they are.

| module | |
| --- | --- |
| `expansion` | The mechanism that a pumping unit is, with its rotator: elements like any other |
| `polished_rod_load` | The load on the polished rod of a pumping unit, and what balances it |
| `rod_rotator` | The worm-type rotator of a sucker-rod string |
| `rotator_lengths` | Link and lever of a rotator, given or made for the unit and the regime |
| `unit` | Beam pumping units, described by the letters of API Spec 11E |
| `unit_catalogue` | Published pumping units |
| `unit_file` | Pumping units of a maker from a file of comma-separated values |
"""
