r"""Sections of a shaft: cylinders, tapers, flanges, hubs, splines; keyways, fillets of steps.

A section twists under a torque $M$ by $e M$. Its *flexibility* is that without the material,

.. math:: e = \frac{1}{G} \int \frac{dx}{I_p}, \qquad I_p = \frac{\pi}{32} (d^4 - d_i^4)

| kind | is | its flexibility |
| --- | --- | --- |
| `cylinder` | a cylindrical length | $L/I_p$ |
| `taper` | a cone, solid or hollow | the integral |
| `flange` | from the shaft out to a circle of bolts | $(1/d^2 - 1/D_b^2)/(\pi L) + 0.1\,d/I_p$ |
| `hub` | a shaft inside a shrunk or keyed hub | a third of $L/I_p$ |
| `spline` | a splined length | $L/I_p$ of a circle 0.22 of the teeth's height above their roots |

The flange is a plate under a torque [1]_, whose middle yields where the shaft enters, by 0.1 d of the solid
shaft; this keeps to the equation of torsion of bodies of revolution within 0.012 d for plates from 0.12 d
to 0.5 d thick. The third of a hub is a rule for fits that slip a little at their edge [2]_; perfectly
bonded, a shaft twists in a hub as 0.15 d do. Splines of 6 to 10 straight teeth have their circle at 0.19 to
0.25 of the height, by Prandtl's membrane equation.

A keyway of width b and depth t takes the part $g = 3.38\,(b/d)^{0.336} (t/d)^{1.34}$ of the solid shaft's
$I_p$, two of them $2g(1 - g/4)$: fitted to Prandtl's membrane equation within 0.4 % of $I_p$, for b/d of
0.1 to 0.4 and t/d of 0.05 to 0.18; with a bore of half the diameter it takes a tenth more.

Sections in a row, and the steps between them, are in `shaft_row`.

References
----------
.. [1] Timoshenko, Goodier, Theory of Elasticity, 3rd ed. 1970: problems in polar coordinates; torsion.
.. [2] API RP 684, tutorial on rotordynamics: torsional modelling. Ker Wilson, Practical Solution of Torsional
    Vibration Problems, vol. 1, 1956, chapter 3.
.. [3] Moore, The Effect of Keyways on the Strength of Shafts, University of Illinois Bulletin 42, 1909.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, fault
from linkwright.kernel.numerics.tangent import total
from linkwright.kernel.units.kinds import DENSITY, LENGTH, PRESSURE, RATIO
from linkwright.kernel.units.marks import FRACTION, Quantity, not_negative, positive
from linkwright.linkages.model.element import PositiveLength
from linkwright.torsion.model.shaft_flexibility import cone_integral, cone_place, polar_moment

Modulus = Annotated[float, positive(PRESSURE)]
Density = Annotated[float, positive(DENSITY)]
Bore = Annotated[float, not_negative(LENGTH)]
Share = Annotated[float, Quantity(RATIO, FRACTION)]

# Share of a shaft's length inside a hub that twists as if it were free [2].
HUB_SHARE = 1 / 3
# Share of the height of a spline's teeth, above their roots, where the circle of equal stiffness is.
_TOOTH_SHARE = 0.22
# Entry of a shaft into a flange, as a length over the diameter.
_ENTRY = 0.1

Kind = Literal["cylinder", "taper", "flange", "hub", "spline"]

# Which further keys each kind asks for, and which it may have.
_KEYS: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "cylinder": ((), ("keyway_width", "keyway_depth", "keyways", "fillet")),
    "taper": (("diameter_end",), ("inner_diameter_end", "fillet")),
    "flange": (("bolt_circle",), ("fillet",)),
    "hub": ((), ("share", "keyway_width", "keyway_depth", "keyways")),
    "spline": (("root_diameter",), ("share",)),
}
_FURTHER = tuple(dict.fromkeys(key for pair in _KEYS.values() for keys in pair for key in keys))


class ShaftSection(CheckedDescription):
    """A length of a shaft: a cylinder, solid or hollow, or another kind."""

    kind: Kind = Field("cylinder", description="Kind of section.")
    length: PositiveLength = Field(
        description="Length of the section; thickness of a flange; engaged length of a hub."
    )
    diameter: PositiveLength = Field(
        description="Outer diameter; of a taper, at its start; of a flange, that of the adjoining shaft; "
        "of a spline, over the teeth."
    )
    inner_diameter: Bore = Field(0.0, description="Diameter of the bore; of a taper, at its start.")
    diameter_end: PositiveLength | None = Field(None, description="Outer diameter at the end of a taper.")
    inner_diameter_end: Bore | None = Field(
        None, description="Diameter of the bore at the end of a taper. Default: that at the start."
    )
    bolt_circle: PositiveLength | None = Field(None, description="Flange: diameter of the bolt circle.")
    root_diameter: PositiveLength | None = Field(
        None, description="Spline: diameter at the root of the teeth."
    )
    share: Share | None = Field(
        None,
        description="Hub or spline: share of the length that twists freely. Default: a third of a hub, "
        "all of a spline.",
    )
    keyway_width: PositiveLength | None = Field(None, description="Width of the keyway, if there is one.")
    keyway_depth: PositiveLength | None = Field(
        None, description="Depth of the keyway in the shaft, from the full circle."
    )
    keyways: Literal[1, 2] | None = Field(
        None, description="Number of keyways; two are opposite. Default: one if a keyway is given."
    )
    fillet: Annotated[float, not_negative(LENGTH)] | None = Field(
        None,
        description="Fillet radius at the step to the next section; 0 for a sharp corner. Default: the "
        "step adds no twist. Flange: fillet radius to its shaft.",
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from self._key_faults()
        for key, bore, outside in self._rings():
            if bore >= outside:
                expected = f"a bore smaller than the diameter, {outside:.6g} m"
                yield fault(key, found=bore, expected=expected)
        yield from self._size_faults()

    def _key_faults(self) -> Iterator[InitErrorDetails]:
        needed, allowed = _KEYS[self.kind]
        for key in _FURTHER:
            value = getattr(self, key)
            if value is None and key in needed:
                yield fault(key, expected=f'a length, which the kind "{self.kind}" needs')
            elif value is not None and key not in (*needed, *allowed):
                kinds = ", ".join(kind for kind, (must, may) in _KEYS.items() if key in (*must, *may))
                expected = f'no such entry for the kind "{self.kind}"'
                yield fault(key, found=value, expected=expected, remedy=f"it belongs to: {kinds}")
        if (self.keyway_width is None) != (self.keyway_depth is None):
            missing = "keyway_width" if self.keyway_width is None else "keyway_depth"
            yield fault(missing, expected="both width and depth of the keyway")

    def _rings(self) -> Iterator[tuple[str, float, float]]:
        outside = self.diameter if self.root_diameter is None else self.root_diameter
        yield "inner_diameter", self.inner_diameter, outside
        if self.diameter_end is not None:
            key = "inner_diameter" if self.inner_diameter_end is None else "inner_diameter_end"
            yield key, self.bores[1], self.diameter_end

    def _size_faults(self) -> Iterator[InitErrorDetails]:
        d = self.diameter
        if self.bolt_circle is not None and self.bolt_circle <= d:
            expected = f"a circle larger than the shaft, {d:.6g} m"
            yield fault("bolt_circle", found=self.bolt_circle, expected=expected)
        elif self.bolt_circle is not None and (self.fillet or 0.0) > min(d / 4, (self.bolt_circle - d) / 2):
            expected = "at most a quarter of the diameter, and what fits between shaft and bolts"
            yield fault("fillet", found=self.fillet, expected=expected)
        if self.root_diameter is not None and self.root_diameter >= d:
            expected = f"less than over the teeth, {d:.6g} m"
            yield fault("root_diameter", found=self.root_diameter, expected=expected)
        if self.keyway_width is not None and self.keyway_width > 0.4 * d:
            expected = f"at most 0.4 of the diameter, {0.4 * d:.6g} m"
            yield fault("keyway_width", found=self.keyway_width, expected=expected)
        deepest = min(0.2 * d, 0.3 * (d - self.inner_diameter))
        if self.keyway_depth is not None and self.keyway_depth > deepest:
            expected = f"at most 0.2 of the diameter and 0.6 of the wall, {deepest:.6g} m"
            yield fault("keyway_depth", found=self.keyway_depth, expected=expected)

    @property
    def diameters(self) -> tuple[float, float]:
        """Outside, where it begins and where it ends [m]; of a spline between its teeth."""
        first = self.diameter if self.root_diameter is None else self.root_diameter
        return first, first if self.diameter_end is None else self.diameter_end

    @property
    def bores(self) -> tuple[float, float]:
        """Of the bore, where it begins and where it ends [m]."""
        end = self.inner_diameter_end
        return self.inner_diameter, self.inner_diameter if end is None else end

    @property
    def _keyway(self) -> tuple[float, float]:
        """Width and depth of the keyway over the diameter; 0 without one."""
        return (self.keyway_width or 0.0) / self.diameter, (self.keyway_depth or 0.0) / self.diameter

    @property
    def _stiff_moment(self) -> float:
        """Polar second moment of the circle or ring of equal stiffness [m⁴]."""
        d, bore = self.diameters[0], self.bores[0]
        if self.kind == "spline":
            return polar_moment(d + _TOOTH_SHARE * (self.diameter - d), bore)
        if self.keyway_width is None:
            return polar_moment(d, bore)
        width, depth = self._keyway
        taken: float = 3.38 * width**0.336 * depth**1.34
        if self.keyways == 2:
            taken *= 2 * (1 - taken / 4)
        return polar_moment(d, bore) - taken * polar_moment(d)

    @property
    def flexibility(self) -> float:
        """Twist per torque, times the shear modulus [1/m³]."""
        if self.kind == "flange":
            assert self.bolt_circle is not None
            plate = (self.diameter**-2 - self.bolt_circle**-2) / (math.pi * self.length)
            corner: float = 0.7 * ((self.fillet or 0.0) / self.diameter) ** 1.3
            return plate + (_ENTRY - corner) * self.diameter / polar_moment(self.diameter)
        if self.kind == "taper":
            return cone_integral(self.length, self.diameters, self.bores)
        share = self.share if self.share is not None else HUB_SHARE if self.kind == "hub" else 1.0
        return share * self.length / self._stiff_moment

    @property
    def section_modulus(self) -> float:
        """Torque per largest shear stress at the weakest place, without stress concentration [m³]."""
        if self.kind == "flange":
            return math.pi / 2 * self.diameter**2 * self.length
        width, depth = self._keyway
        rings = zip(self.diameters, self.bores, strict=True)
        modulus = min(polar_moment(d, b) / (d / 2) for d, b in rings)
        # The strength that each keyway leaves [3].
        left: float = (1 - 0.2 * width - 1.1 * depth) ** (self.keyways or 1)
        return modulus * left

    def inertia(self, density: float) -> float:
        """Inertia about the axis [kg m²], of a flange out to its circle of bolts; `density` [kg/m³]."""
        (a, b), (p, q) = self.diameters, self.bores
        if self.kind == "spline":
            # The teeth fill about half of the ring that they stand in.
            a = b = math.sqrt((self.diameter**2 + a**2) / 2)
        if self.bolt_circle is not None:
            a = b = self.bolt_circle
        return density * self.length * math.pi / 32 * (mean_fourth(a, b) - mean_fourth(p, q))

    def place(self, share: float) -> float:
        """How far from where it begins a share of its twist lies [m]."""
        if self.kind == "taper":
            return self.length * cone_place(share, self.diameters, self.bores)
        return self.length * share


def mean_fourth(a: float, b: float) -> float:
    """Mean of the fourth power of a length that goes from a to b in proportion."""
    mean: float = total(a ** (4 - n) * b**n for n in range(5)) / 5
    return mean
