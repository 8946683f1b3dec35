"""Every command that has ``--json`` answers in one form: what can be done, what cannot, and wrong input.

The commands are those of the application: one that is added and is not told here fails.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import click
import numpy as np
import pytest
from click.testing import Result
from command_line import invoke
from tests.samples.tasks import FUNCTION, POSES
from tests.samples.topper_fields import FIELD, TOPPER

import linkwright as lw
from linkwright import InputError, InternalError
from linkwright.app.application import COMMANDS, GROUPS, application
from linkwright.kernel.command.answer import Answer, hand_over, json_text
from linkwright.kernel.command.group import Commands
from linkwright.studies.sweep import begun

ROOT = Path(__file__).parents[2]
FILES = {path.stem: str(path) for path in (ROOT / "machines").glob("*.toml")} | {
    "undercut": str(ROOT / "examples" / "cam_roller_undercut" / "machine.toml"),
    "drawn_rod": str(ROOT / "examples" / "drawn_connecting_rod" / "rod.dxf"),
    "coupling": str(ROOT / "examples" / "elastic_coupling_of_carts" / "machine.toml"),
    "engine": str(ROOT / "examples" / "weak_cylinder" / "machine.toml"),
}

# What tasks of a synthesis and measurements hold.
TEXTS = {
    "symmetric.toml": """
format = 1
name = "Three discs"
[train.discs]
left = { inertia = 1 }
M = { inertia = 1 }
right = { inertia = 1 }
[train.shafts]
one = { between = ["left", "M"], stiffness = 1e4 }
two = { between = ["M", "right"], stiffness = 1e4 }
""",
    "servo.toml": """
format = 1
name = "Servo"
[master]
cycle_time = "1 s"
[axes.A]
sections = [
  { angle = "180 deg", swing = "180 deg", law = "cycloidal" },
  { angle = "180 deg", swing = "-180 deg", law = "cycloidal" },
]
gearbox = { ratio = 10 }
[axes.A.motor]
inertia = "0.9 kg cm^2"
continuous = { speed = "0, 3000 rpm", torque = "2.4, 2.4 N m" }
peak = { speed = "0, 3000 rpm", torque = "7, 7 N m" }
[mechanism.cranks.A]
radius = "120 mm"
[bodies]
A = { inertia = "0.07 kg m^2" }
""",
    "field.toml": TOPPER + FIELD,
    "poses.toml": POSES,
    "function.toml": FUNCTION,
    "phases.toml": """
machine = "roller_two_carts"
[variables.phase]
address = "mechanism.cranks.A2.phase"
range = ["80 deg", "100 deg"]
steps = 3
[variables.rod]
address = "mechanism.sliders.cart1.rod"
values = ["0.8 m"]
[responses]
delta = "steady_state.unevenness"
""",
    "best.toml": """
machine = "roller_two_carts"
[variables.phase]
address = "mechanism.cranks.A1.phase"
range = ["10 deg", "80 deg"]
[responses]
x = { curve = "motion.A1.x", at = "0 deg" }
[constraints]
x = { min = 0.1 }
[goals]
x = "minimise"
""",
    "scatter.toml": """
machine = "roller_two_carts"
[variables.phase]
address = "mechanism.cranks.A1.phase"
tolerance = "± 1 deg"
[responses]
x = { curve = "motion.A1.x", at = "0 deg" }
[constraints]
x = { max = 0.3 }
""",
    "wheel.toml": """
format = 1
name = "Wheel"
[drive.flywheel]
inertia = "2 kg m^2"
on = "crank"
[mechanism.cranks.A]
radius = "80 mm"
[loads.oil]
kind = "viscous"
on = "A"
damping_torsional = "0.5 N m s/rad"
""",
    "servos.csv": """
type, inertia [kg cm^2], torque_rated [N m], speed_rated [rpm], torque_max [N m], speed_max [rpm]
SV 750, 0.9, 2.39, 3000, 7.1, 6000
""",
    "gearboxes.csv": """
type, ratio, efficiency [%]
P20, 20, 93
""",
    "coast.csv": """
time [s], speed [rpm]
0, 100.2
1, 77.7
2, 60.8
3, 47.1
4, 36.9
5, 28.6
""",
    "path.toml": """
