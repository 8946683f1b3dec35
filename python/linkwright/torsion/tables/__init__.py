"""Tables of trains.

| module | |
| --- | --- |
| `engine` | Tables of an engine, of its cylinders, of a damper for its train |
| `torsion` | Tables of the torsional vibration of a train |
"""
