r"""The disc that stands for a throw: exact means of J(φ) over one revolution, and as published.

With the rod as the two masses of (1) and (2), the piston's speed by its first two harmonics (3), and the
kinetic energy averaged over one revolution (4) to (6), the disc has

.. math::

    J = J_k + r^2 \left[ m_1 + \tfrac12 (m_2 + m_3) \left(1 + \tfrac{λ^2}{4}\right) \right] + J_a \quad (7)

with λ = r/l. For the usual λ the last factor is taken as 1,

.. math:: J = J_k + J_a + \tfrac12 r^2 \left[ (1 + k)\,m + m_3 \right] \quad (9)

and ½/g is printed as 0.00051 s²/cm. J_a stands for the articulated rod; with masses spread alike,

.. math:: \frac{J_w}{m} = \frac{J_a}{m_a} \quad (10, 11), \qquad J_a = J_w \frac{m_a}{m} \quad (12).

So J_a is the moment of inertia of the articulated rod about *its own small end*, k l² m_a, and the formulas
add it to the disc as it is, though the rod does not turn with the crank: its share of the disc is about
½ (1 + k) r² m_a. What the formulas neglect otherwise is said with the exact mean, in `mean_inertia`.

At constant speed the mean energy of a throw is that of a disc with the mean of J(φ) over the crank angle,
which is then its mean over time: ``mean``. It is what (7) approximates, and what a train of constant inertias
takes. Other questions lead to other means:

| mean | is | holds for |
| --- | --- | --- |
| ``mean`` | ⟨J⟩ | the mean energy at constant speed; the exact (7) |
| ``constant_energy`` | ⟨√J⟩² | the time of a revolution at constant energy, ω = √(2E/J) |
| ``harmonic`` | 1/⟨1/J⟩ | the mean speed at constant momentum Jω, as of a twist slow against the turning |

They are power means of the exponents 1, ½, −1, so each is at least the next, and to second order they lie
var J/(4⟨J⟩) and var J/⟨J⟩ below the first.

**Closed form.** For a rigid rod on the crank pin and a central cylinder, with λ = r/l and

.. math::

    S = \frac{1 - \sqrt{1 - λ^2}}{λ^2} = \frac{1}{1 + \sqrt{1 - λ^2}}
    = \tfrac12 \left( 1 + \tfrac{λ^2}{4} + \tfrac{λ^4}{8} + \tfrac{5 λ^6}{64} + … \right)

the means over the revolution are

.. math::

    \langle x'^2 \rangle = r^2 S, \qquad \langle ψ'^2 \rangle = \frac{r^2}{l^2} S, \qquad
    \langle x' ψ' \sin ψ \rangle = -\frac{r^2}{l} \left(S - \tfrac12\right),

.. math:: \langle J \rangle = J_k + r^2 \left[ m_1 + (m_2 + m_3) S
    + 2 \left( m_1 - m \frac{l - c}{l} \right) \left(S - \tfrac12\right) \right].

The last term is what the split of (1), (2) misses since it does not keep the centre of mass c. But for it,
(7) is the series to its second term: it neglects the share λ⁴/8 of the reciprocating part, 0.05 % with λ = ¼.

References
----------
.. [1] Paper 3, equations (3) to (12). Its I is J here, with the same indices; R/L is λ.
.. [2] Paper 3, equations (4) to (7), for the mean of the energy. The closed form is derived in
   docs/theory/crank_throws.md.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import AssemblyError, ConvergenceError
from linkwright.kernel.numerics.tangent import plain
from linkwright.torsion.model.engine.rod import Rod
from linkwright.torsion.model.engine.running_gear import RunningGear, throw_reduction

# Angles of the first and of the last mesh of a revolution.
_FIRST, _LAST = 32, 1 << 15
# Means over even angles of a smooth periodic function converge geometrically: a mesh of twice as many angles
# has the square of the error. Two meshes that agree so far leave the finer one with rounding alone.
_AGREE = 1e-9


class MeanInertia(NamedTuple):
    """Means of J(φ) over one revolution."""

    mean: float  # ⟨J⟩, of equal energy at constant speed [kg m²]
    constant_energy: float  # ⟨√J⟩², of equal time of a revolution at constant energy [kg m²]
    harmonic: float  # 1/⟨1/J⟩, of equal speed at constant momentum [kg m²]


def mean_inertia(crank_radius: float, gears: Sequence[RunningGear], own_inertia: float = 0.0) -> MeanInertia:
    """Means over one revolution of the inertia of a throw with all its rods and pistons, to rounding.

    ``mean`` is the disc of equal energy. `crank_radius`: r [m]; `own_inertia`: J_k of all that turns with the
    shaft [kg m²].
    """
    n, before = _FIRST, _means(crank_radius, gears, own_inertia, _FIRST)
    while n < _LAST:
        n *= 2
        after = _means(crank_radius, gears, own_inertia, n)
        if max(abs(a - b) for a, b in zip(after, before, strict=True)) <= _AGREE * after.mean:
            return after
        before = after
    text = (
        f"the mean inertia of a throw was not found to {_AGREE:g} with {n} crank angles: a rod comes close "
        "to a right angle to its cylinder; make it longer, or the crank radius smaller"
    )
    raise ConvergenceError(text, method="mean inertia", iterations=n)


def _means(crank_radius: float, gears: Sequence[RunningGear], own_inertia: float, n: int) -> MeanInertia:
    """The three means over n even angles; derivatives are squared from mesh to mesh as the means are."""
    phi = np.linspace(0.0, 2.0 * math.pi, n, endpoint=False)
    J = throw_reduction(crank_radius, gears, phi, own_inertia).inertia_reduced
    # Without own inertia and piston a rod of two masses may rest for a moment: its harmonic mean is zero.
    harmonic = 1.0 / (1.0 / J).mean() if J.min() > 0.0 else 0.0
    return MeanInertia(*(plain(mean) for mean in (J.mean(), np.sqrt(J).mean() ** 2, harmonic)))


def central_mean_inertia(
    crank_radius: float, rod: Rod, piston_mass: float, own_inertia: float = 0.0
) -> float:
    """Mean over one revolution of the inertia of a throw with one rod in a central cylinder, in closed form.

    ⟨J⟩ [kg m²]. `crank_radius`: r [m]; `piston_mass`: m_3 [kg]; `own_inertia`: J_k of all that turns with the
    shaft [kg m²].
    """
    ratio = crank_radius / rod.length
    if ratio >= 1.0:
        text = (
            f"the rod of {rod.length:.6g} m does not pass the crank radius of {crank_radius:.6g} m; make it "
            "longer"
        )
        raise AssemblyError(text, gap=crank_radius - rod.length)
    S = 1.0 / (1.0 + math.sqrt((1.0 - ratio) * (1.0 + ratio)))
    m, centre, _ = rod.body
    missed = 2.0 * (rod.mass_pin - m * (rod.length - centre) / rod.length) * (S - 0.5)
    return own_inertia + crank_radius**2 * (rod.mass_pin + (rod.mass_piston + piston_mass) * S + missed)


# The paper's rounding of 1/(2·981) [s²/cm].
PRINTED_FACTOR = 0.00051


def published_piston_speed(
    crank_radius: float, rod_length: float, speed: float, crank_angle: ArrayLike
) -> Floats:
    """Speed of the piston by its first two harmonics, (3).

    v, positive towards the crank [m/s]. `crank_radius`, `rod_length`: r, l [m]; `speed`: ω of the crank
    [rad/s]; `crank_angle`: [rad].
    """
    phi = np.asarray(crank_angle, dtype=np.float64)
    v: Floats = speed * crank_radius * (np.sin(phi) + 0.5 * crank_radius / rod_length * np.sin(2.0 * phi))
    return v


def articulated_inertia(moment_small_end: float, mass: float, mass_articulated: float) -> float:
    """J_a = J_w m_a/m of an articulated rod from that of its master rod, (12) [kg m²]; masses [kg]."""
    return moment_small_end * mass_articulated / mass


def disc_by_two_masses(
    crank_radius: float,
    rod_length: float,
    masses: tuple[float, float, float],
    own_inertia: float = 0.0,
    articulated_inertia: float = 0.0,
) -> float:
    """J of the disc of a throw with one rod, (7) [kg m²]; r, l [m]; masses [kg]; inertias [kg m²]."""
    m_1, m_2, m_3 = masses
    second = 1.0 + (crank_radius / rod_length) ** 2 / 4.0
    return own_inertia + crank_radius**2 * (m_1 + 0.5 * (m_2 + m_3) * second) + articulated_inertia


def disc_by_distribution(
    crank_radius: float,
    distribution: float,
    mass: float,
    piston_mass: float,
    own_inertia: float = 0.0,
    articulated_inertia: float = 0.0,
) -> float:
    """The disc of a throw by the coefficient of the mass distribution, (9) in SI.

    J [kg m²]. `crank_radius`: r [m]; `distribution`: k; `mass`, `piston_mass`: m of the rod, m_3 of the
    piston [kg]; `own_inertia`, `articulated_inertia`: [kg m²].
    """
    moving = (1.0 + distribution) * mass + piston_mass
    return own_inertia + articulated_inertia + 0.5 * crank_radius**2 * moving


def printed_disc(
    crank_radius: float,
    distribution: float,
    rod_weight: float,
    piston_weight: float,
    own_inertia: float = 0.0,
    articulated_inertia: float = 0.0,
) -> float:
    """The disc of a throw by (9) as printed, with 0.00051.

    I [kgf cm s²]. `crank_radius`: R [cm]; `distribution`: k; `rod_weight`, `piston_weight`: G of the rod, G_p
    of the piston [kgf]; `own_inertia`, `articulated_inertia`: I_k, I_a [kgf cm s²].
    """
    moving = (1.0 + distribution) * rod_weight + piston_weight
    return own_inertia + articulated_inertia + PRINTED_FACTOR * crank_radius**2 * moving


def published_throw_inertia(
    crank_radius: float, gears: Sequence[RunningGear], own_inertia: float = 0.0
) -> float:
    """The disc of a throw with all its cylinders by (7) and (12).

    J [kg m²]: of each rod on the crank pin the bracket of (7), of each articulated rod J_a by (12), and of
    its piston the share that a piston has in (7). `crank_radius`: r [m]; `own_inertia`: J_k of all that turns
    with the shaft [kg m²].
    """
    total = own_inertia
    for gear in gears:
        rod, masses, J_a = gear.rod, (gear.rod.mass_pin, gear.rod.mass_piston, gear.piston_mass), 0.0
        if gear.is_articulated:
            master = gears[gear.master].rod
            J_a = articulated_inertia(master.moment_small_end, master.mass, rod.mass)
            masses = (0.0, 0.0, gear.piston_mass)
        total += disc_by_two_masses(crank_radius, rod.length, masses, articulated_inertia=J_a)
    return total
