"""Figures of drives.

| module | |
| --- | --- |
| `captions` | The figures of a drive with their captions |
| `compare` | Steady motion of several machines in one picture |
| `in_time` | Speed and acceleration of a motion in time, with their extremes |
| `motor` | The motor's characteristic, and the part of it that steady motion uses |
| `reduction` | Reduced inertia and torque over one revolution |
| `run_up` | Speed from the start to steady motion |
| `steady` | Speed, acceleration, torque and power over one revolution and over time |
"""
