"""Mechanisms by their drawing: from the places of its points, a machine is the one that was drawn."""

from __future__ import annotations

import copy
import tomllib
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np
import pytest
from zoo import ZOO

import linkwright as lw
from linkwright import LinkwrightError

# What a drawing tells, by table.
TOLD = {
    "cranks": ("radius", "phase"),
    "sliders": ("rod", "offset", "assembly"),
    "rockers": ("coupler", "rocker", "assembly"),
    "rigid_points": ("along", "across"),
    "bars": ("length",),
    "joints": ("x", "y"),
    "points": ("x", "y"),
}
GUIDES = {"yokes": ("guide",), "linear_drivers": ("guide",), "crossings": ("first", "second")}

# Crank angle of the drawing: none where anything is in line.
AT = 0.7


def whole(name: str) -> dict[str, Any]:
    return {"format": 1, "name": name} | tomllib.loads(ZOO[name])


def drawn(machine: lw.Machine, tables: dict[str, Any]) -> dict[str, Any]:
    """Tables of a machine without what its drawing tells, and that drawing on a sheet with its own origin."""
    placed = lw.pose(machine, AT).points
    stripped = copy.deepcopy(tables)
    mechanism = stripped["mechanism"]
    first = next(iter(mechanism.get("cranks", {})), "")
    for table, told in TOLD.items():
        for name, entry in mechanism.get(table, {}).items():
            for key in told:
                # The first crank says from where its angle counts; directions of gears are not drawn.
                is_kept = key == "phase" and name == first
                if not is_kept and entry.get("link") not in mechanism.get("gears", {}):
                    entry.pop(key, None)
    for table, parts in GUIDES.items():
        for entry in mechanism.get(table, {}).values():
            for part in parts:
                entry.get(part, {}).pop("offset", None)
    if not first:
        mechanism["assembled_at"] = AT
    sheet = {name: [x + 1.5, y - 0.25] for name, (x, y) in ((n, p.position) for n, p in placed.items())}
    sheet.setdefault("O", [1.5, -0.25])
    stripped["drawing"] = {"points": sheet}
    return stripped


@pytest.mark.parametrize("name", ZOO)
def test_the_machine_that_was_drawn_moves_alike(name: str) -> None:
    tables = whole(name)
    machine = lw.Machine.model_validate(copy.deepcopy(tables))
    again = lw.Machine.model_validate(drawn(machine, tables))
    span = np.linspace(0.0, 2 * np.pi, 25)
    angles = span[[bool(each) for each in map(machine_closes(machine), span)]]
    one, other = lw.kinematics(machine, angles), lw.kinematics(again, angles)
    for point, motion in one.points.items():
        # Lengths of the order of a metre, from coordinates that were rounded once more on their sheet; near
        # limits errors grow with the root of rounding, which these machines keep away from.
        np.testing.assert_allclose(other.points[point].position, motion.position, rtol=0, atol=2e-12)
    assert again.drawing is None


def machine_closes(machine: lw.Machine) -> Any:
    def closes(angle: float) -> bool:
        try:
            lw.pose(machine, float(angle))
        except LinkwrightError:
            return False
        return True

    return closes


def test_centres_of_mass_are_drawn() -> None:
    text = """
format = 1
name = "drawn"
[drawing.points]
A = "0, 100 mm"
S = "300, 0 mm"
"S.rod" = "120, 90 mm"
[mechanism.cranks.A]
[mechanism.sliders.S]
crank = "A"
[bodies]
"S.rod" = { mass = 2, inertia = 0.01 }
A = { mass = 1, inertia = 0.1 }
S = { mass = 3 }
"""
    machine = lw.loads(text)
    rod = machine.bodies["S.rod"]
    start, end, centre = np.array([0, 0.1]), np.array([0.3, 0]), np.array([0.12, 0.09])
    along = (end - start) / np.hypot(*(end - start))
    assert rod.along == pytest.approx(along @ (centre - start), rel=1e-14)
    assert rod.across == pytest.approx(
        along[0] * (centre - start)[1] - along[1] * (centre - start)[0], rel=1e-14
    )
    # A crank is a point and a link: what is drawn under its name is its pin.
    assert machine.bodies["A"].along is None
    assert machine.mechanism.assembled_at == pytest.approx(np.pi / 2)


def test_what_is_written_counts() -> None:
    tables = whole("slider-crank with offset")
    made = drawn(lw.Machine.model_validate(copy.deepcopy(tables)), tables)
    made["mechanism"]["sliders"]["S"]["rod"] = "400 mm"
    assert lw.Machine.model_validate(made).mechanism.sliders["S"].rod == 0.4


