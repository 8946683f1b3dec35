"""Tolerances behind the values of a machine file: what is computed with, what scatters, what is refused."""

from __future__ import annotations

from pathlib import Path

import pytest

import linkwright as lw
from linkwright import InputError, MachineFileError
from linkwright.machine import dumps, tolerance_names
from linkwright.studies.plan import with_tolerances

RADIUS = "mechanism.cranks.A1.radius"
STUDY = {"study.responses.delta": "steady_state.unevenness"}


def machine(tmp_path: Path, text: str) -> Path:
    lines = Path("machines/roller_two_carts.toml").read_text().splitlines()
    lines[lines.index('radius = "0.2 m"')] = f'radius = "{text}"'
    path = tmp_path / "machine.toml"
    path.write_text("\n".join([*lines, "[study.responses]", 'delta = "steady_state.unevenness"']))
    return path


@pytest.mark.parametrize(
    ("text", "tolerance", "ends"),
    [
        ("0.2 m ± 0.2 mm", "± 0.2 mm", (0.1998, 0.2002)),
        ("200 ± 0.2 mm", "± 0.2 mm", (0.1998, 0.2002)),
        ("20 cm +0.1 -0.3 mm", "+0.1 -0.3 mm", (0.1997, 0.2001)),
        ("0.2 m -0.3/0 mm", "-0.3/0 mm", (0.1997, 0.2)),
        ("200 -0.3 / +0.1 mm", "-0.3 / +0.1 mm", (0.1997, 0.2001)),
        ("0.2 m ± 1 %", "± 1 %", (0.198, 0.202)),
        ("200 H7", "H7", (0.2, 0.200046)),
        ("0.2 m P7", "P7", (0.199921, 0.199967)),
    ],
)
def test_the_size_is_computed_with_and_the_tolerance_scatters(
    tmp_path: Path, text: str, tolerance: str, ends: tuple[float, float]
) -> None:
    path = machine(tmp_path, text)
    read = lw.read(path)
    assert lw.get(read, RADIUS) == pytest.approx(0.2, rel=1e-15)
    assert dict(read.tolerances) == {RADIUS: tolerance}
    # What is written is the machine with its tolerance.
    assert lw.loads(dumps(read)) == read
    found = lw.tolerance(lw.read_study(path), rows=100)
    (axis,) = with_tolerances(lw.read_study(path)).axes
    assert (axis.low, axis.high) == pytest.approx(ends, rel=1e-12)
    # The same study with the tolerance as a variable of its own has the same machines.
    plain = machine(tmp_path, "0.2 m")
    variable = {"study.variables.A1_radius": {"address": RADIUS, "tolerance": tolerance}}
    assert found.to_dict() == lw.tolerance(lw.read_study(plain, variable), rows=100).to_dict()


def test_a_variable_of_the_study_goes_before_the_tolerance(tmp_path: Path) -> None:
    path = machine(tmp_path, "0.2 m ± 0.2 mm")
    wide = {"study.variables.r": {"address": RADIUS, "tolerance": "± 2 mm"}}
    found = lw.tolerance(lw.read_study(path, wide), rows=100)
    assert list(found.variables) == ["r"]
    for address in ('mechanism.cranks."A1".radius', "mechanism.cranks.A1"):
        values = [{"radius": 0.2, "phase": 0.0}] if address.endswith("A1") else [0.2, 0.21]
        other = {"study.variables.r": {"address": address, "values": values}}
        assert [axis.name for axis in with_tolerances(lw.read_study(path, other)).axes] == ["r"]


def test_sweeps_do_not_vary_tolerances(tmp_path: Path) -> None:
    path = machine(tmp_path, "0.2 m ± 0.2 mm")
    with pytest.raises(InputError, match=r"variables of .linkwright tolerance. alone"):
        lw.sweep(lw.read_study(path), tmp_path / "sweep")
    varied = {"study.variables.m": {"address": "bodies.cart1.mass", "range": [900, 1000], "steps": 3}}
    assert [axis.name for axis in lw.read_study(path, varied).axes] == ["m"]


