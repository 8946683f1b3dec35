"""The archive and its description: valid for fmpy, units by pint, the same machine the same bytes."""

from __future__ import annotations

import math
import re
import zipfile
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pint
import pytest
from command_line import invoke
from conftest import Unpacked
from fmpy.model_description import read_model_description
from fmpy.validation import validate_fmu
from sizes import DEEP

import linkwright as lw

VERSIONS = ("2.0", "3.0")
# A cam, a drive with an elastic shaft; in `make test-deep` loads by formulas, many parts, several motors.
SOME = ("roller_cam", "elastic_coupling_of_carts")
ALL = (*SOME, "fan_by_formula", "bearing_loads_of_a_press", "press_line_two_motors")


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.deep
@pytest.mark.parametrize("name", ALL if DEEP else SOME)
def test_fmpy_finds_no_fault(name: str, version: str, unpacked: Unpacked) -> None:
    """An FMU of a drive is valid by schema, names, start values, units and model structure."""
    path = unpacked(name, version).with_name("machine.fmu")
    assert validate_fmu(str(path)) == []
    description = read_model_description(str(path), validate=True, validate_variable_names=True)
    assert description.modelExchange is not None
    assert description.coSimulation is not None
    states = [variable for variable in description.modelVariables if variable.derivative is not None]
    assert len(description.derivatives) == len(states) > 0


def test_the_same_machine_gives_the_same_bytes() -> None:
    """Two exports of a machine are one file; a changed mass gives another file and another token."""
    machine = lw.read("roller_two_carts")
    one, other = lw.fmu(machine), lw.fmu(lw.read("roller_two_carts"))
    changed = lw.fmu(lw.replace(machine, {"bodies.cart1.mass": 900.0}))
    assert one.data == other.data
    assert one.token == other.token
    assert changed.token != one.token


@pytest.mark.parametrize("version", VERSIONS)
def test_units_by_their_exponents(version: str, unpacked: Unpacked) -> None:
    """Every unit has the exponents that pint gives it, and its unit for display the factor."""
    root = ElementTree.parse(unpacked("press_from_rest", version) / "modelDescription.xml").getroot()
    registry: Any = pint.UnitRegistry()
    base = {"kg": "kilogram", "m": "meter", "s": "second", "rad": "radian", "K": "kelvin", "A": "ampere"}
    units = root.findall("UnitDefinitions/Unit")
    assert len(units) > 8
    for unit in units:
        text = unit.attrib["name"].replace(".", " ")
        quantity = registry.Quantity(1.0, _for_pint(text)).to_root_units()
        element = unit.find("BaseUnit")
        assert element is not None
        expected = registry.Quantity(1.0, "")
        for name, power in element.attrib.items():
            expected = expected * registry.Quantity(1.0, base[name]) ** int(power)
        assert (quantity / expected).to_root_units().magnitude == pytest.approx(1.0)
        assert quantity.dimensionality == expected.dimensionality
        for shown in unit.findall("DisplayUnit"):
            own = registry.Quantity(1.0, _for_pint(text)).to(shown.attrib["name"]).magnitude
            assert float(shown.attrib["factor"]) == pytest.approx(own, rel=1e-15)


def _for_pint(unit: str) -> str:
    """A unit as Modelica writes it, with powers and products as pint reads them."""
    return "".join(f"**{letter}" if letter.isdigit() else letter for letter in unit).replace(" ", "*")


def test_units_for_display_are_those_of_the_file(tmp_path: Path) -> None:
    """The table [units] of a machine chooses the units in which a tool shows its variables."""
    machine = lw.read("press_from_rest", ['units.length="mm"', 'units.speed="rpm"'])
    lw.fmu(machine).write(tmp_path / "m.fmu")
    variables = read_model_description(str(tmp_path / "m.fmu")).modelVariables
    shown = {variable.name: variable.displayUnit for variable in variables}
    assert shown["slides.ram.position"] == "mm"
    assert shown["crank_speed"] == "rpm"


def test_outputs_name_what_they_depend_on(unpacked: Unpacked) -> None:
    """A position depends on the crank angle, a velocity on the speed too: no algebraic loop by them."""
    outputs = read_model_description(str(unpacked("roller_one_cart", "2.0"))).outputs
    depends = {
        unknown.variable.name: None
        if unknown.dependencies is None
        else {v.name for v in unknown.dependencies}
        for unknown in outputs
    }
    assert depends["slides.cart1.position"] == {"crank_angle"}
    assert depends["slides.cart1.velocity"] == {"crank_angle", "crank_speed"}
    assert depends["slides.cart1.acceleration"] is None
    assert depends["crank_acceleration"] is None


@pytest.mark.parametrize(("name", "convention"), [("ram 1", "structured"), ("повзун", "flat")])
def test_names_that_are_no_identifiers(name: str, convention: str, tmp_path: Path) -> None:
    """Names with spaces are quoted parts of structured names; with letters beyond ASCII they are flat."""
    path = tmp_path / "machine.toml"
    path.write_text(
        f"""format = 1
name = "Ram"
[drive]
motor = {{ kind = "dc", speed_no_load = "100 rpm", torque_stall = "50 N m", inertia = 0.1 }}
[mechanism]
cranks.A = {{ radius = "100 mm" }}
sliders."{name}" = {{ crank = "A", rod = "400 mm" }}
[bodies]
"{name}" = {{ mass = "5 kg" }}
""",
        encoding="utf-8",
    )
    lw.fmu(lw.read(path)).write(tmp_path / "m.fmu")
    assert validate_fmu(str(tmp_path / "m.fmu")) == []
    description = read_model_description(str(tmp_path / "m.fmu"))
    assert description.variableNamingConvention == convention
    names = {variable.name for variable in description.modelVariables}
    assert {f"slides.'{name}'.position", f"bodies.'{name}'.mass"} <= names


def test_the_archive_is_plain(tmp_path: Path) -> None:
    """Plain files with one date; the description is one of them, and there is one library and the machine."""
    unit = lw.fmu(lw.read("roller_one_cart"), version="2.0")
    unit.write(tmp_path / "m.fmu")
    with zipfile.ZipFile(tmp_path / "m.fmu") as archive:
        infos = archive.infolist()
    assert {info.date_time for info in infos} == {(1980, 1, 1, 0, 0, 0)}
    names = [info.filename for info in infos]
    assert names[-2:] == ["modelDescription.xml", "resources/machine.lw"]
    libraries = [name for name in names[:-2] if Path(name).stem == unit.identifier]
    assert libraries == names[:-2]
    assert libraries
    assert math.isclose(unit.accuracy, 1e-8)


def test_a_ukrainian_report(tmp_path: Path) -> None:
    """In a Ukrainian report units are Ukrainian, and the version of FMI is the name 2.0."""
    page = tmp_path / "report.html"
    result = invoke("report", "--lang", "uk", "--to", page, "fmu", "roller_one_cart")
    assert result.exit_code == 0, result.output
    cells = [cell.strip() for cell in re.findall(r"<td[^>]*>([^<]*)</td>", page.read_text(encoding="utf-8"))]
    assert "2.0" in cells
    assert {"[рад]", "[рад/с]", "[рад/с²]", "[Н·м]", "[Вт]", "[Дж]", "[кг·м²]"} <= set(cells)
    assert not [cell for cell in cells if re.search(r"\b(rad|N m|kg)\b", cell)]
