r"""The running gear of one throw: motion of its rods and pistons, dead centres, reduction to the crank.

Side by side, or fork and blade, all rods stand on the crank pin and move alike; they differ in mass alone.
Articulated rods stand on a pin of their master rod.

With S the centre of mass of a rod, θ = β + ψ its angle and x the place of its piston,

.. math::

    J(φ) = J_k + \sum m\,|S'|^2 + J_S θ'^2 + m_3 x'^2, \qquad
    J'(φ) = 2 \sum m\,S' \cdot S'' + J_S θ' θ'' + m_3 x' x''.

The kinetic energy is ½Jω², so at constant speed the throw takes the torque ½J′ω² from the shaft: the torque
of its inertia on the shaft is −½J′ω². The weights add M_g = −dV/dφ with the heights along the vertical:

.. math:: V = g \sum m\,\mathrm{Re}\,S, \qquad M_g = -g \sum m\,\mathrm{Re}\,S'.

A dead centre is where :math:`x' = 0`. On the crank pin crank and rod are in line there; the stroke of a
central cylinder is 2r. An offset turns the dead centres and lengthens the stroke:

.. math::

    \sin(φ_t - β) = \frac{e}{l + r}, \quad \sin(φ_b - β - π) = \frac{e}{l - r}, \quad
    s = \sqrt{(l + r)^2 - e^2} - \sqrt{(l - r)^2 - e^2}.

On an articulated pin there is no such form: they are found by Newton on :math:`x'` with the exact
:math:`x''`.

References
----------
.. [1] Artobolevsky, Theory of Mechanisms and Machines: reduction of masses and forces.
.. [2] Norton, Design of Machinery, chapter 4: offset slider-crank.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import ConvergenceError, InputError
from linkwright.kernel.numerics.tangent import primal
from linkwright.torsion.model.engine.pendulum import FREE_FALL
from linkwright.torsion.model.engine.rod import ArticulatedRod, Rod
from linkwright.torsion.model.engine.rod_motion import RodMotion, articulated_pin, crank_pin, rod_motion


@dataclass(frozen=True, slots=True)
class RunningGear:
    """Rod and piston of one cylinder."""

    rod: Rod  # on the crank pin; an `ArticulatedRod` on its master rod
    piston_mass: float  # of the reciprocating mass with the piston: piston, rings, pin [kg]
    # β, from the vertical to the axis of the cylinder, in the sense of rotation [rad].
    bank_angle: float = 0.0
    offset: float = 0.0  # e of that axis from the axis of the crank, in the sense of rotation [m]
    master: int = 0  # of an articulated rod: the place of its master rod among the gears of the throw, from 0
    name: str = "the cylinder"  # what the cylinder is called in messages

    def __post_init__(self) -> None:
        if not (math.isfinite(primal(self.piston_mass)) and self.piston_mass >= 0):
            raise InputError(f"piston_mass: found {self.piston_mass:g}, expected a mass of 0 or more [kg]")

    @property
    def is_articulated(self) -> bool:
        """Whether the rod stands on a master rod."""
        return isinstance(self.rod, ArticulatedRod)


def throw_motion(
    crank_radius: float, gears: Sequence[RunningGear], crank_angle: ArrayLike
) -> tuple[RodMotion, ...]:
    """Motion of all rods and pistons of one throw. `crank_radius`: r [m]; `crank_angle`: [rad]."""
    pin = crank_pin(crank_radius, crank_angle)
    motions: dict[int, RodMotion] = {}
    # Master rods come first, wherever they stand.
    for at, gear in sorted(enumerate(gears), key=lambda gear: gear[1].is_articulated):
        big_end = pin
        if isinstance(gear.rod, ArticulatedRod):
            master = motions[_master(gears, at)]
            big_end = articulated_pin(master, gear.rod.pin_radius, gear.rod.pin_angle)
        motions[at] = rod_motion(
            big_end, crank_angle, gear.rod.length, gear.bank_angle, gear.offset, gear.name
        )
    return tuple(motions[at] for at in range(len(gears)))


def _master(gears: Sequence[RunningGear], at: int) -> int:
    place = gears[at].master
    if not 0 <= place < len(gears) or gears[place].is_articulated:
        found = "none" if not 0 <= place < len(gears) else "an articulated rod"
        raise InputError(
            f"master: found {place} for {gears[at].name}, where {found} stands; expected the place of a "
            "master rod among the gears of the throw, counted from 0"
        )
    return place


@dataclass(frozen=True, eq=False, slots=True)
class ThrowReduction:
    """A throw reduced to its crank, over the crank angle."""

    crank_angle: Floats  # φ of this throw, from the vertical [rad]
    # `inertia_reduced`, `inertia_reduced_d1`: J and J′ [kg m², kg m²/rad].
    inertia_reduced: Floats
    inertia_reduced_d1: Floats
    weight_torque: Floats  # M_g of all weights on the crank, positive where they drive [N m]

    def inertia_torque(self, speed: float) -> Floats:
        """−½J′ω² at constant ω [rad/s], positive where it drives the crank [N m], as ``crank_angle``."""
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
    J, J_d1 = own_inertia + np.zeros(phi.shape), np.zeros(phi.shape)
    # Σ m Re S′ of all that has weight.
    lift = np.zeros(phi.shape) if not static_moment else (1j * static_moment * np.exp(1j * phi)).real
    for gear, motion in zip(gears, throw_motion(crank_radius, gears, phi), strict=True):
        m, centre, J_S, m_3 = (*gear.rod.body, gear.piston_mass)
        S = motion.point(centre)
        x_d1, x_d2, turn, turn_d1 = motion.piston_d1, motion.piston_d2, motion.angle_d1, motion.angle_d2
        J = J + m * (S.d1.real**2 + S.d1.imag**2) + J_S * turn**2 + m_3 * x_d1**2
        J_d1 = J_d1 + 2.0 * m * (S.d1.real * S.d2.real + S.d1.imag * S.d2.imag)
        J_d1 = J_d1 + 2.0 * (J_S * turn * turn_d1 + m_3 * x_d1 * x_d2)
        lift = lift + m * S.d1.real + m_3 * np.cos(gear.bank_angle) * x_d1
    return ThrowReduction(phi, J, J_d1, -gravity * lift)


# Angles of the revolution from whose highest and lowest Newton starts, 1.4 degrees apart.
_SAMPLES = 256
# Newton squares the error of 0.01 rad at each step; the rest is for dead centres that are nearly flat.
_STEPS = 12
# Maximum speed at a dead centre, over that of the crank pin: rounding of a few operations.
_AT_REST = 1e-12


class DeadCentres(NamedTuple):
    """Where a piston turns back."""

    # `top`, `bottom`: crank angles of the throw from the vertical [rad]: top within half a revolution of the
    # cylinder's axis, bottom within a revolution after it.
    top: float
    bottom: float
    # `highest`, `lowest`: distance of the piston pin from the axis of the crank there [m].
    highest: float
    lowest: float

    @property
    def stroke(self) -> float:
        """Way of the piston between them [m]."""
        return self.highest - self.lowest


def dead_centres(crank_radius: float, gears: Sequence[RunningGear]) -> tuple[DeadCentres, ...]:
    """Dead centres of all pistons of one throw, to rounding. `crank_radius`: r [m]."""
    if not gears:
        return ()
    phi = np.linspace(0.0, 2.0 * math.pi, _SAMPLES, endpoint=False)
    samples = throw_motion(crank_radius, gears, phi)
    start = np.array([[motion.piston.argmax(), motion.piston.argmin()] for motion in samples])
    angle, piston = _refined(crank_radius, gears, phi[start])
    return tuple(map(_counted, angle, piston, (gear.bank_angle for gear in gears)))


def _refined(crank_radius: float, gears: Sequence[RunningGear], start: Floats) -> tuple[Floats, Floats]:
    """Angles of the dead centres and piston positions there, (gears, 2); Newton within a sample's reach."""
    angle, reach = start, 2.0 * math.pi / _SAMPLES
    for _ in range(_STEPS):
        piston, d1, d2 = _own_rows(crank_radius, gears, angle)
        with np.errstate(divide="ignore", invalid="ignore"):
            step = np.nan_to_num(d1 / d2)
        after = np.clip(angle - step, start - reach, start + reach)
        if np.abs(after - angle).max() <= np.finfo(float).eps * 2.0 * math.pi:
            break
        angle = after
    worst = int(np.abs(d1).max(axis=1).argmax())
    residual = float(np.abs(d1[worst]).max()) / crank_radius
    if residual > _AT_REST:
        text = (
            f"the dead centres of {gears[worst].name} were not found: its piston still moves at "
            f"{residual:.3g} of the crank pin's speed after {_STEPS} steps; check lengths and places of its "
            "rod and its pin"
        )
        raise ConvergenceError(text, method="dead centres", iterations=_STEPS, residual=residual)
    return angle, piston


def _own_rows(crank_radius: float, gears: Sequence[RunningGear], angle: Floats) -> tuple[Floats, ...]:
    """x, x′, x″ of each gear at its own angles, (gears, 2) each."""
    motion = throw_motion(crank_radius, gears, angle)
    rows = [(row.piston[at], row.piston_d1[at], row.piston_d2[at]) for at, row in enumerate(motion)]
    return tuple(np.array(row) for row in zip(*rows, strict=True))


def _counted(angle: Floats, piston: Floats, bank_angle: float) -> DeadCentres:
    top = bank_angle + math.remainder(float(angle[0]) - bank_angle, 2.0 * math.pi)
    bottom = top + (float(angle[1]) - top) % (2.0 * math.pi)
    return DeadCentres(top, bottom, float(piston[0]), float(piston[1]))
