"""Cams whose shape is known: followers of an eccentric circle, and laws by any formula."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.polynomial import Chebyshev, Polynomial

import linkwright as lw
from linkwright.cam import CamCurve, MotionLaw, Sizes, cam_kernel
from linkwright.cam.laws.motion_law import Piece
from linkwright.cam.profile.contact import Contact

Floats = np.ndarray
TURN = 2 * np.pi

# Pieces and degree of a fitted law: for the circles below the Chebyshev series ends below 1e-16 of its size.
PIECES, DEGREE = 24, 13


def fitted(function: Callable[[Floats], Floats], pieces: int = PIECES, degree: int = DEGREE) -> MotionLaw:
    """A smooth function over a revolution as a law, good to rounding."""
    breaks = TURN * np.arange(pieces + 1) / pieces
    made = []
    for low, high in pairwise(breaks):
        series = Chebyshev.interpolate(
            lambda u, low=low, high=high: function(low + (high - low) * u), degree, domain=[0, 1]
        )
        made.append(Piece(tuple(series.convert(kind=Polynomial, domain=[-1, 1]).coef)))
    return MotionLaw(tuple(breaks), tuple(made))


def contact(law: MotionLaw, size: Sizes, start: float, **kind: bool) -> Contact:
    return Contact("cam", law, size, cam_kernel(law, size, **kind), start)


def unit(angle: Floats | float) -> Floats:
    """Unit vectors, (…, 2)."""
    return np.stack((np.cos(angle), np.sin(angle)), axis=-1)


def turned(vectors: Floats, angle: Floats | float) -> Floats:
    """Vectors (…, 2) turned by angles."""
    x, y = vectors[..., 0], vectors[..., 1]
    return np.stack((np.cos(angle) * x - np.sin(angle) * y, np.sin(angle) * x + np.cos(angle) * y), axis=-1)


@dataclass(frozen=True)
class Circle:
    """An eccentric circle under a follower: all that is known of it by plain geometry."""

    oscillating: bool
    roller: float | None
    opposite: bool = False
    left: bool = True
    offset: float = 0.0
    tilt: float = 0.0
    R: float = 0.05
    e: float = 0.012
    theta: float = 0.7
    distance: float = 0.14
    arm: float = 0.11

    @property
    def sense(self) -> float:
        return -1.0 if self.opposite else 1.0

    @property
    def side(self) -> float:
        return 1.0 if self.left else -1.0

    @property
    def centre(self) -> Floats:
        return self.e * unit(self.theta)

    def place(self, phi: Floats) -> Floats:
        """Place of the follower: along its line, or angle of the arm."""
        C = turned(self.centre, self.sense * phi)
        x, y = C[..., 0], C[..., 1]
        if not self.oscillating:
            if self.roller is None:
                n = unit(self.tilt)
                return (x * n[0] + y * n[1] + self.R) / n[0]
            return x + np.sqrt((self.R + self.roller) ** 2 - (self.offset - y) ** 2)
        D = np.hypot(self.distance - x, y)
        chi = np.arctan2(self.side * y, self.distance - x)
        if self.roller is None:
            return chi + np.arcsin((self.R + self.offset) / D)
        l = self.arm  # noqa: E741
        return chi + np.arccos((l**2 + D**2 - (self.R + self.roller) ** 2) / (2 * l * D))

    def contact(self) -> Contact:
        phi = np.linspace(0, TURN, 20001)
        start = float(self.place(phi).min())
        roller = self.roller or 0.0
        if self.oscillating and self.roller is None:
            base = self.distance * np.sin(start) - self.offset
        elif self.oscillating:
            a, l = self.distance, self.arm  # noqa: E741
            base = np.sqrt(a**2 + l**2 - 2 * a * l * np.cos(start)) - roller
        elif self.roller is None:
            base = start * np.cos(self.tilt)
        else:
            base = np.hypot(start, self.offset) - roller
        a = self.distance if self.oscillating else 0.0
        size = Sizes(base, roller, self.offset, a, self.arm if self.oscillating else 0.0, self.tilt)
        law = fitted(lambda phi: self.place(phi) - start)
        kind = {"oscillating": self.oscillating, "roller": self.roller is not None}
        return contact(law, size, start, opposite=self.opposite, left=self.left, **kind)

    def follower(self, phi: Floats) -> tuple[Floats, Floats]:
        """Roller centre or a point of the face, and direction of the arm or of the face's normal; ground."""
        q = self.place(phi)
        if not self.oscillating:
            zero = np.zeros_like(q)
            return np.stack((q, zero + self.offset), axis=-1), np.broadcast_to(unit(self.tilt), (*q.shape, 2))
        u = np.stack((-np.cos(q), self.side * np.sin(q)), axis=-1)
        pivot = np.array([self.distance, 0.0])
        if self.roller is not None:
            return pivot + self.arm * u, u
        n = np.stack((np.sin(q), self.side * np.cos(q)), axis=-1)
        return pivot - self.offset * n, n


CIRCLES: dict[str, Circle] = {
    "knife": Circle(False, 0.0),
    "knife with offset": Circle(False, 0.0, offset=0.015),
    "roller": Circle(False, 0.011),
    "roller with offset to the right": Circle(False, 0.011, offset=-0.02),
    "roller, cam against the shaft": Circle(False, 0.011, offset=0.018, opposite=True),
    "flat": Circle(False, None),
    "flat, tilted": Circle(False, None, tilt=0.4),
    "flat, tilted, cam against the shaft": Circle(False, None, tilt=-0.3, opposite=True),
    "arm with an edge": Circle(True, 0.0),
    "arm with a roller": Circle(True, 0.011),
    "arm with a roller to the right": Circle(True, 0.011, left=False),
    "arm with a roller, cam against the shaft": Circle(True, 0.011, opposite=True),
    "arm with a roller to the right, cam against the shaft": Circle(True, 0.011, left=False, opposite=True),
    "flat arm": Circle(True, None),
    "flat arm with offset": Circle(True, None, offset=0.01),
    "flat arm to the right": Circle(True, None, left=False, offset=-0.006),
    "flat arm, cam against the shaft": Circle(True, None, opposite=True),
    "flat arm to the right, cam against the shaft": Circle(True, None, left=False, opposite=True),
}


def profile_of(touching: Contact) -> CamCurve:
    return CamCurve(touching, -touching.sizes.roller_radius)


def machine(cam: str, rest: str = "") -> lw.Machine:
    return lw.loads(f'format = 1\nname = "Cam"\n[mechanism.cams.F]\n{cam}\n{rest}')


# Sections of a rise, a dwell, a return and a dwell of 20 mm, or 0.3 rad.
RISE = """
sections = [
  { angle = "110 deg", lift = "20 mm", law = "cycloidal" },
  { angle = "50 deg" },
  { angle = "120 deg", lift = "-20 mm", law = "modified_sine" },
  { angle = "80 deg" },
]
"""
SWING = RISE.replace('lift = "20 mm"', "swing = 0.3").replace('lift = "-20 mm"', "swing = -0.3")
