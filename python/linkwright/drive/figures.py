"""Figures of a drive over angle and time, and of its motor, with their captions."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from linkwright.drive.characteristic import characteristic
from linkwright.drive.model.motor import ConstantSpeedMotor
from linkwright.drive.motion_events import course, sides
from linkwright.kernel.figure.legends import legend_above
from linkwright.kernel.figure.lines import Level, Line, Panel, line_figure
from linkwright.kernel.figure.style import (
    ACCELERATION,
    BLUE,
    DRIVE,
    INERTIA,
    INK,
    LOAD,
    MOTOR,
    RED,
    SKY,
    SOFT,
    SPEED,
    CaptionedFigure,
    panels,
    roomy,
    styled,
    zero_line,
)
from linkwright.kernel.reader.numbers import number, quantity
from linkwright.kernel.reader.out_units import reader
from linkwright.machine.analysis import Results

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from linkwright.drive.characteristic import Characteristic
    from linkwright.drive.motion_events import MotionExtreme
    from linkwright.drive.reduction import Reduction
    from linkwright.drive.run_up import RunUp
    from linkwright.drive.steady_state import SteadyState
    from linkwright.drive.transient import Transient
    from linkwright.kernel.arrays import Floats

# Turns drawn against time: two show that the motion repeats.
_TURNS = 2

# Mean power from which it is drawn in kilowatts [W].
_KILOWATT = 1000.0


@styled
def speed_figure(steady: SteadyState) -> Figure:
    """Draw speed and acceleration of the crank over its angle."""
    extremes = Line(
        np.array([steady.speed_min, steady.speed_max]),
        SPEED,
        "minimum and maximum",
        np.degrees([steady.speed_min_angle, steady.speed_max_angle]),
        "o",
        {"markersize": 4.5},
    )
    mean = steady.speed_mean_extremes
    words = f"mean of the extremes {quantity(mean, 'rad/s')}"
    speed = Panel("speed ω\n[rad/s]", [Line(steady.speed, SPEED, "speed"), Level(mean, words), extremes])
    acceleration = Panel("acceleration ε\n[rad/s²]", [Line(steady.acceleration, ACCELERATION)])
    return line_figure(np.degrees(steady.crank_angle), speed, acceleration, height=4.2)


@styled
def torque_figure(steady: SteadyState) -> Figure:
    """Draw torques at the crank and power of the motor with its mean over the crank angle."""
    usual = "kW" if abs(steady.power_motor_mean) >= _KILOWATT else "W"
    unit, size = reader().shown("W", usual)
    torques = [
        Line(steady.torque_load, LOAD, "load torque"),
        Line(steady.torque_drive, DRIVE, "driving torque"),
    ]
    mean = steady.power_motor_mean / size
    power = Line(steady.power_motor / size, MOTOR, "power of the motor")
    return line_figure(
        np.degrees(steady.crank_angle),
        Panel("torque at the crank\n[N m]", torques),
        Panel(f"power $P$\n[{unit}]", [power, Level(mean, f"mean over time {mean:.4g} {unit}")]),
        height=4.2,
    )


@styled
def time_figure(steady: SteadyState) -> Figure:
    """Draw speed and motor torque against time, over two cycles."""
    time = np.concatenate([steady.time + turn * steady.period for turn in range(_TURNS)])
    speed = Line(np.tile(steady.speed, _TURNS), SPEED, "speed")
    mean, rms = steady.speed_mean_time, steady.torque_motor_rms
    torque = Line(np.tile(steady.torque_motor, _TURNS), MOTOR, "torque of the motor")
    count = "two" if steady.turns == 1 else _TURNS * steady.turns
    figure = line_figure(
        time,
        Panel("speed ω\n[rad/s]", [speed, Level(mean, f"mean over time {quantity(mean, 'rad/s')}")]),
        Panel("motor torque $M$\n[N m]", [torque, Level(rms, f"root mean square {quantity(rms, 'N m')}")]),
        height=4.2,
        over=f"time t [s], {count} revolutions",
    )
    figure.axes[-1].set_xlim(0, _TURNS * steady.period)
    return figure


@styled
def reduction_figure(reduction: Reduction) -> Figure:
    """Draw reduced inertia and reduced torque over the crank angle."""
    mean = reduction.torque_load_mean
    words = f"mean {quantity(mean, 'N m', scale=_size(reduction))}"
    load = Line(reduction.torque_load, LOAD, "load torque")
    drawn = [Panel("reduced torque $M_r$\n[N m]", [load, Level(mean, words)], room=(0.0,))]
    if reduction.inertia_max:
        inertia = Line(reduction.inertia_reduced, INERTIA)
        drawn.insert(0, Panel("reduced inertia $J$\n[kg m²]", [inertia]))
    return line_figure(np.degrees(reduction.crank_angle), *drawn, height=2.1 * len(drawn))


# Points per revolution that show the solver's quintics as smooth lines.
_POINTS = 180

# Share of the motion after settling that is drawn: enough to see that it repeats.
_AFTER = 1.0


@styled
def run_up_figure(run_up: RunUp, steady: SteadyState | None = None) -> Figure:
    """Draw the speed during run-up over time and revolutions, with the band about `steady` motion."""
    figure, axes = panels(1, height=3.0, columns=2, shared=False)
    time, turns, speed = _fine(run_up.motion, run_up.turns + _AFTER)
    for panel, x in zip(axes, (time, turns), strict=True):
        panel.plot(x, speed, color=BLUE, label="speed")
        _band(panel, steady)
        panel.set_xlim(0, float(x[-1]))
    settled = f"settled to {100 * run_up.settled:.2g} %"
    for panel, at in zip(axes, (run_up.time, run_up.turns), strict=True):
        panel.axvline(at, color=INK, linewidth=1.1, linestyle=":", label=settled)
    _words(axes)
    _legend(figure, axes[0])
    return figure


@styled
def attempt_figure(motion: Transient) -> Figure:
    """Draw the speed of a failed run-up, from the start to the stall, over time and revolutions."""
    figure, axes = panels(1, height=3.0, columns=2, shared=False)
    time, turns, speed = _fine(motion, motion.turns)
    for panel, x in zip(axes, (time, turns), strict=True):
        panel.plot(x, speed, color=BLUE, label="speed")
        panel.plot(x[-1:], speed[-1:], "X", color=RED, markersize=8, label="end of the motion")
    _words(axes)
    legend_above(axes[0])
    return figure


def _fine(motion: Transient, turns: float) -> tuple[Floats, ...]:
    travelled = (motion.crank_angle - motion.crank_angle[0]) / (2 * np.pi)
    end = float(np.interp(turns, travelled, motion.time))
    n = int(np.clip(_POINTS * turns, 200, 4000))
    time = np.linspace(float(motion.time[0]), end, n)
    angle, speed = motion.at(time)
    return time, (angle - motion.crank_angle[0]) / (2 * np.pi), speed


def _band(axes: Axes, steady: SteadyState | None) -> None:
    if steady is not None:
        label = "band of steady motion"
        axes.axhspan(steady.speed_min, steady.speed_max, color=SKY, alpha=0.3, linewidth=0, label=label)


def _words(axes: list[Axes]) -> None:
    for panel, word in zip(axes, ("time t [s]", "revolutions of the crank [–]"), strict=True):
        panel.set_xlabel(word)
        panel.set_ylim(bottom=0)
        panel.spines["left"].set_color(SOFT)
    axes[0].set_ylabel("speed ω [rad/s]")


def _legend(figure: Figure, axes: Axes) -> None:
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=3, handlelength=1.8)


@styled
def motor_figure(characteristic: Characteristic, steady: SteadyState | None = None) -> Figure:
    """Draw motor torque over motor speed: the whole curve, and the working range beside it.

    `steady`: steady motion; without it the whole curve alone is drawn. Returns: one or two panels, side by
    side.
    """
    figure, axes = panels(1, height=3.3, columns=2 if steady else 1, shared=False)
    full = axes[0]
    _curves(full, characteristic)
    _points(full, characteristic)
    full.set_xlim(0, float(characteristic.speed[-1]))
    roomy(full, characteristic.torque, characteristic.torque_load)
    _motor_words(full)
    if steady is not None:
        span = _span(steady, characteristic)
        full.axvspan(*span, color=SKY, alpha=0.25, linewidth=0)
        _detail(axes[1], characteristic, steady, span)
    _motor_legend(figure, full, axes[-1])
    return figure


def _span(steady: SteadyState, characteristic: Characteristic) -> tuple[float, float]:
    return steady.speed_min * characteristic.ratio, steady.speed_max * characteristic.ratio


def _curves(axes: Axes, characteristic: Characteristic) -> None:
    axes.plot(characteristic.speed, characteristic.torque, color=MOTOR, label="motor")
    load = axes.plot(characteristic.speed, characteristic.torque_load, color=LOAD, label="mean load")
    load[0].set(linestyle=(0, (5, 3)), linewidth=1.4)
    if characteristic.speed_no_load is not None:
        word = "no-load speed" if characteristic.speed_breakdown is None else "synchronous speed"
        axes.axvline(characteristic.speed_no_load, color=SOFT, linewidth=1, linestyle=":", label=word)


def _points(axes: Axes, characteristic: Characteristic) -> None:
    speed, torque = characteristic.speed_rated, characteristic.torque_rated
    if speed is not None and torque is not None:
        axes.plot(speed, torque, "o", color=INK, markersize=5, label="rated point")
    speed, torque = characteristic.speed_breakdown, characteristic.torque_breakdown
    if speed is not None and torque is not None:
        axes.plot(speed, torque, "^", color=INK, markersize=5.5, label="breakdown")


def _detail(
    axes: Axes, characteristic: Characteristic, steady: SteadyState, span: tuple[float, float]
) -> None:
    _curves(axes, characteristic)
    _points(axes, characteristic)
    speed = steady.speed * characteristic.ratio
    axes.plot(
        speed,
        steady.torque_motor,
        color=BLUE,
        linewidth=4,
        alpha=0.75,
        label=f"steady motion, {_cycle_words(steady)}",
    )
    axes.axvspan(*span, color=SKY, alpha=0.25, linewidth=0)
    # Room for the rated point and the synchronous speed, which lie near the working range.
    near = 0.5 * (span[1] - span[0]) + 0.01 * span[1]
    axes.set_xlim(max(0.0, span[0] - near), span[1] + near)
    axes.locator_params(axis="x", nbins=6)
    roomy(axes, steady.torque_motor, _load_in(axes.get_xlim(), characteristic), np.array([0.0]))
    _motor_words(axes)


def _load_in(limits: tuple[float, float], characteristic: Characteristic) -> np.ndarray:
    return np.interp(limits, characteristic.speed, characteristic.torque_load)


def _motor_words(axes: Axes) -> None:
    axes.set_xlabel("motor speed [rad/s]")
    axes.set_ylabel("motor torque [N m]")
    zero_line(axes)


def _motor_legend(figure: Figure, full: Axes, last: Axes) -> None:
    if full is last:
        legend_above(full)
        return
    handles, labels = last.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=3, handlelength=1.8)


# The motor's curve is drawn beyond the fastest instant of the revolution by this share of it, and half the
# range of speeds: as far as the detail beside it looks.
_BEYOND = 0.012


def drive_figures(study: Results) -> Iterator[CaptionedFigure]:
    """The figures that a drive has results for: steady motion, motor, run-up, reduction."""
    yield from _steady(study)
    yield from _motor(study)
    yield from _run_up(study)
    yield from _reduction(study)


def _cycle_words(steady: SteadyState) -> str:
    return "one revolution" if steady.turns == 1 else f"{steady.turns} revolutions"


def _steady(study: Results) -> Iterator[CaptionedFigure]:
    steady = study.steady_state
    if steady is None:
        return
    low, high = quantity(steady.speed_min, "rad/s"), quantity(steady.speed_max, "rad/s")
    over = _cycle_words(steady)
    caption = (
        f"The crank speed varies from {low} to {high}, δ = {number(steady.unevenness)}; {over} "
        f"{'takes' if steady.turns == 1 else 'take'} {quantity(steady.period, 's')}."
    )
    yield CaptionedFigure("speed", f"Speed and acceleration over {over}", caption, speed_figure(steady))
    caption = (
        "The speed follows the difference of driving and load torque and the change of the reduced inertia. "
        f"The work of the motor is {quantity(steady.energy_motor, 'J')} per revolution."
    )
    yield CaptionedFigure("torque", f"Torque and power over {over}", caption, torque_figure(steady))
    caption = "The same motion over time, as a tachometer records it."
    yield CaptionedFigure("time", "Speed and motor torque over time", caption, time_figure(steady))


def _motor(study: Results) -> Iterator[CaptionedFigure]:
    drive, steady, reduced = study.machine.drive, study.steady_state, study.reduction
    if drive is None or drive.motor is None or reduced is None or isinstance(drive.motor, ConstantSpeedMotor):
        return
    reach = (1.5 + _BEYOND) * steady.speed_max - 0.5 * steady.speed_min if steady else 0.0
    curve = characteristic(study.machine, reduced=reduced, speed_max=reach * drive.gearbox.ratio)
    caption = "Torque over speed at the motor's shaft, against the mean load of a revolution."
    if steady is not None:
        ends = (steady.speed_min, steady.speed_max)
        slow, fast = (quantity(speed * drive.gearbox.ratio, "rad/s") for speed in ends)
        caption += f" Shaded: the speeds of steady motion, {slow} to {fast}."
    yield CaptionedFigure("motor", "Motor and working range", caption, motor_figure(curve, steady))


def _run_up(study: Results) -> Iterator[CaptionedFigure]:
    if study.run_up is not None:
        run_up = study.run_up
        caption = (
            f"Steady motion, to within {100 * run_up.settled:.3g} %, is reached after "
            f"{quantity(run_up.time, 's')} "
            f"and {number(run_up.turns)} revolutions."
        )
        yield CaptionedFigure("run_up", "Run-up", caption, run_up_figure(run_up, study.steady_state))
    elif study.attempt is not None and len(study.attempt.time) > 1:
        caption = f"The motion ends after {number(study.attempt.turns)} revolutions."
        yield CaptionedFigure("run_up", "Failed run-up", caption, attempt_figure(study.attempt))


def _size(reduced: Reduction) -> float:
    """Peak absolute load torque [N m], beside which a mean may be rounding."""
    return float(np.abs(reduced.torque_load).max())


def _reduction(study: Results) -> Iterator[CaptionedFigure]:
    reduced = study.reduction
    if reduced is None or not (reduced.inertia_max or reduced.torque_load.any()):
        return
    low, high, mean = reduced.inertia_min, reduced.inertia_max, reduced.torque_load_mean
    load = f"{quantity(mean, 'N m', scale=_size(reduced))} on average."
    title, caption = "Load torque referred to the crank", f"Load torque referred to the crank, {load}"
    if high:
        title = "Reduced inertia and torque"
        caption = (
            f"Inertia reduced to the crank, from {quantity(low, 'kg m²', scale=high)} to "
            f"{quantity(high, 'kg m²')}, and load torque referred to the crank, {load}"
        )
    yield CaptionedFigure("reduction", title, caption, reduction_figure(reduced))


# Points that show polynomials as smooth lines.
_DRAWN_POINTS = 2000


@styled
def in_time_figure(motion: Transient, extremes: Sequence[MotionExtreme]) -> Figure:
    """Draw speed and acceleration of the crank over time; `extremes` are marked by dots."""
    time, _, _, acceleration = course(motion, _DRAWN_POINTS)
    time, acceleration = _with_jumps(motion, time, acceleration)
    drawn = []
    for name, symbol, values, unit, colour in (
        ("speed", "ω", motion.at(time)[1], "rad/s", SPEED),
        ("acceleration", "ε", acceleration, "rad/s²", ACCELERATION),
    ):
        marked = [extreme for extreme in extremes if extreme.quantity == name]
        heights, at = (np.array([getattr(one, key) for one in marked]) for key in ("value", "time"))
        marks = Line(heights, INK, x=at, form="o", style={"markersize": 4, "clip_on": False})
        drawn.append(Panel(f"{name} {symbol} [{unit}]", [Line(values, colour), marks]))
    return line_figure(time, *drawn, height=5.0, over="time t [s]")


def _with_jumps(
    motion: Transient, time: np.ndarray, acceleration: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Time and acceleration with both sides of every step's end, so that jumps are upright."""
    before, after = sides(motion)
    if not len(before):
        return time, acceleration
    inner = motion.time[1:-1]
    times = np.concatenate([time, inner, inner])
    values = np.concatenate([acceleration, before[:-1], after[1:]])
    order = np.argsort(times, kind="stable")
    return times[order], values[order]
