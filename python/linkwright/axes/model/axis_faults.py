"""What is wrong with the axes of a machine: their drivers, their sections, what the cycle does not give."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from pydantic import BaseModel
from pydantic_core import InitErrorDetails

from linkwright.axes.model.axis import Axis
from linkwright.axes.model.follower import cycle_time_of, family_of, whole_sections
from linkwright.cam.laws.programme import CLOSES, TURN
from linkwright.cam.model.motion_section import Family, section_faults
from linkwright.kernel.description.base import fault, suggestion
from linkwright.kernel.description.place import keys, look

# Entries by which drivers along a line move or act, and their words.
_MOVED_BY = {
    "linear_drivers": (("per_turn", "law"), "either per_turn or law"),
    "cylinders": (
        ("law", "flow", "pressure", "pressure_rod", "stiffness", "damping"),
        "law or flow of a driver, pressure of a force, stiffness or damping",
    ),
}


def axes_faults(machine: object) -> Iterator[InitErrorDetails]:
    """Faults of the axes of a machine, checked or raw, and of drivers that nothing moves."""
    mechanism, axes = look(machine, "mechanism"), look(machine, "axes")
    moved: dict[str, str] = {}
    for name in keys(axes):
        axis = look(axes, name)
        driver = look(axis, "driver") or name
        tables = ("cranks", "linear_drivers", "cylinders", "cams")
        known = [each for table in tables for each in keys(look(mechanism, table))]
        if driver not in known:
            remedy = suggestion(str(driver), known) if known else "give the mechanism a crank"
            key = ("driver",) if look(axis, "driver") else ()
            expected = "a crank, a linear driver, a cylinder or a cam of the mechanism"
            yield fault("axes", name, *key, found=driver, expected=expected, remedy=remedy)
        elif driver in moved:
            remedy = f"it is driven by the axis {moved[driver]}"
            yield fault(
                "axes", name, "driver", found=driver, expected="a driver without an axis", remedy=remedy
            )
        else:
            moved[driver] = name
            if isinstance(machine, BaseModel):
                yield from _within(("axes", name), _own_faults(machine, axis, driver))
    yield from _unmoved(mechanism, axes)


def _unmoved(mechanism: object, axes: object) -> Iterator[InitErrorDetails]:
    """Linear drivers and cylinders that neither their own entries nor an axis moves."""
    followed = {name: look(axes, name) for name in keys(axes)}
    by_axis = {look(axis, "driver") or name for name, axis in followed.items() if look(axis, "sections")}
    for table, (moves, expected) in _MOVED_BY.items():
        drivers = look(mechanism, table)
        for name in keys(drivers):
            driver = look(drivers, name)
            if name in by_axis or not (isinstance(driver, BaseModel) or hasattr(driver, "keys")):
                continue
            if all(look(driver, key) is None for key in moves):
                remedy = f"or the sections of an axis: [axes.{name}]"
                yield fault("mechanism", table, name, found="none of these", expected=expected, remedy=remedy)


def _within(place: tuple[str, ...], faults: Iterator[InitErrorDetails]) -> Iterator[InitErrorDetails]:
    """Faults of a part, with the place of the part."""
    for each in faults:
        yield InitErrorDetails(type=each["type"], loc=(*place, *each["loc"]), input=each.get("input"))


def _own_faults(machine: Any, axis: Axis, driver: str) -> Iterator[InitErrorDetails]:
    """What does not fit the driver of an axis, or its cycle."""
    family = family_of(machine.mechanism, driver)
    if family is None:
        yield from _cam_faults(axis)
        return
    tables = ("cranks", "linear_drivers", "cylinders")
    moved = (getattr(machine.mechanism, table) for table in tables)
    own = next(table[driver] for table in moved if driver in table)
    key, other = ("advance", "travel") if family == "swing" else ("travel", "advance")
    if other in axis.model_fields_set:
        kind = "crank, which turns" if family == "swing" else "driver along a line"
        yield fault(other, found=getattr(axis, other), expected=f"{key}: {driver} is a {kind}")
    if axis.travel and driver in machine.mechanism.cylinders:
        expected, remedy = "nothing for a cylinder", "its rod returns in every cycle"
        yield fault("travel", found=axis.travel, expected=expected, remedy=remedy)
    if getattr(own, "start_length", 0.0) is None:
        expected = f"start_length of {driver}, its length at the start of the sections"
        yield fault("driver", found=driver, expected=expected)
    if family == "lift" and axis.motor is not None and axis.gearbox.per_turn is None:
        expected = "the travel per revolution of the gearbox output: screw lead, pulley circumference"
        yield fault("gearbox", "per_turn", expected=expected)
    if family == "swing" and axis.gearbox.per_turn is not None:
        found, remedy = axis.gearbox.per_turn, "remove it"
        yield fault("gearbox", "per_turn", found=found, expected="nothing for a crank", remedy=remedy)
    if not axis.sections:
        if "sections" in axis.model_fields_set:
            remedy = f"without the key {driver} follows its own motion"
            yield fault("sections", found="an empty list", expected="at least one section", remedy=remedy)
        if axis.advance or axis.travel:
            remedy = f"a formula says it beside its law: advance of {driver}"
            yield fault(key, found=getattr(axis, key), expected="sections that advance", remedy=remedy)
        return
    for beside in ("law", "per_turn", "flow", "pressure", "pressure_rod", "stiffness", "damping"):
        if getattr(own, beside, None) is not None:
            expected = f"either sections or {beside} of {driver}"
            yield fault("sections", found="both", expected=expected, remedy="remove one of them")
    yield from _section_faults(machine, axis, family)


def _cam_faults(axis: Axis) -> Iterator[InitErrorDetails]:
    """A camshaft turns with the master."""
    for key in ("sections", "phase", "advance", "travel"):
        if getattr(axis, key):
            found = f"{len(axis.sections)} sections" if key == "sections" else getattr(axis, key)
            remedy = "the cam has sections and a phase of its own; its camshaft turns with the master"
            yield fault(key, found=found, expected="nothing for a cam", remedy=remedy)


def _section_faults(machine: Any, axis: Axis, family: Family) -> Iterator[InitErrorDetails]:
    """Sections without an angle or a time, or beyond the cycle, and what they themselves have wrong."""
    cycle_time = cycle_time_of(machine.master, machine.drive)
    wrong = False
    for i, section in enumerate(axis.sections):
        if (section.angle is None) == (section.time is None):
            found, wrong = "neither" if section.angle is None else "both", True
            yield fault("sections", i, "angle", found=found, expected="either angle or time")
        elif section.time is not None and cycle_time is None:
            wrong = True
            remedy = '[master] with cycle_time = "0.5 s" or speed = "120 rpm" says it'
            expected = "an angle, as the cycle time is not known"
            yield fault("sections", i, "time", found=section.time, expected=expected, remedy=remedy)
    if wrong:
        return
    angles = [section.over(cycle_time).angle for section in axis.sections]
    over = math.fsum(angles) - TURN
    if over > CLOSES * TURN:
        yield _too_long(axis, angles, over, cycle_time)
        return
    advance = ("advance", axis.advance) if family == "swing" else ("travel", axis.travel)
    yield from section_faults(whole_sections(axis, cycle_time), family, advance)


def _too_long(axis: Axis, angles: list[float], over: float, cycle_time: float | None) -> InitErrorDetails:
    """Sections that take longer than the cycle."""
    longest = max(range(len(angles)), key=angles.__getitem__)
    found = f"sections over {math.degrees(TURN + over):.6g} deg of the master"
    remedy = f"{math.degrees(over):.6g} deg too much: shorten sections.{longest}"
    if cycle_time is not None and any(section.time is not None for section in axis.sections):
        found = f"sections that take {(TURN + over) / TURN * cycle_time:.6g} s"
        more = f"{over / TURN * cycle_time:.6g} s more than the cycle of {cycle_time:.6g} s"
        remedy = f"{more}: shorten sections.{longest}"
    return fault("sections", found=found, expected="at most 360 deg, one cycle", remedy=remedy)
