"""Machines for programs of multibody dynamics and robotics: a tree of bodies, and the loops that close it.

| module | |
| --- | --- |
| `commands` | ``linkwright export`` |
| `export` | A machine as MJCF or URDF: what is written, and what it stands on |
| `linear_laws` | Motor and loads as forces with a linear law |
| `mjcf_file` | A machine as MJCF, with loops closed by constraints |
| `numbers` | Numbers and elements of XML |
| `refusals` | What such programs cannot do |
| `tables` | An export as tables of text |
| `transmission` | Positions of the joints of the tree over the crank angle |
| `tree` | Bodies, the tree of their joints, and what is left to close |
| `urdf_file` | The tree as URDF |
"""

from linkwright import exports

__getattr__ = exports(globals())
