"""Area, centre and moment of inertia of outlines: closed forms, brute force, and Open CASCADE."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np
import pytest

import linkwright as lw
from linkwright import MachineFileError
from linkwright.outlines import PlateProperties, plate_solid

RNG = np.random.default_rng(50)


def drawing(folder: Path, draw: Callable[[Any], None], units: int = 4, name: str = "link.dxf") -> Path:
    """A DXF file in millimetres."""
    document = ezdxf.new(units=units)
    draw(document.modelspace())
    document.saveas(folder / name)
    return folder / name


def agrees(plate: PlateProperties, area: float, centre: tuple[float, float], moment: float) -> None:
    """Numbers in mm², mm, mm⁴."""
    assert plate.area == pytest.approx(area * 1e-6, rel=1e-12)
    size = math.sqrt(area) * 1e-3
    assert (plate.along, plate.across) == pytest.approx(tuple(1e-3 * x for x in centre), abs=1e-12 * size)
    assert plate.second_moment == pytest.approx(moment * 1e-12, rel=1e-12)
    assert plate.accuracy < 1e-12


def test_a_rectangle(tmp_path: Path) -> None:
    """b h, the middle, and b h (b² + h²)/12; of four lines in any order and direction."""

    def lines(space: Any) -> None:
        space.add_line((120, 50), (120, 10))
        space.add_line((20, 10), (20, 50))
        space.add_line((120, 10), (20, 10))
        space.add_line((120, 50), (20, 50))

    agrees(lw.outline(drawing(tmp_path, lines)), 4000, (70, 30), 4000 * (100**2 + 40**2) / 12)


def test_a_ring(tmp_path: Path) -> None:
    """π (R² − r²) and π (R⁴ − r⁴)/2."""

    def circles(space: Any) -> None:
        space.add_circle((30, -20), 50)
        space.add_circle((30, -20), 20)

    plate = lw.outline(drawing(tmp_path, circles))
    agrees(plate, math.pi * (50**2 - 20**2), (30, -20), math.pi / 2 * (50**4 - 20**4))
    assert plate.hole_diameter == pytest.approx([0.04])


def test_a_segment_of_a_disc(tmp_path: Path) -> None:
    """R²(θ − sin θ)/2, the centre at 4R sin³(θ/2)/(3(θ − sin θ)), and the polar moment by its integral."""
    radius, theta = 50.0, math.radians(120)

    def segment(space: Any) -> None:
        space.add_lwpolyline(
            [
                (radius * math.cos(-theta / 2), radius * math.sin(-theta / 2), math.tan(theta / 4)),
                (radius * math.cos(theta / 2), radius * math.sin(theta / 2), 0),
            ],
            format="xyb",
            close=True,
        )

    share = theta - math.sin(theta)
    area, centre = radius**2 * share / 2, 4 * radius * math.sin(theta / 2) ** 3 / (3 * share)
    # Sector R⁴θ/4 less the triangle to the centre, b h (b² + 12 h²)/48 about its corner there.
    b, h = 2 * radius * math.sin(theta / 2), radius * math.cos(theta / 2)
    about_origin = radius**4 * theta / 4 - b * h * (b**2 + 12 * h**2) / 48
    agrees(lw.outline(drawing(tmp_path, segment)), area, (centre, 0), about_origin - area * centre**2)


def test_an_inclined_ellipse(tmp_path: Path) -> None:
    """π a b and π a b (a² + b²)/4, in any direction."""
    a, ratio = math.hypot(30, 10), 0.4
    path = drawing(tmp_path, lambda space: space.add_ellipse((10, 5), (30, 10), ratio))
    area = math.pi * a * a * ratio
    agrees(lw.outline(path), area, (10, 5), area * a * a * (1 + ratio**2) / 4)


def test_a_spline_that_is_a_circle(tmp_path: Path) -> None:
    """A rational spline of degree 2, weights 1 and √½, is a circle (Piegl and Tiller, section 7.5)."""
    corners = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)]
    weights = [1, math.sqrt(0.5)] * 4 + [1]
    knots = [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4]

    def spline(space: Any) -> None:
        space.add_rational_spline(
            [(40 * x, 40 * y) for x, y in corners], weights=weights, degree=2, knots=knots
        )

    agrees(lw.outline(drawing(tmp_path, spline)), math.pi * 40**2, (0, 0), math.pi / 2 * 40**4)


def test_a_spline_by_parabolas(tmp_path: Path) -> None:
    """A spline of degree 2 with one span is a parabola: its area to the chord is 2/3 of b h."""

    def parabola(space: Any) -> None:
        space.add_open_spline([(0, 0), (30, 60), (60, 0)], degree=2)
        space.add_line((0, 0), (60, 0))

    plate = lw.outline(drawing(tmp_path, parabola))
    assert plate.area == pytest.approx(1e-6 * 2 / 3 * 60 * 30, rel=1e-12)
    assert (plate.along, plate.across) == pytest.approx((0.03, 1e-3 * 2 / 5 * 30), rel=1e-12)


def test_random_polygons_by_brute_force(tmp_path: Path) -> None:
    """Points of a fine grid that lie inside, by their angles about each, give area, centre and moment."""
    for n in range(5):
        angles = np.sort(RNG.uniform(0, 2 * np.pi, 9))
        corners = RNG.uniform(20, 50, 9)[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])
        path = drawing(tmp_path, lambda space: space.add_lwpolyline(corners, close=True), name=f"{n}.dxf")  # noqa: B023
        plate = lw.outline(path)
        axis = np.linspace(-50, 50, 801)
        x, y = (values.ravel() for values in np.meshgrid(axis, axis))
        turned = np.zeros_like(x)
        for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
            one, other = np.arctan2(a[1] - y, a[0] - x), np.arctan2(b[1] - y, b[0] - x)
            turned += (other - one + np.pi) % (2 * np.pi) - np.pi
        inside = np.abs(turned) > np.pi
        cell = (axis[1] - axis[0]) ** 2
        centre = np.array([x[inside].mean(), y[inside].mean()])
        moment = cell * ((x[inside] - centre[0]) ** 2 + (y[inside] - centre[1]) ** 2).sum()
        assert plate.area * 1e6 == pytest.approx(cell * inside.sum(), rel=3e-3)
        assert (plate.along * 1e3, plate.across * 1e3) == pytest.approx(tuple(centre), abs=0.05)
        assert plate.second_moment * 1e12 == pytest.approx(moment, rel=5e-3)


def mixed(space: Any) -> None:
    """An outline of arcs, with a round, an elliptic and an odd hole."""
    corners = [(0, 0, 0.5), (100, 0, -0.2), (100, 40, 0), (0, 40, 1)]
    space.add_lwpolyline(corners, format="xyb", close=True)
    space.add_circle((20, 20), 5)
    space.add_ellipse((70, 20), (10, 3), 0.5)
    space.add_lwpolyline([(40, 10, 0.5), (48, 10, -0.2), (48, 20, 0)], format="xyb", close=True)


def wave(space: Any) -> None:
    """A spline of degree 3 and an arc of an ellipse."""
    space.add_open_spline([(0, 0), (10, -20), (40, 10), (60, -15), (80, 0)], degree=3)
    space.add_ellipse((40, 0), (40, 0), 0.5, 0, math.pi)


@pytest.mark.parametrize("draw", [mixed, wave])
def test_open_cascade_agrees(draw: Callable[[Any], None], tmp_path: Path) -> None:
    """The solid of the plate has the volume, the centre and the moment that Green's theorem gives."""
    gprop = pytest.importorskip("OCP.GProp")
    from OCP.BRepGProp import BRepGProp

    plate = lw.outline(drawing(tmp_path, draw), start=(0.01, 0.02), end=(0.05, 0.07))
    properties = gprop.GProp_GProps()
    # Adaptive quadrature: with its fixed one a spline's volume is wrong by 1e-5.
    solid = plate_solid(plate.section, 0.01)
    BRepGProp.VolumePropertiesGK_s(solid, properties, 1e-12, True, False, True, True, False)
    centre, inertia = properties.CentreOfMass(), properties.MatrixOfInertia()
    assert properties.Mass() == pytest.approx(1e9 * 0.01 * plate.area, rel=1e-12)
    place = (1e-3 * centre.X(), 1e-3 * centre.Y(), centre.Z())
    assert place == pytest.approx((plate.along, plate.across, 0), abs=1e-12)
    assert inertia.Value(3, 3) == pytest.approx(1e15 * 0.01 * plate.second_moment, rel=1e-12)


