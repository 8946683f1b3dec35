"""Files of manufacture hold what they are to hold, and what is wrong in one is noticed."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Callable
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from brute_force import distances, samples
from cam_outlines import CAMS, Cam, eccentric
from sizes import DEEP

from linkwright import ExchangeError, InputError, write_drawing
from linkwright.cam import Drawing, Form, Track, read_back
from linkwright.cam.manufacture.fit import FORMS

CAM = CAMS["dwells, cycloidal, roller"]
DRAWING = Drawing("Presser cam", {"PROFILE": CAM, "PITCH_CURVE": CAMS["flat face"]}, zero_angle=0.5)


@pytest.mark.deep
@pytest.mark.parametrize(
    ("name", "form"),
    # In `make test` every form with half of the cams, and every cam with half of the forms.
    [(name, form) for n, name in enumerate(CAMS) for k, form in enumerate(FORMS) if DEEP or (n + k) % 2],
)
def test_files_are_written_and_keep_the_tolerance(tmp_path: Path, name: str, form: Form) -> None:
    drawing = Drawing(name, {"PROFILE": CAMS[name]})
    written = write_drawing(tmp_path, drawing, form=form, tolerance=1e-5)
    assert [each.path.suffix for each in written] == [".dxf", ".svg", ".csv"]
    assert all(measured.deviation.largest <= 1e-5 for each in written[:2] for measured in each.outlines)
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(each.path.name for each in written)


# -- seen by other readers
# -------------------------------------------------------------------------------------


def test_dxf_seen_by_its_library(tmp_path: Path) -> None:
    """Arcs as ezdxf makes them lie on the profile; layers, units, marks, closed entities."""
    written = write_drawing(tmp_path, DRAWING, formats=["dxf"], tolerance=1e-6)
    document = ezdxf.readfile(written[0].path)
    assert document.dxfversion == "AC1024"
    assert document.header["$INSUNITS"] == 4
    assert not document.audit().has_issues
    space = document.modelspace()
    (outline,) = space.query('LWPOLYLINE[layer=="PROFILE"]')
    assert outline.closed
    places = []
    for arc in outline.virtual_entities():
        assert arc.dxftype() == "ARC"
        assert arc.dxf.radius > 1
        places += [1e-3 * np.array([p.x, p.y]) for p in arc.vertices(arc.angles(50))]
    # Degrees between 0 and 360 have rounding of 1e-14, and the polygon's chords add 4e-10 m.
    assert distances(np.array(places), samples(CAM, 60_000)).max() < 1e-6 + 4e-10
    kinds = {each.dxf.layer: each.dxftype() for each in space}
    assert kinds.keys() == {"PROFILE", "PITCH_CURVE", "CENTRE", "ZERO_ANGLE", "TEXT"}
    (point,) = space.query('POINT[layer=="CENTRE"]')
    assert point.dxf.location.magnitude == 0
    (mark,) = space.query('LINE[layer=="ZERO_ANGLE"]')
    assert math.atan2(mark.dxf.end.y, mark.dxf.end.x) == pytest.approx(0.5, abs=1e-12)
    texts = [each.dxf.text for each in space.query("TEXT")]
    assert texts[:2] == ["Presser cam", "tolerance 0.001 mm"]


@pytest.mark.parametrize(("form", "degree"), [("spline", 5), ("cubic", 3)])
def test_spline_seen_by_its_library(tmp_path: Path, form: Form, degree: int) -> None:
    written = write_drawing(tmp_path, DRAWING, formats=["dxf"], form=form, tolerance=1e-6)
    (spline,) = ezdxf.readfile(written[0].path).modelspace().query('SPLINE[layer=="PROFILE"]')
    assert spline.closed
    assert spline.dxf.degree == degree
    tool = spline.construction_tool()
    x = np.linspace(0, tool.max_t, 5000)
    places = 1e-3 * np.array([(p.x, p.y) for p in tool.points(x.tolist())])
    # The polygon's chords add 4e-10 m.
    assert distances(places, samples(CAM, 60_000)).max() < 1e-6 + 4e-10


def test_svg_is_of_true_scale(tmp_path: Path) -> None:
    """Corners of the path as any reader sees them: in millimetres, y down."""
    (written,) = write_drawing(
        tmp_path, Drawing("circle", {"PROFILE": eccentric(0.03, 0.01)}), formats=["svg"]
    )
    text = written.path.read_text(encoding="utf-8")
    width, box = re.search(r'width="([\d.]+)mm"', text), re.search(r'viewBox="([^"]+)"', text)
    assert width is not None
    assert box is not None
    assert float(width[1]) == float(box[1].split()[2])
    data = re.search(r'id="PROFILE" stroke="#000" d="([^"]+)"', text)
    assert data is not None
    arcs = re.findall(r"A (\S+) (\S+) 0 0 (\d) (\S+) (\S+)", data[1])
    assert len(arcs) == 4
    for radius, same, sweep, x, y in arcs:
        assert float(radius) == float(same) == pytest.approx(30, rel=1e-14)
        assert sweep == "0"
        assert math.hypot(float(x) - 10, float(y)) == pytest.approx(30, rel=1e-14)


@pytest.mark.parametrize("by", ["cam", "polar"])
@pytest.mark.parametrize("name", CAMS)
def test_table_holds_the_curve(tmp_path: Path, name: str, by: str) -> None:
    cam = CAMS[name]
    (written,) = write_drawing(
        tmp_path, Drawing("t", {"PROFILE": cam}), formats=["csv"], step=math.radians(0.5), by=by
    )
    with written.path.open() as stream:
        head, *rows = list(csv.reader(stream))
    assert head == ["phi_deg", "x_mm", "y_mm", "radius_mm", "polar_angle_deg", "curvature_per_mm"]
    phi, x, y, radius, polar, curvature = np.array(rows, dtype=float).T
    assert len(phi) == 721
    stepped = phi if by == "cam" else polar
    np.testing.assert_allclose(stepped, 0.5 * np.arange(721), atol=1e-12)
    places = cam.points(np.radians(phi) % math.tau)
    # 1e-13 of the size: angles in degrees are rounded.
    np.testing.assert_allclose(np.stack([x, y], axis=1), 1e3 * places, atol=1e-13 * radius.max())
    np.testing.assert_allclose(radius * np.exp(1j * np.radians(polar)), x + 1j * y, atol=1e-13 * radius.max())
    if name == "eccentric":
        np.testing.assert_allclose(curvature, 1 / 30, rtol=1e-13)


def test_curvature_of_a_table_is_positive_where_convex(tmp_path: Path) -> None:
    """Both signs with hollow flanks, the same whichever way round; a base circle bends by 1/r."""
    for name, base in (("hollow flanks", 39.0), ("dwells, 3-4-5, offset roller, clockwise", 40.0)):
        drawing = Drawing("t", {"PROFILE": CAMS[name]})
        (written,) = write_drawing(tmp_path, drawing, formats=["csv"])
        with written.path.open() as stream:
            rows = {float(row["phi_deg"]): float(row["curvature_per_mm"]) for row in csv.DictReader(stream)}
        assert rows[320.0] == pytest.approx(1 / base, rel=1e-12)
        assert (min(rows.values()) < 0) == (name == "hollow flanks")


# -- what is wrong is noticed
# ----------------------------------------------------------------------------------


def _line_after(text: str, marker: str, code: str, which: int) -> tuple[int, list[str]]:
    """Lines of a DXF, and the place of the value of a group code, so many after a marker."""
    lines = text.splitlines()
    found = [i for i in range(lines.index(marker), len(lines), 1) if lines[i].strip() == code]
    return found[which] + 1, lines


def _moved(code: str, by: float, which: int = 3) -> Callable[[str], str]:
    """Move one number of the first polyline."""

    def change(text: str) -> str:
        i, lines = _line_after(text, "AcDbPolyline", code, which)
        lines[i] = repr(float(lines[i]) + by)
        return "\n".join(lines) + "\n"

    return change


def _units(text: str) -> str:
    lines = text.splitlines()
    i = lines.index("$INSUNITS")
    lines[i + 2] = "1"
    return "\n".join(lines) + "\n"


def _open(text: str) -> str:
    i, lines = _line_after(text, "AcDbPolyline", "70", 0)
    lines[i] = "0"
    return "\n".join(lines) + "\n"


def _without_corner(text: str) -> str:
    i, lines = _line_after(text, "AcDbPolyline", "10", 2)
    count, _ = _line_after(text, "AcDbPolyline", "90", 0)
    lines[count] = str(int(lines[count]) - 1)
    del lines[i - 1 : i + 5]
    return "\n".join(lines) + "\n"


DXF_FAULTS: dict[str, tuple[Callable[[str], str], str]] = {
    "a corner moved by 5 µm": (
        _moved("10", 5e-3),
        r"mm from the curve at cam angle θ = [\d.]+°; the tolerance is 0.001 mm",
    ),
    "a bulge grown by 0.001": (_moved("42", 1e-3), "mm from the curve at cam angle"),
    "a bulge of another sign": (lambda text: _moved("42", -0.2)(text), "mm from the curve at cam angle"),
    "inches": (_units, r"\$INSUNITS is 1, expected 4"),
    "open": (_open, "is not marked as closed"),
    "a corner left out": (_without_corner, "mm from the curve"),
    "another layer": (lambda text: text.replace("PROFILE", "SKETCH"), "layer PROFILE holds nothing"),
    "cut off": (lambda text: text[: len(text) // 2], "that can be read"),
    "no DXF": (lambda text: "solid cube", "that can be read"),
}


@pytest.mark.parametrize("fault", DXF_FAULTS)
def test_corrupted_dxf_is_noticed(tmp_path: Path, fault: str) -> None:
    (written,) = write_drawing(tmp_path, DRAWING, formats=["dxf"], tolerance=1e-6)
    text = written.path.read_text(encoding="utf-8")
    assert read_back(written.path, DRAWING, 1e-6)
    change, message = DXF_FAULTS[fault]
    changed = change(text)
    assert changed != text
    written.path.write_text(changed, encoding="utf-8")
    with pytest.raises(ExchangeError, match=message):
        read_back(written.path, DRAWING, 1e-6)


def test_corrupted_spline_is_noticed(tmp_path: Path) -> None:
    (written,) = write_drawing(tmp_path, DRAWING, formats=["dxf"], form="spline", tolerance=1e-6)
    document = ezdxf.readfile(written.path)
    (spline,) = document.modelspace().query('SPLINE[layer=="PROFILE"]')
    points = [list(point) for point in spline.control_points]
    points[7][1] += 0.02
    spline.control_points = points
    document.save()
    with pytest.raises(ExchangeError, match="mm from the curve at cam angle"):
        read_back(written.path, DRAWING, 1e-6)


def _cell(line: int, column: int, by: float) -> Callable[[str], str]:
    """Change one number of a table."""

    def change(text: str) -> str:
        lines = text.splitlines()
        cells = lines[line].split(",")
        cells[column] = repr(float(cells[column]) + by)
        lines[line] = ",".join(cells)
        return "\n".join(lines) + "\n"

    return change


CSV_FAULTS: dict[str, tuple[Callable[[str], str], str]] = {
    "a place moved by a picometre": (
        lambda text: _cell(40, 1, 1e-9)(text),
        r"line 41: radius and polar angle are \S+ mm from x and y",
    ),
    "a cam angle": (_cell(40, 0, 1e-6), "line 41: the place is .* from the curve at its cam angle"),
    "a curvature": (_cell(50, 5, 1e-4), "line 51: the curvature is 0.0001/mm from that of the curve"),
    "no curvature": (_cell(50, 5, math.nan), "line 51: the curvature is nan/mm from that of the curve"),
    "the last row": (
        lambda text: text[: text.rstrip().rfind("\n") + 1],
        "last row is not the place of the first",
    ),
    "other units": (lambda text: text.replace("x_mm", "x_inch"), "columns phi_deg, x_inch"),
    "no numbers": (lambda text: text.replace("0", "o"), "is not a table"),
    "empty": (lambda text: "", "is not a table"),
}


@pytest.mark.parametrize("fault", CSV_FAULTS)
def test_corrupted_table_is_noticed(tmp_path: Path, fault: str) -> None:
    drawing = Drawing("t", {"PROFILE": CAM})
    (written,) = write_drawing(tmp_path, drawing, formats=["csv"])
    assert read_back(written.path, drawing)
    change, message = CSV_FAULTS[fault]
    text = written.path.read_text(encoding="utf-8")
    written.path.write_text(change(text), encoding="utf-8")
    with pytest.raises(ExchangeError, match=message):
        read_back(written.path, drawing)


SVG_FAULTS: dict[str, tuple[str, str, str]] = {
    "scale": (r'width="[\d.]+mm"', 'width="100mm"', "is not one millimetre a unit"),
    "open": (r" Z", "", "is not one closed path"),
    "sweep": (r" 0 0 0 ", " 0 0 1 ", "mm from the curve"),
    "radius": (r"A 4(\d\.\d+) 4(\d\.\d+)", r"A 5\1 5\2", "mm from the curve"),
    "name": ("PROFILE", "SKETCH", 'have the id "PROFILE"'),
    "text": ("</svg>", "", "that can be read"),
}


@pytest.mark.parametrize("fault", SVG_FAULTS)
def test_corrupted_svg_is_noticed(tmp_path: Path, fault: str) -> None:
    drawing = Drawing("t", {"PROFILE": CAM})
    (written,) = write_drawing(tmp_path, drawing, formats=["svg"])
    assert read_back(written.path, drawing)
    old, new, message = SVG_FAULTS[fault]
    text = written.path.read_text(encoding="utf-8")
    changed = re.sub(old, new, text, count=1)
    assert changed != text
    written.path.write_text(changed, encoding="utf-8")
    with pytest.raises(ExchangeError, match=message):
        read_back(written.path, drawing)


def test_a_file_that_does_not_keep_the_tolerance_is_not_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As if the writer wrote another cam."""
    from linkwright.cam.manufacture import write

    wrong = Track.of(CAMS["hollow flanks"])
    true_fit = write.fit
    monkeypatch.setattr(write, "fit", lambda track, form, tolerance: true_fit(wrong, form, tolerance))
    with pytest.raises(ExchangeError, match="the outline of layer PROFILE"):
        write_drawing(tmp_path, Drawing("t", {"PROFILE": CAM}), formats=["dxf"])
    assert list(tmp_path.iterdir()) == []


