r"""A shaft or coupling of a drive: linear, by a torque curve, with backlash.

With the backlash b from flank to flank and the spring S, straight or by a curve,

.. math:: T = S + D, \qquad S = S(|\Delta| - b/2)\,\mathrm{sign}\,\Delta, \qquad
    D = c\,\dot\Delta \text{ within } \pm|S|

T is zero between the flanks, has the sign of S in contact, and is continuous [1]_.

References
----------
.. [1] Modelica Standard Library 4.0, Modelica.Mechanics.Rotational.Components.ElastoBacklash.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import fault
from linkwright.kernel.units.kinds import ANGLE
from linkwright.kernel.units.marks import Angles, Torques, not_negative
from linkwright.torsion.model.coupling import rising_curve, torque_curve_faults
from linkwright.torsion.model.train import ElasticShaft, Shaft

_ONE = "one of stiffness, sections, or twist and torque"


class DriveShaft(ElasticShaft):
    """A flexible shaft or coupling of a drive."""

    twist: Angles | None = Field(
        None,
        description="Angles of twist of a torque curve from 0, instead of the stiffness; the curve is odd.",
    )
    torque: Torques | None = Field(None, description="Torque at each angle of twist, from 0.")
    backlash: Annotated[float, not_negative(ANGLE)] = Field(
        0.0,
        description="Backlash from flank to flank; the curve begins at the flank, and damping acts in "
        "contact only.",
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.twist is None and self.torque is None:
            yield from super()._faults()
            return
        if self.stiffness is not None or self.sections is not None:
            yield fault(found="both", expected=_ONE)
        yield from torque_curve_faults(self)
        limit = self.limit
        if limit is not None and limit.needs_section and not limit.has_section:
            yield fault("limit", "diameter", expected="the diameter where the stress counts")

    @property
    def rate(self) -> float:
        """Torque per twist; of a curve, its slope at rest [N m/rad]."""
        if self.twist is None:
            return super().rate
        rate: float = self.points[2][0]
        return rate

    @property
    def points(self) -> tuple[Floats, Floats, Floats]:
        """Twists, torques and slopes at the points of its curve."""
        return rising_curve(self.twist, self.torque)


class LooseShaft(DriveShaft, Shaft):
    """A shaft of a drive between two discs of its train."""
