"""Cylinders between two points of any links: lengths by law and flow, limits, and what cannot be."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_line import invoke

import linkwright as lw
from linkwright.app.report.scene import moving_scene
from linkwright.kernel.errors import MachineError
from linkwright.linkages.model.mobility import mobility

FOUND = Path(__file__).parents[1] / "found"

BOOM = """
format = 1
name = "boom"
[drive]
speed = "6 rpm"
[mechanism.points]
T = { x = "0.4 m", y = "-0.3 m" }
[mechanism.cylinders.Z]
start = "T"
end = "B"
start_length = "1.2 m"
law = "0.3*(1 - cos(phi)) + 0.02*sin(3*phi)"
bore = "100 mm"
rod = "60 mm"
[mechanism.joints.B]
x = "1.4 m"
y = "0.4 m"
[mechanism.bars.boom]
start = "O"
end = "B"
length = "1.5 m"
"""

FLOW = BOOM.replace(
    'law = "0.3*(1 - cos(phi)) + 0.02*sin(3*phi)"',
    'flow = "0, 60, 60, -38.4, -38.4, 0 l/min"\nflow_time = "0, 1, 3, 4.64, 6.82, 7.82 s"',
)


def closed_form(phi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Angle of the boom by the law of cosines, and its derivative by φ."""
    length = 1.2 + 0.3 * (1 - np.cos(phi)) + 0.02 * np.sin(3 * phi)
    rate = 0.3 * np.sin(phi) + 0.06 * np.cos(3 * phi)
    cosine = (0.25 + 2.25 - length**2) / (2 * 0.5 * 1.5)
    return np.arctan2(-0.3, 0.4) + np.arccos(cosine), rate * length / (0.75 * np.sqrt(1 - cosine**2))


def test_a_boom_follows_the_law_of_cosines() -> None:
    """Position, velocity and, as their differences, second and third derivatives of the boom's angle."""
    machine, phi = lw.loads(BOOM), np.linspace(0.0, 2 * np.pi, 41)
    motion = lw.kinematics(machine, phi, third=True)
    angle, rate = closed_form(phi)
    assert motion.links["boom"].angle == pytest.approx(angle, abs=1e-12)
    assert motion.links["boom"].d1 == pytest.approx(rate, abs=1e-12)
    step = 1e-5
    ahead, back = (lw.kinematics(machine, phi + s).links["boom"] for s in (step, -step))
    assert motion.links["boom"].d2 == pytest.approx((ahead.d1 - back.d1) / (2 * step), abs=1e-8)
    assert motion.links["boom"].d3 == pytest.approx((ahead.d2 - back.d2) / (2 * step), abs=1e-8)
    length = 1.2 + 0.3 * (1 - np.cos(phi)) + 0.02 * np.sin(3 * phi)
    assert motion.slides["Z"].position == pytest.approx(length, abs=1e-13)
    # Barrel and rod lie in the same line, from either end.
    turn = motion.links["Z.rod"].angle - motion.links["Z"].angle
    assert np.cos(turn) == pytest.approx(-1.0, abs=1e-14)


def test_lengths_of_many_machines_are_arrays() -> None:
    """A batch over the length at the start is the machines one by one."""
    machine, phi = lw.loads(BOOM), np.linspace(0.0, 6.0, 13)
    lengths = np.array([1.15, 1.2, 1.25])
    many = lw.kinematics(lw.replace(machine, {"mechanism.cylinders.Z.start_length": lengths}), phi)
    for row, length in enumerate(lengths):
        one = lw.kinematics(lw.replace(machine, {"mechanism.cylinders.Z.start_length": float(length)}), phi)
        assert many.links["boom"].angle[row] == pytest.approx(one.links["boom"].angle, abs=1e-12)


def test_flow_fills_the_chambers_exactly() -> None:
    """Over each straight stretch of flow the volume is its trapezium; the rod side is smaller by the rod."""
    machine = lw.loads(FLOW)
    time = np.array([0.0, 1.0, 3.0, 4.64, 6.82, 7.82])
    flow = np.array([0.0, 60, 60, -38.4, -38.4, 0.0]) * 1e-3 / 60
    bore = np.pi / 4 * 0.1**2
    annulus = np.pi / 4 * (0.1**2 - 0.06**2)
    zero = 4.0
    at, q = np.insert(time, 3, zero), np.insert(flow, 3, 0.0)
    volume = np.diff(at) * (q[1:] + q[:-1]) / 2
    length = 1.2 + np.concatenate([[0.0], np.cumsum(volume / np.where(volume > 0, bore, annulus))])
    motion = lw.kinematics(machine, 2 * np.pi * at[:-1] / time[-1])
    assert motion.slides["Z"].position == pytest.approx(length[:-1], abs=1e-12)
    assert length[-1] == pytest.approx(1.2, abs=1e-12)
    # The velocity follows the flow at once.
    middle = lw.kinematics(machine, np.array([2 * np.pi * 2.0 / time[-1]])).slides["Z"].d1[0]
    assert middle * 2 * np.pi / time[-1] == pytest.approx(1e-3 / bore, rel=1e-12)


