"""Plates of a machine file: bodies whose mass and inertia come from a drawing."""

from __future__ import annotations

from pathlib import Path

import ezdxf
import numpy as np
import pytest
from command_line import invoke

import linkwright as lw
from linkwright import MachineFileError
from linkwright.machine import dumps
from linkwright.sensitivity.gradient import Gradient

MACHINE = """
format = 1
name = "Slider-crank with a drawn rod"
[drive]
speed = "10 rad/s"
[mechanism.cranks.A]
radius = "40 mm"
[mechanism.sliders.S]
crank = "A"
rod = "120 mm"
[bodies]
"S.rod" = { plate = { file = "rod.dxf", start = "10, 20 mm", end = "10, 140 mm", thickness = "8 mm", density = "7850 kg/m^3" } }
S = { mass = 1 }
"""  # noqa: E501

ROD = 'bodies."S.rod".plate.'


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A rod drawn upright: a strip of 30 mm by 150 mm with two holes, its long axis along y."""
    document = ezdxf.new(units=4)
    space = document.modelspace()
    space.add_lwpolyline([(-5, 5), (25, 5), (25, 155), (-5, 155)], close=True)
    for y in (20, 140):
        space.add_circle((10, y), 6)
    document.saveas(tmp_path / "rod.dxf")
    (tmp_path / "machine.toml").write_text(MACHINE)
    return tmp_path / "machine.toml"


def test_a_plate_is_the_body_with_its_mass(path: Path) -> None:
    """By hand: strip less two discs, the centre in the middle between the joints, Steiner for the moments."""
    body = lw.read(path).bodies["S.rod"]
    strip, disc, weight = 0.03 * 0.15, np.pi * 0.006**2, 7850 * 0.008
    assert body.mass == pytest.approx(weight * (strip - 2 * disc))
    assert (body.along, body.across) == pytest.approx((0.06, 0), abs=1e-15)
    moment = strip * (0.03**2 + 0.15**2) / 12 - 2 * disc * (0.006**2 / 2 + 0.06**2)
    assert body.inertia == pytest.approx(weight * moment)


def test_forces_are_those_of_the_same_body_by_numbers(path: Path) -> None:
    """A plate and a body with its mass, inertia and centre are one machine."""
    machine = lw.read(path)
    body = machine.bodies["S.rod"]
    given = ", ".join(f"{name} = {getattr(body, name)!r}" for name in ("mass", "inertia", "along", "across"))
    lines = [f'"S.rod" = {{ {given} }}' if "plate" in line else line for line in MACHINE.splitlines()]
    other = lw.loads("\n".join(lines))
    assert lw.forces(machine).torque_drive == pytest.approx(lw.forces(other).torque_drive, rel=1e-14)


def test_what_is_written_reads_back(path: Path) -> None:
    """A written machine has the numbers of the drawing in place of its name."""
    machine = lw.read(path)
    text = dumps(machine)
    assert "rod.dxf" not in text
    assert lw.loads(text) == machine


def test_variants_have_the_mass_of_their_thickness(path: Path) -> None:
    """By ``--set`` as by entries: mass and inertia grow with the thickness."""
    machine = lw.read(path)
    for thick in (
        lw.read(path, [f'{ROD}thickness="16 mm"']),
        machine.with_entries(
            {
                "bodies": {
                    "S.rod": machine.bodies["S.rod"].with_entries(
                        {"plate": machine.bodies["S.rod"].plate.with_entries({"thickness": 0.016})}
                    )
                }
            }
        ),
    ):
        body = thick.bodies["S.rod"]
        assert body.mass == pytest.approx(2 * machine.bodies["S.rod"].mass)
        assert body.inertia == pytest.approx(2 * machine.bodies["S.rod"].inertia)


@pytest.mark.parametrize("entry", ["thickness", "density", "area", "second_moment", "along", "across"])
def test_derivatives_by_a_plate_agree_with_differences(entry: str, path: Path) -> None:
    """The peak force in a pin, by every number of the plate."""
    address = f"{ROD}{entry}"

    def peak(*entries: str) -> Gradient:
        return lw.gradient(lw.read(path, entries), ["forces.reaction_max.S"], [address])

    exact = peak()
    value = float(exact.at[0])
    step = 1e-4 * (abs(value) or 0.01)
    above, below = (peak(f"{address}={value + side * step!r}").values[0] for side in (1, -1))
    assert exact.derivatives[0, 0] == pytest.approx((above - below) / (2 * step), rel=1e-6)


@pytest.mark.parametrize(
    ("entry", "words"),
    [
        ('{ROD}file="none.dxf"', "no such file"),
        ('{ROD}file="../rod.dxf"', "a file in the folder of the machine file"),
        ('{ROD}start="1"', 'two lengths, x and y, such as "80, 25 mm"'),
        ('{ROD}end="10, 20 mm"', "a joint apart from the start"),
        ('{ROD}layers="0"', "a list of names of layers"),
        ('{ROD}layers=["none"]', "no curve on the layers none"),
        ('{ROD}unit="3 kg"', "the length of a unit of the drawing"),
        ("{ROD}thickness=0", "a length greater than 0"),
        ('bodies."S.rod".mass=3', "either plate or mass"),
        ("bodies.S={plate={file='rod.dxf', thickness=1, density=1}}", "only a mass on a point"),
        ("bodies.S={plate={thickness=1, density=1}}", "a file with the outline"),
    ],
)
def test_wrong_entries_of_a_plate_are_refused(entry: str, words: str, path: Path) -> None:
    """With the entry and what belongs there."""
    with pytest.raises(MachineFileError) as error:
        lw.read(path, [entry.replace("{ROD}", ROD)])
    assert words in str(error.value)


def test_a_drawing_of_another_length_is_a_warning(path: Path) -> None:
    """Joints 120 mm apart in the drawing, on a rod of 125 mm."""
    (said,) = invoke("check", str(path), "--set", "mechanism.sliders.S.rod=0.125").stdout.split("WARNING")[1:]
    assert "0.12 m apart in its drawing; the link is 0.125 m long" in " ".join(said.split())
    assert "WARNING" not in invoke("check", str(path)).stdout


def test_the_command_prints_lines_that_mean_the_same(path: Path, tmp_path: Path) -> None:
    """The lines of ``linkwright outline`` give a machine with the mass that it prints."""
    words = ["--start", "10, 20 mm", "--end", "10, 140 mm", "--thickness", "8 mm", "--density", "7850 kg/m^3"]
    out = tmp_path / "out"
    done = invoke("outline", str(tmp_path / "rod.dxf"), *words, "--on", "S.rod", "--out", str(out))
    assert done.exit_code == 0
    head = MACHINE.partition("[bodies]")[0]
    (tmp_path / "other.toml").write_text(head + (out / "body.toml").read_text())
    assert lw.read(tmp_path / "other.toml").bodies["S.rod"] == lw.read(path).bodies["S.rod"]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--start", "1"], "--start: found"),
        (["--end", "0, 0 mm"], "--end: found the start of the link"),
        (["--step"], "--step: found without --out and --thickness"),
        (["--thickness", "0 mm"], "--thickness: found"),
    ],
)
def test_wrong_options_are_refused(words: list[str], said: str, path: Path, tmp_path: Path) -> None:
    """With exit code 2 and the option."""
    done = invoke("outline", str(tmp_path / "rod.dxf"), *words)
    assert done.exit_code == 2
    assert said in done.stderr


def test_a_step_file_has_the_volume(path: Path, tmp_path: Path) -> None:
    """The solid that is written, read back by Open CASCADE."""
    control = pytest.importorskip("OCP.STEPControl")
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    words = ["--thickness", "8 mm", "--step", "--out", str(tmp_path / "out")]
    assert invoke("outline", str(tmp_path / "rod.dxf"), *words).exit_code == 0
    reader = control.STEPControl_Reader()
    reader.ReadFile(str(tmp_path / "out" / "rod.step"))
    reader.TransferRoots()
    properties = GProp_GProps()
    BRepGProp.VolumeProperties_s(reader.OneShape(), properties)
    assert properties.Mass() == pytest.approx(8 * (30 * 150 - 2 * np.pi * 36), rel=1e-9)
