"""A linkage close to a change point gives a warning; one that passes it, or is far from it, gives none."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from command_line import invoke

import linkwright as lw
from linkwright.linkages.warnings import linkage_warnings

RHOMBUS = """
format = 1
name = "Rhombus"
[mechanism.points]
D = { x = 0.3 }
[mechanism.cranks.A]
radius = 0.3
[mechanism.rockers.B]
crank = "A"
pivot = "D"
coupler = 0.3
rocker = 0.3
"""


@pytest.mark.parametrize(("radius", "is_near"), [(0.3, False), (0.29999, True), (0.299, True), (0.25, False)])
def test_a_rhombus_and_its_neighbours(radius: float, is_near: bool) -> None:
    machine = lw.loads(RHOMBUS, {"mechanism.cranks.A.radius": radius})
    told = list(linkage_warnings(lw.linkage(machine)))
    assert len(told) == is_near
    if is_near:
        # Crank and frame differ by so much, which leaves the dyad out of line by as much over its length.
        angle = lw.linkage(machine).elements[0].transmission_angle_worst
        assert angle == pytest.approx((0.3 - radius) / 0.3, rel=1e-2)
        assert "B" in told[0]


@pytest.mark.parametrize("way", [["--at", "200 deg"], ["--steps", "4"], ["--law", "2*pi*t"]])
def test_motion_tells_of_it(way: list[str], tmp_path: Path) -> None:
    file = tmp_path / "rhombus.toml"
    file.write_text(RHOMBUS.replace("radius = 0.3", "radius = 0.29999"))
    told = invoke("motion", file, *way)
    assert told.exit_code == 0
    assert "close to a change point" in told.output
    found = json.loads(invoke("motion", file, *way, "--json").output)
    assert "close to a change point" in found["warnings"][0]


def test_motion_tells_the_angle_as_it_counts_it(tmp_path: Path) -> None:
    """The links are in line at 0° of the file, a quarter of a revolution behind the outer dead centre."""
    file = tmp_path / "rhombus.toml"
    file.write_text(RHOMBUS.replace("radius = 0.3", "radius = 0.29999"))
    told = invoke("motion", file, "--steps", "4", "--zero", "B outer")
    angle = re.findall(r"of a straight line at a crank angle of ([\d.]+)°", told.output)
    assert float(angle[0]) == pytest.approx(90.0, abs=0.01)
