"""What can be wrong with an indicator diagram: gaps, ends that do not meet, wrong units, wrong zero."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import fault

Array = NDArray[np.float64]

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
        remedy = 'without a unit a number is in pascals: write "pressure [bar]" in the head of the file'
        yield fault("pressure", found=found, expected="absolute pressures of a cylinder", remedy=remedy)
    elif top > _HIGHEST:
        found = f"a maximum pressure of {top:.6g} Pa"
        yield fault("pressure", found=found, expected=f"less than {_HIGHEST:.0e} Pa", remedy="check the unit")
    if angle[-1] - angle[0] > _LONGEST + _SAME_ANGLE:
        yield _wrong_span(angle, _LONGEST, "more than")
        return
    for i in _holes(np.diff(np.asarray(angle))):
        yield _hole(angle[i], angle[i + 1])


def _holes(steps: Array) -> list[int]:
    """Steps that are too large, alone or beside their neighbours."""
    beside = np.maximum(np.r_[steps[1:2], steps[:-1]], np.r_[steps[1:], steps[-2:-1]])
    lone = (steps > _HOLE * beside) & (steps > _SMALL_STEP) if len(steps) > 1 else np.zeros(len(steps), bool)
    return [int(i) for i in np.flatnonzero((steps > _LARGEST_STEP) | lone)]


def _hole(before: float, after: float) -> InitErrorDetails:
    """The fault of a diagram that has no points between two angles."""
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
    """The fault of a diagram over another angle than that of the cycle."""
    a, b, whole = (math.degrees(each) for each in (angle[0], angle[-1], cycle))
    return fault(
        "angle",
        found=f"angles from {a:.6g} to {b:.6g} deg, {how} the cycle",
        expected=f"one working cycle, {whole:.6g} deg",
        remedy='check the strokes of the engine, and the unit: "angle [deg]" in the head of the file',
    )


def _end_faults(pressure: Array, closing: float) -> Iterator[InitErrorDetails]:
    """Ends of the cycle whose pressures do not go over into each other."""
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
    """A maximum pressure far from the angle that should be the firing dead centre."""
    at = angle[int(np.argmax(pressure))]
    off = math.remainder(at, cycle)
    if abs(off) > _PEAK_WITHIN:
        yield fault(
            "angle",
            found=f"the maximum pressure at {math.degrees(at):.6g} deg",
            expected=f"within {math.degrees(_PEAK_WITHIN):.6g} deg of the top dead centre of firing, angle 0",
            remedy=f"count from there: subtract {180 * round(at / math.pi)} deg from all angles",
        )
