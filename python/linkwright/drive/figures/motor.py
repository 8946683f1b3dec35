"""The characteristic of the motor, and the part of it that steady motion uses."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from linkwright.kernel.figure.style import (
    BLUE,
    INK,
    LOAD,
    MOTOR,
    SKY,
    SOFT,
    legend_above,
    panels,
    roomy,
    styled,
    zero_line,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from linkwright.drive.characteristic import Characteristic
    from linkwright.drive.steady_state import SteadyState


@styled
def motor_figure(characteristic: Characteristic, steady: SteadyState | None = None) -> Figure:
    """Draw motor torque over motor speed: the whole curve, and the working range beside it.

    `steady`: steady motion; without it the whole curve alone is drawn. Returns: one or two panels, side by
    side.
    """
    figure, axes = panels(1, height=3.3, columns=2 if steady else 1, shared=False)
    whole = axes[0]
    _curves(whole, characteristic)
    _points(whole, characteristic)
    whole.set_xlim(0, float(characteristic.speed[-1]))
    roomy(whole, characteristic.torque, characteristic.torque_load)
    _words(whole)
    if steady is not None:
        span = _span(steady, characteristic)
        whole.axvspan(*span, color=SKY, alpha=0.25, linewidth=0)
        _detail(axes[1], characteristic, steady, span)
    _legend(figure, whole, axes[-1])
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
    """Rated point and breakdown point."""
    speed, torque = characteristic.speed_rated, characteristic.torque_rated
    if speed is not None and torque is not None:
        axes.plot(speed, torque, "o", color=INK, markersize=5, label="rated point")
    speed, torque = characteristic.speed_breakdown, characteristic.torque_breakdown
    if speed is not None and torque is not None:
        axes.plot(speed, torque, "^", color=INK, markersize=5.5, label="breakdown")


def _detail(
    axes: Axes, characteristic: Characteristic, steady: SteadyState, span: tuple[float, float]
) -> None:
    """The working range, large: the points that a revolution goes through."""
    _curves(axes, characteristic)
    _points(axes, characteristic)
    speed = steady.speed * characteristic.ratio
    axes.plot(
        speed, steady.torque_motor, color=BLUE, linewidth=4, alpha=0.75, label="steady motion, one revolution"
    )
    axes.axvspan(*span, color=SKY, alpha=0.25, linewidth=0)
    # Room for the rated point and the synchronous speed, which lie near the working range.
    near = 0.5 * (span[1] - span[0]) + 0.01 * span[1]
    axes.set_xlim(max(0.0, span[0] - near), span[1] + near)
    axes.locator_params(axis="x", nbins=6)
    roomy(axes, steady.torque_motor, _load_in(axes.get_xlim(), characteristic), np.array([0.0]))
    _words(axes)


def _load_in(limits: tuple[float, float], characteristic: Characteristic) -> np.ndarray:
    """The mean load between two speeds."""
    return np.interp(limits, characteristic.speed, characteristic.torque_load)


def _words(axes: Axes) -> None:
    axes.set_xlabel("motor speed [rad/s]")
    axes.set_ylabel("motor torque [N m]")
    zero_line(axes)


def _legend(figure: Figure, whole: Axes, last: Axes) -> None:
    """One legend for both panels, above them."""
    if whole is last:
        legend_above(whole)
        return
    handles, labels = last.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=3, handlelength=1.8)
