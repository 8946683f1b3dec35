"""Trains in the terms of the core.

| module | |
| --- | --- |
| `distributed` | Trains with shafts of distributed inertia at any frequency |
| `response` | Forced vibration of a train: amplitudes at every order and speed, and what they add up to |
| `rod` | Such shafts: dynamic stiffness, counting of frequencies, energies |
| `torque` | Torques on the discs of a train from outside, a motor among them, for its motion in time |
| `train` | A train in the core's terms: referred to one speed, discs behind rigid gears taken together |
| `transient` | A train in motion: discs, shafts and torques, and how they cross the border |
"""
