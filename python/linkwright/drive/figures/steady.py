"""One revolution of steady motion: speed, acceleration, torque and power."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from linkwright.kernel.figure.style import (
    ACCELERATION,
    DRIVE,
    LOAD,
    MATH,
    MOTOR,
    SPEED,
    legend_above,
    level,
    panels,
    roomy,
    styled,
    turn_axis,
    zero_line,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from linkwright.drive.steady_state import SteadyState

# Turns drawn against time: two show that the motion repeats.
_TURNS = 2

# Mean power from which it is drawn in kilowatts [W].
_KILOWATT = 1000.0


@styled
def speed_figure(steady: SteadyState) -> Figure:
    """Draw speed and acceleration of the crank over its angle."""
    figure, (speed, acceleration) = panels(2, height=4.2)
    degrees = np.degrees(steady.crank_angle)
    _speed(speed, degrees, steady)
    acceleration.plot(degrees, steady.acceleration, color=ACCELERATION)
    acceleration.set_ylabel("acceleration ε\n[rad/s²]")
    roomy(acceleration, steady.acceleration)
    zero_line(acceleration)
    turn_axis(speed, label=False)
    turn_axis(acceleration)
    return figure


def _speed(axes: Axes, degrees: np.ndarray, steady: SteadyState) -> None:
    """The speed with its mean and its extremes."""
    axes.plot(degrees, steady.speed, color=SPEED, label="speed")
    level(axes, steady.speed_mean_extremes, f"mean of the extremes {steady.speed_mean_extremes:.5g} rad/s")
    places = np.degrees([steady.speed_min_angle, steady.speed_max_angle])
    extremes = [steady.speed_min, steady.speed_max]
    axes.plot(places, extremes, "o", color=SPEED, markersize=4.5, label="minimum and maximum")
    axes.set_ylabel("speed ω\n[rad/s]")
    roomy(axes, steady.speed)
    legend_above(axes)


@styled
def torque_figure(steady: SteadyState) -> Figure:
    """Draw torques at the crank and power of the motor over the crank angle."""
    figure, (torque, power) = panels(2, height=4.2)
    degrees = np.degrees(steady.crank_angle)
    torque.plot(degrees, steady.torque_load, color=LOAD, label="load torque")
    torque.plot(degrees, steady.torque_drive, color=DRIVE, label="driving torque")
    torque.set_ylabel("torque at the crank\n[N m]")
    roomy(torque, steady.torque_drive, steady.torque_load)
    zero_line(torque)
    legend_above(torque)
    _power(power, degrees, steady)
    turn_axis(torque, label=False)
    turn_axis(power)
    return figure


def _power(axes: Axes, degrees: np.ndarray, steady: SteadyState) -> None:
    """The power of the motor with its mean."""
    unit, size = ("kW", 1e3) if abs(steady.power_motor_mean) >= _KILOWATT else ("W", 1.0)
    power, mean = steady.power_motor / size, steady.power_motor_mean / size
    axes.plot(degrees, power, color=MOTOR, label="power of the motor")
    level(axes, mean, f"mean over time {mean:.4g} {unit}")
    axes.set_ylabel(f"power $P$\n[{unit}]", **MATH)
    roomy(axes, power)
    zero_line(axes)
    legend_above(axes)


@styled
def time_figure(steady: SteadyState) -> Figure:
    """Draw speed and motor torque against time, over two revolutions."""
    figure, (speed, torque) = panels(2, height=4.2)
    time = np.concatenate([steady.time + turn * steady.period for turn in range(_TURNS)])
    speed.plot(time, np.tile(steady.speed, _TURNS), color=SPEED, label="speed")
    level(speed, steady.speed_mean_time, f"mean over time {steady.speed_mean_time:.5g} rad/s")
    speed.set_ylabel("speed ω\n[rad/s]")
    roomy(speed, steady.speed)
    legend_above(speed)
    torque.plot(time, np.tile(steady.torque_motor, _TURNS), color=MOTOR, label="torque of the motor")
    level(torque, steady.torque_motor_rms, f"root mean square {steady.torque_motor_rms:.4g} N m")
    torque.set_ylabel("motor torque $M$\n[N m]", **MATH)
    roomy(torque, steady.torque_motor)
    zero_line(torque)
    legend_above(torque)
    torque.set_xlabel("time t [s], two revolutions")
    torque.set_xlim(0, _TURNS * steady.period)
    return figure
