"""Manoeuvres of trains, followed in time.

| module | |
| --- | --- |
| `moving_drive` | A driveline that moves in time |
| `moving_train` | A train of a machine file, with its engine, made ready to move in time |
| `steady_start` | A running train starts as in steady running: mean torques balance, shafts carry them |
| `transient` | Motion of a train in time |
| `waterfall` | Amplitudes over speed and order |
"""
