"""Servo axes in the machine file.

| module | |
| --- | --- |
| `axis_catalogue` | Servo motors and gearboxes from files |
| `axis_gearbox` | Ratio, losses and permitted torques of a gearbox |
| `servo_motor` | Inertia, continuous and peak torque over the speed |
"""
