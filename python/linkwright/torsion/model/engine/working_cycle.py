r"""A whole working cycle at n operating points: the closed gas, then the gas exchange by valve timing.

The work of the cycle is linear in the heat as the pressure is, so the heat for a mean effective pressure is

.. math:: Q = \frac{p_i - p_{i,a}}{p_{i,b}}

with the mean effective pressures of p_a and p_b; for a peak pressure p̂ it is the minimum (p̂ - p_a)/p_b over
the cycle.

From opening on the pressure falls to that of the exhaust, in the course of a cosine over the blow-down;
between the opening of the intake and the closing of the exhaust it goes over to that of the charge, and
stays there until the cylinder is closed:

.. math:: p = p_e + (p_c - p_e) s(φ) + (p_o - p_e) b(φ)

with p_o the pressure at opening. It is a scheme, not gas dynamics: the pressures of the gas exchange are a
few bars, those of combustion a hundred.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import Description, fault
from linkwright.kernel.errors import FindingError, MachineError, Problem
from linkwright.kernel.units.kinds import ANGLE
from linkwright.kernel.units.marks import positive
from linkwright.torsion.model.engine.closed_cycle import (
    ClosedGas,
    ClosedTrace,
    Rule,
    Split,
    closed_trace,
    no_heat,
)
from linkwright.torsion.model.engine.cycle_pressure import CycleMesh, peak
from linkwright.torsion.model.engine.gas import check_reach

PositiveAngle = Annotated[float, positive(ANGLE)]

# Usual timing, in degrees after the dead centre of firing, by strokes.
_USUAL = {
    4: {"exhaust_opens": 130.0, "intake_opens": 350.0, "exhaust_closes": 370.0, "intake_closes": 580.0},
    2: {"exhaust_opens": 110.0, "intake_opens": 140.0, "exhaust_closes": 250.0, "intake_closes": 220.0},
}
# A cylinder blows down within some fifty degrees, or before fresh charge enters it.
_BLOWDOWN = math.radians(50.0)
# Without overlap, the pressure still needs some angle to change.
_CHANGE = math.radians(20.0)


@dataclass(frozen=True)
class Timing:
    """Crank angles from the top dead centre of firing, in order [rad]."""

    closes: float  # the cylinder is closed, before the dead centre: negative
    opens: float  # the exhaust opens
    blown_down: float  # the pressure is that of the exhaust
    # `intake_opens`, `charged`: the pressure begins to change to that of the charge, and is there.
    intake_opens: float
    charged: float
    ends: float  # the cylinder closes again, a cycle after `closes`

    @property
    def corners(self) -> tuple[float, ...]:
        """Where the pressure of the open cylinder has corners [rad]."""
        return (self.blown_down, self.intake_opens, self.charged)

    def blowdown(self, angle: Floats) -> Floats:
        """Share b of the pressure at opening that is left at crank angles (m,) while open [rad]."""
        return 1.0 - _rise(angle, self.opens, self.blown_down)

    def charging(self, angle: Floats) -> Floats:
        """Share s of the charge in the pressure at crank angles (m,) while open [rad]."""
        return _rise(angle, self.intake_opens, self.charged)


def _rise(angle: Floats, start: float, end: float) -> Floats:
    """Half-cosine rise from 0 to 1."""
    return np.asarray(0.5 - 0.5 * np.cos(np.pi * np.clip((angle - start) / (end - start), 0.0, 1.0)))


class Valves(Description):
    """When valves or ports open and close, after the top dead centre of firing."""

    exhaust_opens: PositiveAngle | None = Field(
        None, description="Opening of the exhaust. Default: 130 deg with four strokes, 110 deg with two."
    )
    exhaust_closes: PositiveAngle | None = Field(
        None, description="Closing of the exhaust. Default: 370 deg with four strokes, 250 deg with two."
    )
    intake_opens: PositiveAngle | None = Field(
        None, description="Opening of the intake. Default: 350 deg with four strokes, 140 deg with two."
    )
    intake_closes: PositiveAngle | None = Field(
        None, description="Closing of the intake. Default: 580 deg with four strokes, 220 deg with two."
    )
    blowdown: PositiveAngle | None = Field(
        None,
        description="Blowdown: crank angle in which the pressure falls to the exhaust pressure. Default: "
        "50 deg, or less if the intake opens earlier.",
    )

    def angle(self, name: str, strokes: int) -> float:
        """One of the four angles, given or usual [rad]."""
        given: float | None = getattr(self, name)
        return math.radians(_USUAL[strokes][name]) if given is None else given

    def timing(self, strokes: int) -> Timing:
        """The angles in order."""
        opens, intake = (self.angle(name, strokes) for name in ("exhaust_opens", "intake_opens"))
        last = max(self.angle(name, strokes) for name in ("exhaust_closes", "intake_closes"))
        blowdown = self.blowdown or min(_BLOWDOWN, intake - opens)
        charged = min(max(self.angle("exhaust_closes", strokes), intake + _CHANGE), last)
        return Timing(last - math.pi * strokes, opens, opens + blowdown, intake, charged, last)

    def cycle_faults(self, strokes: int) -> Iterator[InitErrorDetails]:
        """Angles that are not in their order, or not in the stroke that they belong to."""
        cycle, opens = 180.0 * strokes, math.degrees(self.angle("exhaust_opens", strokes))
        intake = math.degrees(self.angle("intake_opens", strokes))
        yield from _outside("exhaust_opens", opens, 45.0, 216.0)
        yield from _outside("intake_opens", intake, opens, cycle)
        yield from _outside(
            "exhaust_closes", math.degrees(self.angle("exhaust_closes", strokes)), opens, cycle - 45.0
        )
        yield from _outside(
            "intake_closes", math.degrees(self.angle("intake_closes", strokes)), intake, cycle - 45.0
        )
        if self.blowdown is not None:
            yield from _outside("blowdown", math.degrees(self.blowdown), 0.0, intake - opens)


def _outside(name: str, found: float, low: float, high: float) -> Iterator[InitErrorDetails]:
    if not low < found <= high:
        expected = f"between {low:.6g} and {high:.6g} deg after the dead centre of firing"
        yield fault(name, found=f"{found:.6g} deg", expected=expected)


@dataclass(frozen=True, eq=False)
class WorkingCycle:
    """A cycle at n operating points."""

    closed: ClosedGas  # between closing and opening
    open: CycleMesh  # crank angles while the cylinder is open
    open_volume_d1: Floats  # (m,) V′ there [m³/rad]
    timing: Timing  # of valves or ports
    # `exhaust_pressure`, `charge_pressure`: (n, 1) absolute [Pa].
    exhaust_pressure: Floats
    charge_pressure: Floats

    @property
    def angle(self) -> Floats:
        """Crank angles of the cycle, shape (k,) [rad]."""
        return np.concatenate([self.closed.mesh.angle, self.open.angle])

    @property
    def weight(self) -> Floats:
        """What each angle counts in an integral, shape (k,) [rad]."""
        return np.concatenate([self.closed.mesh.weight, self.open.weight])

    def pressure(self, trace: ClosedTrace) -> Floats:
        """Pressure over the cycle, shape (n, k) [Pa]."""
        return np.hstack([trace.pressure, self._exchange + self._blowdown * trace.opening])

    @property
    def _blowdown(self) -> Floats:
        return np.asarray(self.timing.blowdown(self.open.angle))

    @property
    def _exchange(self) -> Floats:
        s = self.timing.charging(self.open.angle)
        p_e = self.exhaust_pressure
        return np.asarray(p_e + (self.charge_pressure - p_e) * s - p_e * self._blowdown)

    def mean_effective(self, trace: ClosedTrace) -> Floats:
        """Mean effective pressure, shape (n, 1) [Pa]."""
        return self._mean_effective(trace.pressure, trace.opening, self._exchange)

    def _mean_effective(self, closed: Floats, opening: Floats, exchange: Floats) -> Floats:
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

    def heat_for_load(self, wanted: Floats) -> Rule:
        """The rule that gives a mean effective pressure. `wanted`: (n, 1) p_i [Pa]."""
        exchange = self._exchange
        none = np.zeros_like(exchange)

        def rule(split: Split) -> Floats:
            p_a = self._mean_effective(split.without, split.opening_without, exchange)
            p_b = self._mean_effective(split.per_heat, split.opening_per_heat, none)
            _check_work(p_b)
            check_reach(wanted[:, 0], p_a[:, 0], self.closed.speed[:, 0])
            return (wanted - p_a) / p_b

        return rule

    def heat_for_peak(self, wanted: float) -> Rule:
        """The rule that gives a peak pressure. `wanted`: [Pa]."""
        angle = self.closed.mesh.angle

        def rule(split: Split) -> Floats:
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


def _check_work(work: Floats) -> None:
    if not (work > 0).all():
        raise FindingError(
            "the heat released in a cylinder does no work: it is so early, so late or so sudden that no "
            "load corresponds to it; check start, duration and form factor of [train.engine.gas] releases"
        )
