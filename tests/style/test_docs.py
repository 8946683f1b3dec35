"""The documentation is true: its examples run, its tables are those of the code, its links lead somewhere."""

from __future__ import annotations

import doctest
import importlib.util
import re
import shlex
import tomllib
from pathlib import Path
from types import ModuleType

import pytest
from click.testing import CliRunner

import linkwright as lw
from linkwright.app.application import application
from linkwright.kernel.files.library import template
from linkwright.machine.read import loads

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PAGES = sorted(DOCS.rglob("*.md"))

_FENCED = re.compile(r"^```(\w+)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
_LINK = re.compile(r"\]\(([\w/.-]+\.md)(?:#[\w-]+)?\)")


def blocks(page: Path, language: str) -> list[str]:
    """Fenced blocks of a language, in order."""
    return [text for kind, text in _FENCED.findall(page.read_text(encoding="utf-8")) if kind == language]


def tables() -> ModuleType:
    """The script that writes the tables of the page on the machine file."""
    spec = importlib.util.spec_from_file_location("tables", DOCS / "tables.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize(
    "page", [page for page in PAGES if blocks(page, "python")], ids=lambda page: page.name
)
def test_examples_run(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """In an empty folder: machines are found by name; in the clone where a page names one of its files."""
    monkeypatch.chdir(ROOT if '"examples/' in page.read_text(encoding="utf-8") else tmp_path)
    names: dict[str, object] = {}
    for text in blocks(page, "python"):
        if ">>>" not in text:
            exec(compile(text, page.name, "exec"), names)
            continue
        test = doctest.DocTestParser().get_doctest(text, names, page.name, str(page), 0)
        report: list[str] = []
        runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE)
        runner.run(test, out=report.append, clear_globs=False)
        names.update(test.globs)
        assert not runner.failures, "".join(report)


def test_docstring_of_the_package_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert doctest.testmod(lw).failed == 0


@pytest.mark.parametrize("page", ["file_format.md", "units.md", "limits.md", "notation.md", "glossary.md"])
def test_tables_of_the_pages_are_those_of_the_code(page: str) -> None:
    text = (DOCS / page).read_text(encoding="utf-8")
    assert tables().written(text) == text, "run: python docs/tables.py"


def test_every_part_of_a_machine_file_has_its_table() -> None:
    page = (DOCS / "file_format.md").read_text(encoding="utf-8")
    assert set(tables().descriptions()) == set(tables().models(page))


def test_first_machine_is_the_template() -> None:
    text = blocks(DOCS / "start.md", "toml")[0]
    assert loads(text) == loads(template("slider-crank"))


def test_shown_message_is_the_real_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    command, *message = blocks(DOCS / "start.md", "console")[2].strip().splitlines()
    words = shlex.split(command.removeprefix("$ linkwright "))
    monkeypatch.chdir(tmp_path)
    Path("press.toml").write_text(template("slider-crank"), encoding="utf-8")
    result = CliRunner().invoke(application(), words)
    assert result.output.strip().splitlines() == message


def test_commands_are_listed() -> None:
    page = (DOCS / "cli.md").read_text(encoding="utf-8")
    listed = set(re.findall(r"^\| `linkwright (\w+)", page, re.MULTILINE))
    assert listed == set(application().entries)


def test_units_of_the_page_are_read() -> None:
    from linkwright.kernel.units.spellings import COMMON, normal

    known = {text for row in COMMON.values() for text in row}
    page = (DOCS / "units.md").read_text(encoding="utf-8").split("## Usual spellings")[1].split("\n##")[0]
    cells = [line.strip("|").split("|")[1:] for line in page.splitlines() if line.startswith("| ")][2:]
    listed = [
        unit.strip() for row in cells for cell in row for unit in re.sub(r"\(.*?\)|;.*", "", cell).split(",")
    ]
    assert [unit for unit in listed if unit != "–" and normal(unit) not in known] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(DOCS)))
def test_links_lead_somewhere(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    assert [link for link in _LINK.findall(text) if not (page.parent / link).is_file()] == []


def test_tests_that_theory_points_to_exist() -> None:
    sources = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "crates").rglob("*.rs"))
    for page in (DOCS / "theory").glob("*.md"):
        checks = page.read_text(encoding="utf-8").split("## Checks")[-1].split("\n## ")[0]
        named = [name for name in re.findall(r"`(\w+)`", checks) if "_" in name and not name.startswith("lw")]
        missing = [name for name in named if f"fn {name}(" not in sources]
        assert not missing, f"{page.name}: {missing}"


def test_machines_of_the_pages_are_sound() -> None:
    for page in PAGES:
        for text in blocks(page, "toml"):
            tomllib.loads(text)
