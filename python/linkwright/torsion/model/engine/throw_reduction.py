r"""Inertia and weight of one throw with all its rods and pistons, reduced to the crank, exactly.

With S the centre of mass of a rod, θ = β + ψ its angle and x the place of its piston,

.. math::

    J(φ) = J_k + \sum m\,|S'|^2 + J_S θ'^2 + m_3 x'^2, \qquad
    J'(φ) = 2 \sum m\,S' \cdot S'' + J_S θ' θ'' + m_3 x' x''.

The kinetic energy is ½Jω², so at constant speed the throw takes the torque ½J′ω² from the shaft: the torque
of its inertia on the shaft is −½J′ω². The weights add M_g = −dV/dφ with the heights along the vertical:

.. math:: V = g \sum m\,\mathrm{Re}\,S, \qquad M_g = -g \sum m\,\mathrm{Re}\,S'.

References
----------
.. [1] Artobolevsky, Theory of Mechanisms and Machines: reduction of masses and forces.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from linkwright.torsion.model.engine.pendulum import FREE_FALL
from linkwright.torsion.model.engine.running_gear import RunningGear, throw_motion

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False, slots=True)
class ThrowReduction:
    """A throw reduced to its crank, over the crank angle."""

    crank_angle: Array  # φ of this throw, from the vertical [rad]
    # `inertia_reduced`, `inertia_reduced_d1`: J and J′ [kg m², kg m²/rad].
    inertia_reduced: Array
    inertia_reduced_d1: Array
    weight_torque: Array  # M_g of all weights on the crank, positive where they drive [N m]

    def inertia_torque(self, speed: float) -> Array:
        """Torque of the inertia on the crank at constant speed, positive where it drives, as ``crank_angle``.

        −½J′ω² [N m]. `speed`: ω of the crank [rad/s].
        """
        return -0.5 * speed**2 * self.inertia_reduced_d1


def throw_reduction(
    crank_radius: float,
    gears: Sequence[RunningGear],
    crank_angle: ArrayLike,
    own_inertia: float = 0.0,
    static_moment: complex = 0.0,
    gravity: float = FREE_FALL,
) -> ThrowReduction:
    """Inertia and weight of one throw with all its rods and pistons, reduced to the crank.

    In the shape of the crank angles. `crank_radius`: r [m]; `crank_angle`: [rad]; `own_inertia`: [kg m²];
    `static_moment`: [kg m]; `gravity`: [m/s²].
    """
    phi = np.asarray(crank_angle, dtype=np.float64)
    J, J_d1 = np.full(phi.shape, float(own_inertia)), np.zeros(phi.shape)
    # Σ m Re S′ of all that has weight.
    lift = np.zeros(phi.shape) if not static_moment else (1j * static_moment * np.exp(1j * phi)).real
    for gear, motion in zip(gears, throw_motion(crank_radius, gears, phi), strict=True):
        m, centre, J_S = gear.rod.body
        S = motion.point(centre)
        x_d1, x_d2, turn, turn_d1 = motion.piston_d1, motion.piston_d2, motion.angle_d1, motion.angle_d2
        J += m * (S.d1.real**2 + S.d1.imag**2) + J_S * turn**2 + gear.piston_mass * x_d1**2
        J_d1 += 2.0 * m * (S.d1.real * S.d2.real + S.d1.imag * S.d2.imag)
        J_d1 += 2.0 * (J_S * turn * turn_d1 + gear.piston_mass * x_d1 * x_d2)
        lift += m * S.d1.real + gear.piston_mass * np.cos(gear.bank_angle) * x_d1
    return ThrowReduction(phi, J, J_d1, -gravity * lift)
