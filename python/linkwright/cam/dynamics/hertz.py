r"""Line contact of two cylinders by Hertz: cam and roller, cam and flat face.

With the load P per length, and

.. math:: \frac1R = \frac1{R_1} + \frac1{R_2}, \qquad
    \frac1{E^*} = \frac{1-\nu_1^2}{E_1} + \frac{1-\nu_2^2}{E_2}

the half width of the contact and the largest pressure are

.. math:: b = \sqrt{\frac{4PR}{\pi E^*}}, \qquad p_0 = \frac{2P}{\pi b} = \sqrt{\frac{PE^*}{\pi R}}

Source: K. L. Johnson, *Contact Mechanics*, Cambridge University Press 1985, section 4.2(c), equations 4.43 to
4.49. His a is our b.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from numpy.typing import ArrayLike

from linkwright.cam.dynamics.follower_load import alike
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import FindingError, InputError
from linkwright.kernel.public import public, public_type
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import Label
from linkwright.kernel.result import Result
from linkwright.kernel.units.kinds import FORCE, LENGTH, PRESSURE
from linkwright.kernel.units.marks import Quantity, positive

# Depth of the largest shear: τ(ζ) = ζ − ζ²/√(1+ζ²) has its extreme where (1+q)³ = q(2+q)² with q = ζ²,
# that is q² + q − 1 = 0, the golden section.
_Q = 0.5 * (math.sqrt(5.0) - 1.0)

SHEAR_DEPTH = math.sqrt(_Q)
"""Depth of the largest shear over the half width, 0.786."""

# There 1 + q = 1/q and 1 − q = q², so τ = √q (1 − q).
SHEAR_MAX = math.sqrt(_Q) * (1.0 - _Q)
"""Largest shear over the largest pressure, 0.300."""


@public_type
@dataclass(frozen=True, slots=True)
class Material:
    """An elastic material.

    Attributes
    ----------
    modulus : float
        Young's modulus E [Pa].
    poisson : float
        Poisson's ratio ν [–].
    """

    modulus: float
    poisson: float

    def __post_init__(self) -> None:
        """Refuse numbers that no material has."""
        in_range(modulus=(self.modulus, positive(PRESSURE)))
        if not -1.0 < self.poisson <= 0.5:
            raise InputError(f"poisson: found {self.poisson:g}, expected more than -1 and at most 0.5")

    @property
    def compliance(self) -> float:
        """(1 − ν²)/E [1/Pa]."""
        own: float = compliance(self.modulus, self.poisson)
        return own


def compliance(modulus: Any, poisson: Any) -> Any:
    """(1 − ν²)/E."""
    return (1.0 - poisson * poisson) / modulus


def peak_pressure(load: Any, curvature: Any, compliance: Any) -> Any:
    """p₀ of a load per length, of 1/R, and of the compliances of both bodies together."""
    return np.sqrt(load * curvature / (math.pi * compliance))


STEEL = Material(206e9, 0.3)
"""Steel, by the usual numbers of machine design (Niemann, *Maschinenelemente*: 206 GPa, 0.3)."""


@dataclass(frozen=True)
class LineContact(Result):
    """Line contact, for each force."""

    force: Annotated[
        Floats,
        Label(
            "normal force", "F", "N", "Where it is not positive there is no contact, and all else is zero."
        ),
    ]
    radius: Annotated[Floats, Label("radius of both bodies together", "R", "m")]
    half_width: Annotated[Floats, Label("half the width of the contact", "b", "m")]
    pressure: Annotated[Floats, Label("maximum pressure", "p₀", "Pa")]
    shear: Annotated[Floats, Label("maximum shear stress below the surface", "", "Pa")]
    shear_depth: Annotated[Floats, Label("depth of the maximum shear stress", "", "m")]
    von_mises: Annotated[
        Floats,
        Label("maximum equivalent stress by von Mises", "", "Pa", "In the material that has the larger one."),
    ]
    von_mises_depth: Annotated[Floats, Label("depth of the maximum equivalent stress", "", "m")]
    slenderness: Annotated[
        Floats,
        Label(
            "half the width over the smaller radius of the two",
            "",
            "–",
            "Hertz's theory asks for much less than 1.",
        ),
    ]
    pressure_max: Annotated[float, Label("maximum pressure of all forces", "", "Pa")]


@public
def line_contact(
    force: ArrayLike,
    radius: ArrayLike,
    radius_other: ArrayLike,
    length: float,
    material: Material = STEEL,
    material_other: Material = STEEL,
) -> LineContact:
    """Width, pressure and stress of the contact of two cylinders with parallel axes.

    Parameters
    ----------
    force : array_like, shape (n,) or ()
        Normal force; nothing presses where it is negative [N].
    radius, radius_other : array_like, shape (n,) or ()
        Radii of curvature; negative where a body is concave, infinite where it is flat [m].
    length : float
        Of the contact along the axes [m].
    material, material_other : Material
        Of the two bodies.

    Returns
    -------
    LineContact
        For each force.

    Raises
    ------
    InputError
        A length, radius or force that makes no sense.
    FindingError
        The convex body does not fit into the concave one: they touch in more than one line.

    References
    ----------
    .. [1] K. L. Johnson, Contact Mechanics (1985), section 4.2(c).
    """
    in_range(length=(length, positive(LENGTH)), force=(force, Quantity(FORCE)))
    given = alike(force=force, radius=radius, radius_other=radius_other)
    kappa = _curvature(given["radius"], given["radius_other"])
    both = material.compliance + material_other.compliance
    load = np.maximum(given["force"], 0.0)
    p0 = peak_pressure(load / length, kappa, both)
    b = np.sqrt(4 * load / length * both / (math.pi * kappa))
    mises, depth = max(von_mises_largest(body.poisson) for body in (material, material_other))
    sharpest = np.maximum(np.abs(1 / given["radius"]), np.abs(1 / given["radius_other"]))
    return LineContact(
        force=given["force"],
        radius=1 / kappa,
        half_width=b,
        pressure=p0,
        shear=SHEAR_MAX * p0,
        shear_depth=SHEAR_DEPTH * b,
        von_mises=mises * p0,
        von_mises_depth=depth * b,
        slenderness=b * sharpest,
        pressure_max=float(p0.max()),
    )


def _curvature(first: Floats, second: Floats) -> Floats:
    """1/R₁ + 1/R₂, where the bodies touch in one line."""
    for name, values in (("radius", first), ("radius_other", second)):
        # Below, what follows from a reciprocal is no number.
        wrong = np.flatnonzero(np.isnan(values) | (np.abs(values) < 1e-100))
        if len(wrong):
            raise InputError(f"{name}: found {values[wrong[0]]:g} at index {wrong[0]}, expected a length")
    kappa: Floats = 1 / first + 1 / second
    wrong = np.flatnonzero(kappa <= 0)
    if len(wrong):
        k = int(wrong[0])
        least, most = sorted((first[k], second[k]))
        raise FindingError(
            f"radii {first[k]:.6g} m and {second[k]:.6g} m at index {k} do not touch in one line: the convex "
            f"radius {most:.6g} m must be smaller than the concave one, {-least:.6g} m"
        )
    return kappa


def von_mises_largest(poisson: float) -> tuple[float, float]:
    r"""Largest equivalent stress by von Mises below the contact, over the largest pressure.

    With x = (√(1+ζ²) − ζ)², plane strain along the axes and κ = 1 − ν + ν²,

    .. math:: \frac{\sigma_v^2}{p_0^2} = 4\kappa x - \frac{12x^2}{(1+x)^2}

    whose extremes are roots of the cubic κ(1+x)³ = 6x.

    ``poisson``: Poisson's ratio ν [–].

    Source: Johnson, Contact Mechanics (1985), equations 4.46, with σ_y = ν(σ_x + σ_z).
    """
    kappa = 1 - poisson + poisson**2
    roots = np.roots([kappa, 3 * kappa, 3 * kappa - 6, kappa])
    inside = roots.real[(np.abs(roots.imag) < 1e-9) & (roots.real > 0) & (roots.real < 1)]
    x = np.append(inside, 1.0)
    square = 4 * kappa * x - 12 * x**2 / (1 + x) ** 2
    best = int(np.argmax(square))
    return math.sqrt(square[best]), 0.5 * (1 / math.sqrt(x[best]) - math.sqrt(x[best]))
