"""Derivatives of strokes, swings, time ratios and transmission angles: closed forms, differences, ties."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from command_line import invoke

import linkwright as lw
from linkwright import FindingError
from linkwright.linkages.gradient import linkage_tangents

EXAMPLES = Path(__file__).parents[2] / "examples"


R, L, E = 0.1, 0.28, 0.03
SLIDER = f"""
format = 1
name = "slider-crank"
[mechanism.cranks.A]
radius = {R}
[mechanism.sliders.S]
crank = "A"
rod = {L}
offset = {E}
"""


def test_an_offset_slider() -> None:
    """Stroke √((l+r)²−e²) − √((l−r)²−e²); μ_min = arccos((r+e)/l); both dead centres for the time ratio."""

    def closed(r: float, rod: float, e: float) -> dict[str, float]:
        far, near = math.asin(e / (rod + r)), math.asin(e / (rod - r))
        between = near - far
        return {
            "stroke": math.sqrt((rod + r) ** 2 - e**2) - math.sqrt((rod - r) ** 2 - e**2),
            "transmission_angle_worst": math.acos((r + abs(e)) / rod),
            "time_ratio": (math.pi + between) / (math.pi - between),
        }

    entries = [f"mechanism.{name}" for name in ("cranks.A.radius", "sliders.S.rod", "sliders.S.offset")]
    found = lw.gradient(lw.loads(SLIDER), ["linkage.S"], entries)
    at, h = np.array([R, L, E]), 1e-4
    for name in closed(R, L, E):
        for column, unit in enumerate(np.eye(3)):
            near = {n: closed(*(at + n * h * unit))[name] for n in (-2, -1, 1, 2)}
            difference = (8 * (near[1] - near[-1]) - near[2] + near[-2]) / (12 * h)
            exact = found.of(f"linkage.S.{name}")[entries[column]]
            # Differences of fourth order over 1e-4.
            assert exact == pytest.approx(difference, rel=1e-8, abs=1e-10), (name, entries[column])


def test_of_an_inline_slider_the_stroke_is_twice_the_crank() -> None:
    found = linkage_tangents(lw.loads(SLIDER.replace(str(E), "0")), ["mechanism.cranks.A.radius"])
    assert found.tangents["S.stroke"].d.item() == pytest.approx(2.0, rel=1e-13)
    # Both ends of the cycle have the same μ, which an offset would part.
    along = linkage_tangents(lw.loads(SLIDER.replace(str(E), "0")), ["mechanism.sliders.S.offset"])
    assert "deviate equally from 90°" in along.ties["S.transmission_angle_worst"]
    assert np.isnan(along.tangents["S.transmission_angle_worst"].d).all()
    assert along.missing["S.time_ratio"] == "both ways take the same crank angle"


def test_what_has_no_derivative_says_why() -> None:
    leg = linkage_tangents(lw.read(EXAMPLES / "jansen_leg" / "machine.toml"), ["mechanism.cranks.A.radius"])
    assert leg.missing["C.transmission_angle_min"] == "it is the same at all crank angles"
    with pytest.raises(FindingError, match="no link or slide"):
        linkage_tangents(
            lw.read(EXAMPLES / "cam_on_the_shaft" / "machine.toml"), ["mechanism.cams.valve.phase"]
        )


def test_from_the_command_line(tmp_path: Path) -> None:
    (tmp_path / "slider.toml").write_text(SLIDER)
    given = ["sensitivity", str(tmp_path / "slider.toml"), "--of", "linkage.S.stroke"]
    said = invoke(*given)
    assert said.exit_code == 0, said.output
    assert "stroke of the slide of S" in said.output