# -- what cannot be asked for
# ----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"formats": ["dwg"]}, 'format "dwg": expected dxf'),
        ({"step": math.radians(0.7)}, r"step of 0.7°: expected a whole number .* as 0.7\d+° or 0.69"),
        ({"step": 0.0}, "step: found 0,"),
        ({"step": -1.0}, "step: found -1,"),
        ({"step": math.nan}, "step: found nan,"),
        ({"tolerance": 0.0}, "tolerance: found 0,"),
    ],
)
def test_what_cannot_be_written_is_told(tmp_path: Path, arguments: dict[str, object], message: str) -> None:
    with pytest.raises(InputError, match=message):
        write_drawing(tmp_path, DRAWING, **arguments)  # type: ignore[arg-type]


def test_a_directory_that_cannot_be_written_is_told(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="cannot be written"):
        write_drawing(tmp_path / "file", DRAWING)


def test_overhanging_outline_has_no_polar_table(tmp_path: Path) -> None:
    """A circle beside the origin."""
    beside = Drawing("t", {"PROFILE": eccentric(0.01, 0.03)})
    with pytest.raises(ExchangeError, match="not a function of its polar angle"):
        write_drawing(tmp_path, beside, formats=["csv"], by="polar")
    write_drawing(tmp_path, beside, formats=["csv"], by="cam")


