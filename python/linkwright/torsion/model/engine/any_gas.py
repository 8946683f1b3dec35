"""The gas in the cylinders of an engine: measured or calculated.

| kind | is | module |
| --- | --- | --- |
| `table` | measured indicator diagrams | `indicator` |
| `wiebe` | a cycle by Wiebe's function | `combustion` |

Both follow a load map (`gas_load`) and give a `CyclePressure` for a `Cylinder`; `gas_torque` makes harmonics
of it.
"""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from linkwright.torsion.model.engine.combustion import Combustion
from linkwright.torsion.model.engine.indicator import Indicator

AnyGas = Annotated[Indicator | Combustion, Field(discriminator="kind")]
