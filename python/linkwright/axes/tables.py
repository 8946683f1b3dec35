"""Axes as tables: a row an axis, checks of its motor, the DC bus, the timing of all cams and axes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from linkwright.axes.axis import ServoAxis
from linkwright.axes.bus import DcBus
from linkwright.axes.clearance import Clearance
from linkwright.axes.timing import Track
from linkwright.kernel.arrays import Floats
from linkwright.kernel.page.checks import check_table
from linkwright.kernel.page.table import Row, Table, known_rows
from linkwright.kernel.reader.numbers import degrees, measured, parted

# Places of a revolution in the timing diagram of a terminal, and its heights from low to high.
_PLACES, _HEIGHTS = 48, "▁▂▃▄▅▆▇█"

_VERDICT = {True: "passes", False: "fails", None: "no motor"}


def axis_tables(axes: Sequence[ServoAxis]) -> Iterator[Table]:
    """Drivers and motors, a row each, and the checks of every motor."""
    yield drivers_table(axes)
    yield motors_table(axes)
    for axis in axes:
        if axis.checks:
            yield check_table(f"axis_{axis.name}_checks", f"Checks of axis {axis.name}", axis.checks)


def drivers_table(axes: Sequence[ServoAxis]) -> Table:
    """What each driver asks of its drive."""
    heads = (
        "axis",
        "",
        "driver",
        "advance per cycle",
        "peak velocity",
        "peak torque",
        "at φ",
        "rms torque",
        "mean inertia",
    )
    names = ("advance", "velocity_max", "torque_max", "torque_max_angle", "torque_rms", "inertia_mean")
    rows: list[Row] = [(axis.name, "", axis.driver, *(_cell(axis, name) for name in names)) for axis in axes]
    return Table("axes", "Axes: torque or force of each driver", heads, rows)


def _cell(axis: ServoAxis, name: str) -> str:
    value, unit = getattr(axis, name), axis.unit_of(name)
    if name == "advance":
        value = 0.0 if abs(value) <= 1e-9 * float(np.ptp(axis.position)) else value
    return degrees(value) if unit == "rad" else measured(value, unit, float(abs(value or 0.0)))


def motors_table(axes: Sequence[ServoAxis]) -> Table:
    """What each motor has to give."""
    heads = (
        "axis",
        "",
        "motor",
        "ratio",
        "peak torque",
        "rms torque",
        "top speed",
        "inertia ratio",
        "regenerated",
        "verdict",
    )
    rows: list[Row] = [
        (
            axis.name,
            "",
            _motor_name(axis),
            f"{axis.axis.gearbox.ratio:.4g}",
            *(
                measured(getattr(axis.motor, name), axis.motor.unit_of(name))
                for name in (
                    "torque_peak",
                    "torque_rms",
                    "speed_peak",
                    "inertia_ratio",
                    "energy_regenerated",
                )
            ),
            _VERDICT[axis.passes],
        )
        for axis in axes
    ]
    title = "Motors of the axes"
    if any(axis.axis.motor is None for axis in axes):
        title += "; without a motor, its rotor does not count"
    return Table("axis_motors", title, heads, rows)


def _motor_name(axis: ServoAxis) -> str:
    motor = axis.axis.motor
    return "none" if motor is None else motor.type or motor.catalogue or "given"


def bus_tables(bus: DcBus) -> Iterator[Table]:
    """The DC bus of all axes."""
    rows = [row[:3] for row in known_rows(bus, "bus")]
    yield Table("dc_bus", "DC bus of all axes", ("quantity", "", "value"), rows)


def clearance_tables(apart: Clearance) -> Iterator[Table]:
    """Minimum distance of two points of axes, and the shift that keeps a wanted one."""
    beside = {"distance_min": f"at φ = {degrees(apart.distance_min_angle)}"}
    if apart.earlier is not None:
        is_any = apart.earlier >= 2 * np.pi
        beside["earlier"] = (
            f"any start of axis {apart.axis}" if is_any else f"axis {apart.axis}; negative: later"
        )
    title = f"Clearance between {apart.first} and {apart.second}"
    yield Table(
        "clearance", title, ("quantity", "", "value", "where"), known_rows(apart, "clearance", beside)
    )


def timing_tables(tracks: Sequence[Track]) -> Iterator[Table]:
    """Positions of all cams and axes over a revolution of the master, as a row of heights each."""
    rows: list[Row] = [
        (track.name, "", heights(track), *(_range(track, name) for name in ("position", "velocity")))
        for track in tracks
    ]
    heads = ("driver", "", "position, 0° to 360° of the master", "range", "velocity")
    yield Table("timing", "Timing of cams and axes", heads, rows, is_drawing=True)


def heights(track: Track) -> str:
    """The position of a driver over a revolution of the master, from its lowest to its highest."""
    at = 2 * np.pi * (np.arange(_PLACES) + 0.5) / _PLACES
    position = np.interp(at, track.crank_angle, track.position)
    low, span = float(track.position.min()), float(np.ptp(track.position))
    share: Floats = (position - low) / span if span > 0 else np.zeros_like(position)
    return "".join(_HEIGHTS[int(level)] for level in np.rint(share * (len(_HEIGHTS) - 1)))


def _range(track: Track, name: str) -> str:
    """Lowest to highest value of a curve."""
    values, unit = getattr(track, name), track.unit_of(name)
    low, high = float(values.min()), float(values.max())
    if unit == "rad":
        return f"{degrees(low)} to {degrees(high)}"
    scale = max(abs(low), abs(high))
    return f"{measured(low, unit, scale)} to {measured(high, unit, scale)}"


def axes_headline(axes: Sequence[ServoAxis]) -> Iterator[tuple[str, str, str]]:
    """Peak and root mean square torque of every motor, and its verdict."""
    for axis in axes:
        yield f"axis {axis.name}: peak torque of the motor", *parted(axis.motor.torque_peak, "N m")
        yield f"axis {axis.name}: rms torque of the motor", *parted(axis.motor.torque_rms, "N m")
        if axis.passes is not None:
            yield f"axis {axis.name}: motor", _VERDICT[axis.passes], ""