x = "60, 40, 0, -30, 0, 40 mm"
y = "0, 30, 40, 10, -20, -20 mm"
generations = 30
""",
}


class Case(NamedTuple):
    """Words after a command: that it can do, that its machine cannot do, that make no sense."""

    right: str
    finding: str
    wrong: str


_SHORT_ROD = " --set mechanism.sliders.cart1.rod=0.1"
_NO_KEY = " --set drive.motor.nothing=1"
_UNSUITED = " --set points=1"

# Papers, terms and motion laws have no machine that could fail.
NEVER = ""
CASES = {
    "run": Case("{roller_two_carts}", "{roller_two_carts}" + _SHORT_ROD, "{roller_two_carts}" + _NO_KEY),
    "motion": Case("{roller_two_carts}", "{roller_two_carts}" + _SHORT_ROD, "{roller_two_carts} --at 30"),
    "transient": Case(
        "{roller_two_carts} --revolutions 1",
        "{roller_two_carts} --set loads.rolling1.force=1e5",
        "{roller_two_carts} --from-angle 30",
    ),
    "elastic": Case(
        "{coupling} --over drive.crankshaft.stiffness --from 20000 --to 22000",
        "{coupling} --set loads.rolling1.force=1e5",
        "{coupling} --over drive.crankshaft.stiffness",
    ),
    "plot": Case(
        "{roller_two_carts} cart1.velocity",
        "{roller_two_carts}" + _SHORT_ROD,
        "{roller_two_carts} cart9.velocity",
    ),
    "forces": Case(
        "{roller_two_carts}", "{roller_two_carts}" + _SHORT_ROD, "{roller_two_carts} --angles 1deg"
    ),
    "loads": Case(
        "{roller_two_carts} --link A1", "{roller_two_carts}" + _SHORT_ROD, "{roller_two_carts} --link nobody"
    ),
    "outline": Case("{drawn_rod}", NEVER, "{drawn_rod} --start 3"),
    "balance": Case(
        "{roller_two_carts} --links A1",
        "{roller_two_carts} --links A1" + _SHORT_ROD,
        "{roller_two_carts} --links nobody",
    ),
    "sensitivity": Case(
        "{roller_two_carts}",
        "{roller_two_carts}" + _SHORT_ROD,
        "{roller_two_carts} --by mechanism.cranks.A2.phas",
    ),
    "size": Case(
        "{roller_two_carts}",
        "{roller_two_carts} --set loads.rolling1.force=1e5",
        "{roller_two_carts} --unevenness 3",
    ),
    "axes": Case(
        "{servo.toml} --catalogue {servos.csv} --gearboxes {gearboxes.csv}",
        "{servo.toml} --set bodies.A.inertia=70 --catalogue {servos.csv}",
        "{servo.toml} --goal rms",
    ),
    "motors": Case("--poles 6", NEVER, "--poles 7"),
    "check": Case("{roller_two_carts}", "{roller_two_carts}" + _SHORT_ROD, "{roller_two_carts}" + _NO_KEY),
    "papers": Case("4", NEVER, "9"),
    "glossary": Case("unevenness", NEVER, "xyzzy"),
    "synthesise dead-centre": Case(
        "--swing 60deg", "--swing 60deg --time-ratio 9", "--swing 60deg --stroke 1m"
    ),
    "synthesise motion": Case(
        "--task {poses.toml}",
        "--task {poses.toml} --set rocker_point.x=-20mm --set rocker_point.y=-50mm",
        "--task {poses.toml}" + _UNSUITED,
    ),
    "synthesise function": Case(
        "--task {function.toml}", "--task {function.toml} --set function=sin(40*x)", "--task {poses.toml}"
    ),
    "synthesise path": Case(
        "--task {path.toml}",
        "--task {path.toml} --set transmission_angle_min=1.5",
        "--task {path.toml}" + _UNSUITED,
    ),
    "synthesise line": Case(
        "--kind hoeken", "--kind hoeken --proportion arm=0.1", "--kind hoeken --proportion arm"
    ),
    "fmu": Case(
        "{roller_two_carts}",
        "{roller_two_carts} --set mechanism.sliders.cart1.rod=0.1 --from-angle=90deg",
        "{roller_two_carts} --accuracy 1",
    ),
    "export": Case(
        "{roller_two_carts} --to urdf",
        "{roller_two_carts} --to urdf" + _SHORT_ROD,
        "{roller_two_carts} --to mjcf --leave-out nobody",
    ),
    "law": Case("{roller_cam}", "{roller_cam} --to siemens --points 3", "{roller_two_carts}"),
    "cam": Case("{roller_cam}", "{undercut}", "{roller_two_carts}"),
    "cam laws": Case("--law cycloidal", NEVER, "--law nothing"),
    "cam search": Case(
        "{roller_cam} --vary base_radius=0.3:0.4:3",
        "{roller_cam} --vary base_radius=0.21695:0.21696:11",
        "{roller_cam} --vary base_radius",
    ),
    "torsion": Case(
        "{symmetric.toml}", "{v8_diesel} --set train.engine.limit.stress_permitted=1MPa", "{roller_cam}"
    ),
    "torsion damper": Case(
        "{symmetric.toml} --on left --ring-inertia 0.1",
        "{symmetric.toml} --on M --ring-inertia 0.1",
        "{symmetric.toml} --on nobody --ring-inertia 0.1",
    ),
    "torsion diagnose": Case(
        "{engine} {even.csv} --on flywheel",
        "{engine} {even.csv} --on flywheel --set train.engine.gas.walls.kind=hohenberg "
        "--set train.engine.gas.walls.factor=1e6 --set train.engine.gas.walls.wall_temperature=400",
        "{engine} {even.csv} --on nobody",
    ),
    "sweep": Case(
        "{phases.toml} --out {rows}",
        "{phases.toml} --out {rows_of_none} --set study.variables.rod.values=[0.15]",
        "{phases.toml} --out {rows} --set study.responses.delta=steady_state.nothing",
    ),
    "optimise": Case(
        "{best.toml} --evaluations 20",
        "{best.toml} --evaluations 20 --set study.constraints.x.min=0.5",
        "{phases.toml}",
    ),
    "tolerance": Case(
        "{scatter.toml} --rows 20",
        "{scatter.toml} --rows 20 --set study.constraints.x.max=0.1",
        "{phases.toml} --rows 20",
    ),
    "fit": Case(
        "{wheel.toml} --vary loads.oil.damping_torsional --record {coast.csv} --motion coast",
        "{wheel.toml} --vary loads.oil.damping_torsional --vary drive.flywheel.inertia "
        "--record {coast.csv} --motion coast",
        "{wheel.toml} --vary loads.oil.nothing --record {coast.csv}",
    ),
    "sweep show": Case("{swept}", "{unswept}", "{phases.toml}"),
    "rods": Case(
        "{rod_string}",
        "{rod_string} --set rod_string.service_factor=0.5",
        "{rod_string} --set rod_string.nothing=1",
    ),
    "topper": Case("{topper}", "{topper} --set topper.edge_angle=89.9deg", "{topper} --set topper.nothing=1"),
    "topper field": Case(
        "{field.toml} --set topper.limits.complete_min=0.5",
        "{field.toml} --set topper.limits.complete_min=0.99",
        "{field.toml} --over nothing=1:2:3",
    ),
    "topper best": Case(
        "{field.toml} --set topper.limits.complete_min=0.5",
        "{field.toml} --set topper.limits.knife_speed_max=0 --set topper.limits.slicing_min=3",
        "{field.toml} --objective nothing",
    ),
}

# Commands that print a text of their own, and no answer about a machine for programs.
WITHOUT = {"draw", "mcp", "new", "report", "schema", "studio"}
# Keys besides those that all have.
EXTRA = {"cam": {"files"}, "torsion": {"balance"}}


def commands() -> dict[str, Any]:
    """Words of a command → what it is; a group's own words stand for what it does with a file."""
    top = application()
    assert set(top.entries) == {*COMMANDS, *GROUPS}
    found: dict[str, Any] = {}
    for name in top.entries:
        command = top.get_command(None, name)
        if isinstance(command, Commands):
            found |= {name: command.for_a_file} if command.for_a_file else {}
            found |= {f"{name} {part}": command.get_command(None, part) for part in command.entries}
        else:
            found[name] = command
    return found


