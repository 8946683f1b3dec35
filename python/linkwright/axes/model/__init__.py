"""Servo axes in the machine file.

| module | |
| --- | --- |
| `axis_catalogue` | Servo motors and gearboxes from files |
| `axis` | Master and axis |
| `axis_faults` | What is wrong with axes: drivers, sections, cycle |
| `axis_gearbox` | Ratio, losses and permitted torques of a gearbox |
| `follower` | The driver that follows the law of an axis |
| `servo_motor` | Inertia, continuous and peak torque over the speed |
"""
