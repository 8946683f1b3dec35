r"""Wiebe's function: how much of the heat is released at a crank angle.

.. math:: x = \frac{1 - e^{-a y^{m+1}}}{1 - e^{-a}}, \qquad y = \frac{φ - φ_0}{Δφ}

The denominator, 0.999 for the usual a = 6.908, makes the release complete at the end.

References
----------
.. [1] Wiebe, Brennverlauf und Kreisprozess von Verbrennungsmotoren, 1970.
.. [2] Heywood, Internal Combustion Engine Fundamentals, 1988, equation (9.30): a efficiency factor, m form
factor.
.. [3] Miyamoto et al., SAE 850107: two functions for Diesel engines.
"""

from __future__ import annotations

import math
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from linkwright.kernel.description.base import Description
from linkwright.kernel.units import ANGLE, FRACTION, RATIO, Angle, Quantity, not_negative, positive

Array = NDArray[np.float64]

# Of the heat, 99.9 % is released within the duration: -ln 0.001.
_COMPLETE = -math.log(0.001)


class Wiebe(Description):
    """One release of heat."""

    start: Angle = Field(description="Crank angle from the top dead centre of firing; negative before it.")
    duration: Annotated[float, positive(ANGLE)] = Field(description="Crank angle to the end of the release.")
    form_factor: Annotated[float, not_negative(RATIO)] = Field(
        2.0, description="m: 2 for spark ignition, 0.5 to 1 for Diesel engines, 0 for an abrupt start."
    )
    efficiency_factor: Annotated[float, positive(RATIO)] = Field(
        _COMPLETE, description="a: the usual 6.908 leaves a thousandth at the end."
    )
    share: Annotated[float, Quantity(RATIO, FRACTION)] = Field(
        1.0, description="Of the heat; the shares of all releases make 1."
    )

    @property
    def end(self) -> float:
        """Crank angle at which all is released [rad]."""
        return self.start + self.duration

    def released(self, angle: Array) -> Array:
        """Share of the whole heat that is released, shape (m,). `angle`: (m,) crank angles [rad]."""
        a, y = self.efficiency_factor, self._progress(angle)
        return np.asarray(self.share * np.expm1(-a * y ** (self.form_factor + 1)) / math.expm1(-a))

    def rate(self, angle: Array) -> Array:
        """Its derivative by the crank angle, shape (m,) [1/rad]. `angle`: (m,) crank angles [rad]."""
        a, m, y = self.efficiency_factor, self.form_factor, self._progress(angle)
        inside = (angle >= self.start) & (angle <= self.end)
        scale = self.share * a * (m + 1) / (-math.expm1(-a) * self.duration)
        return np.asarray(inside * scale * y**m * np.exp(-a * y ** (m + 1)))

    def _progress(self, angle: Array) -> Array:
        """y, held before the start and after the end."""
        return np.clip((angle - self.start) / self.duration, 0.0, 1.0)
