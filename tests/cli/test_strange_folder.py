"""A folder from a stranger: nothing in it runs or configures a library, and nothing outside it is read."""

from __future__ import annotations

import asyncio
import os
import subprocess
import sys
from pathlib import Path

import pytest

import linkwright as lw
from linkwright import InputError, LinkwrightError, MachineFileError
from linkwright.app.report.company import svg_fault
from linkwright.kernel.files.library import template
from linkwright.studio.worker import Worker

# Modules of the library that children import before any of ours.
SHADOWED = (
    "json",
    "multiprocessing",
    "struct",
    "asyncio",
    "signal",
    "pickle",
    "concurrent",
    "numpy",
    "typing",
)

STUDY = """
machine = "machine.toml"
[variables.phase]
address = "mechanism.cranks.A1.phase"
range = ["80 deg", "100 deg"]
steps = 4
[responses]
x = { curve = "motion.A1.x", at = "0 deg" }
"""

# What the folder would have libraries do: matplotlib calls LaTeX, ezdxf reads the whole of another file.
SETTINGS = {
    "matplotlibrc": "text.usetex: True\ntext.latex.preamble: \\input{/etc/hostname}\nbackend: nonsense\n",
    "ezdxf.ini": "[core]\ndefault_dimension_text_style = [",
}


@pytest.fixture
def strange(tmp_path: Path) -> Path:
    for name in SHADOWED:
        (tmp_path / f"{name}.py").write_text('open("RUN", "a").write(__name__)\n')
    for name, text in SETTINGS.items():
        (tmp_path / name).write_text(text)
    (tmp_path / "machine.toml").write_text(template("two-carts"), encoding="utf-8")
    (tmp_path / "cam.toml").write_text(template("cam"), encoding="utf-8")
    (tmp_path / "study.toml").write_text(STUDY, encoding="utf-8")
    return tmp_path


def call(*words: str, folder: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    known = {key: value for key, value in os.environ.items() if key != "PYTHONSAFEPATH"}
    return subprocess.run(
        [sys.executable, "-P", "-m", "linkwright", *words],
        cwd=folder,
        env=known | environment,
        capture_output=True,
        text=True,
        check=False,
    )


def test_children_of_a_sweep_import_nothing_from_the_folder(strange: Path) -> None:
    done = call("sweep", "study.toml", "--out", "rows", "--workers", "2", folder=strange)
    assert done.returncode == 0, done.stderr
    assert not (strange / "RUN").exists()


def test_children_of_the_studio_import_nothing_from_the_folder(
    strange: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(strange)
    monkeypatch.delenv("PYTHONSAFEPATH", raising=False)

    async def answer() -> bytes | None:
        worker = Worker()
        text = template("two-carts")
        job = {"number": 1, "lane": "study", "text": text, "path": "", "language": "en", "units": []}
        try:
            return await worker.run(job)
        finally:
            await worker.end()

    assert asyncio.run(answer())
    assert not (strange / "RUN").exists()


@pytest.mark.parametrize(
    "words",
    ["run machine.toml --out out", "cam cam.toml --out out", "plot machine.toml motion.A1.x --out plot.png"],
)
def test_settings_of_the_folder_are_not_read(strange: Path, words: str) -> None:
    done = call(*words.split(), folder=strange, MPLBACKEND="nonsense")
    assert done.returncode == 0, done.stderr
    assert "matplotlibrc" not in done.stderr
    assert "nsense" not in done.stderr


def test_the_machine_of_a_study_lies_in_its_folder(tmp_path: Path) -> None:
    secret = tmp_path / "secret"
    secret.write_text("first line of a secret")
    inside = tmp_path / "in"
    inside.mkdir()
    (inside / "link.toml").symlink_to(secret)
    for name in (str(secret), "../secret", "link.toml"):
        (inside / "study.toml").write_text(STUDY.replace("machine.toml", name), encoding="utf-8")
        with pytest.raises(MachineFileError, match="below it") as refused:
            lw.read_study(inside / "study.toml")
        assert "first line" not in str(refused.value)
        assert "study.toml:2: machine" in str(refused.value)
    (tmp_path / "machine.toml").write_text(template("two-carts"), encoding="utf-8")
    (inside / "study.toml").write_text(STUDY.replace("machine.toml", "../machine.toml"), encoding="utf-8")
    assert lw.read_study(inside / "study.toml", allow_outside=True).machine.name


def test_a_logo_lies_in_its_folder(tmp_path: Path) -> None:
    (tmp_path / "private.svg").write_text('<svg xmlns="http://www.w3.org/2000/svg"><text>secret</text></svg>')
    (tmp_path / "in").mkdir()
    company = tmp_path / "in" / "company.toml"
    (tmp_path / "in" / "link.svg").symlink_to(tmp_path / "private.svg")
    for name in ("../private.svg", str(tmp_path / "private.svg"), "link.svg"):
        company.write_text(f'logo = "{name}"')
        with pytest.raises(LinkwrightError, match="in the folder of the company file"):
            lw.read_heading(company)


ACTIVE = [
    "<script>1</script>",
    '<image href="private.png"/>',
    '<image xlink:href="https://example.org/a.png"/>',
    '<image href="data:image/svg+xml;base64,PHN2Zy8+"/>',
    '<a href="https://example.org"><rect/></a>',
    '<rect onload="1"/>',
    "<style>@import 'a.css';</style>",
    "<style>rect { fill: url(a.svg#b) }</style>",
    "<style>rect { fill: u\\72l(a.svg) }</style>",
    '<rect style="fill: url( &quot;a.svg&quot; )"/>',
    '<rect fill="url(http://example.org/#a)"/>',
    "<foreignObject><body xmlns='http://www.w3.org/1999/xhtml'/></foreignObject>",
    '<animate attributeName="href" to="a.svg"/>',
    '<set attributeName="onclick"/>',
    '<use href="other.svg#a"/>',
    "<h:script xmlns:h='http://www.w3.org/1999/xhtml'>1</h:script>",
    "<h:img xmlns:h='http://www.w3.org/1999/xhtml' src='a.png'/>",
]
HEAD = '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink">'


@pytest.mark.parametrize("part", ACTIVE)
def test_logos_neither_run_nor_load(part: str, tmp_path: Path) -> None:
    (tmp_path / "logo.svg").write_text(f"{HEAD}{part}</svg>")
    (tmp_path / "company.toml").write_text('logo = "logo.svg"')
    with pytest.raises(InputError, match="expected a picture without scripts and links"):
        lw.read_heading(tmp_path / "company.toml")


def test_logos_are_drawn() -> None:
    good = (
        '<defs><linearGradient id="a"/></defs><style>rect { fill: url(#a) }</style><rect fill="url(#a)"/>'
        '<use xlink:href="#a"/><image href="data:image/png;base64,AAAA"/>'
        '<metadata><x:y xmlns:x="urn:x" x:resource="http://example.org"/></metadata>'
    )
    assert not svg_fault(f"{HEAD}{good}</svg>".encode())
    assert svg_fault(b"<!DOCTYPE svg [<!ENTITY a 'b'>]><svg>&a;</svg>") == "an entity"