def test_two_cylinders_carry_a_joint_alone() -> None:
    """A point held by two cylinders is where both lengths meet."""
    machine = lw.loads("""
format = 1
name = "two"
[mechanism.points]
D = { x = "1 m" }
[mechanism.cylinders]
Y = { start = "O", end = "J", start_length = "0.8 m", law = "0.1*sin(phi)" }
Z = { start = "D", end = "J", start_length = "0.7 m", law = "0.1*sin(2*phi)" }
[mechanism.joints]
J = { x = "0.6 m", y = "0.5 m" }
[loads]
pull = { kind = "force", on = "J", force = "100 N", direction = "-90 deg" }
""")
    phi = np.linspace(0.0, 2 * np.pi, 37)
    joint = lw.kinematics(machine, phi).points["J"].position
    assert np.hypot(*joint.T) == pytest.approx(0.8 + 0.1 * np.sin(phi), abs=1e-12)
    assert np.hypot(*(joint - [1, 0]).T) == pytest.approx(0.7 + 0.1 * np.sin(2 * phi), abs=1e-12)
    # The two rods alone hold the weight.
    held = lw.forces(machine, speed=0.0, angles=phi)
    e = [joint / np.hypot(*joint.T)[:, None], (joint - [1, 0]) / np.hypot(*(joint - [1, 0]).T)[:, None]]
    total = held.drives["Y"][:, None] * e[0] + held.drives["Z"][:, None] * e[1]
    assert total == pytest.approx(np.tile([0.0, 100.0], (37, 1)), abs=1e-9)


def test_a_boom_by_a_cylinder_is_the_crank_by_its_law() -> None:
    """The length grows with φ without end: the crank's law says acos, the cylinder 5 + φ."""
    crank = lw.loads((FOUND / "boom_by_law.toml").read_text())
    cylinder = lw.loads("""
format = 1
name = "boom by a cylinder"
[mechanism.points]
G = { x = 3 }
[mechanism.cylinders.cyl]
start = "G"
end = "C"
start_length = 5
law = "phi"
[mechanism.joints.C]
x = 0.1
y = 4
[mechanism.bars.boom]
start = "O"
end = "C"
length = 4
""")
    phi = np.linspace(0.0, 1.9, 20)
    by_law, by_length = lw.kinematics(crank, phi).links["C"], lw.kinematics(cylinder, phi).links["boom"]
    for name in ("angle", "d1", "d2"):
        assert getattr(by_length, name) == pytest.approx(getattr(by_law, name), rel=1e-9), name


def test_a_cylinder_is_two_links_and_no_freedom() -> None:
    assert mobility(lw.loads(BOOM).linkage).freedom == 1
    for name in ("scissor_lift_cylinder", "excavator_bucket"):
        assert mobility(lw.read(name).linkage).freedom == 1


def test_a_position_out_of_reach_is_a_finding_with_the_missing_length() -> None:
    """The boom stretches to 1.5 + 0.5 m; the cylinder is to grow to 2.2 m."""
    text = BOOM.replace('"0.3*(1 - cos(phi)) + 0.02*sin(3*phi)"', '"0.5*(1 - cos(phi))"')
    machine = lw.loads(text)
    with pytest.raises(lw.FindingError, match="the mechanism closes only at") as caught:
        lw.forces(machine)
    said = str(caught.value)
    assert "the cylinder Z reaches 2 m of 2.2 m at a crank angle of 180°: 200 mm are missing" in said


def test_a_length_beyond_its_limit_is_a_finding(tmp_path: Any) -> None:
    """Both ends of the stroke, in run and in check, with angle and excess."""
    path = tmp_path / "boom.toml"
    path.write_text(BOOM.replace("+ 0.02*sin(3*phi)", "").replace("bore =", 'length_max = "1.7 m"\nbore ='))
    for command in ("check", "run"):
        result = invoke(command, str(path), "--json")
        assert result.exit_code == 1
        said = json.loads(result.stdout)
        assert "is 100 mm above length_max, 1.7 m, at a crank angle of 180°" in json.dumps(
            said, ensure_ascii=False
        )


