"""Loads on single links, for their stress analysis.

| module | |
| --- | --- |
| `bending` | Bending moment of a link as a straight beam between its joints |
| `commands` | ``linkwright loads`` |
| `figures` | Forces at the joints and bending moment over the crank angle |
| `loads` | All loads on a link in its own axes |
| `mesh` | Centres of the elements of a mesh |
| `result` | What is known about the loads on a link |
| `steps` | Steps of CalculiX and Abaqus |
| `tables` | Loads on links as tables of text |
"""

from linkwright import exports

__getattr__ = exports(globals())
