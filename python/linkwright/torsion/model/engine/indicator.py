r"""A measured indicator diagram: pressure in the cylinder over the crank angle of a whole cycle.

Between its points the pressure is a periodic monotone cubic (Fritsch and Butland [1]_): it has no overshoot
beside the steep rise of combustion, as a spline has, so that no pressure is invented.

Without combustion the same cylinder would follow its compression line through the dead centre,

.. math:: p_0 = p(φ_s) \left(\frac{V(φ_s)}{V}\right)^n

from the start of combustion φ_s until the exhaust opens, n fitted to the forty degrees before φ_s. What is
above this line is the combustion, and fades out while the exhaust blows down. Other loads scale it,

.. math:: p = p_0 + f (p - p_0), \qquad f = \frac{p_i - p_{i,0}}{p_{i,1} - p_{i,0}}

with p_i the mean effective pressure asked for, p_{i,1} that of the diagram and p_{i,0} that of the motored
line. Between diagrams at several loads the pressure is linear in p_i; below the minimum and above the maximum
of them combustion is scaled.

References
----------
.. [1] Fritsch, Butland, A method for constructing local monotone piecewise cubic interpolants, SIAM J. Sci.
Stat. Comput. 5 (1984) 300-304.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, fault
from linkwright.kernel.description.curve import curve_faults, unread_file
from linkwright.kernel.errors import MachineError, Problem
from linkwright.kernel.units import ANGLE, Angle, Angles, Pressures, positive
from linkwright.torsion.model.engine.cycle_pressure import CyclePressure, periodic_cubic
from linkwright.torsion.model.engine.cylinder import Cylinder
from linkwright.torsion.model.engine.gas import Exponent, Gas, TableGasLoad, below, check_reach
from linkwright.torsion.model.engine.indicator_faults import diagram_faults, whole_cycle_faults

Array = NDArray[np.float64]

# Half a degree: a quarter of a period of order 24 has thirty points, and combustion some hundred.
_STEP = math.radians(0.5)
# Finer diagrams are taken at a tenth of a degree; their noise beyond is that of the transducer.
_FINEST = math.radians(0.1)
# Length of the compression line that its exponent is fitted to.
_FITTED = math.radians(40.0)
# Exponents of compression lie between 1.25 and 1.42; a wrong zero of pressure or angle leads away from there.
_LEAST, _GREATEST = 1.2, 1.5
# Mean effective pressure of the combustion as a share of the peak: at idle some 0.02, of a motored cylinder
# noise.
_NO_COMBUSTION = 2e-3
# Angle over which combustion fades out once the exhaust is open, as a blow-down takes.
_FADE = math.radians(50.0)


def _fitted(volume: Array, pressure: Array) -> float:
    """Exponent of a polytropic line through points."""
    n = -float(np.polyfit(np.log(volume), np.log(pressure), 1)[0])
    if not _LEAST < n < _GREATEST:
        found = f"{n:.4g} fitted to the compression of the diagram"
        expected = f"between {_LEAST} and {_GREATEST}"
        remedy = "check compression_ratio, combustion_start, and the zeros of pressure and of angle"
        raise MachineError([Problem("train.engine.gas.polytropic_exponent", found, expected, remedy)])
    return n


def _check_combustion(fired: Array, motored: Array, peak: float) -> None:
    """Refuse diagrams of motored cylinders where a load is asked for."""
    for each, without in zip(fired, motored, strict=True):
        if each - without < _NO_COMBUSTION * peak:
            found = f"a mean effective pressure of {each:.6g} Pa, {without:.6g} Pa of it without combustion"
            expected = "a diagram with combustion, which a load map can scale"
            raise MachineError([Problem("train.engine.gas.pressure", found, expected)])


def default_opening(strokes: int) -> float:
    """Crank angle at which the exhaust opens where none is given [rad]."""
    # Usual timing: 50 deg before the bottom with four strokes; ports a fifth of the stroke high with two.
    return math.radians(130.0 if strokes == 4 else 110.0)


class Diagram(CheckedDescription):
    """Pressure in a cylinder at crank angles of a whole cycle."""

    kind: Literal["table"]
    file: str | None = Field(
        None,
        description="File of comma-separated values beside the machine file, in place of the lists, with "
        'units in its head: "angle [deg], pressure [bar]".',
    )
    angle: Angles = Field(
        (), description="Crank angles from the top dead centre of firing, increasing, over one working cycle."
    )
    pressure: Pressures = Field((), description="Absolute pressure at each angle.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from super()._faults()
        if self.file is not None:
            yield unread_file(self.file)
            return
        wrong = list(curve_faults(self, "angle", ("pressure",)))
        yield from wrong or diagram_faults(self.angle, self.pressure)

    def over(self, angle: Array, cycle: float) -> Array:
        """Pressure at any angles of the cycle, (m,).

        Absolute pressure [Pa]. `angle`: (m,) [rad]; `cycle`: crank angle of a working cycle [rad].
        """
        return periodic_cubic(np.asarray(self.angle), np.asarray(self.pressure), cycle, angle)


class Indicator(Diagram, Gas):
    """A measured diagram, with others at other loads if there are."""

    other_loads: tuple[Diagram, ...] = Field(
        (), description="Diagrams of the same cylinder at other loads, in any order."
    )
    combustion_start: Angle = Field(
        -math.radians(15.0),
        description="Crank angle up to which the diagram is that of a motored cylinder; before the ignition.",
    )
    exhaust_opens: Annotated[float, positive(ANGLE)] | None = Field(
        None, description="Crank angle; without it 130 deg with four strokes, 110 deg with two."
    )
    polytropic_exponent: Exponent | None = Field(
        None, description="Of the motored line; without it, fitted to the compression of the diagram."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from super()._faults()
        if not -math.pi / 2 < self.combustion_start < math.pi / 4:
            found = f"{math.degrees(self.combustion_start):.6g} deg"
            yield fault("combustion_start", found=found, expected="between -90 and 45 deg")
        if self.exhaust_opens is not None and not math.pi / 4 < self.exhaust_opens < math.pi * 1.2:
            found = f"{math.degrees(self.exhaust_opens):.6g} deg"
            yield fault("exhaust_opens", found=found, expected="between 45 and 216 deg")
        yield from self._load_faults()

    def _load_faults(self) -> Iterator[InitErrorDetails]:
        """Diagrams that no load map leads to; a load map with what only a model can follow."""
        if self.other_loads and self.load is None:
            expected = "a load map, which says at which speed each diagram holds"
            yield fault("load", expected=expected)
        if isinstance(self.load, TableGasLoad) and self.load.charge_pressure is not None:
            expected = "none: a measured diagram has its charge pressure in itself"
            yield fault("load", "charge_pressure", found="a list", expected=expected)

    def cycle_faults(self, strokes: int) -> Iterator[InitErrorDetails]:
        cycle = math.pi * strokes
        yield from whole_cycle_faults(self.angle, self.pressure, cycle)
        for i, other_load in enumerate(self.other_loads):
            for problem in whole_cycle_faults(other_load.angle, other_load.pressure, cycle):
                yield below(problem, "other_loads", i)

    def cycle_pressure(self, cylinder: Cylinder, speeds: Array) -> CyclePressure:
        angle = self._angles(cylinder.cycle)
        weight = np.full(len(angle), cylinder.cycle / len(angle))
        fired = np.array([other_load.over(angle, cylinder.cycle) for other_load in (self, *self.other_loads)])
        motored = np.array([self._motored(each, angle, cylinder) for each in fired])
        _, V_d1 = cylinder.volume(angle, self.compression_ratio)
        of_work = V_d1 * weight / cylinder.swept_volume
        shares = self._shares(fired @ of_work, motored @ of_work, np.asarray(speeds))
        return CyclePressure(
            np.asarray(speeds), angle, weight, np.vstack([fired, motored]), *shares, self.crankcase_pressure
        )

    def _angles(self, cycle: float) -> Array:
        """Even angles of a cycle, as close as the finest diagram has them."""
        steps = [cycle / len(other_load.angle) for other_load in (self, *self.other_loads)]
        n = round(cycle / max(_FINEST, min(_STEP, *steps)))
        return np.asarray(np.arange(n) * (cycle / n) - cycle / 2)

    def _motored(self, pressure: Array, angle: Array, cylinder: Cylinder) -> Array:
        """The diagram without its combustion."""
        start, opens = self.combustion_start, self.exhaust_opens or default_opening(cylinder.strokes)
        V, _ = cylinder.volume(angle, self.compression_ratio)
        ahead = (angle <= start) & (angle > start - _FITTED)
        n = self.polytropic_exponent or _fitted(V[ahead], pressure[ahead])
        at = np.flatnonzero(ahead)[-1]
        line = pressure[at] * (V[at] / V) ** n
        fades = np.clip((angle - opens) / _FADE, 0.0, 1.0)
        combustion = np.where(angle > angle[at], 0.5 * (1 + np.cos(np.pi * fades)), 0.0)
        return np.asarray(pressure - combustion * (pressure - line))

    def _shares(self, fired: Array, motored: Array, speeds: Array) -> tuple[Array, Array]:
        """Shares of the traces at each speed, from the mean effective pressures of the diagrams."""
        k, n = len(fired), len(speeds)
        if self.load is None:
            shares = np.eye(2)[:, None, :] + np.zeros((1, n, 1))
            return shares[0], shares[1]
        wanted = self.load.mean_effective(speeds, float(fired[0]))
        _check_combustion(fired, motored, max(self.pressure))
        order = np.argsort(fired)
        # Place of the load in the row of diagrams; the end diagrams hold beyond.
        place = np.interp(wanted, fired[order], np.arange(k))
        mix = np.zeros((n, k))
        mix[:, order] = np.maximum(0.0, 1.0 - np.abs(place[:, None] - np.arange(k)))
        hot, cold = mix @ fired, mix @ motored
        check_reach(wanted, cold, speeds)
        f = ((wanted - cold) / (hot - cold))[:, None]
        return np.hstack([mix * f, mix * (1 - f)]), np.hstack([0 * mix, mix])
