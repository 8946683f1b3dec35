r"""Motion of a rod and its piston over the crank angle, exact, for pins on a crank and on a master rod.

Points of the plane are complex numbers: the real axis points up the vertical from which cylinders and cranks
are counted, the imaginary axis a quarter of a revolution on in the sense of rotation. The crank pin is
:math:`p = r e^{iφ}`.

In the frame of a cylinder, whose axis is turned by β and runs past the axis of the crank at the offset e in
the sense of rotation, let the pin of the big end be :math:`p e^{-iβ} = ξ + iη`. The rod, of the length l,
closes with

.. math:: \sin ψ = \frac{e - η}{l}, \qquad x = ξ + l \cos ψ,

ψ being its angle from the axis of the cylinder and x the distance of the piston pin from the axis of the
crank, along the cylinder. The chain rule gives, exactly,

.. math::

    ψ' = \frac{-η'}{l \cos ψ}, \quad ψ'' = \frac{-η''/l + ψ'^2 \sin ψ}{\cos ψ}, \quad
    x' = ξ' - l ψ' \sin ψ, \quad x'' = ξ'' - l (ψ'^2 \cos ψ + ψ'' \sin ψ).

An articulated pin stands on the master rod at the radius ρ and the angle γ from the master rod's axis:

.. math:: p_a = p + ρ e^{i(β + ψ + γ)}.

It takes the place of the crank pin for its own rod and cylinder; so its piston has another stroke, and other
dead centres, than the master rod's.

References
----------
.. [1] Norton, Design of Machinery, chapter 13: slider-crank of engines. Its exact position is x with e = 0.
.. [2] Ker Wilson, Practical Solution of Torsional Vibration Problems, vol. 2: articulated rods.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from linkwright.kernel.arrays import Complexes, Floats
from linkwright.kernel.errors import AssemblyError


@dataclass(frozen=True, eq=False, slots=True)
class PinMotion:
    """A pin in the plane of the engine over the crank angle."""

    # p, complex, in the shape of the crank angles: up the vertical, and a quarter of a revolution on [m].
    position: Complexes
    # `d1`, `d2`: p′, p″ [m/rad, m/rad²].
    d1: Complexes
    d2: Complexes


@dataclass(frozen=True, eq=False, slots=True)
class RodMotion:
    """A rod and its piston over the crank angle."""

    crank_angle: Floats  # φ of the throw, from the vertical [rad]
    pin: PinMotion  # the pin of the big end
    bank_angle: float  # β, from the vertical to the axis of the cylinder [rad]
    # `piston`, `piston_d1`, `piston_d2`: x of the piston pin from the axis of the crank, along the cylinder,
    # x′ and x″ [m, m/rad, m/rad²].
    piston: Floats
    piston_d1: Floats
    piston_d2: Floats
    direction: Complexes  # unit vector from big to small end, complex as the pins: :math:`e^{i(β + ψ)}`
    # `angle`, `angle_d1`, `angle_d2`: ψ of the rod from the axis of the cylinder in the sense of rotation,
    # ψ′, ψ″ [rad, –, 1/rad].
    angle: Floats
    angle_d1: Floats
    angle_d2: Floats

    def point(self, along: float, across: float = 0.0) -> PinMotion:
        """Motion of a point of the rod. The point, complex as the pins. `along`: [m]; `across`: [m]."""
        arm = (along + 1j * across) * self.direction
        d1, d2 = self.angle_d1, self.angle_d2
        return PinMotion(
            self.pin.position + arm,
            self.pin.d1 + 1j * d1 * arm,
            self.pin.d2 + (1j * d2 - d1**2) * arm,
        )


def crank_pin(crank_radius: float, crank_angle: ArrayLike) -> PinMotion:
    """Motion of the crank pin.

    In the shape of the crank angles. `crank_radius`: r [m]; `crank_angle`: [rad].
    """
    p = crank_radius * np.exp(1j * np.asarray(crank_angle, dtype=np.float64))
    return PinMotion(p, 1j * p, -p)


def articulated_pin(master: RodMotion, pin_radius: float, pin_angle: float) -> PinMotion:
    """Motion of an articulated pin on a master rod.

    The pin. `pin_radius`: ρ, from the axis of its big end to the pin [m]; `pin_angle`: [rad].
    """
    return master.point(pin_radius * np.cos(pin_angle), pin_radius * np.sin(pin_angle))


def rod_motion(
    pin: PinMotion,
    crank_angle: ArrayLike,
    rod_length: float,
    bank_angle: float = 0.0,
    offset: float = 0.0,
    name: str = "the cylinder",
) -> RodMotion:
    """Motion of a rod on a pin that moves as given, and of its piston.

    In the shape of the crank angles. `crank_angle`: φ at which it stands so, in its shape [rad];
    `rod_length`: l [m]; `bank_angle`: [rad]; `offset`: [m].
    """
    phi = np.asarray(crank_angle, dtype=np.float64)
    turn = np.exp(-1j * bank_angle)
    p, p_d1, p_d2 = pin.position * turn, pin.d1 * turn, pin.d2 * turn
    sine = (offset - p.imag) / rod_length
    if not np.all(np.abs(sine) < 1.0):
        raise _open(phi, sine, rod_length, name)
    cosine = np.sqrt((1.0 - sine) * (1.0 + sine))
    d1 = -p_d1.imag / (rod_length * cosine)
    d2 = (d1**2 * sine - p_d2.imag / rod_length) / cosine
    return RodMotion(
        phi,
        pin,
        bank_angle,
        p.real + rod_length * cosine,
        p_d1.real - rod_length * d1 * sine,
        p_d2.real - rod_length * (d1**2 * cosine + d2 * sine),
        (cosine + 1j * sine) / turn,
        np.arcsin(sine),
        d1,
        d2,
    )


def slider_crank(
    crank_radius: float, rod_length: float, crank_angle: ArrayLike, offset: float = 0.0
) -> RodMotion:
    """Motion of a rod on the crank pin, in a cylinder along the vertical.

    In the shape of the crank angles. `crank_radius`, `rod_length`: r, l [m]; `crank_angle`: [rad]; `offset`:
    [m].
    """
    return rod_motion(crank_pin(crank_radius, crank_angle), crank_angle, rod_length, 0.0, offset)


def _open(phi: Floats, sine: Floats, rod_length: float, name: str) -> AssemblyError:
    wrong = ~(np.abs(sine) < 1.0)
    at = int(np.flatnonzero(wrong)[0])
    away = abs(float(sine.flat[at])) * rod_length
    angle = float(phi.flat[at])
    text = (
        f"the rod of {name} does not reach its piston at crank angle {np.degrees(angle):.6g} deg: its pin "
        f"stands {away:.6g} m beside the axis of the cylinder and the rod is {rod_length:.6g} m long; make "
        "the rod longer, or the crank radius smaller"
    )
    return AssemblyError(text, element=name, crank_angle=angle, gap=away - rod_length)