def test_axes_of_the_link(tmp_path: Path) -> None:
    """A drawing that is turned and shifted with its joints gives the same numbers."""
    turn, shift = math.radians(37), np.array([110.0, -40.0])
    rotation = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
    corners = np.array([[0, -10], [100, -20], [120, 0], [100, 15], [0, 10]])

    def one(space: Any) -> None:
        space.add_lwpolyline(corners, close=True)
        space.add_circle((50, 0), 4)

    def other(space: Any) -> None:
        space.add_lwpolyline(corners @ rotation.T + shift, close=True)
        space.add_circle(rotation @ (50, 0) + shift, 4)

    first = lw.outline(drawing(tmp_path, one), start=(0, 0), end=(0.1, 0))
    end = 1e-3 * (rotation @ (100, 0) + shift)
    second = lw.outline(drawing(tmp_path, other), start=1e-3 * shift, end=end)
    for name in ("area", "along", "across", "second_moment", "distance"):
        assert getattr(second, name) == pytest.approx(getattr(first, name), rel=1e-11), name
    assert second.hole_along == pytest.approx([0.05])


@pytest.mark.parametrize(("units", "size"), [(1, 0.0254), (2, 0.3048), (4, 1e-3), (5, 1e-2), (6, 1.0)])
def test_units_of_the_drawing(units: int, size: float, tmp_path: Path) -> None:
    """$INSUNITS is the unit of the drawing, unless another one is given."""

    def square(space: Any) -> None:
        space.add_lwpolyline([(0, 0), (2, 0), (2, 2), (0, 2)], close=True)

    path = drawing(tmp_path, square, units)
    assert lw.outline(path).area == pytest.approx(4 * size**2)
    assert lw.outline(path, unit=3e-3).area == pytest.approx(4 * 9e-6)


