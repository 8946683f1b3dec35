"""Laws of drivers with corners, laws that do not repeat, idle parts, and parallelograms behind rockers."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_line import invoke

import linkwright as lw
from linkwright import FindingError
from linkwright.linkages.idle_parts import idle_parts
from linkwright.linkages.law_jumps import law_jumps, law_warnings

FOUND = Path(__file__).parents[1] / "found" / "use"
MACHINES = Path(__file__).parents[2] / "machines"


def answer(*words: str) -> tuple[int, Any]:
    result = invoke(*words, "--json")
    return result.exit_code, json.loads(result.stdout)


def crank(law: str, *, mass: str = "[bodies]\nS = { mass = 10 }") -> lw.Machine:
    return lw.loads(f"""
format = 1
name = "law"
[drive]
speed = "60 rpm"
[drive.motor]
kind = "constant_speed"
speed = "60 rpm"
[mechanism.cranks.A]
radius = "0.1 m"
law = "{law}"
[mechanism.sliders.S]
crank = "A"
rod = "0.4 m"
[mechanism.cranks.B]
radius = "0.1 m"
[mechanism.sliders.T]
crank = "B"
rod = "0.5 m"
{mass}
""")


@pytest.mark.parametrize("command", [("check",), ("run",), ("forces",)])
def test_a_corner_that_moves_masses_is_refused(command: tuple[str, ...]) -> None:
    """The crank turns back at 180°; that the slider is at its dead centre there does not help."""
    code, said = answer(*command, str(FOUND / "law_with_corner.toml"))
    assert code == 1
    text = json.dumps(said, ensure_ascii=False)
    assert "The velocity of the law of A jumps from 1 to −1 rad/rad at a crank angle of 180°" in text.replace(
        "the velocity", "The velocity"
    ).replace("to -1", "to −1")


def test_where_a_corner_is() -> None:
    """Angle and both velocities, to rounding; the corner at the end of the revolution too."""
    (corner,) = [jump for jump in law_jumps(crank("0.3*abs(phi - 2)*sin(phi)")) if jump.order == 1]
    assert corner.angle == pytest.approx(2.0, abs=1e-9)
    assert (corner.before, corner.after) == pytest.approx((-0.3 * np.sin(2), 0.3 * np.sin(2)), abs=1e-6)
    angles = [jump.angle % (2 * np.pi) for jump in law_jumps(crank("abs(sin(phi))")) if jump.order == 1]
    np.testing.assert_allclose(np.cos(angles), [-1, 1], atol=1e-9)


def test_a_jump_of_the_acceleration_is_a_warning() -> None:
    """A parabola: ±2 per rad² on either side."""
    machine = crank("where(sin(phi) > 0, 0.5*sin(phi)^2, -0.5*sin(phi)^2)")
    jumps = law_jumps(machine)
    assert {jump.order for jump in jumps} == {2}
    assert [abs(jump.after - jump.before) for jump in jumps] == pytest.approx([2.0, 2.0], abs=1e-6)
    lw.forces(machine)
    assert any("inertia forces jump there" in text for text in law_warnings(machine))


@pytest.mark.parametrize("law", ["phi", "0.6*sin(phi)", "phi + 0.3*sin(3*phi)^5", "0.5*tanh(40*sin(phi))"])
def test_smooth_laws_have_no_jumps(law: str) -> None:
    assert law_jumps(crank(law)) == []


def test_a_corner_beside_the_masses_is_a_warning() -> None:
    """Masses that another driver moves do not feel it; nor do loads alone."""
    corner = "abs(sin(phi))"
    for mass in ("[bodies]\nT = { mass = 10 }", ""):
        machine = crank(corner, mass=mass)
        lw.forces(machine)
        assert any("masses there would need" in text for text in law_warnings(machine))
    with pytest.raises(FindingError, match="S would need an infinite acceleration"):
        lw.forces(crank(corner, mass="[bodies]\nT = { mass = 10 }\nS = { mass = 1 }"))
    with pytest.raises(FindingError, match="S would need an infinite acceleration"):
        lw.steady_state(crank(corner))


@pytest.mark.parametrize(
    ("name", "words", "remedy"),
    [
        ("law_that_saturates", "the law of A stays at 1;", "advance, 57.2958 deg"),
        ("packaging", "the law of dial stays at 1.047;", "add mechanism.cranks.dial.advance, 60 deg"),
    ],
)
def test_a_law_that_saturates_is_told_with_its_remedy(name: str, words: str, remedy: str) -> None:
    """Which advance to write, or the table of an axis."""
    for command in ("check", "run"):
        code, said = answer(command, str(FOUND / f"{name}.toml"))
        assert code == 1
        (text,) = [text for text in said["findings"] if "continues beyond 2π" in text]
        assert words in text
        assert remedy in text


def test_the_remedy_is_one(tmp_path: Path) -> None:
    """With it the dial indexes by 60° in every revolution."""
    text = (FOUND / "packaging.toml").read_text()
    machine = lw.loads(text.replace('law = "where', 'advance = "60 deg"\nlaw = "where'))
    steady = lw.steady_state(machine)
    assert steady.period > 0
    assert lw.period_turns(machine) == 6
    assert not [jump for jump in law_jumps(machine) if jump.order == 1]


def test_a_bar_that_carries_an_idle_driver_is_a_cylinder() -> None:
    """An excavator's cylinder as a nut on a bar of constant length: the finding says between which points."""
    code, said = answer("check", str(FOUND / "excavator_bucket.toml"))
    assert code == 1
    (text,) = said["findings"]
    assert "replace cyl and its bar by a cylinder between T and P, [mechanism.cylinders.cyl]" in text


def test_what_no_driver_moves_is_named() -> None:
    """A bar on O in place of the crank's pin: W = 1, and nothing moves but the crank."""
    for command in ("check", "run"):
        code, said = answer(command, str(FOUND / "locked_four_bar.toml"))
        assert code == 1
        assert any("Joint C and bars coupler, rocker never move" in text for text in said["findings"])
    mended = (FOUND / "locked_four_bar.toml").read_text().replace('start = "O"', 'start = "A"')
    assert not [*idle_parts(lw.loads(mended))]


@pytest.mark.parametrize("path", sorted(MACHINES.glob("*.toml")), ids=lambda path: path.stem)
def test_no_machine_of_ours_has_idle_parts(path: Path) -> None:
    machine = lw.read(path)
    if machine.has_crank:
        assert not [*idle_parts(machine)]
        assert not [jump for jump in law_jumps(machine) if jump.order == 1]


def test_a_parallelogram_behind_a_rocker() -> None:
    """50/460/50/460, angles equal to the last digit; the other branch is the antiparallelogram."""
    machine = lw.read(FOUND / "wiper_parallelogram.toml")
    moved = lw.linkage(machine)
    loops = {element.element: element.four_bar for element in moved.elements}
    assert loops["R2"] is not None
    assert loops["R2"].grashof == "change-point: parallelogram"
