"""Beam pumping units and the rotator of the sucker-rod string.

| module | |
| --- | --- |
| `cautions` | What the user of a pumping unit or of a rotator should know although it runs |
| `figures/` | Figures of pumping units and rotators |
| `gear_torque` | How does the polished rod move, and what does its gearbox carry? |
| `lever` | How does the lever turn the rod string? |
| `model/` | Pumping units and rotators in a machine file; the mechanism that they are |
| `rod_rotator` | How does the lever turn the rod string? |
| `tables` | Results of pumping units and of rotators as tables of text |
| `template` | Machine files of the pumping units of the catalogue |
| `unit` | How does the polished rod move, and what does its gearbox carry? |
"""
