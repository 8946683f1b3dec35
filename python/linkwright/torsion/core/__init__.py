"""Trains in the terms of the core.

| module | |
| --- | --- |
| `encoding` | The lists in which a train in motion crosses the border |
| `motor` | Torque of a motor over its speed, for a train that moves in time |
| `response` | Forced vibration of a train: amplitudes at every order and speed, and what they add up to |
| `torque` | Torques on the discs of a train from outside, for its motion in time |
| `train` | A train in the core's terms: referred to one speed, discs behind rigid gears taken together |
| `transient` | A train in motion in the core's terms |
"""
