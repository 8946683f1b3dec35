"""Drawings of cams of machines: right layers, in one frame, of the size that the cam has."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import linkwright as lw
from linkwright.cam import Drawing, Track

ROOT = Path(__file__).parents[2]

TEXT = """
format = 1
name = "t"
[mechanism.cams.f]
base_radius = "50 mm"
roller_radius = "10 mm"
{entries}
sections = [
  {{ angle = "90 deg", lift = "20 mm", law = "cycloidal" }},
  {{ angle = "60 deg" }},
  {{ angle = "90 deg", lift = "-20 mm", law = "cycloidal" }},
  {{ angle = "120 deg" }},
]
"""


def drawings(entries: str) -> tuple[Drawing, ...]:
    return lw.cam_drawings(lw.cam_profile(lw.loads(TEXT.format(entries=entries))))


@pytest.mark.parametrize(
    ("entries", "layers"),
    [
        ("", ["PROFILE", "PITCH_CURVE"]),
        ('cutter_radius = "20 mm"', ["PROFILE", "PITCH_CURVE", "CUTTER_PATH"]),
        ('cutter_radius = "10 mm"', ["PROFILE", "PITCH_CURVE"]),
        ('closure = "groove"', ["PROFILE", "PROFILE_OUTER", "PITCH_CURVE"]),
        (
            'closure = "groove"\ncutter_radius = "6 mm"',
            ["PROFILE", "PROFILE_OUTER", "PITCH_CURVE", "CUTTER_PATH", "CUTTER_PATH_OUTER"],
        ),
    ],
)
def test_layers(entries: str, layers: list[str]) -> None:
    (drawing,) = drawings(entries)
    assert list(drawing.curves) == layers


def test_outlines_lie_beside_one_another() -> None:
    """Profile, cutter path and outer flank are parallels of the pitch curve at their radii."""
    (drawing,) = drawings('closure = "groove"\ncutter_radius = "6 mm"')
    pitch = Track.of(drawing.curves["PITCH_CURVE"])
    phi = np.linspace(0, math.tau, 200)
    for layer, away in (("PROFILE", 10), ("PROFILE_OUTER", 10), ("CUTTER_PATH", 4), ("CUTTER_PATH_OUTER", 4)):
        _, off = pitch.nearest(drawing.curves[layer].points(phi))
        np.testing.assert_allclose(off, 1e-3 * away, rtol=1e-9)
    radius = {layer: np.linalg.norm(curve.points(phi), axis=1) for layer, curve in drawing.curves.items()}
    assert (radius["PROFILE"] < radius["CUTTER_PATH"]).all()
    assert (radius["CUTTER_PATH_OUTER"] < radius["PROFILE_OUTER"]).all()


def test_second_cam_is_drawn_in_the_frame_of_the_first() -> None:
    """Two rollers on one carriage, 150 mm apart: through the centre, the pitch curves are that far apart."""
    entries = 'closure = "conjugate"\nsecond = { distance = "150 mm", roller_radius = "8 mm" }'
    first, second = drawings(entries)
    phi = np.linspace(0, math.tau, 300)[:-1]
    a, b = (drawing.curves["PITCH_CURVE"].points(phi) for drawing in (first, second))
    # At one cam angle both rollers stand on a line through the centre, on opposite sides.
    np.testing.assert_allclose(np.linalg.norm(a - b, axis=1), 0.15, rtol=1e-12)
    np.testing.assert_allclose(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], 0, atol=1e-15)
    assert (first.name, second.name) == ("f", "f second")


def test_constant_diameter_of_the_drawn_cam(tmp_path: Path) -> None:
    """The cam of the roller-forming machine, read from its table: opposite places are 1 m apart."""
    machine = lw.read(ROOT / "machines" / "roller_cam.toml")
    (drawing,) = lw.cam_drawings(lw.cam_profile(machine))
    (written,) = lw.write_drawing(tmp_path, drawing, formats=["csv"])
    rows = np.loadtxt(written.path, delimiter=",", skiprows=1)
    radius = rows[:-1, 3]
    np.testing.assert_allclose(radius[:180] + radius[180:], 1000.0, rtol=1e-13)
    assert written.path.name == "cart.csv"
