"""STEP files, where the kernel of the extra is installed; elsewhere a message with the remedy."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

import pytest
from brute_force import area
from cam_outlines import CAMS

from linkwright import ExchangeError, InputError, write_drawing
from linkwright.cam import Drawing, read_back

needs_kernel = pytest.mark.skipif(importlib.util.find_spec("OCP") is None, reason="extra step not installed")


@needs_kernel
@pytest.mark.parametrize("form", ["arcs", "cubic"])
@pytest.mark.parametrize("name", CAMS)
def test_solid_keeps_the_tolerance(tmp_path: Path, name: str, form: str) -> None:
    drawing = Drawing(name, {"PROFILE": CAMS[name]}, width=0.02)
    (written,) = write_drawing(tmp_path, drawing, formats=["step"], form=form, tolerance=1e-7)  # type: ignore[arg-type]
    assert written.outlines[0].deviation.largest <= 1e-7
    text = written.path.read_text()
    assert "AUTOMOTIVE_DESIGN" in text
    assert "MILLI" in text


@needs_kernel
def test_volume_is_area_times_width(tmp_path: Path) -> None:
    """By the kernel's integration of what it read."""
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps
    from OCP.STEPControl import STEPControl_Reader

    cam = CAMS["hollow flanks"]
    drawing = Drawing("t", {"PROFILE": cam}, width=0.02)
    (written,) = write_drawing(tmp_path, drawing, formats=["step"], tolerance=1e-8)
    reader = STEPControl_Reader()
    reader.ReadFile(str(written.path))
    reader.TransferRoots()
    found = GProp_GProps()
    # Gauss–Kronrod; the kernel's plain quadrature is off by 1e-3 on faces with so long an edge.
    BRepGProp.VolumePropertiesGK_s(reader.OneShape(), found, 1e-9)
    # Tolerance times circumference over area is 4e-7, and the kernel's own accuracy is 1e-7.
    assert found.Mass() == pytest.approx(1e9 * area(cam) * 0.02, rel=5e-7)


@needs_kernel
def test_another_cam_is_noticed(tmp_path: Path) -> None:
    drawing = Drawing("t", {"PROFILE": CAMS["hollow flanks"]}, width=0.02)
    (written,) = write_drawing(tmp_path, drawing, formats=["step"])
    with pytest.raises(ExchangeError, match="PROFILE"):
        read_back(written.path, Drawing("t", {"PROFILE": CAMS["flat face"]}, width=0.02))
    written.path.write_text("solid")
    with pytest.raises(ExchangeError, match="that can be read"):
        read_back(written.path, drawing)


def test_a_solid_needs_a_width(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="give the cam a width"):
        write_drawing(tmp_path, Drawing("t", {"PROFILE": CAMS["eccentric"]}), formats=["step"])


def test_a_missing_kernel_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As on a computer without it."""
    for module in [each for each in sys.modules if each.split(".")[0] == "OCP"]:
        monkeypatch.delitem(sys.modules, module)
    monkeypatch.setitem(sys.modules, "OCP", None)
    drawing = Drawing("t", {"PROFILE": CAMS["eccentric"]}, width=0.02)
    with pytest.raises(InputError, match=r"Open CASCADE kernel, which is not installed; .*\.\[step\]"):
        write_drawing(tmp_path, drawing, formats=["step"])
    assert list(tmp_path.iterdir()) == []
