r"""A whole working cycle at n operating points: the closed gas, then the gas exchange.

The work of the cycle is linear in the heat as the pressure is, so the heat for a mean effective pressure is

.. math:: Q = \frac{p_i - p_{i,a}}{p_{i,b}}

with the mean effective pressures of p_a and p_b; for a peak pressure p̂ it is the minimum (p̂ - p_a)/p_b over
the cycle.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.errors import FindingError, MachineError, Problem
from linkwright.torsion.model.engine.closed_cycle import (
    ClosedGas,
    ClosedTrace,
    Rule,
    Split,
    closed_trace,
    no_heat,
)
from linkwright.torsion.model.engine.cycle_mesh import CycleMesh
from linkwright.torsion.model.engine.cycle_pressure import peak
from linkwright.torsion.model.engine.gas import check_reach
from linkwright.torsion.model.engine.valves import Timing

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class WorkingCycle:
    """A cycle at n operating points."""

    closed: ClosedGas  # between closing and opening
    open: CycleMesh  # crank angles while the cylinder is open
    open_volume_d1: Array  # (m,) V′ there [m³/rad]
    timing: Timing  # of valves or ports
    # `exhaust_pressure`, `charge_pressure`: (n, 1) absolute [Pa].
    exhaust_pressure: Array
    charge_pressure: Array

    @property
    def angle(self) -> Array:
        """Crank angles of the cycle, shape (k,) [rad]."""
        return np.concatenate([self.closed.mesh.angle, self.open.angle])

    @property
    def weight(self) -> Array:
        """What each angle counts in an integral, shape (k,) [rad]."""
        return np.concatenate([self.closed.mesh.weight, self.open.weight])

    def pressure(self, trace: ClosedTrace) -> Array:
        """Pressure over the cycle, shape (n, k) [Pa]."""
        return np.hstack([trace.pressure, self._exchange + self._blowdown * trace.opening])

    @property
    def _blowdown(self) -> Array:
        """Pressure of the open cylinder per pressure at opening."""
        return np.asarray(self.timing.blowdown(self.open.angle))

    @property
    def _exchange(self) -> Array:
        """Pressure of the open cylinder besides."""
        s = self.timing.charging(self.open.angle)
        p_e = self.exhaust_pressure
        return np.asarray(p_e + (self.charge_pressure - p_e) * s - p_e * self._blowdown)

    def mean_effective(self, trace: ClosedTrace) -> Array:
        """Mean effective pressure, shape (n, 1) [Pa]."""
        return self._mean_effective(trace.pressure, trace.opening, self._exchange)

    def _mean_effective(self, closed: Array, opening: Array, exchange: Array) -> Array:
        """The same from the pressure while closed, at opening, and while open besides what is left of it."""
        gas = self.closed
        work = closed @ (gas.volume_d1 * gas.mesh.weight)
        open_work = (exchange + self._blowdown * opening) @ (self.open_volume_d1 * self.open.weight)
        return np.asarray((work + open_work)[:, None] / gas.swept_volume)

    def motored(self) -> ClosedTrace:
        """The closed gas without combustion."""
        return closed_trace(self.closed, no_heat)

    def fired(self, rule: Rule, motored: ClosedTrace) -> ClosedTrace:
        """The closed gas with heat."""
        return closed_trace(self.closed, rule, motored.pressure)

    def heat_for_load(self, wanted: Array) -> Rule:
        """The rule that gives a mean effective pressure. `wanted`: (n, 1) p_i [Pa]."""
        exchange = self._exchange
        none = np.zeros_like(exchange)

        def rule(split: Split) -> Array:
            p_a = self._mean_effective(split.without, split.opening_without, exchange)
            p_b = self._mean_effective(split.per_heat, split.opening_per_heat, none)
            _check_work(p_b)
            check_reach(wanted[:, 0], p_a[:, 0], self.closed.speed[:, 0])
            return (wanted - p_a) / p_b

        return rule

    def heat_for_peak(self, wanted: float) -> Rule:
        """The rule that gives a peak pressure. `wanted`: [Pa]."""
        angle = self.closed.mesh.angle

        def rule(split: Split) -> Array:
            least = float(peak(angle, split.without).max())
            if wanted <= least:
                expected = f"more than {least:.6g} Pa, the pressure of compression alone"
                raise MachineError([Problem("train.engine.gas.peak_pressure", f"{wanted:.6g} Pa", expected)])
            # The peak lies between points; how far beyond the maximum of them, the last iterate says.
            beyond = split.last.max(axis=1) / peak(angle, split.last)
            burns = split.per_heat > 0
            _check_work(burns.max(axis=1))
            room = (wanted * beyond[:, None] - split.without) / np.where(burns, split.per_heat, 1.0)
            return np.asarray(np.where(burns, room, np.inf).min(axis=1, keepdims=True))

        return rule


def _check_work(work: Array) -> None:
    """Refuse heat that does no work, or raises no pressure, so that no heat gives what is wanted."""
    if not (work > 0).all():
        raise FindingError(
            "the heat released in a cylinder does no work: it comes so early, so late or so suddenly that no "
            "load goes with it; check start, duration and form factor of [train.engine.gas] releases"
        )
