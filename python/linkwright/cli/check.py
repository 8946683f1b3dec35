"""``linkwright check FILE``: is the machine file sound?"""

from __future__ import annotations

from typing import TYPE_CHECKING

import typer

from linkwright.cli.common import File, Sets

if TYPE_CHECKING:
    from linkwright.machine import Machine


def check(file: File, set: Sets = None) -> None:
    """Check a machine file.

    Says what is in it, or all that is wrong with it.
    """
    from linkwright.files.read import read

    machine = read(file, set or ())
    typer.echo(f"OK  {file}\n\n{summary(machine)}")


def summary(machine: Machine) -> str:
    """What a machine consists of, a line for each part.

    Parameters
    ----------
    machine : Machine
        The machine.

    Returns
    -------
    str
        Text of a few lines.
    """
    from linkwright.machine.mobility import mobility

    rows = [("machine", machine.name), ("motor", _motor(machine)), *_mechanism(machine)]
    if not machine.is_train_alone:
        rows += [("mobility", str(mobility(machine.linkage)))]
    rows += _train(machine)
    rows += [("bodies", ", ".join(machine.bodies)), ("loads", _loads(machine))]
    return "\n".join(f"  {word:<14} {text}" for word, text in rows if text)


def _motor(machine: Machine) -> str:
    """Kind of the motor, with its rated power and the ratio of the gearbox."""
    if machine.drive is None or machine.drive.motor is None:
        return "none"
    motor, ratio = machine.drive.motor, machine.drive.gearbox.ratio
    power = f", {motor.power_rated / 1e3:.4g} kW" if motor.power_rated else ""
    return f"{motor.kind.replace('_', ' ')}{power}, ratio {ratio:.6g}"


def _mechanism(machine: Machine) -> list[tuple[str, str]]:
    """The names of the elements, kind by kind."""
    from linkwright.machine.outline import TABLES

    # A cam is told as such, not as the driver that it is in the whole mechanism.
    cams = machine.mechanism.cams
    known = {
        table: [name for name in getattr(machine.linkage, table) if name not in cams] for table in TABLES
    }
    known["cams"] = list(cams)
    return [(table.replace("_", " "), ", ".join(names)) for table, names in known.items()]


def _train(machine: Machine) -> list[tuple[str, str]]:
    """The names of discs, shafts and gear stages."""
    train = machine.train
    if train is None:
        return []
    return [
        ("discs", ", ".join(train.discs)),
        ("shafts", ", ".join(train.shafts)),
        ("gears", ", ".join(train.gears)),
    ]


def _loads(machine: Machine) -> str:
    """The names of the loads with their kinds."""
    return ", ".join(f"{name} ({load.kind.replace('_', ' ')})" for name, load in machine.loads.items())