@pytest.mark.parametrize("layer", ["", "0", "TEXT", "A*B"])
def test_layers_that_do_not_exist_are_told(layer: str) -> None:
    with pytest.raises(InputError, match="expected a name of its own"):
        Drawing("t", {layer: CAM})


def test_read_back_tells_other_files_and_layers(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"expected \.csv, \.step, \.dxf"):
        read_back(tmp_path / "cam.dwg", DRAWING)
    with pytest.raises(InputError, match='layer "GROOVE": the drawing has PROFILE, PITCH_CURVE'):
        read_back(tmp_path / "cam.dxf", DRAWING, layers=("GROOVE",))
    for name in ("cam.dxf", "cam.svg", "cam.csv"):
        with pytest.raises(ExchangeError, match="that can be read"):
            read_back(tmp_path / name, DRAWING)


def test_a_drawing_needs_a_curve() -> None:
    with pytest.raises(InputError, match="at least one curve"):
        Drawing("t", {})


def test_names_of_files_are_names(tmp_path: Path) -> None:
    def named(name: str) -> str:
        (written,) = write_drawing(tmp_path, Drawing(name, {"PROFILE": CAM}), formats=["csv"])
        return written.path.name

    assert [named("Cam 7/b"), named("Nockenwelle_ä"), named("../"), named("con")] == [
        "Cam_7_b.csv",
        "Nockenwelle_ä.csv",
        "cam.csv",
        "con_.csv",
    ]


def test_clockwise_and_other_cams_are_cams() -> None:
    """The zoo has one that runs clockwise; its mirror image has the same sizes."""
    clockwise: Cam = CAMS["dwells, 3-4-5, offset roller, clockwise"]
    assert Track.of(clockwise).sense == -1
    assert Track.of(CAM).sense == 1
