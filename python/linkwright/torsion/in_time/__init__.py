"""Manoeuvres of trains, followed in time.

| module | |
| --- | --- |
| `balanced_start` | A running train starts as in steady running: its mean torques balance |
| `loaded_start` | Motion in time |
| `moving_drive` | Motion in time |
| `moving_engine` | Motion in time |
| `moving_train` | Motion in time |
| `transient` | Motion in time |
| `waterfall` | Amplitudes over speed and order |
"""
