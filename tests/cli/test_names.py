"""Names of any letters go through every command: tables, figures, drawings, CSV, JSON, pages."""

from __future__ import annotations

import csv
import json
import re
from io import StringIO
from pathlib import Path

import pytest
from command_line import invoke
from sizes import DEEP

from linkwright import MachineFileError, forces, loads
from linkwright.kernel.page.table import csv_text
from linkwright.kinetostatics.figures import hodograph_figure

# What each would do where it is taken for more than a name.
NASTY = [
    "[/x]",
    "[red]a[/red]",
    "[link=file:///etc/passwd]",
    ":smile:",
    "$x^{$ \\frac{",
    r"a\b\1\g<1>\d",
    "a,b;c",
    'say "hi"',
    "it's",
    "=1+1",
    "+a",
    "-a",
    "@SUM(A1)",
    "<script>alert(1)</script>",
    "</script><!--",
    "{{ 7*7 }} %s %(x)s {0}",
    "../../etc/passwd",
    "/etc/passwd",
    "CON",
    "_hidden",
    "#hash",
    "🚲 Ω ж 漢字",
    "a b",
    "a_b",
    "x" * 100,
    "nan",
    "--force",
]
REFUSED = ["\u202eabc", "a\nb", "a\x1b[2Jb", "a\x00b", "", " ", "a.b", "x" * 101, "\"'", "\u200d"]


def quoted(name: str) -> str:
    return json.dumps(name, ensure_ascii=False)


def slider_crank(some: list[str]) -> str:
    title, crank, slider, load, dry, point = map(quoted, some)
    return f"""format = 1
name = {title}
source = {title}
[drive]
speed = "60 rpm"
[drive.motor]
kind = "induction"
catalogue = "4A132S6U3"
inertia = 0.05
[drive.gearbox]
ratio = 16
[mechanism.cranks.{crank}]
radius = 0.2
[mechanism.sliders.{slider}]
crank = {crank}
rod = 0.8
[mechanism.rigid_points.{point}]
link = {crank}
along = 0.1
[bodies.{slider}]
mass = 300
[bodies.{crank}]
mass = 3
along = 0.0
inertia = 0
[loads.{load}]
kind = "dry"
on = {slider}
force = 500
[loads.{dry}]
kind = "viscous"
on = {slider}
damping = 10
"""


def train(some: list[str]) -> str:
    title, first, second, shaft, source, *_ = map(quoted, some)
    return f"""format = 1
name = {title}
[train.discs.{first}]
inertia = 1
[train.discs.{second}]
inertia = 2
[train.shafts.{shaft}]
between = [{first}, {second}]
stiffness = 1e5
damping = 10
[train.excitations.{source}]
on = {first}
harmonics = [{{ order = 2, torque = 10 }}]
[train.run]
speed_min = 60
speed_max = 200
points = 5
"""


def cams(some: list[str]) -> str:
    text = f"format = 1\nname = {quoted(some[0])}\n[drive]\nspeed = '60 rpm'\n"
    for name in some[1:3]:
        key = quoted(name)
        text += f"""[mechanism.cams.{key}]
follower = "translating"
contact = "roller"
roller_radius = "10 mm"
base_radius = "60 mm"
sections = [
  {{ angle = "180 deg", lift = "20 mm", law = {{ kind = "cycloidal" }} }},
  {{ angle = "180 deg", lift = "-20 mm", law = {{ kind = "cycloidal" }} }},
]
"""
    return text


def topper(some: list[str]) -> str:
    return f"""format = 1
name = {quoted(some[0])}
[topper]
root_diameter = "110 mm"
cut_height = "30 mm"
offset = "20 mm"
edge_length = "0.2 m"
edge_angle = "20 deg"
forward_speed = "1.9 m/s"
knife_speed = "0.5 m/s"
[topper.motion]
kind = "harmonic"
stroke = "60 mm"
[topper.field]
kind = "random"
roots = 200
rows = 10
"""


KINDS = {
    "slider": (slider_crank, [("run",), ("size",), ("forces",), ("motion",)]),
    "train": (train, [("torsion",)]),
    "cam": (cams, [("cam",), ("run",), ("motion", "--csv")]),
    "topper": (topper, [("run",), ("topper", "field")]),
}


def run(*words: str) -> tuple[int, str]:
    """Exit code and output of a command; anything it did not raise on purpose is raised here."""
    result = invoke(*words)
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    return result.exit_code, result.output


def some_names(count: int, start: int) -> list[str]:
    """Names of one machine, no two the same but for the machine's own."""
    turned = [*NASTY[start:], *NASTY[:start]]
    return turned[:count]


