"""Manoeuvres of trains, followed in time.

| module | |
| --- | --- |
| `balanced_start` | A running train starts as in steady running: its mean torques balance |
| `loaded_start` | Angles with which a train starts as if it had run steadily before |
| `moving_drive` | A driveline that moves in time |
| `moving_engine` | An engine in motion: the inertia of its throws over the angle, torques of gas and weight |
| `moving_train` | A train of a machine file made ready to move in time |
| `transient` | Motion of a train in time |
| `waterfall` | Amplitudes over speed and order |
"""
