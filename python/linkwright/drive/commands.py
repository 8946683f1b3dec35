"""``linkwright transient FILE``: motion in time from rest or any state, what happens on the way, extremes."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Annotated

from linkwright.kernel.command.answer import Answer
from linkwright.kernel.command.common import Curves, FolderOutput, ZeroAt, to_folder
from linkwright.kernel.command.parameter import Option, Value
from linkwright.kernel.errors import InputError, require_within
from linkwright.kernel.later import at_place, later
from linkwright.kernel.limits import ROWS_OUT
from linkwright.kernel.units.kinds import ANGLE, SPEED, TIME
from linkwright.machine.file_argument import File

if TYPE_CHECKING:
    from linkwright.drive.transient import Transient
    from linkwright.kernel.reader.angle_zero import Zero
    from linkwright.linkages.motion import Motion

FromAngle = Annotated[float, Value("--from-angle", ANGLE, 'Crank angle at the start, such as "90 deg".', "0")]
FromSpeed = Annotated[
    float,
    Value(
        "--from-speed",
        SPEED,
        'Crank speed at the start, such as "30 rpm"; negative clockwise: --from-speed="-30 rpm".',
        "0",
    ),
]
Duration = Annotated[float | None, Value("--duration", TIME, "Duration of the motion.")]
Revolutions = Annotated[
    float | None,
    Option("--revolutions", "N", "Revolutions of the crank. Default, without --duration: 10."),
]
NoMotor = Annotated[bool, Option("--no-motor", help="Switch the motor off.")]
Clockwise = Annotated[
    bool,
    Option("--clockwise", help="Motor drives the crank clockwise, also in a start from rest."),
]
WithBrake = Annotated[bool, Option("--brake", help="Apply the brake of the file.")]
Accuracy = Annotated[float, Option("--accuracy", "X", "Relative accuracy of a step.")]
Steps = Annotated[int, Option("--steps", "N", "Number of equal time intervals in CSV and --curves.", min=1)]
To = Annotated[
    FolderOutput,
    to_folder("Write results.json, transient.csv and the figure as SVG and PNG there.", curves=Curves),
]

# Without a duration and a number of revolutions.
_REVOLUTIONS = 10.0

# Intervals of the table on the terminal.
_ROWS = 12


def end_of(duration: float | None, turns: float | None, steps: int) -> dict[str, float]:
    """The end of a motion in time, whose curves have so many steps: time, revolutions, or 10 of them."""
    require_within(ROWS_OUT, steps, "--steps", "take fewer")
    if turns is not None and not turns > 0:
        raise InputError(f"--revolutions: found {turns:g}, expected more than 0")
    until: dict[str, float] = {} if duration is None else {"duration": duration}
    if turns is not None or not until:
        until["turns"] = turns or _REVOLUTIONS
    return until


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
    zero: ZeroAt = None,
    accuracy: Accuracy = 1e-8,
    steps: Steps = 500,
    to: To,
) -> None:
    """Follow the motion in time from rest or any state.

    Reports what happens on the way (kinks of the loads, standstill, stall) with angle and numbers, and the
    exact extremes of speed and acceleration.
    """
    from linkwright.drive.motion_events import course, motion_events, motion_extremes
    from linkwright.drive.tables_in_time import end_sentence
    from linkwright.drive.transient import transient as follow
    from linkwright.drive.warnings import unjudged_limits
    from linkwright.kernel.findings import Findings
    from linkwright.kinetostatics.contact_in_time import contact_losses
    from linkwright.linkages.motion import motion_along
    from linkwright.linkages.zero import zero_of

    until = end_of(duration, turns, steps)
    machine = file.read()
    counted = zero_of(machine, zero)
    motion = follow(
        machine,
        angle=from_angle + counted.angle,
        speed=from_speed,
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
    extremes, events = motion_extremes(motion), motion_events(machine, motion)

    def even(intervals: int) -> Motion:
        return motion_along(machine, *course(motion, intervals))

    results = {
        "end": motion.end.name.lower(),
        "duration": float(motion.time[-1]),
        "turns": motion.turns,
        "angle_zero": counted.angle,
        "zero": counted.words,
        "torque_drive_end": motion.torque_drive_end,
        "torque_load_end": motion.torque_load_end,
        "evaluations": motion.evaluations,
        "steps": motion.steps,
        "methods": [method._asdict() for method in motion.methods],
        "extremes": [extreme._asdict() for extreme in extremes],
        "events": [event._asdict() for event in events],
        "contact_losses": [loss._asdict() for loss in losses],
    }
    answer = Answer(
        machine=machine,
        is_described=True,
        results=lambda curves: {"transient": results | (_lists(even(steps)) if curves else {})},
        findings=list(findings.findings),
        warnings=[*findings.warnings, *unjudged_limits(machine)],
        head=partial(_head, motion, counted),
        tables=lambda: at_place("drive.tables_in_time:in_time_tables")(
            motion, extremes, events, even(_ROWS), counted
        ),
        files={"transient.csv": lambda: _csv(even(steps), counted)},
        figures={"transient": later("drive.figures:in_time_figure", motion, extremes)},
    )
    to.hand_over(answer)


def _head(motion: Transient, zero: Zero) -> str:
    """How far the angles are from those of the file; the methods of a motion that took implicit steps."""
    from linkwright.drive.tables_in_time import methods_sentence
    from linkwright.kernel.reader.numbers import zero_words

    lines = []
    if zero.words:
        lines.append(zero_words(zero))
    if motion.implicit.any():
        lines.append(f"Integrated in {methods_sentence(motion)}")
    return "\n".join(lines)


def _lists(course: Motion) -> dict[str, list[float]]:
    return {name: values.tolist() for name, values in course.curves().items()}


def _csv(course: Motion, zero: Zero) -> str:
    from linkwright.kernel.page.table import columns_csv, head

    curves = course.curves() | {"crank_angle": course.crank_angle - zero.angle}
    return columns_csv({head(course, name): curve for name, curve in curves.items()})
