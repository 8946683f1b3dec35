r"""The torque of the gas on the crank, and its harmonics.

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

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.errors import MachineError, Problem
from linkwright.torsion.model.engine.cycle_pressure import CyclePressure
from linkwright.torsion.model.engine.cylinder import Cylinder, powers

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

# Beyond, the mesh of the cycle would have to be finer: up to here its harmonics are good to 1e-6 of the
# largest.
_HIGHEST = 48.0


@dataclass(frozen=True, eq=False)
class GasTorque:
    """Harmonics of the gas torque of one cylinder at n speeds, for o orders."""

    speeds: Array  # (n,) of the crank [rad/s]
    orders: Array  # (o,) per revolution of the crank, from 0
    # (n, o) M_ν of a sound cylinder, complex [N m]; φ = 0 is where the crank points along the cylinder, near
    # the firing.
    firing: Complex
    # (n, o) the same of a cylinder that misfires: it compresses and expands without combustion.
    motored: Complex
    mean_effective_pressure: Array  # (n,) Indicated, of a sound cylinder [Pa]
    pressure: CyclePressure  # what it is from

    @property
    def peak_pressure(self) -> Array:
        """Maximum pressure of a sound cylinder, shape (n,) [Pa]."""
        return self.pressure.peak_pressure

    def of(self, factor: float) -> Complex:
        """Harmonics of a cylinder whose combustion is weaker or stronger, (n, o). M_ν, complex [N m]."""
        return self.motored + factor * (self.firing - self.motored)

    def waveform(self, crank_angle: Array, factor: float = 1.0) -> Array:
        """Torque over the crank angle, summed from the harmonics, (n, m).

        M [N m]. `crank_angle`: (m,) φ [rad].
        """
        turns = np.exp(1j * self.orders[:, None] * np.asarray(crank_angle))
        return np.asarray((self.of(factor) @ turns).real)


def torque_orders(strokes: int, highest: float = 24.0) -> Array:
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