def require_sound(folder: Path, some: list[str]) -> None:
    """Files that a run wrote: in their folder, readable, with nothing of a name at work."""
    for path in folder.rglob("*"):
        assert path.resolve().parent == folder.resolve()
        if path.suffix == ".csv":
            head, *rows = list(csv.reader(StringIO(path.read_text(encoding="utf-8"))))
            assert {len(row) for row in rows} == {len(head)}
            assert not [cell for cell in head if cell.startswith(("=", "+", "-", "@"))]
        if path.suffix == ".html":
            page = path.read_text(encoding="utf-8")
            assert "<script>alert" not in page
            assert "49 %s" not in page
        if path.suffix == ".json":
            json.loads(path.read_text(encoding="utf-8"))


@pytest.mark.filterwarnings("error")
@pytest.mark.deep
@pytest.mark.parametrize(
    ("kind", "start"),
    # In `make test` every name goes through two kinds or three, and every kind takes two thirds of the names.
    [(kind, 9 * k) for n, kind in enumerate(KINDS) for k in range(3) if DEEP or (n + k) % 3],
)
def test_names_go_through_every_command(tmp_path: Path, kind: str, start: int) -> None:
    made, commands = KINDS[kind]
    some = some_names(6, start)
    file = tmp_path / "machine.toml"
    file.write_text(made(some), encoding="utf-8")
    for command in commands:
        out = tmp_path / "-".join(command)
        write = () if command[0] in ("size", "motion") else ("--out", str(out))
        code, output = run(*command, str(file), *write)
        assert code in (0, 1), output
        assert "Traceback" not in output
        if write:
            require_sound(out, some)
        if command[0] in ("size", "run") and kind != "cam":
            assert some[0] in re.sub(r"\s*\n\s*", " ", output)
    if kind == "slider":
        shown = invoke("motion", file, "--at", "30 deg", "--csv").stdout
        rows = list(csv.reader(StringIO(shown)))
        assert {len(row) for row in rows} == {5}
        # The crank pin and the slider are reported under their own names.
        assert {name.removeprefix("'") for name, *_ in rows} >= {some[1], some[2]}


def test_two_cams_whose_files_would_have_one_name(tmp_path: Path) -> None:
    file = tmp_path / "machine.toml"
    file.write_text(cams(["two", "a b", "a/b"]), encoding="utf-8")
    code, output = run("cam", str(file), "--out", str(tmp_path / "o"), "--formats", "csv")
    assert code == 0, output
    assert {"a_b.csv", "a_b_2.csv"} <= {path.name for path in (tmp_path / "o").iterdir()}


@pytest.mark.parametrize("name", REFUSED, ids=range(len(REFUSED)))
@pytest.mark.parametrize("place", [1, 2, 3, 5])
def test_names_that_steer_a_terminal_are_refused(name: str, place: int) -> None:
    some = ["title", "A", "S", "l", "d", "p"]
    some[place] = "NAME"
    escaped = json.dumps(name)[1:-1].replace("\\u0000", "\\u0000")
    with pytest.raises(MachineFileError) as caught:
        loads(slider_crank(some).replace('"NAME"', f'"{escaped}"'), path="x.toml")
    assert all(line.isprintable() for line in str(caught.value).splitlines())


@pytest.mark.parametrize("name", ["a\x1b[2Jb", "a\nb", "\u202eabc", "x" * 301])
def test_a_machine_is_named_in_one_line(name: str) -> None:
    with pytest.raises(MachineFileError, match=r"x.toml:2: name"):
        loads(f"format = 1\nname = {json.dumps(name)}\n[mechanism.cranks.A]\nradius = 1\n", path="x.toml")


def test_csv_cells() -> None:
    text = csv_text(
        ["a,b", "=x", 'say "hi"', "−1"], [(-1.5, float("nan"), "-x", "@y"), (1e-300, 2, "+", "ok")]
    )
    rows = list(csv.reader(StringIO(text)))
    assert rows[0] == ["a,b", "'=x", 'say "hi"', "−1"]
    assert rows[1:] == [["-1.5", "", "'-x", "'@y"], ["1e-300", "2", "'+", "ok"]]


@pytest.mark.parametrize("command", [("run",), ("forces",), ("size",), ("new", "slider-crank"), ("schema",)])
@pytest.mark.parametrize("words", ["", " "])
def test_an_empty_out_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: tuple[str, ...], words: str
) -> None:
    monkeypatch.chdir(tmp_path)
    file = [] if command[0] in ("new", "schema") else ["machine.toml"]
    code, output = run(*command, *file, "--out", words)
    assert code == 2
    assert "--out" in output
    assert "expected a path" in output
    assert list(tmp_path.iterdir()) == []


def test_every_reaction_of_a_hodograph_is_in_the_legend() -> None:
    """Matplotlib leaves out of a legend what begins with an underscore."""
    machine = loads(slider_crank(["_a", "_b", "_c", "_d", "_e", "_f"]))
    axes = hodograph_figure(forces(machine, speed=1.0)).axes[0]
    labels = axes.get_legend_handles_labels()[1]
    assert " _b" in labels
    assert len(labels) == sum(line.get_linestyle() != "None" for line in axes.lines)