@pytest.mark.parametrize(
    ("text", "found", "expected"),
    [
        ("0.2 m ± 2 kg", "± 2 kg", "a length"),
        ("0.2 m Z7", "Z7", "D to H"),
        ("0.2 m ± 0 mm", "± 0 mm", "two limits that differ"),
        ("0.2 m ± 0.2", "± 0.2", "with its unit"),
        ("0.2 m ± 5 m", "-4.8 m to 5.2 m", "greater than 0"),
    ],
)
def test_what_is_no_tolerance_is_told_at_its_entry(
    tmp_path: Path, text: str, found: str, expected: str
) -> None:
    path = machine(tmp_path, text)
    with pytest.raises(MachineFileError) as caught:
        lw.read(path)
    (problem,) = caught.value.problems
    line = 1 + path.read_text().splitlines().index(f'radius = "{text}"')
    assert (problem.key, problem.line) == (RADIUS, line)
    assert found in problem.found
    assert expected in problem.expected


def test_the_table_of_tolerances(tmp_path: Path) -> None:
    path = machine(tmp_path, "0.2 m ± 0.2 mm")
    with pytest.raises(MachineFileError, match="has a tolerance"):
        lw.read(path, {"tolerances": {RADIUS: "H7"}})
    for address, words in (("bodies.cart9.mass", "cart1"), ("name", "number")):
        with pytest.raises(MachineFileError, match=words):
            lw.read("roller_two_carts", {"tolerances": {address: "± 1 %"}})
    for spelled in ('mechanism.cranks."A1".radius', RADIUS):
        with pytest.raises(MachineFileError, match="has a tolerance"):
            lw.read(machine(tmp_path, "0.2 m ± 1 mm"), {"tolerances": {spelled: "± 2 mm"}})
    twice = {"tolerances": {RADIUS: "± 1 mm", 'mechanism.cranks."A1".radius': "± 2 mm"}}
    with pytest.raises(MachineFileError, match="has a tolerance"):
        lw.read("roller_two_carts", twice)
    # Without its size a tolerance holds for another size too.
    sized = lw.read("roller_two_carts", {"tolerances": {RADIUS: "0.2 m ± 1 mm"}})
    assert dict(sized.tolerances) == {RADIUS: "± 1 mm"}
    assert lw.get(lw.loads(dumps(lw.replace(sized, {RADIUS: 0.25}))), RADIUS) == 0.25
    both = {"tolerances": {RADIUS: "H7", "mechanism.cranks.A2.radius": "± 0.1 mm"}}
    names = tolerance_names(lw.read("roller_two_carts", both))
    assert names == {"A1_radius": RADIUS, "A2_radius": "mechanism.cranks.A2.radius"}


@pytest.mark.parametrize("path", sorted(Path().glob("examples/*/machine.toml")))
def test_lists_are_no_tolerances(path: Path) -> None:
    """As `"-14, -20, -17 kN"`: one machine of the gallery has tolerances."""
    assert bool(lw.read(path).tolerances) == (path.parent.name == "coupler_path_tolerances")


@pytest.mark.parametrize("text", ["10 - 4 - 3", "10 + 4 - 3", "-400*(tanh((v - 0.1)/0.01) - 3)", "5 +4 -3*t"])
def test_formulas_are_no_tolerances(text: str) -> None:
    load = {"loads.push": {"kind": "formula", "on": "cart1", "force": text}}
    machine = lw.read("roller_one_cart", load)
    assert not machine.tolerances
    assert lw.get(machine, "loads.push.force") == text


def test_words_are_no_tolerances() -> None:
    assert not lw.read("roller_two_carts", {"name": "25 H7", "description": "5 ± 1"}).tolerances
