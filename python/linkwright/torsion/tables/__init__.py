"""Tables of trains.

| module | |
| --- | --- |
| `engine` | Tables of an engine, of its cylinders, of a damper for its train |
| `orders` | Every order over the speed, and the curves of a manoeuvre |
| `torsion` | Tables of the torsional vibration of a train |
"""