@pytest.mark.parametrize(
    ("old", "new", "place", "expected"),
    [
        ('end = "B"\nstart_length', 'end = "T"\nstart_length', "end", "another point than the start"),
        ('rod = "60 mm"', 'rod = "100 mm"', "rod", "less than the bore"),
        ("law =", 'flow = "0, 1, 0 l/min"\nlaw =', "flow", "either law or flow"),
        ("bore =", 'pressure = "1 bar"\nbore =', "pressure", "one of them"),
        ('start_length = "1.2 m"\n', "", "start_length", "distance of both points at crank angle zero"),
        ('law = "0.3*(1 - cos(phi)) + 0.02*sin(3*phi)"\n', "", "Z", "law or flow of a driver"),
        ('law = "0.3*(1 - cos(phi)) + 0.02*sin(3*phi)"', 'law = "0.3*x"', "law", "phi"),
        ('end = "B"\nstart_length', 'end = "X"\nstart_length', "end", "the name of a point"),
        ("bore =", 'length_min = "2 m"\nlength_max = "1 m"\nbore =', "length_min", "less than length_max"),
    ],
)
def test_wrong_entries_are_named(old: str, new: str, place: str, expected: str) -> None:
    assert old in BOOM
    with pytest.raises(MachineError) as caught:
        lw.loads(BOOM.replace(old, new, 1))
    problems = caught.value.problems
    assert any(p.key.endswith(place) and expected in p.expected + p.remedy for p in problems), problems


def test_no_driver_is_an_error() -> None:
    text = BOOM.replace('start_length = "1.2 m"\n', "").replace(
        'law = "0.3*(1 - cos(phi)) + 0.02*sin(3*phi)"', 'pressure = "10 bar"'
    )
    with pytest.raises(MachineError, match="at least one crank"):
        lw.loads(text)


def test_an_open_cycle_of_flow_says_what_is_missing() -> None:
    """60 l/min for 3 s out, 38.4 l/min for less than it takes back: the rod side lacks the rest."""
    with pytest.raises(MachineError, match=r"0\.64 litres are missing on the rod side"):
        lw.loads(FLOW.replace("4.64, 6.82, 7.82", "4.64, 5.82, 6.82"))


def test_too_many_drivers_are_named() -> None:
    """Crank and cylinder both move the joint."""
    text = BOOM.replace(
        "[mechanism.joints.B]", "[mechanism.cranks.A]\nradius = '0.1 m'\n[mechanism.joints.B]"
    )
    text += '[mechanism.bars.rod]\nstart = "A"\nend = "B"\nlength = "1.4 m"\n'
    with pytest.raises(MachineError, match="one constraint too many"):
        lw.loads(text)


def test_barrel_and_rod_are_drawn() -> None:
    scene = moving_scene(lw.loads(BOOM), None)
    assert scene is not None
    parts = [(part["kind"], part["name"]) for part in scene["parts"]]
    assert parts.index(("link", "Z.rod")) < parts.index(("slot", "Z"))


def test_the_excavator_of_a_new_user_by_a_cylinder() -> None:
    """Trunnion T and eye P on the lever: its angle by the law of cosines, and the bucket by the four-bar."""
    machine, phi = lw.read(FOUND / "use" / "excavator_by_cylinder.toml"), np.linspace(0.0, 2 * np.pi, 41)
    motion = lw.kinematics(machine, phi)
    trunnion, pivot, hinge = 0.35j, 1.9, 2.3 - 0.05j
    length, base = 1.75 + 0.1 * (1 - np.cos(phi)), abs(trunnion - pivot)
    between = np.arccos((base**2 + 0.48**2 - length**2) / (2 * base * 0.48))
    lever = np.angle(trunnion - pivot) - between
    assert np.exp(1j * motion.links["lever"].angle) == pytest.approx(np.exp(1j * lever), abs=1e-12)
    across = pivot + 0.48 * np.exp(1j * lever) - hinge
    at_hinge = np.arccos((0.42**2 + abs(across) ** 2 - 0.55**2) / (2 * 0.42 * abs(across)))
    bucket = np.angle(across) - at_hinge
    assert np.exp(1j * motion.links["bucket"].angle) == pytest.approx(np.exp(1j * bucket), abs=1e-12)
    stroke = lw.replace(machine, {"mechanism.cylinders.cyl.law": "0.45*(1 - cos(phi))"})
    with pytest.raises(lw.FindingError, match="the cylinder cyl reaches"):
        lw.forces(stroke, speed=1.0)