def test_planes_seen_from_behind(tmp_path: Path) -> None:
    """Entities whose extrusion points away count x to the other side."""

    def behind(space: Any) -> None:
        back = {"extrusion": (0, 0, -1)}
        space.add_arc((-50, 0), 20, 90, 270, dxfattribs=back)
        space.add_lwpolyline(
            [(-50, 20, 0), (0, 20, 0), (0, -20, 0), (-50, -20, 0)], format="xyb", dxfattribs=back
        )

    plate = lw.outline(drawing(tmp_path, behind))
    # In the drawing's own x the half disc is at x = 50 and beyond.
    area = 50 * 40 + math.pi * 20**2 / 2
    along = (50 * 40 * 25 + math.pi * 20**2 / 2 * (50 + 4 * 20 / (3 * math.pi))) / area
    assert plate.area == pytest.approx(area * 1e-6)
    assert plate.along == pytest.approx(along * 1e-3)


def test_blocks_in_place(tmp_path: Path) -> None:
    """A block is drawn where it is inserted, turned and scaled, on the layer of its reference."""
    document = ezdxf.new(units=4)
    block = document.blocks.new("PLATE")
    block.add_lwpolyline([(0, 0), (30, 0), (30, 10), (0, 10)], close=True)
    document.modelspace().add_blockref(
        "PLATE", (100, 0), dxfattribs={"rotation": 90, "xscale": 2, "yscale": 2, "layer": "OUT"}
    )
    document.saveas(tmp_path / "block.dxf")
    agrees(lw.outline(tmp_path / "block.dxf", layers=["OUT"]), 1200, (90, 30), 1200 * (60**2 + 20**2) / 12)


