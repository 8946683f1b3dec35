"""``linkwright motion FILE``: where everything is, at one crank angle, over one revolution or over time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import degrees, isfinite, pi
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import click

from linkwright.drive.crank_speed import CrankSpeed, crank_speed
from linkwright.kernel.command.answer import Answer, as_wanted, is_reported, is_taken, json_text
from linkwright.kernel.command.common import Output, ZeroAt, to_file
from linkwright.kernel.command.out import put
from linkwright.kernel.command.parameter import Option, Value
from linkwright.kernel.errors import InputError, require_within
from linkwright.kernel.later import later
from linkwright.kernel.limits import ROWS_OUT
from linkwright.kernel.units.kinds import ANGLE, ANGULAR_ACCELERATION, SPEED, TIME
from linkwright.machine.file_argument import File

if TYPE_CHECKING:
    from linkwright.kernel.reader.angle_zero import Zero
    from linkwright.linkages.law import Law
    from linkwright.linkages.motion import Motion
    from linkwright.linkages.pose import Pose
    from linkwright.machine.machine import Machine

At = Annotated[float | None, Value("--at", ANGLE, "One pose, at this crank angle.")]
Speed = Annotated[
    float | None,
    Value(
        "--speed",
        SPEED,
        'Speed of the crank, such as "90 rpm", for --at and for a revolution without --law. Default: '
        "the design speed of the file, or 1 rad/s.",
    ),
]
Acceleration = Annotated[
    float | None,
    Value(
        "--acceleration",
        ANGULAR_ACCELERATION,
        'With --at: acceleration of the crank, such as "20 rad/s^2". Default: none.',
    ),
]
LawText = Annotated[
    str | None,
    Option(
        "--law",
        "FORMULA|FILE",
        'Crank angle [rad] over time t [s]: a formula as "2*pi*t", or a CSV file of times and angles.',
    ),
]
Duration = Annotated[
    float | None,
    Value("--duration", TIME, "With --law as a formula: duration of the motion. Default: 1 s."),
]
Steps = Annotated[
    int,
    Option("--steps", "N", "Number of intervals of the revolution or of the duration.", min=1),
]
Csv = Annotated[bool, Option("--csv", help="CSV with all columns, in SI.")]
To = Annotated[Output, to_file("Write there.")]


def motion(
    file: File,
    at: At = None,
    speed: Speed = None,
    acceleration: Acceleration = None,
    law: LawText = None,
    duration: Duration = None,
    zero: ZeroAt = None,
    steps: Steps = 72,
    csv: Csv = False,
    *,
    to: To,
) -> None:
    """Positions, velocities and accelerations of points and links.

    One pose with --at, under a law of time with --law, else a revolution of the crank at constant speed.
    """
    from linkwright.linkages.zero import zero_of

    if steps < 1:
        raise InputError(f"--steps: found {steps}, expected 1 or more")
    require_within(ROWS_OUT, steps, "--steps", "take fewer")
    if at is not None and law is not None:
        raise InputError("--at and --law: one pose or a motion, not both")
    if acceleration is not None and at is None:
        raise InputError("--acceleration: it belongs to --at; a --law has its own")
    if speed is not None and law is not None:
        raise InputError("--speed and --law: the law gives the speed; expected one of them")
    if zero is not None and law is not None:
        raise InputError("--zero and --law: a law counts angles as the file does; expected one of them")
    if duration is not None and (law is None or _is_table(law)):
        raise InputError("--duration: it belongs to a --law that is a formula")
    machine = file.read()
    counted = zero_of(machine, zero)
    with as_wanted(machine.units):
        if law is not None:
            lasting = 1.0 if duration is None else duration
            text = _under_law(machine, law, lasting, steps, json=to.json, csv=csv)
        elif at is not None:
            rates = crank_speed(machine, speed), acceleration or 0.0
            text = _pose(machine, at + counted.angle, *rates, counted, json=to.json, csv=csv)
        else:
            text = _turn(machine, crank_speed(machine, speed), counted, steps, json=to.json, csv=csv)
    put(text, to.out, force=to.force)


def _pose(
    machine: Machine, phi: float, speed: CrankSpeed, acceleration: float, zero: Zero, *, json: bool, csv: bool
) -> str:
    from linkwright.kernel.page.table import csv_text
    from linkwright.kernel.reader.numbers import number
    from linkwright.linkages.pose import pose

    placed = pose(machine, phi, speed=speed.value, acceleration=acceleration)
    if json:
        results = placed.to_dict() | {"speed_source": speed.source} | _zero_data(zero)
        return json_text(Answer(machine=machine, results={"pose": results}, warnings=_warnings(machine)))
    phi = placed.crank_angle - zero.angle
    rows = [("crank angle", "φ [rad]", (phi, placed.speed, placed.acceleration)), *_pose_rows(placed)]
    rows = [_row_shown(row, "" if csv else "deg") for row in rows]
    if csv:
        click.echo("\n".join([str(speed), *_worded(machine, zero)]), err=True)
        heads = ("name", "quantity", "position", "velocity", "acceleration")
        # A transmission angle stands alone: rows are as long as the head all the same.
        empty = (float("nan"),) * 2
        return csv_text(heads, ((name, what, *(*numbers, *empty)[:3]) for name, what, numbers in rows))
    if is_reported():
        is_taken(_pose_answer(machine, rows, f"Crank angle {degrees(phi):.7g}°{_from(zero)}, {speed}"))
        return ""
    lines = [f"crank angle {degrees(phi):.7g}° = {phi:.7g} rad{_from(zero)}, {speed}"]
    wide = max(24, *(len(f"{name} {what} ") for name, what, _ in rows))
    lines += [f"{'':{wide}}{'position':>16}{'velocity':>16}{'acceleration':>16}"]
    scales = [max((abs(row[2][k]) for row in rows if len(row[2]) > k), default=0.0) for k in range(3)]
    lines += [
        f"{name + ' ' + what:<{wide}}"
        + "".join(f"{number(value, scale=scale):>16}" for value, scale in zip(numbers, scales, strict=False))
        for name, what, numbers in rows
    ]
    if placed.near_limit:
        lines.append(f"near a limit: {', '.join(placed.near_limit)}")
    return "\n".join([*lines, *_worded(machine, zero)]) + "\n"


def _warnings(machine: Machine, zero: float = 0.0) -> list[str]:
    from linkwright.linkages.closure import closure
    from linkwright.linkages.cycle import linkage
    from linkwright.linkages.law_jumps import law_warnings
    from linkwright.linkages.warnings import linkage_warnings

    if not closure(machine).turns_fully:
        return []
    return [*linkage_warnings(linkage(machine), zero), *law_warnings(machine)]


def _worded(machine: Machine, zero: Zero) -> list[str]:
    return [f"WARNING  {warning}" for warning in _warnings(machine, zero.angle)]


def _pose_answer(machine: Machine, rows: Sequence[tuple[str, str, tuple[float, ...]]], head: str) -> Answer:
    from linkwright.kernel.page.table import Table
    from linkwright.kernel.reader.numbers import number

    heads = ("name", "quantity", "position", "velocity", "acceleration")
    cells = [(name, what, *(number(x) for x in numbers)) for name, what, numbers in rows]
    table = Table("pose", "Pose", heads, [(*row, *[""] * (len(heads) - len(row))) for row in cells])
    return Answer(
        machine=machine,
        is_described=True,
        warnings=_warnings(machine),
        head=head,
        tables=table,
    )


def _row_shown(row: tuple[str, str, tuple[float, ...]], angle: str) -> tuple[str, str, tuple[float, ...]]:
    """A row in the units that the reader wants; the label says those of all columns where they differ."""
    # `angle`: usual unit of angles; empty for that of the result.
    from linkwright.kernel.reader.out_units import reader

    name, what, numbers = row
    si = "rad" if what.endswith("[rad]") else "m"
    usual = (angle if si == "rad" else "", "", "")
    units_si = (si, f"{si}/s", f"{si}/s²")[: len(numbers)]
    shown = [reader().shown(unit, other) for unit, other in zip(units_si, usual, strict=False)]
    if all(factor == 1.0 for _, factor in shown):
        return row
    units = ", ".join(unit for unit, _ in shown)
    values = tuple(value / factor for value, (_, factor) in zip(numbers, shown, strict=True))
    return name, what.replace(f"[{si}]", f"[{units}]"), values


def _pose_rows(pose: Pose) -> list[tuple[str, str, tuple[float, ...]]]:
    from linkwright.linkages.kinematics import unit_of_coordinate

    rows: list[tuple[str, str, tuple[float, ...]]] = []
    for name, point in pose.points.items():
        for k, axis in enumerate("xy"):
            numbers = (point.position[k], point.velocity[k], point.acceleration[k])
            rows.append((name, f"{axis} [m]", numbers))
    for word, part in (("angle", pose.links), ("place", pose.slides)):
        for name, entry in part.items():
            quantity = f"{word} [{unit_of_coordinate(f'{name}.{word}', pose.links)}]"
            rows.append((name, quantity, (entry.position, entry.velocity, entry.acceleration)))
    for name, mu in pose.transmission_angles.items():
        rows.append((name, "μ [rad]", (mu,)))
    return rows


def _from(zero: Zero) -> str:
    """From where crank angles are counted, for people; nothing where it is the file's zero."""
    return f" from the {zero.words}" if zero.words else ""


