"""``linkwright transient FILE``: motion in time, of an elastic driveline where ``[drive]`` has one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, Annotated

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
)
from linkwright.drive.commands import transient as rigid_transient
from linkwright.kernel.command.answer import Answer
from linkwright.kernel.command.common import ZeroAt
from linkwright.kernel.command.parameter import Option
from linkwright.kernel.command.value import option_value
from linkwright.kernel.errors import InputError, require_within, show
from linkwright.kernel.later import at_place, later
from linkwright.kernel.limits import ROWS_OUT
from linkwright.kernel.units.kinds import TIME
from linkwright.machine.file_argument import File, MachineFile

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

# Without a duration and a number of revolutions.
_REVOLUTIONS = 10.0

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

    require_within(ROWS_OUT, steps, "--steps", "take fewer")
    if turns is not None and not turns > 0:
        raise InputError(f"--revolutions: found {turns:g}, expected more than 0")
    counted = zero_of(machine, zero)
    if turns is None and duration is None:
        turns = _REVOLUTIONS
    follow = partial(
        elastic_transient,
        machine,
        angle=from_angle + counted.angle,
        speed=from_speed,
        accuracy=accuracy,
        motor=not no_motor,
        brake=brake,
        clockwise=clockwise,
        switches=list(_switches(file, switches or ())),
        duration=np.inf if duration is None else duration,
        turns=np.inf if turns is None else turns,
    )
    motion = follow()
    findings, warnings = motion.findings, list[str]()

    def even() -> ElasticTransient:
        return follow(times=np.linspace(0.0, motion.duration, steps + 1))

    if motion.came_to_rest:
        # A machine is meant to come to rest that is switched off.
        is_meant = no_motor or brake or any("=off" in text or "brake" in text for text in switches or ())
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