def test_a_block_in_rows_and_columns(tmp_path: Path) -> None:
    """A reference that repeats its block has every hole: 3 by 2 of radius 5, by Steiner's theorem."""
    document = ezdxf.new(units=4)
    document.blocks.new("HOLE").add_circle((0, 0), 5)
    space = document.modelspace()
    square(space, 0, 200)
    space.add_blockref(
        "HOLE",
        (60, 80),
        dxfattribs={"column_count": 3, "row_count": 2, "column_spacing": 40, "row_spacing": 40},
    )
    document.saveas(tmp_path / "grid.dxf")
    plate = lw.outline(tmp_path / "grid.dxf")
    hole = math.pi * 5**2
    polar = 200**4 / 6 - 6 * hole * 5**2 / 2 - hole * (4 * 40**2 + 6 * 20**2)
    assert len(plate.holes) == 6
    agrees(plate, 200**2 - 6 * hole, (100, 100), polar)


def test_the_frame_of_a_smoothed_polyline_is_no_part_of_it(tmp_path: Path) -> None:
    """Vertices by which a curve was smoothed lie beside it and are passed over."""
    document = ezdxf.new(units=4)
    line = document.modelspace().add_polyline2d([(0, 0), (30, 0), (50, 70), (30, 10), (0, 10)], close=True)
    line.vertices[2].dxf.flags |= 16
    document.saveas(tmp_path / "smoothed.dxf")
    assert lw.outline(tmp_path / "smoothed.dxf").area == pytest.approx(300e-6)


def test_gaps_count_as_inaccuracy(tmp_path: Path) -> None:
    """What a gap that counts as closed leaves out of a rectangle is within the accuracy."""

    def almost(space: Any) -> None:
        corners = [(0, 0), (100, 0), (100, 40), (0, 40), (0, 0)]
        for nth, (start, end) in enumerate(itertools.pairwise(corners)):
            x, y = start
            space.add_line((x, y + (5e-5 if nth == 1 else 0)), end)

    plate = lw.outline(drawing(tmp_path, almost))
    assert 0 < abs(plate.area - 4000e-6) <= plate.accuracy * plate.area
    assert plate.accuracy < 2e-6


def square(space: Any, x: float = 0, size: float = 10, layer: str = "0") -> None:
    """A square with a corner at x."""
    corners = [(x, 0), (x + size, 0), (x + size, size), (x, size)]
    space.add_lwpolyline(corners, close=True, dxfattribs={"layer": layer})


def with_gap(space: Any) -> None:
    space.add_line((0, 0), (100, 0))
    space.add_line((100, 0), (100, 40))
    space.add_line((99.65, 40), (0, 0))


def bow(space: Any) -> None:
    space.add_lwpolyline([(0, 0), (10, 10), (10, 0), (0, 10)], close=True)


def crossing(space: Any) -> None:
    square(space)
    space.add_circle((10, 5), 2)


def apart(space: Any) -> None:
    square(space)
    square(space, 20)


def island(space: Any) -> None:
    for radius in (10, 6, 2):
        space.add_circle((0, 0), radius)


def branch(space: Any) -> None:
    square(space)
    space.add_line((0, 0), (3, 4))
    space.add_line((3, 4), (10, 10))
    space.add_line((0, 0), (10, 0))


def twice(space: Any) -> None:
    square(space, -20, 50)
    for _ in range(2):
        space.add_circle((5, 5), 2)


def layers(space: Any) -> None:
    square(space, layer="PLATE")
    space.add_circle((5, 5), 2, dxfattribs={"layer": "HOLES"})