def _zero_data(zero: Zero) -> dict[str, Any]:
    return {"angle_zero": zero.angle, "zero": zero.words} if zero.words else {}


def _turn(machine: Machine, speed: CrankSpeed, zero: Zero, steps: int, *, json: bool, csv: bool) -> str:
    from linkwright.linkages.closure import driver_word
    from linkwright.linkages.law import constant_speed

    if speed.value * TIME.most < 2 * pi:
        least = 2 * pi / TIME.most
        expected = (
            f"a speed above zero for a revolution of at most {TIME.most:g} s, {least:.3g} rad/s or more"
        )
        raise InputError(f"{speed.source}: found {speed.value:g} rad/s, expected {expected}")
    times = (0.0, 2 * pi / speed.value)
    results = {"crank_speed": speed.value, "speed_source": speed.source} | _zero_data(zero)
    driver = driver_word(machine)
    head = f"one revolution of the {driver}{_from(zero)} in {times[1]:.6g} s, {speed.words(driver)}"
    law = constant_speed(speed.value, zero.angle)
    return _followed(machine, law, times, steps, head, results, zero, json=json, csv=csv)


def _under_law(machine: Machine, law: str, end: float, steps: int, *, json: bool, csv: bool) -> str:
    import numpy as np

    from linkwright.kernel.reader.angle_zero import Zero

    driver, start = _law(law), 0.0
    if hasattr(driver, "times"):
        start, end = driver.times[[0, -1]]
    if not end > start:
        raise InputError(f"--duration: found {end:g} s, expected more than {start:g} s")
    angle = float(abs(driver.at(np.array([end]))[0, 0]))
    if not hasattr(driver, "times") and isfinite(angle) and angle > ANGLE.most:
        expected = f"a duration in which the law turns the crank by at most {ANGLE.most:g} rad"
        raise InputError(f"--duration: found {end:g} s and {angle:.4g} rad, expected {expected}")
    head = f"crank angle [rad] by {law}, from {start:g} s to {end:g} s"
    return _followed(machine, driver, (start, end), steps, head, {"law": law}, Zero(), json=json, csv=csv)


