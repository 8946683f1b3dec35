"""Figures of forces over the crank angle, with their captions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.figure.legends import legend_above
from linkwright.kernel.figure.lines import Line, Panel, line_figure
from linkwright.kernel.figure.style import (
    DRIVE,
    LINES,
    LOAD,
    MATH,
    SOFT,
    CaptionedFigure,
    named,
    panels,
    styled,
)
from linkwright.kernel.reader.angle_zero import zero_shown
from linkwright.kernel.reader.numbers import quantity
from linkwright.kinetostatics.result import Forces

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from linkwright.kinetostatics.result import Forces

# Reactions drawn: the largest.
_MOST = 4
# Circles of a polar diagram, whose numbers do not overlap; and the angle [°] about them that is examined.
_CIRCLES, _BESIDE = 4, 14


@styled
def forces_figure(forces: Forces) -> Figure:
    """Draw the driving torque and the largest reactions over the crank angle."""
    sizes = zip(_largest(forces), LINES, strict=False)
    reactions = [Line(forces.pairs[name].size, colour, named(name)) for name, colour in sizes]
    return line_figure(
        np.degrees(forces.crank_angle),
        *_driving(forces),
        Panel("magnitude of the reaction\n[N]", reactions, room=None),
        height=4.2,
    )


def _driving(forces: Forces) -> Iterator[Panel]:
    """The driving torque; of drives with laws the torque, and the force, of each by name."""
    if not forces.laws:
        yield Panel("driving torque $M_d$\n[N m]", [Line(forces.torque_drive, DRIVE)])
        return
    for unit, word in (("N m", "torque of the drive"), ("N", "force of the drive")):
        names = [name for name in forces.drives if forces.drive_unit(name) == unit]
        coloured = zip(names, LINES * len(names), strict=False)
        lines = [Line(forces.drives[name], colour, named(name)) for name, colour in coloured]
        if lines:
            yield Panel(f"{word}\n[{unit}]", lines)


@styled
def hodograph_figure(forces: Forces) -> Figure:
    """Draw the ends of force vectors: the largest reactions, and the shaking force."""
    figure, (reactions, frame) = panels(1, height=3.6, columns=2, shared=False)
    for name, colour in zip(_largest(forces), LINES, strict=False):
        _vectors(reactions, forces, forces.pairs[name].force, colour, named(name))
    legend_above(reactions)
    _vectors(frame, forces, forces.shaking_force, LOAD, "on the frame")
    legend_above(frame)
    return figure


def _vectors(axes: Axes, forces: Forces, force: np.ndarray, colour: str, label: str) -> None:
    axes.plot(force[:, 0], force[:, 1], color=colour, label=label)
    zero = zero_shown()
    start = int(np.argmin([abs(zero.counted(float(angle))) for angle in forces.crank_angle]))
    axes.plot(force[start, 0], force[start, 1], "o", color=colour, markersize=4)
    axes.plot(0, 0, "+", color=SOFT, markersize=8)
    axes.set_aspect("equal", adjustable="datalim")
    # Numbers of forces are long: more of them run into one another.
    axes.locator_params(axis="x", nbins=4)
    axes.set_xlabel("$F_x$ [N]", **MATH)
    axes.set_ylabel("$F_y$ [N]", **MATH)


def _free(angle: Floats, sizes: Sequence[Floats]) -> float:
    """Middle between two spokes [°] where the largest curve is smallest, for the scale."""
    largest = np.max(sizes, axis=0)
    middles = np.arange(22.5, 360, 45)
    near = (np.cos(angle - np.radians(middle)) > np.cos(np.radians(_BESIDE)) for middle in middles)
    return float(min(zip(middles, near, strict=True), key=lambda at: largest[at[1]].max(initial=0.0))[0])


@styled
def polar_figure(forces: Forces) -> Figure:
    """Draw the size of the largest reactions over the crank angle as a polar diagram."""
    from matplotlib.figure import Figure
    from matplotlib.ticker import MaxNLocator

    figure = Figure(figsize=(4.6, 4.6), layout="constrained")
    # The types know of no polar axes.
    axes: Any = figure.add_subplot(projection="polar")
    names = _largest(forces)
    for name, colour in zip(names, LINES, strict=False):
        axes.plot(forces.crank_angle, forces.pairs[name].size, color=colour, label=named(name))
    axes.set_xlabel("crank angle φ [°]")
    axes.set_ylabel("magnitude of the reaction [N]", labelpad=28)
    axes.yaxis.set_major_locator(MaxNLocator(_CIRCLES))
    axes.set_rlabel_position(_free(forces.crank_angle, [forces.pairs[name].size for name in names]))
    axes.legend(loc="lower left", bbox_to_anchor=(-0.15, 1.07), ncols=2)
    return figure


@styled
def cases_figure(cases: Mapping[str, Forces]) -> Figure:
    """Draw driving torque and shaking force of load cases by name in two panels, one above the other."""
    coloured = list(zip(cases.items(), LINES * len(cases), strict=False))
    torques = [Line(forces.torque_drive, colour, named(name)) for (name, forces), colour in coloured]
    sizes = [Line(np.hypot(*forces.shaking_force.T), colour) for (_, forces), colour in coloured]
    degrees = np.degrees(next(iter(cases.values())).crank_angle)
    both = Panel("driving torque $M_d$\n[N m]", torques), Panel("shaking force\n[N]", sizes, room=None)
    return line_figure(degrees, *both, height=4.2)


def _largest(forces: Forces) -> list[str]:
    sizes = {name: size for name, size in forces.reaction_max.items() if np.isfinite(size) and size > 0}
    return sorted(sizes, key=lambda name: -sizes[name])[:_MOST]


def has_reactions(forces: Forces) -> bool:
    """Whether a pair bears a force at all, which figures show."""
    return bool(_largest(forces))


def _given(forces: Forces) -> str:
    most = quantity(forces.torque_drive_max, "N m")
    if forces.laws:
        each = "; ".join(
            f"peak drive at {name} {quantity(value, forces.drive_unit(name))}"
            for name, value in forces.drive_max.items()
        )
        return f"{each[0].upper()}{each[1:]}. The peak {forces.shaft} is {most}."
    return f"Peak driving torque at the crank: {most}."


def _words(forces: Forces) -> dict[str, tuple[str, str]]:
    if not has_reactions(forces):
        return {}
    pins = forces.reaction_max
    largest = max(pins, key=lambda name: pins[name])
    along = " in steady motion" if np.ptp(forces.motion.speed) > 0 else ""
    return {
        "forces": (
            "Joint reactions",
            f"Joint reactions{along}: peak {quantity(pins[largest], 'N')} at {largest}. {_given(forces)}",
        ),
        "hodograph": (
            "Hodographs of forces",
            "Ends of the force vectors over one revolution, a mark at φ = 0; the peak shaking force is "
            f"{quantity(forces.shaking_force_max, 'N')}.",
        ),
        "polar": (
            "Reactions, polar",
            "Magnitude of the largest reactions over the crank angle, in polar coordinates.",
        ),
    }


_DRAWN = {"forces": forces_figure, "hodograph": hodograph_figure, "polar": polar_figure}


def captioned_forces(forces: Forces) -> Iterator[CaptionedFigure]:
    """The figures of forces with their captions."""
    for name, (title, caption) in _words(forces).items():
        yield CaptionedFigure(name, title, caption, _DRAWN[name](forces))
