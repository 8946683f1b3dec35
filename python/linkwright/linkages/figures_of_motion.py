"""A computed motion for a report: extremes of what moves among the instants, and curves over time."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from linkwright.kernel.figure.lines import Line, Panel, line_figure
from linkwright.kernel.figure.style import LINES, named, styled
from linkwright.kernel.page.table import Row, Table
from linkwright.kernel.reader.numbers import crank_angle, measured
from linkwright.linkages.motion import Motion

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Of a curve and its derivatives: end of the name, word of a place, word of an angle.
_RATES = (
    ("", "position", "angle"),
    (".velocity", "velocity", "angular velocity"),
    (".acceleration", "acceleration", "angular acceleration"),
)

# Kinds of what moves, by the end of the name of its curve.
_KINDS: dict[str, str | tuple[str, ...]] = {"slides": ".place", "links": ".angle", "points": (".x", ".y")}

# What moves by less than this share of the largest of its kind rests.
_AT_REST = 1e-12

# Lines in one figure.
_LINES_MAX = len(LINES)


def course_tables(motion: Motion) -> list[Table]:
    """Extremes of positions, velocities and accelerations among the instants that were computed."""
    rows = [row for kind in _KINDS for name in _moving(motion, kind) for row in _rows(motion, name)]
    heads = ("output", "", "minimum", "at φ", "maximum", "at φ")
    title = f"Extremes of the motion at {len(motion.time)} instants"
    return [Table("motion", title, heads, rows)] if rows else []


def course_figures(motion: Motion) -> dict[str, Figure]:
    """Position, velocity and acceleration over time of slides, links and points."""
    moving = {kind: _moving(motion, kind)[:_LINES_MAX] for kind in _KINDS}
    return {f"motion_of_{kind}": course_figure(motion, names) for kind, names in moving.items() if names}


@styled
def course_figure(motion: Motion, names: list[str]) -> Figure:
    """Draw positions of one kind with their velocities and accelerations, a panel each."""
    curves, drawn = motion.curves(), []
    for ending, *words in _RATES:
        unit = motion.unit_of(names[0] + ending)
        size = 180 / np.pi if unit == "rad" else 1.0
        lines = [
            Line(size * curves[name + ending], colour, "" if ending else named(_name(name)))
            for colour, name in zip(LINES, names, strict=False)
        ]
        word = words[_is_angle(names[0])]
        drawn.append(Panel(f"{word}\n[{'°' if unit == 'rad' else unit}]", lines))
    return line_figure(motion.time, *drawn, height=5.4, over="time t [s]")


def _moving(motion: Motion, kind: str) -> list[str]:
    """Names of the curves of a kind that change by more than rounding."""
    # The lift of a follower is its own motion, counted from the base circle.
    every = {name: curve for name, curve in motion.curves().items() if not name.endswith(".lift.place")}
    curves = {name: curve for name, curve in every.items() if name.endswith(_KINDS[kind])}
    least = _AT_REST * max((float(np.abs(curve).max()) for curve in curves.values()), default=0.0)
    return [name for name, curve in curves.items() if float(np.ptp(curve)) > least]


def _rows(motion: Motion, name: str) -> Iterator[Row]:
    """A row for the position and each derivative, with the crank angles of both extremes."""
    curves = motion.curves()
    for ending, *words in _RATES:
        values, unit = curves[name + ending], motion.unit_of(name + ending)
        cells: list[str] = []
        for at in (int(values.argmin()), int(values.argmax())):
            scale = float(np.abs(values).max())
            cells += [measured(float(values[at]), unit, scale), crank_angle(float(motion.crank_angle[at]))]
        yield (f"{_name(name)}, {words[_is_angle(name)]}", "", *cells)


def _is_angle(name: str) -> bool:
    return name.endswith(".angle")


def _name(curve: str) -> str:
    return curve.removesuffix(".place").removesuffix(".angle")
