"""``linkwright motion FILE``: where everything is, at one crank angle, over a turn or over time."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from linkwright.cli.common import Force, Json, Out, Sets, option_value, put
from linkwright.errors import InputError

if TYPE_CHECKING:
    from linkwright.analysis.law import Law
    from linkwright.analysis.pose import Pose
    from linkwright.machine import Machine

At = Annotated[
    str | None,
    typer.Option("--at", metavar="ANGLE", help="One pose, at this crank angle.", show_default=False),
]
Speed = Annotated[
    str,
    typer.Option("--speed", metavar="SPEED", help="Speed of the crank, for --at and a turn without --law."),
]
LawText = Annotated[
    str | None,
    typer.Option(
        "--law",
        metavar="FORMULA|FILE",
        help='Crank angle [rad] over time t [s]: a formula as "2*pi*t", or a CSV file of times and angles.',
        show_default=False,
    ),
]
Duration = Annotated[
    str, typer.Option("--duration", metavar="TIME", help="With --law as a formula: how long it is followed.")
]
Steps = Annotated[int, typer.Option("--steps", metavar="N", help="Intervals of the turn or of the time.")]
Csv = Annotated[bool, typer.Option("--csv", help="CSV with all columns, in SI.")]
File = Annotated[Path, typer.Argument(metavar="FILE", help="The machine file.", show_default=False)]

# Steps beyond which a table is a mistake.
_STEPS_MAX = 1_000_000


def motion(
    file: File,
    set: Sets = None,
    at: At = None,
    speed: Speed = "1 rad/s",
    law: LawText = None,
    duration: Duration = "1 s",
    steps: Steps = 72,
    csv: Csv = False,
    json: Json = False,
    out: Out = None,
    force: Force = False,
) -> None:
    """Where everything is and how fast it moves.

    One pose with --at, under a law of time with --law, else a turn of the crank at constant speed.
    """
    from linkwright.files.read import read
    from linkwright.units import SPEED

    if not 1 <= steps <= _STEPS_MAX:
        raise InputError(f"--steps: found {steps}, expected a number from 1 to {_STEPS_MAX}")
    if at is not None and law is not None:
        raise InputError("--at and --law: one pose or a motion, not both")
    machine, omega = read(file, set or []), option_value("--speed", speed, SPEED)
    if at is not None:
        put(_pose(machine, at, omega, json=json, csv=csv), out, force=force)
    else:
        put(_motion(machine, law, omega, duration, steps, json=json, csv=csv), out, force=force)


def _pose(machine: Machine, at: str, omega: float, *, json: bool, csv: bool) -> str:
    """One pose as a table, CSV or JSON."""
    from json import dumps

    from linkwright.analysis.pose import pose
    from linkwright.analysis.result import finite
    from linkwright.units import ANGLE

    found = pose(machine, option_value("--at", at, ANGLE), speed=omega)
    if json:
        return dumps(finite(found.to_dict()), allow_nan=False, ensure_ascii=False) + "\n"
    rows = list(_pose_rows(found))
    if csv:
        lines = ["name,quantity,position,velocity,acceleration"]
        lines += [",".join((name, what, *map(repr, numbers))) for name, what, numbers in rows]
        return "\n".join(lines) + "\n"
    lines = [f"{'':24}{'position':>16}{'velocity':>16}{'acceleration':>16}"]
    lines += [
        f"{name + ' ' + what:<24}" + "".join(f"{value:>16.8g}" for value in numbers)
        for name, what, numbers in rows
    ]
    if found.near_limit:
        lines.append(f"near a limit: {', '.join(found.near_limit)}")
    return "\n".join(lines) + "\n"


def _pose_rows(found: Pose) -> list[tuple[str, str, tuple[float, ...]]]:
    """Name, quantity with its unit, and position, velocity, acceleration."""
    rows: list[tuple[str, str, tuple[float, ...]]] = []
    for name, point in found.points.items():
        for k, axis in enumerate("xy"):
            numbers = (point.position[k], point.velocity[k], point.acceleration[k])
            rows.append((name, f"{axis} [m]", numbers))
    for unit, part in (("angle [rad]", found.links), ("place [m]", found.slides)):
        for name, each in part.items():
            rows.append((name, unit, (each.position, each.velocity, each.acceleration)))
    for name, mu in found.transmission_angles.items():
        rows.append((name, "μ [rad]", (mu,)))
    return rows


def _motion(
    machine: Machine, law: str | None, omega: float, duration: str, steps: int, *, json: bool, csv: bool
) -> str:
    """A motion as a table of the outputs, CSV or JSON of everything."""
    from json import dumps

    import numpy as np

    from linkwright.analysis.law import constant_speed
    from linkwright.analysis.motion import motion as follow
    from linkwright.analysis.result import finite
    from linkwright.report.csv import curves_csv
    from linkwright.units import TIME

    end = option_value("--duration", duration, TIME)
    driver, start = (constant_speed(omega), 0.0) if law is None else _law(law)
    if law is None:
        if omega <= 0:
            raise InputError(f"--speed: found {omega:g} rad/s, expected a speed above zero for a turn")
        end = 2 * np.pi / omega
    elif hasattr(driver, "times"):
        start, end = driver.times[[0, -1]]
    if not end > start:
        raise InputError(f"--duration: found {end:g} s, expected more than {start:g} s")
    found = follow(machine, driver, np.linspace(start, end, steps + 1))
    if json:
        return dumps(finite(found.to_dict(curves=True) | _lists(found.curves())), allow_nan=False) + "\n"
    if csv:
        return curves_csv(found)
    return _table(found.curves())


def _lists(curves: dict[str, Any]) -> dict[str, list[float]]:
    return {name: curve.tolist() for name, curve in curves.items()}


def _table(curves: dict[str, Any]) -> str:
    """Positions alone, for people; everything is in the CSV."""
    shown = {name: curve for name, curve in curves.items() if name == "time" or _is_position(name, curve)}
    width = max(14, *(len(name) + 2 for name in shown))
    lines = ["".join(f"{name:>{width}}" for name in shown)]
    lines += ["".join(f"{x:>{width}.7g}" for x in row) for row in zip(*shown.values(), strict=True)]
    return "\n".join(lines) + "\n"


def _is_position(name: str, curve: Any) -> bool:
    """Whether a column is a position of something that moves."""
    return name == "crank_angle" or (
        name.endswith((".x", ".y", ".angle", ".place")) and float(curve.max() - curve.min()) > 0
    )


def _law(text: str) -> tuple[Law, float]:
    """A formula, or the table in a file; and its start."""
    path = Path(text)
    if path.suffix.lower() == ".csv":
        from linkwright.analysis.law import TableLaw
        from linkwright.files.law_table import read_law_table

        return TableLaw(*read_law_table(path)), 0.0
    from linkwright.analysis.law_formula import FormulaLaw

    return FormulaLaw(text), 0.0
