r"""A working cycle by calculation: compression, release of heat by Wiebe's function, expansion, gas exchange.

`closed_cycle` has the gas while the cylinder is closed, `working_cycle` the pressure while it is open, `heat`
release and losses. The heat of a cycle is given, or follows from the mean effective pressure

.. math:: p_i = \frac{1}{V_h} \oint p \, dV

or from the peak pressure. A load map asks for a mean effective pressure at each speed; the shape of the
release stays.

Many speeds are not computed one by one: pressures at a few speeds between the corners of the load map are
computed, and those between them by polynomials through these.

Through values f_j at points x_j of a piece goes the polynomial

.. math:: f(x) = \frac{\sum_j \frac{w_j}{x - x_j} f_j}{\sum_j \frac{w_j}{x - x_j}}, \qquad w_j = (-1)^j,
    \text{ half at both ends}

References
----------
.. [1] Berrut, Trefethen, Barycentric Lagrange interpolation, SIAM Review 46 (2004) 501-517, section 5.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import Annotated, Literal

import numpy as np
from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import fault
from linkwright.kernel.errors import InputError
from linkwright.kernel.units.kinds import ENERGY, TEMPERATURE
from linkwright.kernel.units.marks import positive
from linkwright.torsion.model.engine.closed_cycle import ClosedGas, Rule
from linkwright.torsion.model.engine.cycle_pressure import (
    CycleMesh,
    CyclePressure,
    closed_edges,
    mesh,
    open_edges,
)
from linkwright.torsion.model.engine.cylinder import Cylinder
from linkwright.torsion.model.engine.gas import Exponent, Gas, PositivePressure, below
from linkwright.torsion.model.engine.heat import AnyWallHeat, HeatShare, WallHeat, Wiebe
from linkwright.torsion.model.engine.working_cycle import Timing, Valves, WorkingCycle

# Any one of them sets the heat of a cycle.
_HEATS = ("heat", "mean_effective_pressure", "peak_pressure")
# Shares of heat are written with a few digits.
_WHOLE = 1e-6
# Back pressure where none is given: that of a silencer, and that of a turbine as a share of what the charge
# has above the air. Its corner lies where charging begins, not within the range of a charged engine.
_SILENCER = 105e3
_AIR = 100e3
_TURBINE = 0.9


class Combustion(Gas):
    """A cycle by Wiebe's function."""

    kind: Literal["wiebe"]
    charge_pressure: PositivePressure = Field(
        100e3, description="Absolute pressure in the cylinder at closure and during intake."
    )
    charge_pressure_unloaded: PositivePressure | None = Field(
        None,
        description="Charge pressure at no load; between no load and full load it is linear in the mean "
        "effective pressure. Default: the same at any load.",
    )
    charge_temperature: Annotated[float, positive(TEMPERATURE)] = Field(
        340.0, description="Temperature of the gas at closure of the cylinder."
    )
    exhaust_pressure: PositivePressure | None = Field(
        None,
        description="Absolute exhaust pressure. Default: 105 kPa plus 90 % of the charge pressure above "
        "100 kPa.",
    )
    heat: Annotated[float, positive(ENERGY)] | None = Field(
        None, description="Heat of the fuel per cycle and cylinder."
    )
    mean_effective_pressure: PositivePressure | None = Field(
        None, description="Indicated mean effective pressure, instead of the heat."
    )
    peak_pressure: PositivePressure | None = Field(None, description="Maximum pressure, instead of the heat.")
    releases: tuple[Wiebe, ...] = Field(
        (Wiebe(start=-math.radians(5.0), duration=math.radians(60.0), form_factor=1.0),),
        description="Functions of the heat release, weighted by their shares.",
    )
    isentropic_exponent: Exponent | None = Field(
        None,
        description="Isentropic exponent of the gas. Default: that of air and burnt gas at its temperature.",
    )
    walls: AnyWallHeat | None = Field(None, description="Heat loss to the walls. Default: none.")
    valves: Valves = Field(Valves(), description="Timing of valves or ports.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from super()._faults()
        given = [name for name in _HEATS if getattr(self, name) is not None]
        if self.load is not None and self.load.rated is not None:
            given.append("a load map with its own mean_effective_pressure")
        if len(given) != 1:
            yield fault(
                found=" and ".join(given) or None,
                expected="one of heat, mean_effective_pressure, peak_pressure, or a load map",
            )
        total = math.fsum(release.share for release in self.releases)
        if abs(total - 1) > _WHOLE:
            expected = "releases whose shares make 1"
            yield fault("releases", found=f"shares that make {total:.6g}", expected=expected)

    def cycle_faults(self, strokes: int) -> Iterator[InitErrorDetails]:
        wrong = list(self.valves.cycle_faults(strokes))
        yield from (below(problem, "valves") for problem in wrong)
        if wrong:
            return
        timing = self.valves.timing(strokes)
        for i, release in enumerate(self.releases):
            if release.start <= timing.closes or release.end >= timing.opens:
                yield fault(
                    "releases",
                    i,
                    found=f"heat from {math.degrees(release.start):.6g} to "
                    f"{math.degrees(release.end):.6g} deg",
                    expected=f"between {math.degrees(timing.closes):.6g} and "
                    f"{math.degrees(timing.opens):.6g} deg, while the cylinder is closed",
                )

    def cycle_pressure(self, cylinder: Cylinder, speeds: Floats) -> CyclePressure:
        speeds = np.asarray(speeds, dtype=float)
        if isinstance(self.walls, WallHeat) and not (speeds > 0).all():
            raise InputError(
                f"speeds: found {speeds.min():g} rad/s, expected speeds above 0: at rest the cycle never "
                "ends, and [train.engine.gas.walls] removes all heat from the gas; give a lowest speed, "
                "or walls of a share"
            )
        points, share = self._points(speeds)
        cycle, wanted = self.operating_points(cylinder, points)
        motored = cycle.motored()
        fired = cycle.fired(self._rule(cycle, wanted), motored)
        none = np.zeros_like(share)
        return CyclePressure(
            speeds,
            cycle.angle,
            cycle.weight,
            np.vstack([cycle.pressure(fired), cycle.pressure(motored)]),
            np.hstack([share, none]),
            np.hstack([none, share]),
            self.crankcase_pressure,
        )

    def _points(self, speeds: Floats) -> tuple[Floats, Floats]:
        if self.load is None and not isinstance(self.walls, WallHeat):
            # Nothing depends on the speed.
            return speeds[:1], np.ones((len(speeds), 1))
        return speed_points(speeds, self.load.kinks() if self.load else ())

    def operating_points(self, cylinder: Cylinder, speeds: Floats) -> tuple[WorkingCycle, Floats | None]:
        """The cycle at given speeds, computed for each.

        The cycle, and the mean effective pressure that the load map asks for, shape (n, 1) [Pa]; None without
        one. `speeds`: (n,) [rad/s].
        """
        charge = np.full((len(speeds), 1), self.charge_pressure)
        if self.load is None:
            return self._cycle(cylinder, speeds, charge), None
        rated = self._rated(cylinder)
        wanted = self.load.mean_effective(speeds, rated)[:, None]
        given = self.load.charge(speeds)
        if given is not None:
            charge = given[:, None]
        elif self.charge_pressure_unloaded is not None:
            least = self.charge_pressure_unloaded
            charge = least + (self.charge_pressure - least) * wanted / rated
        return self._cycle(cylinder, speeds, charge), wanted

    def _rated(self, cylinder: Cylinder) -> float:
        """Mean effective pressure at the rated point [Pa]."""
        assert self.load is not None
        if self.load.rated is not None:
            return self.load.rated
        if self.mean_effective_pressure is not None:
            return self.mean_effective_pressure
        charge = np.full((1, 1), self.charge_pressure)
        cycle = self._cycle(cylinder, np.array([self.load.rated_speed]), charge)
        fired = cycle.fired(self._rule(cycle, None), cycle.motored())
        return float(cycle.mean_effective(fired)[0, 0])

    def _rule(self, cycle: WorkingCycle, wanted: Floats | None) -> Rule:
        if wanted is not None:
            return cycle.heat_for_load(wanted)
        if self.mean_effective_pressure is not None:
            return cycle.heat_for_load(np.full_like(cycle.charge_pressure, self.mean_effective_pressure))
        if self.peak_pressure is not None:
            return cycle.heat_for_peak(self.peak_pressure)
        heat = np.full_like(cycle.charge_pressure, self.heat)
        return lambda split: heat

    def _cycle(self, cylinder: Cylinder, speeds: Floats, charge: Floats) -> WorkingCycle:
        timing = self.valves.timing(cylinder.strokes)
        spans = [(release.start, release.duration) for release in self.releases]
        closed = mesh(closed_edges(timing.closes, timing.opens, spans))
        exchange = mesh(open_edges(timing.opens, timing.ends, timing.corners))
        back = _SILENCER + _TURBINE * np.maximum(charge - _AIR, 0.0)
        return WorkingCycle(
            self._closed_gas(cylinder, timing, closed, speeds[:, None], charge),
            exchange,
            cylinder.volume(exchange.angle, self.compression_ratio)[1],
            timing,
            back if self.exhaust_pressure is None else np.full_like(charge, self.exhaust_pressure),
            charge,
        )

    def _closed_gas(
        self, cylinder: Cylinder, timing: Timing, closed: CycleMesh, speed: Floats, charge: Floats
    ) -> ClosedGas:
        kept = 1.0 - self.walls.share if isinstance(self.walls, HeatShare) else 1.0
        volume, volume_d1 = cylinder.volume(closed.angle, self.compression_ratio)
        return ClosedGas(
            mesh=closed,
            volume=volume,
            volume_d1=volume_d1,
            released=np.sum([release.released(closed.angle) for release in self.releases], axis=0),
            release=np.sum([release.rate(closed.angle) for release in self.releases], axis=0),
            kept=kept,
            bore=cylinder.bore,
            swept_volume=cylinder.swept_volume,
            volume_closing=float(cylinder.volume(np.array([timing.closes]), self.compression_ratio)[0][0]),
            pressure_closing=charge,
            temperature_closing=self.charge_temperature,
            speed=speed,
            piston_speed=speed * cylinder.stroke / math.pi,
            exponent=self.isentropic_exponent,
            wall=self.walls if isinstance(self.walls, WallHeat) else None,
        )


# Points of the only piece, and of one among several. They meet the harmonics of a propeller's load map with
# Woschni's loss within 2e-7 of the largest over ranges of speeds of up to 1 to 10; pieces
# of a table are shorter.
_ALONE = 21
_AMONG = 11


def speed_points(speeds: Floats, kinks: tuple[float, ...]) -> tuple[Floats, Floats]:
    """Speeds to compute at, and how the others follow from them.

    Speeds, shape (k,), and the share of each in what is asked for, shape (n, k); rows sum to one. `speeds`:
    (n,) what is asked for [rad/s]; `kinks`: where the load map has corners [rad/s].
    """
    ends = np.unique([speeds.min(), *(x for x in kinks if speeds.min() < x < speeds.max()), speeds.max()])
    pattern = _ALONE if len(ends) == 2 else _AMONG
    asked, place = np.unique(speeds, return_inverse=True)
    if len(asked) <= (len(ends) - 1) * (pattern - 1) + 1:
        return asked, np.eye(len(asked))[place]
    unit = -np.cos(np.pi * np.arange(pattern) / (pattern - 1))
    points = np.unique(np.concatenate([_between(a, b, unit) for a, b in pairwise(ends)]))
    share = np.zeros((len(speeds), len(points)))
    piece = np.clip(np.searchsorted(ends, speeds, side="right") - 1, 0, len(ends) - 2)
    for i in range(len(ends) - 1):
        first = i * (pattern - 1)
        share[piece == i, first : first + pattern] = _shares(
            speeds[piece == i], points[first : first + pattern]
        )
    return points, share


def _between(start: float, end: float, unit: Floats) -> Floats:
    """Chebyshev points of a piece, with its exact ends."""
    return np.asarray(np.r_[start, (start + end) / 2 + (end - start) / 2 * unit[1:-1], end])


def _shares(x: Floats, points: Floats) -> Floats:
    """Share of the value at each point in the polynomial at x, shape (n, k)."""
    w = np.where(np.arange(len(points)) % 2, -1.0, 1.0)
    w[[0, -1]] *= 0.5
    gap = x[:, None] - points
    hit = gap == 0
    terms = w / np.where(hit, 1.0, gap)
    terms = np.where(hit.any(axis=1, keepdims=True), hit, terms)
    return np.asarray(terms / terms.sum(axis=1, keepdims=True))
