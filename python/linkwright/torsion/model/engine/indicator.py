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

Gaps, ends that do not meet, wrong units and a wrong zero of a diagram are faults of its file.

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
from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import CheckedDescription, fault
from linkwright.kernel.description.curve import curve_faults, unread_file
from linkwright.kernel.errors import MachineError, Problem
from linkwright.kernel.units.kinds import ANGLE
from linkwright.kernel.units.marks import Angle, Angles, Pressures, positive
from linkwright.torsion.model.engine.cycle_pressure import CyclePressure, periodic_cubic
from linkwright.torsion.model.engine.cylinder import Cylinder
from linkwright.torsion.model.engine.gas import Exponent, Gas, TableGasLoad, below, check_reach

# Textbooks print pressures at steps of 10 or 15 degrees; more than this says nothing about combustion.
_LARGEST_STEP = math.radians(16.0)
# A step as large as this many of both its neighbours is a hole, not a change of step, ...
_HOLE = 3.0
# ... unless it is so small that the curve between the points is certain.
_SMALL_STEP = math.radians(2.0)
# Cycle of four strokes.
_LONGEST = 4 * math.pi
# Angles are printed to a hundredth of a degree.
_SAME_ANGLE = math.radians(0.02)
# Share of the maximum pressure by which two ends at the same angle may differ: drift of a transducer.
_DRIFT = 0.02
# The minimum pressures of pressure transducers are near that of the air; engines do not run on peaks below
# it.
_ATMOSPHERE = 101325.0
# No engine reaches 100 MPa.
_HIGHEST = 1e8
# Combustion that peaks farther from the dead centre than this belongs to another stroke.
_PEAK_WITHIN = math.radians(60.0)


def diagram_faults(angle: tuple[float, ...], pressure: tuple[float, ...]) -> Iterator[InitErrorDetails]:
    """What is wrong with a diagram that is complete in itself, whatever its cycle.

    Pressures that are not absolute or not in their unit, a hole between two angles. `angle`, `pressure`:
    [Pa].
    """
    lowest, top = min(pressure), max(pressure)
    if lowest <= 0:
        remedy = "add the pressure of the air to gauge pressures"
        yield fault(
            "pressure",
            pressure.index(lowest),
            found=lowest,
            expected="an absolute pressure above 0",
            remedy=remedy,
        )
    elif top < _ATMOSPHERE:
        found = f"a maximum pressure of {top:.6g} Pa, below that of the air"
        remedy = 'without a unit a number is in pascals: write "pressure [bar]" in the header of the file'
        yield fault("pressure", found=found, expected="absolute pressures of a cylinder", remedy=remedy)
    elif top > _HIGHEST:
        found = f"a maximum pressure of {top:.6g} Pa"
        yield fault("pressure", found=found, expected=f"less than {_HIGHEST:.0e} Pa", remedy="check the unit")
    if angle[-1] - angle[0] > _LONGEST + _SAME_ANGLE:
        yield _wrong_span(angle, _LONGEST, "more than")
        return
    for i in _holes(np.diff(np.asarray(angle))):
        yield _hole(angle[i], angle[i + 1])


def _holes(steps: Floats) -> list[int]:
    beside = np.maximum(np.r_[steps[1:2], steps[:-1]], np.r_[steps[1:], steps[-2:-1]])
    lone = (steps > _HOLE * beside) & (steps > _SMALL_STEP) if len(steps) > 1 else np.zeros(len(steps), bool)
    return [int(i) for i in np.flatnonzero((steps > _LARGEST_STEP) | lone)]


def _hole(before: float, after: float) -> InitErrorDetails:
    a, b = math.degrees(before), math.degrees(after)
    return fault(
        "angle",
        found=f"a gap of {b - a:.6g} deg, between {a:.6g} and {b:.6g} deg",
        expected=f"steps of at most {math.degrees(_LARGEST_STEP):.6g} deg, without holes",
        remedy="give the points that are missing, or thin out the others",
    )


def whole_cycle_faults(
    angle: tuple[float, ...], pressure: tuple[float, ...], cycle: float
) -> Iterator[InitErrorDetails]:
    """What is wrong with a diagram as that of one working cycle.

    A cycle that is not covered or more than covered, ends that do not meet, a peak far from the dead centre.
    `angle`, `pressure`: [Pa]; `cycle`: crank angle of the working cycle [rad].
    """
    span = angle[-1] - angle[0]
    if span > cycle + _SAME_ANGLE:
        yield _wrong_span(angle, cycle, "more than")
        return
    if span < 0.5 * cycle:
        yield _wrong_span(angle, cycle, "only a part of")
        return
    closing, steps = cycle - span, np.diff(np.asarray(angle))
    if closing > _LARGEST_STEP or (closing > _SMALL_STEP and closing > _HOLE * max(steps[0], steps[-1])):
        yield _hole(angle[-1], angle[0] + cycle)
    yield from _end_faults(np.asarray(pressure), closing)
    yield from _peak_faults(angle, pressure, cycle)


def _wrong_span(angle: tuple[float, ...], cycle: float, how: str) -> InitErrorDetails:
    a, b, span = (math.degrees(end) for end in (angle[0], angle[-1], cycle))
    return fault(
        "angle",
        found=f"angles from {a:.6g} to {b:.6g} deg, {how} the cycle",
        expected=f"one working cycle, {span:.6g} deg",
        remedy='check the strokes of the engine, and the unit: "angle [deg]" in the header of the file',
    )


