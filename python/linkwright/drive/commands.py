"""``linkwright transient FILE``: motion in time from rest or any state, what happens on the way, extremes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from linkwright.kernel.command.answer import Answer, hand_over
from linkwright.kernel.command.common import Curves, File, Json, Outside, Sets, ZeroAt, option_value
from linkwright.kernel.command.out import Force, out_option, output_folder
from linkwright.kernel.command.parameter import Option
from linkwright.kernel.errors import InputError, require_within
from linkwright.kernel.limits import ROWS_OUT

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from linkwright.drive.motion_events import MotionEvent, MotionExtreme
    from linkwright.drive.transient import Transient
    from linkwright.kernel.findings import Findings
    from linkwright.kernel.page.angle_zero import Zero
    from linkwright.kernel.page.table import Table
    from linkwright.kinetostatics.contact_in_time import ContactLoss
    from linkwright.linkages.motion import Motion
    from linkwright.machine.machine import Machine

FromAngle = Annotated[
    str, Option("--from-angle", metavar="ANGLE", help='Crank angle at the start, such as "90 deg".')
]
FromSpeed = Annotated[
    str,
    Option(
        "--from-speed",
        metavar="SPEED",
        help='Crank speed at the start, such as "30 rpm"; negative clockwise: --from-speed="-30 rpm".',
    ),
]
Duration = Annotated[str | None, Option("--duration", metavar="TIME", help="Duration of the motion.")]
Revolutions = Annotated[
    float | None,
    Option("--revolutions", metavar="N", help="Revolutions of the crank. Default, without --duration: 10."),
]
NoMotor = Annotated[bool, Option("--no-motor", help="Switch the motor off.")]
Clockwise = Annotated[
    bool,
    Option("--clockwise", help="Motor drives the crank clockwise, also in a start from rest."),
]
WithBrake = Annotated[bool, Option("--brake", help="Apply the brake of the file.")]
Accuracy = Annotated[float, Option("--accuracy", metavar="X", help="Relative accuracy of a step.")]
Steps = Annotated[
    int, Option("--steps", metavar="N", help="Number of equal time intervals in CSV and --curves.", min=1)
]
Folder = Annotated[
    Path | None, out_option("Write results.json, transient.csv and the figure as SVG and PNG there.")
]

# Without a duration and a number of revolutions.
_REVOLUTIONS = 10.0

# Intervals of the table on the terminal.
_ROWS = 12


@dataclass(frozen=True)
class _MotionReport:
    """A motion with what is reported of it."""

    machine: Machine
    motion: Transient
    zero: Zero
    steps: int
    losses: tuple[ContactLoss, ...]
    findings: Findings

    @property
    def events(self) -> tuple[MotionEvent, ...]:
        from linkwright.drive.motion_events import motion_events

        return motion_events(self.machine, self.motion)

    @property
    def extremes(self) -> tuple[MotionExtreme, ...]:
        from linkwright.drive.motion_events import motion_extremes

        return motion_extremes(self.motion)


def transient(
    file: File,
    set: Sets = None,
    allow_outside: Outside = False,
    from_angle: FromAngle = "0",
    from_speed: FromSpeed = "0",
    duration: Duration = None,
    turns: Revolutions = None,
    no_motor: NoMotor = False,
    brake: WithBrake = False,
    clockwise: Clockwise = False,
    zero: ZeroAt = None,
    accuracy: Accuracy = 1e-8,
    steps: Steps = 500,
    json: Json = False,
    curves: Curves = False,
    out: Folder = None,
    force: Force = False,
) -> None:
    """Follow the motion in time from rest or any state.

    Reports what happens on the way (kinks of the loads, standstill, stall) with angle and numbers, and the
    exact extremes of speed and acceleration.
    """
    from linkwright.drive.tables_in_time import end_sentence
    from linkwright.drive.transient import transient as follow
    from linkwright.kernel.findings import Findings
    from linkwright.kernel.page.angle_zero import Zero
    from linkwright.kernel.units.kinds import ANGLE, SPEED, TIME
    from linkwright.kinetostatics.contact_in_time import contact_losses
    from linkwright.linkages.zero import zero_angle
    from linkwright.machine.read import read

    folder = output_folder(out, force=force)
    require_within(ROWS_OUT, steps, "--steps", "take fewer")
    if turns is not None and not turns > 0:
        raise InputError(f"--revolutions: found {turns:g}, expected more than 0")
    machine = read(file, set or [], allow_outside=allow_outside)
    counted = zero_angle(machine, zero) if zero is not None else Zero()
    until: dict[str, float] = {}
    if duration is not None:
        until["duration"] = option_value("--duration", duration, TIME)
    if turns is not None or not until:
        until["turns"] = turns or _REVOLUTIONS
    motion = follow(
        machine,
        angle=option_value("--from-angle", from_angle, ANGLE) + counted.angle,
        speed=option_value("--from-speed", from_speed, SPEED),
        accuracy=accuracy,
        motor=not no_motor,
        brake=brake,
        clockwise=clockwise,
        **until,
    )
    findings = Findings()
    if motion.came_to_rest:
        # Without its motor a machine is meant to come to rest.
        (findings.warn if no_motor else findings.add)([end_sentence(motion, counted)])
    losses = findings.beside_of(contact_losses, machine, motion) or ()
    findings.add(loss.sentence(counted) for loss in losses)
    followed = _MotionReport(machine, motion, counted, steps, losses, findings)
    hand_over(_answer(followed), json=json, curves=curves, folder=folder)


def _answer(of: _MotionReport) -> Answer:
    from linkwright.drive.cautions import unjudged_limits

    return Answer(
        machine=of.machine.name,
        units=of.machine.units,
        described=of.machine,
        results=partial(_results, of),
        findings=list(of.findings.findings),
        warnings=[*of.findings.warnings, *unjudged_limits(of.machine)],
        head=lambda: _head(of),
        tables=partial(_tables, of),
        files=partial(_files, of),
        figures=partial(_figures, of),
    )


def _head(of: _MotionReport) -> str:
    """How far the angles are from those of the file; the methods of a motion that took implicit steps."""
    from linkwright.drive.tables_in_time import methods_sentence
    from linkwright.kernel.page.numbers import zero_words

    lines = []
    if of.zero.words:
        lines.append(zero_words(of.zero))
    if of.motion.implicit.any():
        lines.append(f"Integrated in {methods_sentence(of.motion)}")
    return "\n".join(lines)


def _results(of: _MotionReport, curves: bool) -> dict[str, Any]:
    """Extremes, events, and the curves at even times."""
    results: dict[str, Any] = {
        "end": of.motion.end.name.lower(),
        "duration": float(of.motion.time[-1]),
        "turns": of.motion.turns,
        "angle_zero": of.zero.angle,
        "zero": of.zero.words,
        "torque_drive_end": of.motion.torque_drive_end,
        "torque_load_end": of.motion.torque_load_end,
        "evaluations": of.motion.evaluations,
        "steps": of.motion.steps,
        "methods": [method._asdict() for method in of.motion.methods],
        "extremes": [extreme._asdict() for extreme in of.extremes],
        "events": [event._asdict() for event in of.events],
        "contact_losses": [loss._asdict() for loss in of.losses],
    }
    if curves:
        results |= {name: values.tolist() for name, values in _course(of).curves().items()}
    return {"transient": results}


def _course(of: _MotionReport, intervals: int | None = None) -> Motion:
    """The motion of everything at even times."""
    from linkwright.drive.motion_events import course
    from linkwright.linkages.motion import motion_along

    return motion_along(of.machine, *course(of.motion, intervals or of.steps))


def _tables(of: _MotionReport) -> list[Table]:
    from linkwright.drive.tables_in_time import in_time_tables

    return in_time_tables(of.motion, of.extremes, of.events, _course(of, _ROWS), of.zero)


def _files(of: _MotionReport) -> dict[str, str]:
    from linkwright.kernel.page.table import columns_csv, head

    course = _course(of)
    curves = course.curves() | {"crank_angle": course.crank_angle - of.zero.angle}
    return {"transient.csv": columns_csv({head(course, name): curve for name, curve in curves.items()})}


def _figures(of: _MotionReport) -> dict[str, Figure]:
    from linkwright.drive.figures import in_time_figure

    return {"transient": in_time_figure(of.motion, of.extremes)}
