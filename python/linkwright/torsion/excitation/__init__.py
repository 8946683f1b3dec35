"""What excites a train: its engines, its mechanism, its drivers and loads, as harmonics of torque.

| module | |
| --- | --- |
| `drive_line` | The train of a driveline, and how its mechanism excites it |
| `engine_torques` | Torques of an engine on its throws: gas, inertia, weight; its data |
| `excited_train` | A train made ready for forced vibration: its torques, and what it is at each speed |
| `harmonics` | Torques on discs as harmonics, and what harmonics add up to in phase |
| `mounted` | Torques of the mechanisms on a train |
"""