def _end_faults(pressure: Floats, closing: float) -> Iterator[InitErrorDetails]:
    jump, top = abs(pressure[0] - pressure[-1]), pressure.max()
    # Points one step apart may differ as any two neighbours of the diagram do.
    within = _DRIFT * top + (0.0 if closing < _SAME_ANGLE else float(np.abs(np.diff(pressure)).max()))
    if jump > within:
        yield fault(
            "pressure",
            found=f"{pressure[0]:.6g} Pa at the start of the cycle and {pressure[-1]:.6g} Pa at its end",
            expected=f"ends that meet within {within:.3g} Pa",
            remedy="take whole cycles, averaged over many, of a transducer without drift",
        )


def _peak_faults(
    angle: tuple[float, ...], pressure: tuple[float, ...], cycle: float
) -> Iterator[InitErrorDetails]:
    at = angle[int(np.argmax(pressure))]
    off = math.remainder(at, cycle)
    if abs(off) > _PEAK_WITHIN:
        yield fault(
            "angle",
            found=f"the maximum pressure at {math.degrees(at):.6g} deg",
            expected=f"within {math.degrees(_PEAK_WITHIN):.6g} deg of the top dead centre of firing, angle 0",
            remedy=f"count from there: subtract {180 * round(at / math.pi)} deg from all angles",
        )


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


def _fitted(volume: Floats, pressure: Floats) -> float:
    """Exponent of a polytropic line through points."""
    n = -float(np.polyfit(np.log(volume), np.log(pressure), 1)[0])
    if not _LEAST < n < _GREATEST:
        found = f"{n:.4g} fitted to the compression of the diagram"
        expected = f"between {_LEAST} and {_GREATEST}"
        remedy = "check compression_ratio, combustion_start, and the zeros of pressure and of angle"
        raise MachineError([Problem("train.engine.gas.polytropic_exponent", found, expected, remedy)])
    return n


def _check_combustion(fired: Floats, motored: Floats, peak: float) -> None:
    for mean, without in zip(fired, motored, strict=True):
        if mean - without < _NO_COMBUSTION * peak:
            found = f"a mean effective pressure of {mean:.6g} Pa, {without:.6g} Pa of it without combustion"
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
        description="CSV file beside the machine file, instead of the lists, with units in the header: "
        '"angle [deg], pressure [bar]".',
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

    def over(self, angle: Floats, cycle: float) -> Floats:
        """Absolute pressure [Pa], (m,), at angles (m,) [rad] of a working cycle of `cycle` [rad]."""
        return periodic_cubic(np.asarray(self.angle), np.asarray(self.pressure), cycle, angle)


class Indicator(Diagram, Gas):
    """A measured diagram, with others at other loads if there are."""

    other_loads: tuple[Diagram, ...] = Field(
        (), description="Diagrams of the same cylinder at other loads, in any order."
    )
    combustion_start: Angle = Field(
        -math.radians(15.0),
        description="Crank angle up to which the diagram equals that of the motored cylinder, before "
        "ignition.",
    )
    exhaust_opens: Annotated[float, positive(ANGLE)] | None = Field(
        None,
        description="Crank angle at which the exhaust opens. Default: 130 deg with four strokes, "
        "110 deg with two.",
    )
    polytropic_exponent: Exponent | None = Field(
        None,
        description="Polytropic exponent of the motored line. Default: fitted to the compression of "
        "the diagram.",
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

    def cycle_pressure(self, cylinder: Cylinder, speeds: Floats) -> CyclePressure:
        angle = self._angles(cylinder.cycle)
        weight = np.full(len(angle), cylinder.cycle / len(angle))
        fired = np.array([other_load.over(angle, cylinder.cycle) for other_load in (self, *self.other_loads)])
        motored = np.array([self._motored(curve, angle, cylinder) for curve in fired])
        _, V_d1 = cylinder.volume(angle, self.compression_ratio)
        of_work = V_d1 * weight / cylinder.swept_volume
        shares = self._shares(fired @ of_work, motored @ of_work, np.asarray(speeds))
        return CyclePressure(
            np.asarray(speeds), angle, weight, np.vstack([fired, motored]), *shares, self.crankcase_pressure
        )

    def _angles(self, cycle: float) -> Floats:
        steps = [cycle / len(other_load.angle) for other_load in (self, *self.other_loads)]
        n = round(cycle / max(_FINEST, min(_STEP, *steps)))
        return np.asarray(np.arange(n) * (cycle / n) - cycle / 2)

    def _motored(self, pressure: Floats, angle: Floats, cylinder: Cylinder) -> Floats:
        start, opens = self.combustion_start, self.exhaust_opens or default_opening(cylinder.strokes)
        V, _ = cylinder.volume(angle, self.compression_ratio)
        ahead = (angle <= start) & (angle > start - _FITTED)
        n = self.polytropic_exponent or _fitted(V[ahead], pressure[ahead])
        at = np.flatnonzero(ahead)[-1]
        line = pressure[at] * (V[at] / V) ** n
        fades = np.clip((angle - opens) / _FADE, 0.0, 1.0)
        combustion = np.where(angle > angle[at], 0.5 * (1 + np.cos(np.pi * fades)), 0.0)
        return np.asarray(pressure - combustion * (pressure - line))

    def _shares(self, fired: Floats, motored: Floats, speeds: Floats) -> tuple[Floats, Floats]:
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
