"""Files that the page asks for are those of the command line, and none is read from outside the folder."""

from __future__ import annotations

import base64
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import linkwright as lw
from linkwright import InputError
from linkwright.kernel.files.library import library_path
from linkwright.studio.export import export
from linkwright.studio.files import Folder
from linkwright.studio.messages import Export
from linkwright.studio.session import Session

HEADS = {"pdf": b"%PDF", "gif": b"GIF8", "svg": b"<svg", "png": b"\x89PNG", "html": b"<!DOCTYPE html>"}


def data(name: str, **asked: Any) -> bytes:
    return base64.b64decode(export(lw.read(name), asked, asked.get("language", "en"))["data"])


@pytest.mark.parametrize("kind", ["svg", "png", "gif"])
def test_a_drawing_is_one(kind: str) -> None:
    assert data("roller_one_cart", kind=kind, seconds=0.2, angle=1.0).startswith(HEADS[kind])


def test_a_pose_has_the_joints_of_the_crank_angle() -> None:
    import io

    import ezdxf

    document = ezdxf.read(io.StringIO(data("roller_one_cart", kind="dxf", angle=1.25).decode()))
    spots = [tuple(point.dxf.location)[:2] for point in document.modelspace().query("POINT")]
    joint = 1e3 * np.array(lw.pose(lw.read("roller_one_cart"), 1.25).points["A1"].position)
    # The file has its lengths in millimetres with all digits.
    assert any(spot == pytest.approx(tuple(joint), abs=1e-9) for spot in spots)


def test_a_report_has_the_sections_language_and_units_that_were_chosen() -> None:
    page = data(
        "roller_one_cart", kind="html", sections=["summary", "data"], units=["mm", "rpm"], language="uk"
    ).decode()
    assert page.startswith("<!DOCTYPE html>")
    assert 'lang="uk"' in page
    assert "об/хв" in page
    assert "<math" not in page
    assert data("v_diesel", kind="html", of="torsion", sections=["results"]).startswith(HEADS["html"])


def test_variants_stand_beside_the_machine() -> None:
    text = library_path("roller_one_cart").read_text(encoding="utf-8")
    variant = {
        "name": "Variant 1",
        "text": text.replace('radius = "0.2 m"', 'radius = "0.25 m"'),
        "path": "x.toml",
    }
    page = data("roller_one_cart", kind="html", sections=["summary", "results"], variants=[variant]).decode()
    assert "Variant 1" in page


@pytest.mark.parametrize(
    "asked",
    [{"kind": "exe"}, {"kind": "gif", "seconds": 1e9}, {"kind": "html", "units": ["quux"]}],
    ids=["kind", "seconds", "unit"],
)
def test_wrong_requests_are_refused(asked: dict[str, Any]) -> None:
    with pytest.raises(InputError):
        export(lw.read("roller_one_cart"), asked, "en")


def test_nothing_to_draw_is_told() -> None:
    with pytest.raises(InputError, match="no mechanism"):
        data("topper", kind="dxf")


def test_a_company_file_lies_below_the_folder(tmp_path: Path) -> None:
    session = Session(Folder.of(tmp_path), lambda _: None)
    with pytest.raises(InputError, match="outside"):
        session._to_make(Export(ask="export", kind="html", company="../company.toml"))
    made = session._to_make(Export(ask="export", kind="html", company="a/company.toml"))
    assert made["company"] == str(tmp_path / "a/company.toml")
