r"""The working space of a cylinder: its volume and the piston's motion as Fourier series.

With x(φ) the distance of the piston from the axis of the crank, A the area of the bore and r_c the
compression ratio,

.. math:: V = A (x_\max - x) + V_c, \qquad V_h = A (x_\max - x_\min), \qquad V_c = \frac{V_h}{r_c - 1}

The motion comes as values over one revolution, so that any mechanism will do: a plain crank, an offset one, a
rod on a master rod. Its top dead centre is found, and pressures are counted from there.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.errors import ShapeError

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

# Share of the stroke below which a harmonic of the motion is rounding.
_NEGLIGIBLE = 1e-15
# Share of the stroke that the highest harmonic may have where the values describe the motion.
_RESOLVED = 1e-6


@dataclass(frozen=True, eq=False)
class Cylinder:
    """A cylinder whose piston moves as given."""

    bore: float  # diameter [m]
    strokes: int  # of a working cycle, 2 or 4
    # (n,) distance x of the piston from the axis of the crank [m], along the cylinder, at n crank angles
    # 2πi/n from where the crank points along the cylinder.
    position: Array

    def __post_init__(self) -> None:
        size = np.abs(self._spectrum)
        if len(self.position) < 8 or size[-2:].max() > _RESOLVED * size[1:].max():
            raise ShapeError(
                f"{len(self.position)} positions do not describe the motion of a piston: their highest "
                f"harmonics have not faded; give more positions over the revolution"
            )

    @cached_property
    def _spectrum(self) -> Complex:
        """Coefficients c_k of x = Re Σ c_k e^{ikφ}."""
        c = np.fft.rfft(self.position) / len(self.position)
        c[1:] *= 2.0
        return c

    @cached_property
    def _series(self) -> Complex:
        """The coefficients up to the last that is more than rounding."""
        c = self._spectrum
        kept = np.flatnonzero(np.abs(c) > _NEGLIGIBLE * np.abs(c[1:]).max())
        return c[: kept[-1] + 1]

    def motion(self, crank_angle: Array) -> tuple[Array, Array]:
        """Position of the piston [m] and its derivative by the crank angle [m/rad].

        x and x′, shape (m,) each. `crank_angle`: (m,) crank angles φ [rad].
        """
        c = self._series
        turn = np.exp(1j * crank_angle)
        # Horner; a product of matrices so small is shared out to threads, which wait longer than they work.
        x, x_d1 = np.zeros_like(turn), np.zeros_like(turn)
        for k in range(len(c) - 1, 0, -1):
            x, x_d1 = (x + c[k]) * turn, (x_d1 + k * c[k]) * turn
        return x.real + c[0].real, -x_d1.imag

    def _dead_centre(self, start: float) -> float:
        """Angle near a start where the piston rests, by Newton [rad]."""
        c, k = self._series, np.arange(len(self._series))
        phi = start
        # From the nearest of eight or more values Newton doubles its digits at each step.
        for _ in range(50):
            turn = np.exp(1j * k * phi)
            step = (1j * k * c @ turn).real / (-(k**2) * c @ turn).real
            phi -= step
            if abs(step) < 1e-15:
                break
        return float(phi)

    @cached_property
    def top(self) -> float:
        """Crank angle of the top dead centre, between −π and π [rad]."""
        n = len(self.position)
        return math.remainder(self._dead_centre(2 * math.pi * int(np.argmax(self.position)) / n), 2 * math.pi)

    @cached_property
    def bottom(self) -> float:
        """Crank angle of the bottom dead centre, between 0 and 2π [rad]."""
        return self._dead_centre(2 * math.pi * int(np.argmin(self.position)) / len(self.position))

    @cached_property
    def highest(self) -> float:
        """Position at the top dead centre [m]."""
        return float(self.motion(np.array([self.top]))[0][0])

    @cached_property
    def stroke(self) -> float:
        """Way of the piston between its dead centres [m]."""
        return self.highest - float(self.motion(np.array([self.bottom]))[0][0])

    @property
    def area(self) -> float:
        """Of the bore [m²]."""
        return math.pi / 4 * self.bore**2

    @property
    def swept_volume(self) -> float:
        """V_h [m³]."""
        return self.area * self.stroke

    @property
    def cycle(self) -> float:
        """Crank angle of a working cycle [rad]."""
        return math.pi * self.strokes

    def volume(self, angle: Array, compression_ratio: float) -> tuple[Array, Array]:
        """Volume above the piston and its derivative.

        V [m³] and V′ [m³/rad], shape (m,) each. `angle`: (m,) crank angles from the top dead centre [rad];
        `compression_ratio`: r_c.
        """
        x, x_d1 = self.motion(angle + self.top)
        clearance = self.swept_volume / (compression_ratio - 1)
        return self.area * (self.highest - x) + clearance, -self.area * x_d1


def powers(angle: Array, n: int) -> Complex:
    """The rotations e^{ikφ} for k = 0 … n − 1, shape (n, m).

    Each the product of the one before with e^{iφ}, which costs a tenth of as many exponentials and loses n
    units in the last place. `angle`: (m,) angles φ [rad].
    """
    turns = np.empty((n, len(angle)), dtype=np.complex128)
    turns[0] = 1.0
    turns[1:] = np.exp(1j * angle)
    return np.multiply.accumulate(turns, axis=0)
