r"""Fatigue of a crankshaft by IACS UR M53: what is asked of the file, and the fatigue strength.

With σ_B in N/mm² and lengths in mm,

.. math:: \sigma_{DW} = K (0.42\,\sigma_B + 39.3) \left[ 0.264 + 1.073\, D^{-0.2}
    + \frac{785 - \sigma_B}{4900} + \frac{196}{\sigma_B} \sqrt{\frac{1}{R_X}} \right]

D is the diameter of the pin, for the journal fillet that of the journal; R_X the radius of the fillet, of an
oil bore half its diameter.

References
----------
.. [1] IACS, UR M53 Calculation of Crankshafts for I.C. Engines, Rev. 2, 2011: M53.3 geometry, M53.4
   additional bending stresses, M53.6 fatigue strength.
.. [2] Indian Register of Shipping, Classification Notes: Calculation of Crankshafts for Internal Combustion
   Engines, 2012, section 6: the same fatigue strength.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, fault
from linkwright.kernel.units.kinds import LENGTH, PRESSURE
from linkwright.kernel.units.marks import Angle, not_negative, positive
from linkwright.linkages.model.element import PositiveLength
from linkwright.torsion.model.engine.crank_concentration import ThrowRatios
from linkwright.torsion.model.engine.throw import CrankThrow

Forging = Literal["free_form", "grain_flow", "cast_rolled"]

# K of M53.6: free form forged; forged with continuous grain flow; cast steel with cold rolled fillets.
_FORGING: dict[Forging, float] = {"free_form": 1.0, "grain_flow": 1.05, "cast_rolled": 0.93}

# Additional bending of trunk piston engines, by misalignment and axial vibration [Pa]: M53.4.
_ADDITIONAL = 10e6

_MPA, _MM = 1e6, 1e-3


class CrankFatigue(CheckedDescription):
    """Fillets, oil bores and steel of a crankshaft, for its fatigue by IACS UR M53."""

    tensile_strength: Annotated[float, positive(PRESSURE)] = Field(
        description="Specified tensile strength σ_B of the steel."
    )
    forging: Forging = Field(
        "free_form",
        description='Manufacture: free-form forged; "grain_flow": continuous grain flow or drop-forged; '
        '"cast_rolled": cast steel with cold-rolled fillets.',
    )
    pin_fillet: PositiveLength = Field(description="Radius R_H of the fillets of the crank pin.")
    journal_fillet: PositiveLength = Field(description="Radius R_G of the fillets of the main journal.")
    pin_recess: Annotated[float, not_negative(LENGTH)] = Field(
        0.0, description="Recess T_H of the pin fillet."
    )
    journal_recess: Annotated[float, not_negative(LENGTH)] = Field(
        0.0, description="Recess T_G of the journal fillet."
    )
    web_thickness: PositiveLength | None = Field(
        None, description="Thickness W of the solid web. Default: that of the throw."
    )
    web_width: PositiveLength | None = Field(
        None, description="Width B of the web. Default: that of the throw."
    )
    oil_bore: PositiveLength | None = Field(
        None, description="Diameter D_O of the oil bore of the pin, in the middle of each rod."
    )
    oil_bore_angle: Angle = Field(
        0.0, description="Angle ψ of the outlet of the oil bore: 0 across the crank, 90 deg along it."
    )
    additional_bending: Annotated[float, not_negative(PRESSURE)] = Field(
        _ADDITIONAL,
        description="Additional bending stress σ_add by misalignment, deformation of the bedplate and "
        "axial vibration; 30 N/mm² for crosshead engines.",
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.tensile_strength < 1e8:
            expected = 'the strength of a steel, such as "700 MPa"'
            yield fault("tensile_strength", found=self.tensile_strength, expected=expected)

    def web(self, throw: CrankThrow) -> tuple[float, float]:
        """Thickness W and width B of the web [m]."""
        thickness = self.web_thickness or throw.web.thickness
        return thickness, self.web_width or throw.web.breadth

    def ratios(self, throw: CrankThrow) -> ThrowRatios:
        """Sizes of a throw over the diameter of its pin."""
        D, D_G = throw.pin.diameter, throw.journal.diameter
        thickness, width = self.web(throw)
        return ThrowRatios(
            s=((D + D_G) / 2 - throw.radius) / D,
            w=thickness / D,
            b=width / D,
            r=self.pin_fillet / D,
            r_G=self.journal_fillet / D,
            r_T=self.journal_fillet / D_G,
            d_G=throw.journal.inner_diameter / D,
            d_H=throw.pin.inner_diameter / D,
            t=(self.pin_recess + self.journal_recess) / D,
            d_O=None if self.oil_bore is None else self.oil_bore / D,
        )

    def strength(self, diameter: float, radius: float) -> float:
        """σ_DW, fatigue strength [Pa]; pin or journal diameter [m]; R_X of the fillet or bore radius [m]."""
        tensile = self.tensile_strength / _MPA
        size = 0.264 + 1.073 * (diameter / _MM) ** -0.2 + (785 - tensile) / 4900
        notch = 196 / tensile * math.sqrt(1 / (radius / _MM))
        return float(_FORGING[self.forging] * (0.42 * tensile + 39.3) * (size + notch) * _MPA)
