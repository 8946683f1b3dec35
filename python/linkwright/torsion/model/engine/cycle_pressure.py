"""The pressure in a cylinder over its working cycle, at many speeds."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from linkwright.torsion.model.engine.periodic_cubic import periodic_cubic

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class CyclePressure:
    """Pressures at n speeds as sums of a few traces over m crank angles.

    Torque is linear in the pressure, so its harmonics are found for the traces alone and then summed.
    """

    speeds: Array  # (n,) of the crank [rad/s]
    angle: Array  # (m,) crank angles from the top dead centre of firing, increasing over one cycle [rad]
    weight: Array  # (m,) what each angle counts in an integral over the cycle [rad]
    traces: Array  # (k, m) absolute pressures [Pa]
    firing: Array  # (n, k) share of each trace in the pressure at each speed
    motored: Array  # (n, k) the same without combustion
    crankcase_pressure: float  # under the piston [Pa]

    @cached_property
    def pressure(self) -> Array:
        """Absolute pressure, shape (n, m) [Pa]."""
        return self.firing @ self.traces

    @cached_property
    def pressure_motored(self) -> Array:
        """The same without combustion, shape (n, m) [Pa]."""
        return self.motored @ self.traces

    def at(self, angle: Array) -> tuple[Array, Array]:
        """Pressure at any crank angles, by the monotone cubic through the points.

        Absolute pressure with combustion and without, shape (n, j) each [Pa]. `angle`: (j,) [rad].
        """
        cycle = float(self.weight.sum())
        traces = np.array([periodic_cubic(self.angle, each, cycle, angle) for each in self.traces])
        return self.firing @ traces, self.motored @ traces

    @property
    def peak_pressure(self) -> Array:
        """Maximum pressure at each speed, shape (n,) [Pa]."""
        return np.asarray(peak(self.angle, self.pressure))


def peak(angle: Array, pressure: Array) -> Array:
    """Maximum value of each row, by the parabola through its maximum point and the two beside it, (n,).

    The maximum values [Pa]. `angle`: (m,) crank angles [rad]; `pressure`: (n, m) rows of pressures [Pa].
    """
    top = np.clip(np.argmax(pressure, axis=1), 1, len(angle) - 2)
    row = np.arange(len(pressure))
    a, b, c = (angle[top + i] for i in (-1, 0, 1))
    p, q, r = (pressure[row, top + i] for i in (-1, 0, 1))
    # Divided differences of the parabola: slope at the middle, and half its curvature.
    left, right = (q - p) / (b - a), (r - q) / (c - b)
    half = (right - left) / (c - a)
    slope = left + half * (b - a)
    rise = -(slope**2) / (4 * np.where(half < 0, half, -np.inf))
    return np.asarray(q + rise)