def solid(space: Any) -> None:
    square(space)
    space.add_solid([(0, 0), (1, 0), (1, 1)])


def speck(space: Any) -> None:
    space.add_circle((3, 4), 0)


def endless(space: Any) -> None:
    space.add_lwpolyline([(0, 0), (float("nan"), 0), (1, 1)], close=True)


def inclined(space: Any) -> None:
    space.add_polyline3d([(0, 0, 0), (10, 0, 5), (10, 10, 0)], close=True)


def rising(space: Any) -> None:
    space.add_line((0, 0, 0), (10, 0, 3))


def arched(space: Any) -> None:
    space.add_spline().set_open_uniform([(0, 0, 0), (5, 5, 4), (10, 0, 0)], 2)


def recursive(space: Any) -> None:
    block = space.doc.blocks.new("OWN")
    block.add_blockref("OWN", (20, 0))
    space.add_blockref("OWN", (0, 0))


def sliver(space: Any) -> None:
    space.add_lwpolyline([(0, 0), (1000, 0), (1000, 1e-3), (0, 1e-3)], close=True)


def nothing(space: Any) -> None:
    space.add_point((0, 0))


FAULTS = {
    with_gap: "an open outline: a gap of 0.35 between (100, 40) and (99.65, 40)",
    bow: "an outline that crosses itself near",
    crossing: "outlines that cross or touch near",
    apart: "2 separate outlines, about (5, 5) and (25, 5)",
    island: "an outline within a hole, about",
    branch: "curves that meet at",
    twice: "an outline that is drawn twice, about (5, 5)",
    layers: "curves on the layers PLATE, HOLES",
    solid: "SOLID on the layer 0",
    speck: "an outline without size at (3, 4)",
    endless: "no finite number",
    inclined: "POLYLINE out of the plane",
    rising: "LINE out of the plane",
    arched: "SPLINE out of the plane",
    recursive: "more than 8 blocks inside one another",
    sliver: "ends that are 0.002 apart in an outline as narrow",
    nothing: "no curve",
}


@pytest.mark.parametrize("draw", FAULTS, ids=lambda draw: draw.__name__)
def test_what_is_no_outline_is_refused(draw: Callable[[Any], None], tmp_path: Path) -> None:
    """With what is wrong, and where."""
    with pytest.raises(MachineFileError) as error:
        lw.outline(drawing(tmp_path, draw))
    assert FAULTS[draw] in str(error.value)


def test_blocks_in_blocks_end(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A small file that stands for a million texts is refused after as many as a drawing may have."""
    from linkwright.outlines.model import entities

    monkeypatch.setattr(entities, "_ENTITIES_MOST", 500)

    def nested(space: Any) -> None:
        for level in range(6):
            block = space.doc.blocks.new(f"B{level}")
            for nth in range(10):
                block.add_blockref(f"B{level - 1}", (nth, 0)) if level else block.add_text("x")
        space.add_blockref("B5", (0, 0))

    with pytest.raises(MachineFileError, match="more than 500 entities"):
        lw.outline(drawing(tmp_path, nested))


def test_layers_are_chosen(tmp_path: Path) -> None:
    """One layer alone, or several together, in any case of letters."""
    path = drawing(tmp_path, layers)
    assert lw.outline(path, layers=["plate"]).area == pytest.approx(100e-6)
    assert lw.outline(path, layers=["PLATE", "HOLES"]).area == pytest.approx((100 - math.pi * 4) * 1e-6)


def test_a_damaged_file_and_one_without_unit_are_refused(tmp_path: Path) -> None:
    """With the file, and a remedy."""
    (tmp_path / "bad.dxf").write_text("no DXF")
    with pytest.raises(MachineFileError, match="cannot be read as DXF"):
        lw.outline(tmp_path / "bad.dxf")
    with pytest.raises(MachineFileError, match="does not say its unit"):
        lw.outline(drawing(tmp_path, square, units=0))
