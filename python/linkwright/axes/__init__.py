"""Servo axes: drivers with laws and motors of their own.

| module | |
| --- | --- |
| `choice` | Every motor of a catalogue with every gearbox, and why pairs are refused |
| `duty` | What an axis asks of its motor over the cycle, and whether the motor stands it |
| `feasibility` | Accelerating factor and load factor: which ratios are feasible for a motor |
| `model/` | The axis, its motor and gearbox in the machine file |
"""
