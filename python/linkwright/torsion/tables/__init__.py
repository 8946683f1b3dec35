"""Tables of trains.

| module | |
| --- | --- |
| `damper` | Table of a damper for a mode of a train, and the damper as it stands in a machine file |
| `diagnosis` | Table of the cylinders of an engine, and a sentence on the weak ones |
| `torsion` | Tables of the torsional vibration of a train |
"""