def _followed(
    machine: Machine,
    law: Law,
    span: tuple[float, float],
    steps: int,
    head: str,
    results: dict[str, Any],
    zero: Zero,
    *,
    json: bool,
    csv: bool,
) -> str:
    """A motion as a table of the outputs, CSV or JSON of everything; what drives it is said first."""
    import numpy as np

    from linkwright.kernel.page.table import curves_csv
    from linkwright.linkages.motion import motion as follow

    followed = follow(machine, law, np.linspace(*span, steps + 1))
    if json:
        moved = results | followed.to_dict(curves=True) | _lists(followed.curves())
        return json_text(Answer(machine=machine, results={"motion": moved}, warnings=_warnings(machine)))
    if zero.angle:
        followed = replace(followed, crank_angle=followed.crank_angle - zero.angle)
    if csv:
        click.echo("\n".join([head, *_worded(machine, zero)]), err=True)
        return curves_csv(followed)
    if is_reported():
        answer = Answer(
            machine=machine,
            is_described=True,
            warnings=_warnings(machine),
            head=head[:1].upper() + head[1:],
            tables=later("linkages.figures_of_motion:course_tables", followed),
            figures=later("linkages.figures_of_motion:course_figures", followed),
        )
        is_taken(answer)
        return ""
    return "\n".join([head, _table(followed).rstrip("\n"), *_worded(machine, zero)]) + "\n"


def _lists(curves: dict[str, Any]) -> dict[str, list[float]]:
    return {name: curve.tolist() for name, curve in curves.items()}


def _table(followed: Motion) -> str:
    from linkwright.kernel.page.table import head
    from linkwright.kernel.reader.numbers import number
    from linkwright.kernel.reader.out_units import OutUnits, reader, reading, shown_columns

    # Angles are in degrees for people, unless they want another unit.
    with reading(reader().over(OutUnits.of("deg"))):
        shown = shown_columns({head(followed, name): curve for name, curve in _positions(followed).items()})
    width = max(14, *(len(name) + 2 for name in shown))
    lines = ["".join(f"{name:>{width}}" for name in shown)]
    units = [name.rpartition("[")[2] for name in shown]
    sizes = [(unit, float(abs(curve).max())) for unit, curve in zip(units, shown.values(), strict=True)]
    scales = [max(size for other, size in sizes if other == unit) for unit in units]
    for row in zip(*shown.values(), strict=True):
        cells = (number(float(x), scale=scale) for x, scale in zip(row, scales, strict=True))
        lines.append("".join(f"{cell:>{width}}" for cell in cells))
    return "\n".join(lines) + "\n"


# Share of the largest position below which a motion is rounding.
_AT_REST = 1e-12


def _positions(followed: Motion) -> dict[str, Any]:
    """Time, crank angle, and positions of what moves by more than rounding."""
    curves = followed.curves()
    places = {
        name: curve for name, curve in curves.items() if name.endswith((".x", ".y", ".angle", ".place"))
    }
    least = _AT_REST * max((float(abs(curve).max()) for curve in places.values()), default=0.0)
    moving = {name: curve for name, curve in places.items() if float(curve.max() - curve.min()) > least}
    return {"time": curves["time"], "crank_angle": curves["crank_angle"], **moving}


def _is_table(law: str) -> bool:
    return law.lower().endswith(".csv")


def _law(text: str) -> Law:
    if _is_table(text):
        from linkwright.linkages.law import TableLaw, read_law_table

        return TableLaw(*read_law_table(Path(text)))
    from linkwright.linkages.law import FormulaLaw

    return FormulaLaw(text)
