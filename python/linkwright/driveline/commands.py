"""``linkwright transient FILE``: motion in time; ``linkwright elastic FILE``: steady elastic motion."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

from linkwright.drive.commands import (
    Accuracy,
    Clockwise,
    Duration,
    FromAngle,
    FromSpeed,
    NoMotor,
    Revolutions,
    Steps,
    To,
    WithBrake,
    end_of,
)
from linkwright.drive.commands import transient as rigid_transient
from linkwright.kernel.command.answer import Answer
from linkwright.kernel.command.common import FolderOutput, ZeroAt, belong_to, to_folder
from linkwright.kernel.command.parameter import Group, Option
from linkwright.kernel.command.value import option_value
from linkwright.kernel.errors import InputError, show
from linkwright.kernel.later import at_place, later
from linkwright.kernel.units.kinds import TIME
from linkwright.machine.file_argument import File, MachineFile
from linkwright.machine.machine import Machine

if TYPE_CHECKING:
    from linkwright.driveline.in_time import DriveSwitch, ElasticTransient
    from linkwright.kernel.reader.angle_zero import Zero

Rigid = Annotated[bool, Option("--rigid", help="Take an elastic driveline as rigid.")]
Switches = Annotated[
    list[str] | None,
    Option(
        "--switch",
        '"TIME: CHANGE; …"',
        "What changes at a time, with an elastic driveline: motor=off, brake=on, or an entry, such as "
        '"2 s: loads.rolling1.force=7 kN; motor=on". Repeatable, in the order of time.',
    ),
]

_STATES = {"on": True, "off": False}


def transient(
    file: File,
    *,
    from_angle: FromAngle,
    from_speed: FromSpeed,
    duration: Duration = None,
    turns: Revolutions = None,
    no_motor: NoMotor = False,
    brake: WithBrake = False,
    clockwise: Clockwise = False,
    switches: Switches = None,
    rigid: Rigid = False,
    zero: ZeroAt = None,
    accuracy: Accuracy = 1e-8,
    steps: Steps = 500,
    to: To,
) -> None:
    """Follow the motion in time from rest or any state.

    Reports what happens on the way (kinks of the loads, standstill, stall) with angle and numbers, and the
    exact extremes of speed and acceleration. With an elastic driveline: torques of its shafts, motion of its
    stations, and the balance of energy.
    """
    from linkwright.driveline.study import has_elastic_drive

    machine = file.read()
    if rigid or not has_elastic_drive(machine):
        if switches:
            raise InputError("--switch: found a rigid driveline, expected one of which a shaft is flexible")
        rigid_transient(
            file=file,
            from_angle=from_angle,
            from_speed=from_speed,
            duration=duration,
            turns=turns,
            no_motor=no_motor,
            brake=brake,
            clockwise=clockwise,
            zero=zero,
            accuracy=accuracy,
            steps=steps,
            to=to,
        )
        return
    from linkwright.driveline.in_time import elastic_transient
    from linkwright.kernel.findings import sentence
    from linkwright.kernel.reader.numbers import zero_words
    from linkwright.linkages.zero import zero_of

    until: dict[str, Any] = dict(end_of(duration, turns, steps))
    counted = zero_of(machine, zero)
    changes = list(_switches(file, switches or ()))
    follow = partial(
        elastic_transient,
        machine,
        angle=from_angle + counted.angle,
        speed=from_speed,
        accuracy=accuracy,
        motor=not no_motor,
        brake=brake,
        clockwise=clockwise,
        switches=changes,
        **until,
    )
    motion = follow()
    findings, warnings = motion.findings, list[str]()

    def even() -> ElasticTransient:
        return follow(times=np.linspace(0.0, motion.duration, steps + 1))

    if motion.came_to_rest:
        # A machine is meant to come to rest that is switched off.
        is_meant = no_motor or brake or any(each.motor is False or each.brake for each in changes)
        (warnings if is_meant else findings).append(sentence(_end_sentence(motion, counted)))
    answer = Answer(
        machine=machine,
        is_described=True,
        results=lambda curves: {
            "elastic_transient": (even() if curves else motion).to_dict(curves=curves)
            | {"angle_zero": counted.angle, "zero": counted.words}
        },
        findings=findings,
        warnings=warnings,
        head=lambda: zero_words(counted) if counted.words else "",
        tables=lambda: list(at_place("driveline.tables:transient_tables")(motion)),
        files={"transient.csv": lambda: _csv(even(), counted)},
        figures={"transient": later("driveline.figures_in_time:elastic_transient_figure", motion)},
    )
    to.hand_over(answer)


def _switches(file: MachineFile, texts: Sequence[str]) -> Iterator[DriveSwitch]:
    """Each ``--switch``, "TIME: CHANGE; …"; entries hold from then on."""
    from linkwright.driveline.in_time import DriveSwitch

    entries: list[str] = []
    for text in texts:
        when, colon, changes = text.partition(":")
        if not colon or not changes.strip():
            raise InputError(
                f'--switch {show(text)}: expected TIME and what changes then, such as "2 s: motor=off"'
            )
        states: dict[str, bool | None] = {"motor": None, "brake": None}
        own = []
        for change in changes.split(";"):
            name, _, value = (word.strip() for word in change.partition("="))
            if name not in states:
                own.append(change.strip())
            elif value in _STATES:
                states[name] = _STATES[value]
            else:
                raise InputError(f"--switch {show(text)}: {name}: found {show(value)}, expected on or off")
        entries += own
        time = option_value("--switch", when.strip(), TIME)
        yield DriveSwitch(time, states["motor"], states["brake"], file.read(entries) if own else None)


def _end_sentence(motion: ElasticTransient, zero: Zero) -> str:
    from linkwright.kernel.reader.numbers import degrees, number, quantity

    angle = degrees(float(motion.state_end[-1]) - zero.angle)
    return (
        f"The machine comes to rest after {quantity(motion.duration, 's')} and {number(motion.turns)} "
        f"revolutions: at φ = {angle} the drive gives {quantity(motion.torque_drive_end, 'N m')} at the "
        f"crank and the loads need {quantity(motion.torque_load_end, 'N m')}"
    )


def _csv(course: ElasticTransient, zero: Zero) -> str:
    from linkwright.kernel.page.table import columns_csv

    columns = {"time [s]": course.time, "crank_angle [rad]": course.crank_angle - zero.angle}
    for names, curves in ((course.stations, ("speed", "acceleration")), (course.shafts, ("torque", "twist"))):
        for k, name in enumerate(names):
            for curve in curves:
                columns[f"{name}_{curve} [{course.unit_of(curve)}]"] = getattr(course, curve)[k]
    columns |= {f"{name} [N m]": getattr(course, name) for name in ("torque_drive", "torque_load")}
    return columns_csv(columns)


Over = Annotated[
    str | None,
    Option("--over", "ADDRESS", 'Follow the motion over this number, such as "drive.crankshaft.stiffness".'),
]
First = Annotated[str | None, Option("--from", "VALUE", 'First end of its range, such as "5 kN m/rad".')]
Last = Annotated[str | None, Option("--to", "VALUE", "Other end of its range.")]
ToFolder = Annotated[FolderOutput, to_folder("Write results.json and the figure as SVG and PNG there.")]


@dataclass(frozen=True)
class RangeOptions:
    """The number that is changed."""

    over: Over = None
    first: First = None
    last: Last = None


def elastic(file: File, *, along: Annotated[RangeOptions, Group(RangeOptions)], to: ToFolder) -> None:
    """Steady motion of a torsionally flexible driveline with its mechanism.

    Torques of the shafts, motion of the stations, Floquet multipliers, and further steady motions where links
    have backlash or a torque curve. With --over: the branch of steady motions over a number of the file, also
    through folds, with the motions that are stable and the points where their stability changes. Exit code 1
    if there is no steady motion, or a permitted torque is exceeded.

    Example: linkwright elastic press.toml --over drive.crankshaft.stiffness --from "5 kN m/rad" --to
    "50 kN m/rad".
    """
    if along.over is None:
        belong_to("--over", "first", "last")
    machine = file.read()
    to.hand_over(_motion(machine) if along.over is None else _branches(machine, along.over, along))


def _motion(machine: Machine) -> Answer:
    from linkwright.driveline.elastic_motion import elastic_motion
    from linkwright.driveline.study import motion_warnings
    from linkwright.kernel.findings import sentence

    motion = elastic_motion(machine, others=True)
    return Answer(
        machine=machine,
        is_described=True,
        results=lambda curves: {"elastic_motion": motion.to_dict(curves=curves)},
        findings=motion.findings,
        warnings=[sentence(text) for text in motion_warnings(machine, motion)],
        tables=later("driveline.tables:elastic_tables", motion),
        figures=later("driveline.figures:elastic_figures", motion),
    )


def _branches(machine: Machine, address: str, along: RangeOptions) -> Answer:
    from linkwright.driveline.branches import elastic_branches

    first, last = (
        _value(machine, address, option, text)
        for option, text in (("--from", along.first), ("--to", along.last))
    )
    branches = elastic_branches(machine, address, first, last)
    return Answer(
        machine=machine,
        is_described=True,
        results=lambda _: {"elastic_branches": branches.to_dict()},
        tables=later("driveline.branch_tables:branch_tables", branches),
        figures={"elastic_branches": later("driveline.branch_tables:branch_figure", branches)},
    )


def _is_plain(text: str) -> bool:
    """Whether a text is a plain number, which is taken in SI."""
    try:
        float(text)
    except ValueError:
        return False
    return True


def _value(machine: Machine, address: str, option: str, text: Any) -> float:
    from linkwright.machine.address import kind
    from linkwright.machine.size_limits import parsed

    its_kind = kind(machine, address)
    if its_kind is None:
        raise InputError(f"--over: found {address}, expected the address of a number")
    if text is None:
        raise InputError(f"{option}: found nothing, expected an end of the range of {address}")
    return parsed(option, float(text) if _is_plain(text) else text, its_kind)
