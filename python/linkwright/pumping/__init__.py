"""Beam pumping units and the rotator of the sucker-rod string.

| module | |
| --- | --- |
| `analyses` | Its analyses, as study, report, studio, studies and derivatives read them |
| `warnings` | What the user of a pumping unit or of a rotator should know although it runs |
| `check` | What can be seen without solving, and what a machine consists of |
| `figures` | Figures of pumping units and rod rotators |
| `gear_gradient` | Derivatives of peaks, means and work of the gearbox, and of its counterbalance |
| `gear_torque` | Torque of the gearbox of a pumping unit: polished-rod load and counterbalance |
| `gradient` | Derivatives of stroke and torque factors by the dimensions of the unit |
| `lever` | Link and lever of a rotator as functions of the crank angle, and what the lever gives the worm |
| `model/` | Pumping units and rotators in a machine file; the mechanism that they are |
| `rod_rotator` | The rotator of a sucker-rod string |
| `rotator_gradient` | Derivatives of lengths, swing, transfer functions and forces of a rotator |
| `tables` | Results of pumping units and of rotators as tables of text |
| `unit` | Beam pumping units |
"""
