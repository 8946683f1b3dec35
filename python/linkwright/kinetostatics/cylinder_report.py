"""Tables and figures of cylinders."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from linkwright.kernel.figure.lines import Line, Panel, line_figure
from linkwright.kernel.figure.style import DRIVE, LINES, CaptionedFigure, styled
from linkwright.kernel.page.table import Table, few, part_table
from linkwright.kernel.reader.numbers import parted, quantity
from linkwright.kinetostatics.cylinder import CylinderForce

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SIZES = (
    ("cylinder", "name"),
    ("", ""),
    ("minimum length", "length_min"),
    ("maximum length", "length_max"),
    ("peak velocity", "velocity_max"),
    ("maximum force", "force_max"),
    ("minimum force", "force_min"),
    ("maximum pressure [{bar}]", "pressure_max"),
    ("peak flow [{l/min}]", "flow_max"),
    ("peak power", "power_max"),
)


def cylinder_tables(cylinders: Sequence[CylinderForce]) -> tuple[Table, ...]:
    """Lengths, forces, pressures, flow and power of all cylinders, a row each."""
    if not cylinders:
        return ()
    unknown = set[str]()
    if all(one.pressure_max is None for one in cylinders):
        unknown |= {"pressure_max", "flow_max"}
    if not any(_moves(one) for one in cylinders):
        unknown |= {"velocity_max", "flow_max", "power_max"}
    sizes = [size for size in _SIZES if size[1] not in unknown]
    heads, cells = zip(*sizes, strict=True)
    return (part_table("cylinders", "Cylinders over the cycle", cylinders, heads, *cells),)


def _moves(one: CylinderForce) -> bool:
    """Whether its speed is known; without one the force holds each position."""
    return bool(np.any(one.velocity))


def cylinder_headline(cylinders: Sequence[CylinderForce]) -> Iterator[tuple[str, str, str]]:
    """Extremes of force, pressure and power of each cylinder."""
    for one in cylinders:
        before = f"cylinder {one.name}: "
        yield from few(one, ("force_max", "force_min"), before)
        if one.pressure_max is not None:
            yield f"{before}maximum pressure", *parted(one.pressure_max, "Pa", usual="bar")
        if _moves(one):
            yield from few(one, ("power_max",), before)


def cylinder_figures(cylinders: Sequence[CylinderForce]) -> Iterator[CaptionedFigure]:
    """Length, force, pressures and power of each cylinder."""
    for one in cylinders:
        words = f"The force on the rod lies between {quantity(one.force_min, 'N')} and "
        words += f"{quantity(one.force_max, 'N')}; positive outwards."
        title = f"Force and pressure of the cylinder {one.name}"
        yield CaptionedFigure(f"cylinder_{one.name}", title, words, cylinder_figure(one))


@styled
def cylinder_figure(one: CylinderForce) -> Figure:
    """Draw length, force, pressures in both chambers, and power over the crank angle."""
    drawn = [
        Panel("length $L$\n[m]", [Line(one.length, LINES[0])], room=None),
        Panel("force $F$\n[N]", [Line(one.force, DRIVE)]),
    ]
    if one.pressure_bore is not None and one.pressure_rod is not None:
        chambers = (("bore side", one.pressure_bore), ("rod side", one.pressure_rod))
        lines = [Line(p * 1e-5, colour, word) for (word, p), colour in zip(chambers, LINES, strict=False)]
        drawn.append(Panel("pressure $p$\n[bar]", lines))
    if np.any(one.power):
        drawn.append(Panel("power $P$\n[W]", [Line(one.power, LINES[1])]))
    return line_figure(np.degrees(one.crank_angle), *drawn, height=1.2 + 1.3 * len(drawn))
