"""Servo axes: drivers with laws and motors of their own.

| module | |
| --- | --- |
| `analyses` | The analyses |
| `axis` | A servo axis over the cycle: motion and torque of its driver, duty of its motor |
| `bus` | The DC bus of all axes, and the balance of power over all drivers |
| `choice` | Every motor of a catalogue with every gearbox, and why pairs are refused |
| `clearance` | Distance of points of two axes, and the shift that keeps a wanted one |
| `commands` | `linkwright axes` |
| `cycle` | Forces along the motion of the master, piece by piece |
| `driver_cycle` | Speed and torque at a driver over a cycle, piece by piece, and means over time |
| `duty` | What an axis asks of its motor over the cycle, and whether the motor stands it |
| `export/` | Laws as cam tables of motion controllers, read back and compared |
| `feasibility` | Accelerating factor and load factor: which ratios are feasible for a motor |
| `gradient` | Derivatives of axes and their DC bus by entries of the machine |
| `figures` | Timing diagram, torque over speed, power of the bus |
| `gradient` | Derivatives of axes and bus |
| `inertia` | Inertia at each driver, all others held |
| `study` | Axes in the study of a machine |
| `tables` | A row an axis, checks, bus, timing |
| `timing` | All cams and axes over one revolution of the master |
| `page/` | The choice of motors as tables and chart |
| `model/` | The axis, its motor and gearbox in the machine file |
"""
