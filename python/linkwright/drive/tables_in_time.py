"""A motion in time as tables of text: how it ended, extremes, events, the course."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from linkwright.drive.motion_events import MotionEvent, MotionExtreme
from linkwright.drive.transient import End, Transient
from linkwright.kernel.arrays import Floats
from linkwright.kernel.page.table import Cell, Row, Table, part_table
from linkwright.kernel.reader.angle_zero import Zero
from linkwright.kernel.reader.numbers import degrees, number, quantity
from linkwright.linkages.motion import Motion

# What rounding leaves of zero, over the largest value of a column.
_ROUNDING = 1e-12

# Events that a table has: the first and the last ones of a motion with more.
_EVENTS = 24

_SPEED, _ACCELERATION, _TORQUE = "rad/s", "rad/s²", "N m"

_TORQUES = "at φ = {angle} the drive gives {drive} N m at the crank and the loads"
_AFTER = "after {time} s, {turns} revolutions"
_SENTENCES = {
    End.DOES_NOT_START: f"The machine does not start: {_TORQUES} need {{load}} N m",
    End.STARTS_BACKWARDS: f"The machine is driven backwards: {_TORQUES} require {{load}} N m",
    End.STALL: f"The machine stalls {_AFTER}: {_TORQUES} need {{load}} N m",
    End.REVERSAL: f"The machine stops {_AFTER}, and is driven backwards: {_TORQUES} require {{load}} N m",
}


def end_sentence(motion: Transient, zero: Zero) -> str:
    """How a motion came to rest, with numbers; empty if it did not."""
    if motion.end not in _SENTENCES:
        return ""
    return _SENTENCES[motion.end].format(
        angle=_angle(float(motion.crank_angle[-1]), zero),
        time=number(float(motion.time[-1])),
        turns=number(motion.turns),
        drive=number(motion.torque_drive_end),
        load=number(motion.torque_load_end),
    )


_METHODS = {
    "explicit": "the explicit method of Dormand and Prince, order 8 (DOP853)",
    "implicit": "the implicit method Radau IIA, order 9, where the drive is stiff",
}

# Parts that are listed one by one; of a motion that changes its method more often, the sums of steps.
_PARTS = 4


def methods_sentence(motion: Transient) -> str:
    """Which method was used over which part of a motion, with the steps of each."""
    parts = motion.methods
    if len(parts) > _PARTS:
        steps = {name: sum(part.steps for part in parts if part.method == name) for name in _METHODS}
        return ", ".join(f"{steps[name]} steps by {words}" for name, words in _METHODS.items())
    if len(parts) == 1:
        return f"{parts[0].steps} steps by {_METHODS[parts[0].method]}"
    return ", ".join(
        f"{part.steps} steps from {quantity(part.time_start, 's')} to {quantity(part.time_end, 's')} by "
        f"{_METHODS[part.method]}"
        for part in parts
    )


def in_time_tables(
    motion: Transient,
    extremes: Sequence[MotionExtreme],
    events: Sequence[MotionEvent],
    course: Motion,
    zero: Zero,
) -> list[Table]:
    """The tables of a motion in time."""
    tables = [_extremes(extremes, zero), _events(events, zero), _course(course, zero)]
    return [table for table in tables if table.rows]


def _extremes(extremes: Sequence[MotionExtreme], zero: Zero) -> Table:
    rows: list[Row] = [
        (
            f"{extreme.kind} {extreme.quantity}",
            "ω" if extreme.quantity == "speed" else "ε",
            _value(extreme.value, _SPEED if extreme.quantity == "speed" else _ACCELERATION),
            quantity(extreme.time, "s"),
            _angle(extreme.crank_angle, zero),
        )
        for extreme in extremes
    ]
    return Table("extremes", "Extremes of the motion", ("quantity", "", "value", "time", "crank angle"), rows)


def _events(events: Sequence[MotionEvent], zero: Zero) -> Table:
    """Events, without kinks at which nothing jumps: a long motion passes hundreds of these."""
    shown = [event for event in events if event.kind != "kink"]
    if len(shown) > _EVENTS:
        shown = [*shown[: _EVENTS // 2], *shown[-_EVENTS // 2 :]]
    title = "Events" if len(shown) == len(events) else f"Events, {len(shown)} of {len(events)}"
    heads = ("event", "", "time", "crank angle", "speed", "acceleration before", "after")
    rates = tuple(f"acceleration_{side} [{_ACCELERATION}]" for side in ("before", "after"))
    cells: tuple[Cell, ...] = (
        "kind",
        "",
        "time [s]",
        lambda event: _angle(event.crank_angle, zero),
        f"speed [{_SPEED}]",
        *rates,
    )
    return part_table("events", title, shown, heads, *cells)


def _course(course: Motion, zero: Zero) -> Table:
    """Time, angle, speed and acceleration of the crank, and the place and velocity of every slide."""
    slides = list(course.slides.items())
    heads: Row = ("time", "", "crank angle", "speed", "acceleration")
    heads = (*heads, *(word for name, _ in slides for word in (name, f"velocity of {name}")))
    curves = [(course.speed, _SPEED), (course.acceleration, _ACCELERATION)]
    for name, path in slides:
        unit = course.unit_of(f"{name}.place")
        curves += [(path.position, unit), (path.velocity, f"{unit}/s")]
    columns = [_column(curve, si) for curve, si in curves]
    first = [
        (quantity(float(time), "s"), "", _angle(float(angle), zero))
        for time, angle in zip(course.time, course.crank_angle, strict=True)
    ]
    rows: list[Row] = [(*head, *cells) for head, *cells in zip(first, *columns, strict=True)]
    return Table("course", "Motion in time", heads, rows)


def _angle(angle: float, zero: Zero) -> str:
    return degrees(angle - zero.angle)


def _column(curve: Floats, si: str) -> list[str]:
    most = float(np.abs(curve).max())
    return [_value(float(value), si, most) for value in curve]


def _value(value: float | None, si: str, most: float = 0.0) -> str:
    """A value with its unit; zero where nothing but rounding is left beside the largest one."""
    small = value is not None and abs(value) <= _ROUNDING * most
    return quantity(0.0 if small else value, si)
