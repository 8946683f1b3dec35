r"""A cylinder: its working space, the motion of its piston, the torque of its gas on the crank.

With x(φ) the distance of the piston from the axis of the crank, A the area of the bore and r_c the
compression ratio,

.. math:: V = A (x_\max - x) + V_c, \qquad V_h = A (x_\max - x_\min), \qquad V_c = \frac{V_h}{r_c - 1}

The motion comes as values over one revolution, so that any mechanism will do: a plain crank, an offset one, a
rod on a master rod. Its top dead centre is found, and pressures are counted from there.

The gas pushes the piston with p − p_c over the area A, and virtual work gives the torque at the crank
whatever the mechanism between them,

.. math:: M(φ) = -(p - p_c) A x', \qquad
    M = \mathrm{Re} \sum_ν M_ν e^{iνφ}, \qquad
    M_ν = \frac{2}{Φ} \int_Φ M e^{-iνφ} dφ, \quad M_0 = \frac1Φ \int_Φ M dφ

with x the distance of the piston from the axis of the crank (x′ < 0 as it descends: pressure drives) and Φ
the angle of a working cycle. Orders count per revolution of the crank: with four strokes they go by halves.
The integrals are those of the mesh of `CyclePressure`.

References
----------
.. [1] Den Hartog, Mechanical Vibrations, 4th ed. 1956, section 5.6: torque on a crankshaft from the indicator
   diagram.
.. [2] Porter, Harmonic coefficients of engine torque curves, J. Appl. Mech. 10 (1943) A33-A48.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from linkwright.kernel.arrays import Complexes, Floats
from linkwright.kernel.errors import MachineError, Problem, ShapeError
from linkwright.torsion.model.engine.cycle_pressure import CyclePressure

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
    position: Floats

    def __post_init__(self) -> None:
        size = np.abs(self._spectrum)
        if len(self.position) < 8 or size[-2:].max() > _RESOLVED * size[1:].max():
            raise ShapeError(
                f"{len(self.position)} positions do not describe the motion of a piston: their highest "
                f"harmonics have not faded; give more positions over the revolution"
            )

    @cached_property
    def _spectrum(self) -> Complexes:
        """Coefficients c_k of x = Re Σ c_k e^{ikφ}."""
        c = np.fft.rfft(self.position) / len(self.position)
        c[1:] *= 2.0
        return c

    @cached_property
    def _series(self) -> Complexes:
        """Coefficients down to rounding."""
        c = self._spectrum
        kept = np.flatnonzero(np.abs(c) > _NEGLIGIBLE * np.abs(c[1:]).max())
        return c[: kept[-1] + 1]

    def motion(self, crank_angle: Floats) -> tuple[Floats, Floats]:
        """x [m] and x′ [m/rad] of the piston, (m,) each, at crank angles φ (m,) [rad]."""
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

    def volume(self, angle: Floats, compression_ratio: float) -> tuple[Floats, Floats]:
        """Volume above the piston and its derivative.

        V [m³] and V′ [m³/rad], shape (m,) each. `angle`: (m,) crank angles from the top dead centre [rad];
        `compression_ratio`: r_c.
        """
        x, x_d1 = self.motion(angle + self.top)
        clearance = self.swept_volume / (compression_ratio - 1)
        return self.area * (self.highest - x) + clearance, -self.area * x_d1


def powers(angle: Floats, n: int) -> Complexes:
    """The rotations e^{ikφ} for k = 0 … n − 1, shape (n, m).

    Each the product of the one before with e^{iφ}, which costs a tenth of as many exponentials and loses n
    units in the last place. `angle`: (m,) angles φ [rad].
    """
    turns = np.empty((n, len(angle)), dtype=np.complex128)
    turns[0] = 1.0
    turns[1:] = np.exp(1j * angle)
    return np.multiply.accumulate(turns, axis=0)


# Beyond, the mesh of the cycle would have to be finer: up to here its harmonics are good to 1e-6 of the
# largest.
_HIGHEST = 48.0


@dataclass(frozen=True, eq=False)
class GasTorque:
    """Harmonics of the gas torque of one cylinder at n speeds, for o orders."""

    speeds: Floats  # (n,) of the crank [rad/s]
    orders: Floats  # (o,) per revolution of the crank, from 0
    # (n, o) M_ν of a sound cylinder, complex [N m]; φ = 0 is where the crank points along the cylinder, near
    # the firing.
    firing: Complexes
    # (n, o) the same of a cylinder that misfires: it compresses and expands without combustion.
    motored: Complexes
    mean_effective_pressure: Floats  # (n,) Indicated, of a sound cylinder [Pa]
    pressure: CyclePressure  # what it is from

    @property
    def peak_pressure(self) -> Floats:
        """Maximum pressure of a sound cylinder, shape (n,) [Pa]."""
        return self.pressure.peak_pressure

    def of(self, factor: float) -> Complexes:
        """Harmonics of a cylinder whose combustion is weaker or stronger, (n, o). M_ν, complex [N m]."""
        return self.motored + factor * (self.firing - self.motored)

    def waveform(self, crank_angle: Floats, factor: float = 1.0) -> Floats:
        """Torque M [N m], (n, m), summed from the harmonics at crank angles φ (m,) [rad]."""
        turns = np.exp(1j * self.orders[:, None] * np.asarray(crank_angle))
        return np.asarray((self.of(factor) @ turns).real)


def torque_orders(strokes: int, highest: float = 24.0) -> Floats:
    """Orders of a cylinder's torque, shape (o,). From 0, in steps of ½ with four strokes, of 1 with two."""
    if not 0 <= highest <= _HIGHEST:
        expected = f"a number from 0 to {_HIGHEST:.6g}"
        raise MachineError([Problem("train.run.orders_max", f"{highest:.6g}", expected)])
    step = 2.0 / strokes
    return np.asarray(np.arange(round(highest / step) + 1) * step)


def gas_torque(pressure: CyclePressure, cylinder: Cylinder, highest: float = 24.0) -> GasTorque:
    """Torque of the gas of one cylinder. Harmonics at each speed."""
    orders = torque_orders(cylinder.strokes, highest)
    phi = pressure.angle + cylinder.top
    _, x_d1 = cylinder.motion(phi)
    # Integral of M e^{-iνφ} as a matrix: torque per pressure times the mesh's weight, turned by each order.
    lever = -cylinder.area * x_d1 * pressure.weight * (2.0 / cylinder.cycle)
    turns = powers(-phi * (2.0 / cylinder.strokes), len(orders))
    turns[0] *= 0.5
    # No product of matrices: one so small is shared out to threads that wait longer than they work.
    of_traces = np.einsum("tp,op->to", pressure.traces - pressure.crankcase_pressure, turns * lever)
    # Shares sum to one, so the pressure under the piston is taken off the traces.
    firing = np.einsum("nt,to->no", pressure.firing, of_traces)
    return GasTorque(
        pressure.speeds,
        orders,
        firing,
        np.einsum("nt,to->no", pressure.motored, of_traces),
        np.asarray(firing[:, 0].real * (cylinder.cycle / cylinder.swept_volume)),
        pressure,
    )
