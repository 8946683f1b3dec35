"""Figures of axes: the timing diagram, torque over speed of each motor, power of the DC bus."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from linkwright.axes.axis import ServoAxis
from linkwright.axes.bus import DcBus
from linkwright.axes.model.servo_motor import TorqueCurve
from linkwright.axes.timing import Track
from linkwright.kernel.arrays import Floats
from linkwright.kernel.figure.lines import Line, Panel, line_figure
from linkwright.kernel.figure.style import INK, LINES, MOTOR, SOFT, CaptionedFigure, named, styled
from linkwright.kernel.reader.numbers import quantity

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_MASTER = "master angle φ [°]"

# Panels of the timing diagram, and their words.
_PANELS = {
    "position": "position, as a\nshare of its range",
    "velocity": "velocity, as a\nshare of its peak",
    "acceleration": "acceleration, as a\nshare of its peak",
    "torque": "torque or force, as\na share of its peak",
}


def timing_figures(tracks: Sequence[Track]) -> Iterator[CaptionedFigure]:
    """The timing diagram with the size of every curve."""
    if not tracks:
        return
    peaks = "; ".join(f"{track.name}: {_sizes(track)}" for track in tracks)
    yield CaptionedFigure(
        "timing",
        "Timing of cams and axes",
        f"Each curve over its range or peak. {peaks}.",
        timing_figure(tracks),
    )


def _sizes(track: Track) -> str:
    """Range of the position and peaks of the others."""
    values = (float(np.ptp(track.position)), *(_peak(getattr(track, name)) for name in list(_PANELS)[1:]))
    units = [track.unit_of(name) for name in _PANELS]
    return ", ".join(
        quantity(np.degrees(value), "°") if unit == "rad" else quantity(value, unit)
        for value, unit in zip(values, units, strict=True)
    )


@styled
def timing_figure(tracks: Sequence[Track]) -> Figure:
    """Draw position, velocity, acceleration and torque of all cams and axes over the master angle."""
    coloured = list(zip(tracks, LINES * len(tracks), strict=False))
    drawn = []
    for curve, words in _PANELS.items():
        lines = [
            Line(
                _share(getattr(track, curve), is_range=curve == "position"),
                colour,
                named(track.name) if curve == "position" else "",
                np.degrees(track.crank_angle),
            )
            for track, colour in coloured
        ]
        drawn.append(Panel(words, lines))
    return line_figure(np.degrees(tracks[0].crank_angle), *drawn, height=7.2, over=_MASTER)


def _share(values: Floats, *, is_range: bool) -> Floats:
    """Values over their range, from 0 to 1, or over their peak."""
    low = float(values.min()) if is_range else 0.0
    size = float(np.ptp(values)) if is_range else abs(_peak(values))
    share: Floats = (values - low) / size if size > 0 else np.zeros_like(values)
    return share


def _peak(values: Floats) -> float:
    return float(np.max(np.abs(values)))


def axis_figures(axes: Sequence[ServoAxis]) -> Iterator[CaptionedFigure]:
    """Torque over speed of every motor."""
    for axis in axes:
        words = (
            f"Torque over speed of the motor of {axis.name} over a cycle: peak "
            f"{quantity(axis.motor.torque_peak, 'N m')}, root mean square "
            f"{quantity(axis.motor.torque_rms, 'N m')} at a mean speed of "
            f"{quantity(axis.motor.speed_mean, 'rad/s')}."
        )
        if axis.axis.motor is not None:
            words += (
                " Dashed lines show the peak and the continuous torque; the cross is the root mean square "
                "torque."
            )
        yield CaptionedFigure(
            f"axis_{axis.name}", f"Axis {axis.name}: torque over speed", words, loop_figure(axis)
        )


@styled
def loop_figure(axis: ServoAxis) -> Figure:
    """Draw torque over speed of a motor in four quadrants, with its limits."""
    duty, motor = axis.motor, axis.axis.motor
    lines = [Line(duty.torque, MOTOR, named(axis.name), duty.speed)]
    if motor is not None:
        for curve, label in ((motor.peak, "peak"), (motor.continuous, "continuous, S1")):
            if curve is not None:
                lines += _quadrants(curve, label, INK if label == "peak" else SOFT)
    marks = {"markersize": 7, "linestyle": "none"}
    lines.append(
        Line(np.array([duty.torque_rms]), MOTOR, "rms at mean speed", np.array([duty.speed_mean]), "x", marks)
    )
    width = 1.05 * max(float(np.max(np.abs(line.x))) for line in lines if line.x is not None)
    figure = line_figure(
        np.array([-width, width]),
        Panel("torque of the motor $M_m$\n[N m]", lines),
        height=3.6,
        over="speed of the motor $ω_m$ [rad/s]",
    )
    figure.axes[0].axvline(0, color=SOFT, linewidth=0.8)
    return figure


def _quadrants(curve: TorqueCurve, label: str, colour: str) -> list[Line]:
    """A limit of the torque in all four quadrants, as one closed line."""
    speed, torque = np.array(curve.speed), np.array(curve.torque)
    around = np.concatenate([-speed[::-1], speed, speed[::-1], -speed, -speed[-1:]])
    limits = np.concatenate([torque[::-1], torque, -torque[::-1], -torque, torque[-1:]])
    return [Line(limits, colour, label, around, "", {"linestyle": (0, (5, 3)), "linewidth": 1.1})]


def bus_figures(bus: DcBus) -> Iterator[CaptionedFigure]:
    """Power of all axes over the cycle."""
    words = (
        f"Power at the motor shafts: together at most {quantity(bus.power_max, 'W')}, mean "
        f"{quantity(bus.power_mean, 'W')}; fed back per cycle {quantity(bus.energy_regenerated, 'J')}."
    )
    yield CaptionedFigure("dc_bus", "Power of the DC bus", words, bus_figure(bus))


@styled
def bus_figure(bus: DcBus) -> Figure:
    """Draw the power of every axis and of all together over the master angle."""
    lines = [
        Line(power, colour, named(name))
        for (name, power), colour in zip(bus.powers.items(), LINES * len(bus.powers), strict=False)
    ]
    if len(lines) > 1:
        lines.append(Line(bus.power, INK, "all axes"))
    return line_figure(np.degrees(bus.crank_angle), Panel("power\n[W]", lines), height=2.8, over=_MASTER)
