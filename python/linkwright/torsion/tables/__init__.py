"""Tables of trains.

| module | |
| --- | --- |
| `engine` | Tables of an engine, of its cylinders, of a damper for its train |
| `limits` | Limits in normal firing, with a misfire, in the manoeuvre |
| `manoeuvre` | A manoeuvre: ice, torques of shafts and gear stages |
| `orders` | Every order over the speed, and the curves of a manoeuvre |
| `system` | Masses and stiffnesses; gear stages: torque, application factor, tooth contact |
| `torsion` | Tables of the torsional vibration of a train |
"""
