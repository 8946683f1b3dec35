"""Cams with known outlines, from motion laws and the simple formulas of pitch curves, in complex numbers."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.cam import Harmonic, MotionLaw, Piece

Floats = NDArray[np.float64]
Complex = NDArray[np.complex128]
# Cam angles and side → place, first and second derivative, each (n,).
Places = Callable[[Floats, str], tuple[Complex, Complex, Complex]]
TURN = 2 * math.pi


@dataclass(frozen=True)
class Cam:
    """A closed curve; clockwise ones are mirrored at the x axis."""

    breaks: tuple[float, ...]
    places: Places
    clockwise: bool = False

    def _of(self, which: int, phi: Floats, side: str) -> Floats:
        z = self.places(np.asarray(phi, dtype=float), side)[which]
        return np.stack([z.real, -z.imag if self.clockwise else z.imag], axis=-1)

    def points(self, phi: Floats, side: str = "after") -> Floats:
        return self._of(0, phi, side)

    def tangents(self, phi: Floats, side: str = "after") -> Floats:
        return self._of(1, phi, side)

    def seconds(self, phi: Floats, side: str = "after") -> Floats:
        return self._of(2, phi, side)


# -- motion laws ---------------------------------------------------------------------------------------------


def cycloidal(h: float, start: float = 0.0) -> Piece:
    """Rise by h without jumps of acceleration: u − sin(2πu)/(2π)."""
    return Piece((start, h), (Harmonic(TURN, 0.0, -h / TURN),))


def quintic(h: float, start: float = 0.0) -> Piece:
    """Rise by h: 10u³ − 15u⁴ + 6u⁵."""
    return Piece((start, 0.0, 0.0, 10 * h, -15 * h, 6 * h))


def harmonic(h: float, start: float = 0.0) -> Piece:
    """Rise by h with jumps of acceleration at its ends: (1 − cos πu)/2."""
    return Piece((start + h / 2,), (Harmonic(math.pi, -h / 2, 0.0),))


def dwells(h: float, rise: Callable[..., Piece] = cycloidal) -> MotionLaw:
    return MotionLaw.of(
        0.0,
        (math.radians(100), rise(h)),
        (math.radians(60), Piece((h,))),
        (math.radians(120), rise(-h, h)),
        (TURN - math.radians(280), Piece((0.0,))),
    )


def zigzag(h: float) -> MotionLaw:
    return MotionLaw.of(0.0, (math.pi, Piece((0.0, h))), (math.pi, Piece((h, -h))))


# -- cams ----------------------------------------------------------------------------------------------------


def eccentric(radius: float, eccentricity: float) -> Cam:

    def places(phi: Floats, side: str) -> tuple[Complex, Complex, Complex]:
        z = radius * np.exp(1j * phi)
        return z + eccentricity, 1j * z, -z

    return Cam((0.0, TURN), places)


def knife_edge(law: MotionLaw, base: float, clockwise: bool = False) -> Cam:
    """(r₀ + s) e^{iφ}."""

    def places(phi: Floats, side: str) -> tuple[Complex, Complex, Complex]:
        return _pitch(law, base, 0.0, phi, side)[:3]

    return Cam(law.breaks, places, clockwise)


def roller(law: MotionLaw, prime: float, radius: float, offset: float = 0.0, clockwise: bool = False) -> Cam:

    def places(phi: Floats, side: str) -> tuple[Complex, Complex, Complex]:
        z, z1, z2, z3 = _pitch(law, prime, offset, phi, side)
        t = z1 / np.abs(z1)
        turn, turn_d1 = (z2 / z1).imag, (z3 / z1 - (z2 / z1) ** 2).imag
        return z + 1j * radius * t, z1 - radius * turn * t, z2 - radius * (turn_d1 + 1j * turn**2) * t

    return Cam(law.breaks, places, clockwise)


def flat_face(law: MotionLaw, base: float) -> Cam:
    """(r₀ + s + i s′) e^{iφ}: the envelope of a flat face square to its motion."""

    def places(phi: Floats, side: str) -> tuple[Complex, Complex, Complex]:
        s, s1, s2, s3 = (law.at(phi, order, side) for order in range(4))
        turn, radius = np.exp(1j * phi), base + s + s2
        return (base + s + 1j * s1) * turn, 1j * radius * turn, (1j * (s1 + s3) - radius) * turn

    return Cam(law.breaks, places)


def _pitch(law: MotionLaw, prime: float, offset: float, phi: Floats, side: str) -> tuple[Complex, ...]:
    """Centre of the roller over the cam, with three derivatives: (√(r₀² − e²) + s + i e) e^{iφ}."""
    s = [law.at(phi, order, side) for order in range(4)]
    w = math.sqrt(prime**2 - offset**2) + s[0] + 1j * offset
    turn = np.exp(1j * phi)
    return (
        w * turn,
        (s[1] + 1j * w) * turn,
        (s[2] + 2j * s[1] - w) * turn,
        (s[3] + 3j * s[2] - 3 * s[1] - 1j * w) * turn,
    )


CAMS: dict[str, Cam] = {
    "eccentric": eccentric(0.03, 0.01),
    "dwells, cycloidal, roller": roller(dwells(0.02), 0.05, 0.01),
    "dwells, 3-4-5, offset roller, clockwise": roller(dwells(0.02, quintic), 0.05, 0.01, 0.012, True),
    "hollow flanks": roller(dwells(0.035, quintic), 0.045, 0.006),
    "jumps of curvature": roller(dwells(0.015, harmonic), 0.05, 0.01),
    "heart with corners": knife_edge(zigzag(0.03), 0.02),
    "flat face": flat_face(dwells(0.01, quintic), 0.06),
    "small": roller(dwells(2e-3), 5e-3, 1e-3),
    "large": roller(dwells(0.2), 0.6, 0.1),
}