def has_json(command: Any) -> bool:
    return any(param.name == "json" for param in command.params)


@pytest.fixture(scope="module")
def known(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Files by the names that the words have in braces."""
    folder = tmp_path_factory.mktemp("asked")
    for name, text in TEXTS.items():
        (folder / name).write_text(text, encoding="utf-8")
    # Two revolutions, in which eight cylinders fire at one strength.
    rows = [f"{n}, {1500 * (1 + 0.01 * np.cos(n * np.pi / 90)):.6f}" for n in range(721)]
    (folder / "even.csv").write_text("\n".join(["angle [deg], speed [rpm]", *rows]) + "\n")
    files = FILES | {path.name: str(path) for path in folder.iterdir()}
    files |= {name: str(folder / name) for name in ("rows", "rows_of_none", "swept", "unswept")}
    study = lw.read_study(folder / "phases.toml")
    lw.sweep(study, folder / "swept")
    begun(study, folder / "unswept")
    return files


def call(command: str, words: str, known: dict[str, str]) -> list[str]:
    filled = (known.get(word[1:-1], word) if word[0] == "{" else word for word in words.split())
    return [*command.split(), *filled]


@pytest.fixture(scope="module")
def ask(known: dict[str, str]) -> Callable[[str, str], Result]:

    def asked(command: str, words: str) -> Result:
        return invoke(*call(command, words, known), "--json")

    return asked


def answer_of(name: str, done: Result) -> dict[str, Any]:
    assert done.exception is None or isinstance(done.exception, SystemExit), done.exception
    assert done.stdout.count("\n") == 1, done.stdout[:200] + done.stderr
    found: dict[str, Any] = json.loads(done.stdout, parse_constant=pytest.fail)
    common = {"machine", "results", "findings", "warnings"}
    assert common <= set(found) <= common | EXTRA.get(name, set())
    has_file = any(param.name == "file" for param in commands()[name].params)
    assert found["machine"] if has_file else found["machine"] != ""
    assert isinstance(found["results"], dict)
    for sentences in (found["findings"], found["warnings"]):
        assert isinstance(sentences, list)
        assert all(isinstance(each, str) and each.strip() for each in sentences)
    assert found["warnings"][: len(found["findings"])] == found["findings"]
    return found


def test_every_command_is_told_here() -> None:
    found = commands()
    assert {name for name, command in found.items() if has_json(command)} == set(CASES)
    assert {name for name, command in found.items() if not has_json(command)} == WITHOUT


@pytest.mark.parametrize("name", CASES)
def test_what_can_be_done(name: str, ask: Callable[[str, str], Result]) -> None:
    done = ask(name, CASES[name].right)
    assert done.exit_code == 0, done.output
    found = answer_of(name, done)
    assert found["results"]
    assert not found["findings"]


@pytest.mark.parametrize("name", [name for name, case in CASES.items() if case.finding != NEVER])
def test_what_a_machine_cannot_do(name: str, ask: Callable[[str, str], Result]) -> None:
    done = ask(name, CASES[name].finding)
    assert done.exit_code == 1, done.output
    assert answer_of(name, done)["findings"]


@pytest.mark.parametrize("name", CASES)
def test_wrong_input(name: str, ask: Callable[[str, str], Result]) -> None:
    done = ask(name, CASES[name].wrong)
    assert done.exit_code == 2, done.output
    assert done.stdout == ""
    assert len(done.stderr) > 10


@pytest.mark.parametrize("name", ["papers", "synthesise line"])
def test_lists_are_answers_too(name: str, ask: Callable[[str, str], Result]) -> None:
    found = answer_of(name, ask(name, "--list" if name == "synthesise line" else ""))
    assert found["machine"] is None
    assert found["results"]


def _unwanted() -> Any:
    pytest.fail("JSON needs none of it")


def test_json_makes_nothing_for_people(capsys: pytest.CaptureFixture[str]) -> None:
    answer = Answer(
        machine="M",
        results=lambda curves: {"it": {"x": (1.0, float("nan")), "has_curves": curves}},
        warnings=["take care"],
        extra={"files": []},
        head=_unwanted,
        tables=_unwanted,
        tail=_unwanted,
        files=_unwanted,
        figures=_unwanted,
    )
    hand_over(answer, json=True, curves=True)
    assert json.loads(capsys.readouterr().out) == {
        "machine": "M",
        "results": {"it": {"x": [1.0, None], "has_curves": True}},
        "findings": [],
        "warnings": ["take care"],
        "files": [],
    }


def test_an_answer_on_standard_output_is_whole(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Nothing is printed as JSON before its files are written."""
    taken = tmp_path / "machine.toml"
    taken.write_text("another's")
    answer = Answer(machine="M", findings=["It cannot."], machine_file=lambda: "format = 1\n")
    with pytest.raises(InputError):
        hand_over(answer, json=True, out=taken)
    assert capsys.readouterr().out == ""
    with pytest.raises(click.exceptions.Exit) as ended:
        hand_over(answer, json=True, out=taken, force=True)
    assert ended.value.exit_code == 1
    assert capsys.readouterr().out == json_text(answer)
    assert taken.read_text() == "format = 1\n"


@pytest.mark.parametrize("name", ["sensitivity", "transient", "balance", "synthesise dead-centre"])
def test_what_is_wanted_as_a_file_is_written(
    name: str, ask: Callable[[str, str], Result], tmp_path: Path
) -> None:
    """Those with a folder and those with a machine file; without --json, files are written as well."""
    more = " --of steady_state.unevenness --by drive.gearbox.ratio" if name == "sensitivity" else ""
    done = ask(name, f"{CASES[name].right}{more} --out {tmp_path / 'out.toml'}")
    assert done.exit_code == 0, done.output
    written = tmp_path / "out.toml"
    assert written.is_file() or (written / "results.json").is_file()


def test_an_answer_without_a_file_that_is_wanted_is_a_fault_of_ours(tmp_path: Path) -> None:
    with pytest.raises(InternalError, match="no machine to write"):
        hand_over(Answer(machine="x"), out=tmp_path / "x.toml")
