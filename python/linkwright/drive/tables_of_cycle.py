"""The motion over the cycle as a table of text: extremes of every slider, rocker and coupler point."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from linkwright.drive.cycle_motion import CycleMotion, Extremes
from linkwright.kernel.page.table import Row, Table
from linkwright.kernel.reader.numbers import crank_angle, cycle_of_angles, measured
from linkwright.linkages.cycle import Linkage

# Of each kind: end of the name of the curve, word, symbol.
_SLIDE = (
    (".place", "position", "s"),
    (".place.velocity", "velocity", "v"),
    (".place.acceleration", "acceleration", "a"),
)
_ROCKER = (
    (".angle", "angle", "ψ"),
    (".angle.velocity", "angular velocity", "ω"),
    (".angle.acceleration", "angular acceleration", "ε"),
)
_POINT = ((".velocity", "speed", "v"), (".acceleration", "acceleration", "a"))


def cycle_tables(motion: CycleMotion, linkage: Linkage) -> Iterator[Table]:
    """The table of the motion over the cycle, if anything moves that is an output."""
    rows = [
        row
        for name, quantities in outputs(motion, linkage)
        for ending, word, symbol in quantities
        for row in _row(motion, name, ending, word, symbol)
    ]
    if rows:
        heads = ("output", "", "minimum", "at φ", "maximum", "at φ")
        yield Table("motion", f"Motion over the cycle, {speed_words(motion)}", heads, rows)


def speed_words(motion: CycleMotion) -> str:
    """How the crank moves."""
    if motion.is_steady:
        return "in steady motion"
    return measured(float(motion.speed[0]), "rad/s", before="at ") + f" of the {motion.driver}"


def outputs(motion: CycleMotion, linkage: Linkage) -> Iterator[tuple[str, tuple[tuple[str, str, str], ...]]]:
    """Names of sliders, followers, rockers and coupler points, each with its quantities."""
    listed = [element.output for element in linkage.elements]
    # The lift of a follower is its own motion, counted from the base circle.
    slides = [name for name in motion.slides if not name.endswith(".lift")]
    for name in dict.fromkeys([*motion.followers, *listed, *slides]):
        if name in motion.slides:
            yield name, _SLIDE
        if name in motion.links:
            yield name, _ROCKER
    for name in motion.coupler_points:
        yield name, _POINT


def _row(motion: CycleMotion, name: str, ending: str, word: str, symbol: str) -> Iterator[Row]:
    extremes = motion.extremes.get(name + ending)
    if extremes is None or (ending == ".angle" and extremes.maximum is None):
        return
    unit, scale = motion.unit_of(name + ending), _scale(extremes)
    yield (
        f"{name}, {word}",
        symbol,
        measured(extremes.minimum, unit, scale),
        angle_words(motion, extremes.minimum_angle),
        measured(extremes.maximum, unit, scale),
        angle_words(motion, extremes.maximum_angle),
    )


def angle_words(motion: CycleMotion, angle: float | None) -> str:
    """A crank angle [rad] in words: from 0 on, unless the cycle takes several revolutions."""
    is_single = np.ptp(motion.crank_angle) < 2 * np.pi + 1e-6
    within = angle % (2 * np.pi) if angle is not None and is_single else angle
    return crank_angle(within, cycle=cycle_of_angles(motion.crank_angle))


def _scale(extremes: Extremes) -> float:
    return max(
        (abs(extreme) for extreme in (extremes.minimum, extremes.maximum) if extreme is not None), default=0.0
    )
