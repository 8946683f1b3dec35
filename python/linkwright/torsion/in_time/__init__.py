"""Manoeuvres of trains, followed in time.

| module | |
| --- | --- |
| `engaged_start` | Steady start of a train with engaged clutches: what holds turns as one |
| `friction_parts` | Clutches, brakes and freewheels as elements with dry friction |
| `ice_impacts` | Ice at a propeller: pulses over its angle |
| `moving_drive` | A driveline that moves in time |
| `moving_parts` | Stages, joints, pendulums and speed controllers of a train in motion |
| `moving_train` | A train of a machine file, with its engine, made ready to move in time |
| `peak_judgement` | Whether shafts and couplings bear a manoeuvre |
| `stage_torque` | Torque in the gear stages over time |
| `steady_start` | A running train starts as in steady running: mean torques balance, shafts carry them |
| `transient` | Motion of a train in time |
| `waterfall` | Amplitudes over speed and order |
"""