HEAD = """
format = 1
name = "press"
[drawing]
file = "press.dxf"
[mechanism.cranks.A]
[mechanism.sliders.ram]
crank = "A"
angle = "-90 deg"
"""


def sheet(folder: Path, unit: int = 4, **places: tuple[float, float]) -> Path:
    document = ezdxf.new()
    document.header["$INSUNITS"] = unit
    for layer, place in places.items():
        document.modelspace().add_circle(place, 5, dxfattribs={"layer": layer})
        document.modelspace().add_circle(place, 3, dxfattribs={"layer": layer})
    # Holes elsewhere are no point.
    for x in (0.0, 7.0):
        document.modelspace().add_point((x, 1.0), dxfattribs={"layer": "holes"})
    document.saveas(folder / "press.dxf")
    (folder / "machine.toml").write_text(HEAD, encoding="utf-8")
    return folder / "machine.toml"


def test_layers_of_a_dxf_file_are_points(tmp_path: Path) -> None:
    machine = lw.read(sheet(tmp_path, O=(100, 100), A=(130, 140), ram=(100, -160)))
    assert machine.mechanism.cranks["A"].radius == pytest.approx(0.05, rel=1e-14)
    assert machine.mechanism.sliders["ram"].rod == pytest.approx(np.hypot(0.03, 0.3), rel=1e-14)
    assert machine.mechanism.sliders["ram"].offset == 0.0
    inches = lw.read(sheet(tmp_path, 1, O=(100, 100), A=(130, 140), ram=(100, -160)))
    assert inches.mechanism.cranks["A"].radius == pytest.approx(50 * 0.0254, rel=1e-14)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('[drawing]\nfile = "nothing.dxf"\n', "nothing.dxf"),
        ('[drawing]\nfile = "../press.dxf"\n', "folder of the machine file"),
        ('[drawing]\nlayer = "A"\n', "points, file or unit"),
        ("[drawing]\nfile = 3\n", r"drawing.file(.|\n)*the name of a DXF file"),
        ("[drawing]\nfile = ['press.dxf']\n", r"drawing.file(.|\n)*the name of a DXF file"),
        ("[drawing.file]\nA = [[0.03, 0.04]]\n", r"drawing.file(.|\n)*the name of a DXF file"),
        ('[drawing]\nunit = "1 mm"\n', r"drawing.unit(.|\n)*beside a file"),
        ('[drawing.points]\nA = "1 m"\n', "two lengths"),
        ('[drawing.points]\nA = "1, 2 kg"\n', "two lengths"),
        ('[drawing.points]\nrom = "1, 2 m"\n', '"ram"'),
        ('[drawing.points]\nA = "0, 2 m"\n', "mechanism.sliders.ram.rod"),
    ],
)
def test_what_is_wrong_is_told(text: str, said: str, tmp_path: Path) -> None:
    file = tmp_path / "machine.toml"
    file.write_text(HEAD.replace('[drawing]\nfile = "press.dxf"\n', text), encoding="utf-8")
    with pytest.raises(LinkwrightError, match=said):
        lw.read(file)


def test_a_drawing_without_a_unit_is_refused(tmp_path: Path) -> None:
    file = sheet(tmp_path, 0, O=(0, 0), A=(30, 40), ram=(0, -260))
    with pytest.raises(LinkwrightError, match="does not say its unit"):
        lw.read(file)
    assert lw.read(file, ["drawing.unit=2 mm"]).mechanism.cranks["A"].radius == pytest.approx(0.1)


def test_layers_that_nothing_is_named_after_are_passed_over(tmp_path: Path) -> None:
    machine = lw.read(sheet(tmp_path, O=(100, 100), A=(130, 140), ram=(100, -160), dimensions=(7, 7)))
    assert machine.mechanism.cranks["A"].radius == pytest.approx(0.05, rel=1e-14)


def test_a_point_with_several_places_in_its_layer_is_told(tmp_path: Path) -> None:
    file = sheet(tmp_path, O=(100, 100), A=(130, 140), ram=(100, -160))
    document = ezdxf.readfile(tmp_path / "press.dxf")
    document.modelspace().add_circle((150, 140), 5, dxfattribs={"layer": "A"})
    document.saveas(tmp_path / "press.dxf")
    with pytest.raises(LinkwrightError, match="2 places in the layer A"):
        lw.read(file)
    given = lw.read(file, ['drawing.points.A="130, 140 mm"'])
    assert given.mechanism.cranks["A"].radius == pytest.approx(0.05, rel=1e-14)
