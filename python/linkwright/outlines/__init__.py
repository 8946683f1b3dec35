"""Outlines of links: a drawing gives the mass, the centre and the moment of inertia of a plate.

| module | |
| --- | --- |
| `analyses` | The comparison of drawn plates with their links |
| `commands` | ``linkwright outline`` |
| `figures` | The outline with its joints and its centre |
| `joints` | Whether drawing and link have joints of one distance |
| `model/` | Curves of a DXF file, closed outlines with holes, their area and moments |
| `plate` | Area, mass, centre and moment of inertia of a plate |
| `solid` | The plate as STEP |
| `tables` | Properties as tables, and as lines of a machine file |
"""

from linkwright import exports

__getattr__ = exports(globals())
