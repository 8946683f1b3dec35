"""``linkwright check FILE``: is the machine file sound, and the geometry that it describes?"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from linkwright.kernel.command.answer import Answer, hand_over, is_reported
from linkwright.kernel.command.common import File, Json, Outside, Sets
from linkwright.kernel.errors import AssemblyError
from linkwright.kernel.page.numbers import quantity
from linkwright.kernel.page.table import Row, Table

if TYPE_CHECKING:
    from linkwright.linkages.model.mechanism import Mechanism
    from linkwright.machine.machine import Machine
    from linkwright.topping.model.topper import Topper

# Kind of torque in a turning-moment diagram → words.
_TORQUES = {"constant": "constant torque", "formula": "formula", "table": "torque table"}


def check(file: File, set: Sets = None, allow_outside: Outside = False, json: Json = False) -> None:
    """Check a machine file.

    Says what is in it, or all that is wrong with it; and what its geometry does not allow, as far as that can
    be seen at once. Exit code 1 if the machine cannot do something, 2 if the file is wrong.
    """
    from linkwright.app.soundness import soundness
    from linkwright.machine.read import read

    machine = read(file, set or (), allow_outside=allow_outside)
    judged = soundness(machine)
    count = len(judged.findings)
    verdict = f"{count} FINDING{'S' if count > 1 else ''}" if count else "OK"
    answer = Answer(
        machine=machine.name,
        units=machine.units,
        results=lambda curves: {"checked": list(judged.looked_at)},
        findings=judged.findings,
        warnings=judged.warnings,
        head=lambda: f"{verdict}  {file}\n\n{summary(machine)}",
        tables=lambda: [_checks(judged.looked_at)],
    )
    if is_reported():
        # A report has the name of the machine as its title, and tables in place of columns of a terminal.
        verdict = f"{count} finding{'s' if count > 1 else ''}" if count else "no finding"
        tables = [_parts(machine), _checks(judged.looked_at)]
        answer = replace(answer, head=lambda: f"Check of {file}: {verdict}", tables=lambda: tables)
    hand_over(answer, json=json)


def summary(machine: Machine) -> str:
    """What a machine consists of, a line for each part."""
    rows = [("machine", machine.name), *_rows(machine)]
    return "\n".join(f"  {word:<14} {text}" for word, text in rows)


def _parts(machine: Machine) -> Table:
    """The same as a table."""
    rows: list[Row] = [(word, "", text) for word, text in _rows(machine)]
    return Table("parts", "Parts of the machine", ("part", "", "what"), rows, is_whole=True)


def _rows(machine: Machine) -> list[tuple[str, str]]:
    """Words and texts of the parts that a machine has."""
    from linkwright.linkages.model.mobility import mobility

    rows = [*_diagram(machine), *_topper(machine)]
    if machine.has_crank or machine.is_train_alone:
        rows += [("motor", _motor(machine)), *_mechanism(machine)]
    if machine.has_crank:
        rows += [("mobility", str(mobility(_whole(machine))))]
    rows += _train(machine)
    rows += [("bodies", ", ".join(machine.bodies)), ("loads", _loads(machine))]
    return [(word, text) for word, text in rows if text]


def _checks(looked_at: Sequence[str]) -> Table:
    """What was looked at of each part."""
    rows: list[Row] = []
    for text in looked_at:
        part, _, words = text.partition(": ")
        rows.append((part, "", words))
    return Table("checked", "Checked", ("part", "", "what"), rows, is_whole=True)


def _diagram(machine: Machine) -> list[tuple[str, str]]:
    """What drives a shaft, and what resists."""
    described = machine.turning_moment
    if described is None:
        return []
    if described.areas:
        words = f"{len(described.areas)} areas between driver and load"
    else:
        torques = {"driver": described.driver, "load": described.load}
        kinds = {name: "constant" if torque is None else torque.kind for name, torque in torques.items()}
        words = ", ".join(f"{name} {_TORQUES[kind]}" for name, kind in kinds.items())
    turns = "one revolution" if described.turns == 1 else f"{described.turns:.5g} revolutions"
    return [("turning moment", f"{words}; cycle of {turns}, {quantity(described.speed, 'rad/s')}")]


def _topper(machine: Machine) -> list[tuple[str, str]]:
    """The head that is cut, the edge, and how the knife moves."""
    from math import degrees

    from linkwright.topping.roots import head_diameter

    cut = machine.topper
    if cut is None:
        return []
    d = float(head_diameter(cut.root_diameter, cut.cut_height))
    beside = f", up to {_mm(cut.offset)} beside the row" if cut.offset else ", on the row"
    head = f"{_mm(d)} across: root {_mm(cut.root_diameter)}, cut {_mm(cut.cut_height)} below its top{beside}"
    edge = (
        f"{_mm(cut.edge_length)} at {degrees(cut.edge_angle):.4g}°, "
        f"{quantity(cut.forward_speed, 'm/s')} along the row"
    )
    return [("head", head), ("edge", edge), ("knife", _knife(cut)), ("field", _field(cut))]


def _knife(cut: Topper) -> str:
    """How it moves across the row."""
    motion = cut.motion
    if motion.kind == "member":
        return f"moved by {motion.of}"
    if not cut.knife_speed:
        return "at rest"
    stroke = f", stroke {_mm(motion.stroke)}" if motion.stroke else ", one direction over a head"
    word = "harmonic" if motion.kind == "harmonic" else "constant speed"
    return f"{word}{stroke}, {quantity(cut.knife_speed, 'm/s')} across the row in the mean"


def _field(cut: Topper) -> str:
    """How many roots are looked at."""
    if cut.field is None:
        return ""
    if cut.field.kind == "random":
        return f"{cut.field.roots} random roots in {cut.field.rows} rows"
    return f"{len(cut.field.root_diameter)} measured roots, each in {cut.field.phases} phases"


def _mm(value: float) -> str:
    return quantity(value, "m", usual="mm")


def _motor(machine: Machine) -> str:
    """Kind of the motor, with its rated power and the ratio of the gearbox."""
    if machine.drive is None or machine.drive.motor is None:
        return "none"
    motor, ratio = machine.drive.motor, machine.drive.gearbox.ratio
    power = f", {quantity(motor.power_rated, 'W', usual='kW')}" if motor.power_rated else ""
    return f"{motor.kind.replace('_', ' ')}{power}, ratio {ratio:.6g}"


def _mechanism(machine: Machine) -> list[tuple[str, str]]:
    """The names of the elements, kind by kind."""
    from linkwright.linkages.model.topology import TABLES

    # A cam is listed as such, not as the driver that it is in the complete mechanism.
    cams = machine.mechanism.cams
    known = {
        table: [name for name in getattr(_whole(machine), table) if name not in cams] for table in TABLES
    }
    known["cams"] = list(cams)
    return [(table.replace("_", " "), ", ".join(names)) for table, names in known.items()]


def _whole(machine: Machine) -> Mechanism:
    """The whole mechanism; without a rotator that has no lengths, which is a finding."""
    try:
        return machine.linkage
    except AssemblyError:
        return machine.with_entries({"rod_rotator": None}).linkage


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
