r"""Damping of the modes of a train as a whole: ratios ζ, measured or assumed, whatever damps.

.. math:: \ddot p_k + 2\zeta_k\omega_k\,\dot p_k + \omega_k^2 p_k = \Phi_k^T M

References
----------
.. [1] Clough and Penzien, Dynamics of Structures, 2nd ed. 1993, section 12-4: damping of given
   modal ratios.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, fault
from linkwright.kernel.units import RATIO, Quantity, QuantityList

_BELOW = "a ratio from 0 to below 1, as a mode that vibrates has"


class ModalDamping(CheckedDescription):
    """Damping ratios of the modes of vibration, in addition to what damps single parts."""

    ratios: Annotated[tuple[float, ...], QuantityList(RATIO)] = Field(
        (), description="ζ of the modes of vibration by frequency, from the lowest above zero."
    )
    others: Annotated[float, Quantity(RATIO)] = Field(0.0, description="ζ of all further modes.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        for n, ratio in enumerate(self.ratios):
            if not 0 <= ratio < 1:
                yield fault("ratios", n, found=ratio, expected=_BELOW)
        if not 0 <= self.others < 1:
            yield fault("others", found=self.others, expected=_BELOW)
        if not self.ratios and not self.others:
            remedy = 'give the same for all modes as others = "1 %"'
            yield fault(expected="ratios of some modes", remedy=remedy)
