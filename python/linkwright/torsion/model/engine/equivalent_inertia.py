r"""The disc that stands for a throw, as published.

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

References
----------
.. [1] Paper 3, equations (3) to (12). Its I is J here, with the same indices; R/L is λ.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from linkwright.torsion.model.engine.running_gear import RunningGear

Array = NDArray[np.float64]

# The paper's rounding of 1/(2·981) [s²/cm].
PRINTED_FACTOR = 0.00051


def published_piston_speed(
    crank_radius: float, rod_length: float, speed: float, crank_angle: ArrayLike
) -> Array:
    """Speed of the piston by its first two harmonics, (3).

    v, positive towards the crank [m/s]. `crank_radius`, `rod_length`: r, l [m]; `speed`: ω of the crank
    [rad/s]; `crank_angle`: [rad].
    """
    phi = np.asarray(crank_angle, dtype=np.float64)
    v: Array = speed * crank_radius * (np.sin(phi) + 0.5 * crank_radius / rod_length * np.sin(2.0 * phi))
    return v


def articulated_inertia(moment_small_end: float, mass: float, mass_articulated: float) -> float:
    """J_a of an articulated rod from that of its master rod, (12).

    J_a = J_w m_a/m [kg m²]. `moment_small_end`: [kg m²]; `mass`, `mass_articulated`: [kg].
    """
    return moment_small_end * mass_articulated / mass


def disc_by_two_masses(
    crank_radius: float,
    rod_length: float,
    masses: tuple[float, float, float],
    own_inertia: float = 0.0,
    articulated_inertia: float = 0.0,
) -> float:
    """The disc of a throw with one rod on its pin, (7).

    J [kg m²]. `crank_radius`, `rod_length`: r, l [m]; `masses`: [kg]; `own_inertia`, `articulated_inertia`:
    [kg m²].
    """
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
