"""Sizes and grades of sucker rods, as API prints them.

References
----------
.. [1] API RP 11L, Recommended Practice for Design Calculations for Sucker Rod Pumping Systems, table 4.1:
weights of
   rods in air with couplings [lb/ft].
.. [2] API Spec 11B, Specification for Sucker Rods: minimum tensile strength by grade [psi].
"""

from __future__ import annotations

from collections.abc import Mapping

from linkwright.kernel.units.marks import Bound
from linkwright.pumping.model.unit import INCH

POUND, FOOT, PSI = 0.45359237, 0.3048, 6894.757293168361

# Diameter [m] and mass per length with couplings [kg/m] by nominal size [in].
RODS: Mapping[str, tuple[float, float]] = {
    size: (inches * INCH, pounds * POUND / FOOT)
    for size, inches, pounds in (
        ("1/2", 0.5, 0.726),
        ("5/8", 0.625, 1.135),
        ("3/4", 0.75, 1.634),
        ("7/8", 0.875, 2.224),
        ("1", 1.0, 2.904),
        ("1 1/8", 1.125, 3.676),
    )
}

# Minimum tensile strength T [Pa].
GRADES: Mapping[str, float] = {"C": 90_000 * PSI, "K": 90_000 * PSI, "D": 115_000 * PSI}

# Density of steel of 490 lb/ft³, by which API's 0.128 is 62.4/490 [kg/m³].
STEEL_DENSITY = 1000.0 / 0.128

# Modulus of elasticity of steel rods: Gibbs and API RP 11L [Pa].
STEEL = 30.5e6 * PSI


def within(low: float, high: float, unit: str = "") -> Bound:
    """Limits that no pumping installation comes near to: numbers beyond them are in another unit."""
    words = f" from {low:g} to {high:g}{unit and ' '}{unit},"
    return Bound(words, {"minimum": low, "maximum": high}, lambda value: low <= value <= high)
