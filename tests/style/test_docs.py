"""The documentation is true: its examples run, its tables are those of the code, its links lead somewhere."""

from __future__ import annotations

import doctest
import inspect
import re
import shlex
import tomllib
from functools import cache
from pathlib import Path
from types import ModuleType

import pytest
from command_line import invoke
from docs_scripts import docs_script

import linkwright as lw
from linkwright import loads
from linkwright.app.application import application
from linkwright.app.commands.run import run
from linkwright.drive import run_up
from linkwright.drive.commands import transient
from linkwright.kernel.files.library import template
from linkwright.torsion import TrainTransient

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PAGES = sorted(DOCS.rglob("*.md"))

_FENCED = re.compile(r"^```(\w+)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
_LINK = re.compile(r"\]\(([\w/.-]+\.md)?(?:#([\w-]+))?\)")


def blocks(page: Path, language: str) -> list[str]:
    return [text for kind, text in _FENCED.findall(page.read_text(encoding="utf-8")) if kind == language]


def tables() -> ModuleType:
    return docs_script("tables")


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


def test_numbers_of_the_readme_are_those_that_it_computes(capsys: pytest.CaptureFixture[str]) -> None:
    (text,) = blocks(ROOT / "README.md", "python")
    exec(compile(text, "README.md", "exec"), {})
    (comment,) = re.findall(r"print\(.*?\)  # (.*)", text)
    printed = re.findall(r"\d+\.\d+", comment)
    computed = capsys.readouterr().out.split()
    digits = [len(number.partition(".")[2]) for number in printed]
    assert printed == [f"{float(x):.{n}f}" for x, n in zip(computed, digits, strict=True)]


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
    result = invoke(*words)
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


def on_github(words: str) -> str:
    return re.sub(r"[^\w\- ]", "", words.lower()).replace(" ", "-")


def on_the_site(words: str) -> str:
    return re.sub(r"[-\s]+", "-", re.sub(r"[^\w\s-]", "", words.lower(), flags=re.ASCII).strip())


@cache
def anchors(page: Path) -> set[str]:
    """The anchors of a page that lead to the same place on GitHub and on the site.

    Of headings with the same words the first one, as others get numbers; and those that a page writes itself.
    """
    text = _FENCED.sub("", page.read_text(encoding="utf-8"))
    heads = [
        re.sub(r"\[(.*?)\]\(.*?\)|[`*]", r"\1", head) for head in re.findall(r"^#+ (.*)$", text, re.MULTILINE)
    ]
    known = {on_github(head) for head in heads if on_github(head) == on_the_site(head)}
    return known | set(re.findall(r'<a id="([\w-]+)"></a>', text))


@pytest.mark.parametrize(
    "page", [*PAGES, *sorted(ROOT.glob("*.md"))], ids=lambda page: str(page.relative_to(ROOT))
)
def test_links_lead_somewhere(page: Path) -> None:
    for link, anchor in _LINK.findall(_FENCED.sub("", page.read_text(encoding="utf-8"))):
        target = page.parent / link if link else page
        assert target.is_file(), link
        assert not anchor or anchor in anchors(target), f"{link}#{anchor}"


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


# Pages that lead through the sources, and where the paths that they name begin.
MAPS = [
    "ARCHITECTURE.md",
    "CONTRIBUTING.md",
    "README.md",
    "benches/README.md",
    "docs/style.md",
    "docs/performance.md",
]
STARTS = [
    ROOT,
    ROOT / "python" / "linkwright",
    ROOT / "crates",
    ROOT / "crates" / "linkwright-core" / "src",
    ROOT / "benches",
    ROOT / "tests" / "style",
]
# What a command writes.
WRITTEN = {"out/roller_two_carts/report.html", "benches/results.json"}


def paths(text: str) -> list[str]:
    named = [
        words
        for words in re.findall(r"`([^`\s]+)`", text)
        if re.fullmatch(r"[\w{},*/.-]+", words) and re.search(r"\w/|\.(?:py|pyi|rs|toml|md|mjs)$", words)
    ]
    return [
        re.sub(r"\{.*\}", part, words).replace("paperN", "paper1")
        for words in named
        for part in (re.search(r"\{(.*)\}|$", words)[1] or "").split(",")
    ]


def leads_somewhere(path: str) -> bool:
    """Whether a path begins at one of the starts, or in a crate that has the name of its room."""
    room, _, rest = path.partition("/")
    starts = [(start, path) for start in STARTS] + [(ROOT / "crates" / f"linkwright-{room}" / "src", rest)]
    return any(next(start.glob(name or "*"), None) for start, name in starts if start.is_dir())


@pytest.mark.parametrize("page", MAPS)
def test_paths_of_the_maps_exist(page: str) -> None:
    named = paths((ROOT / page).read_text(encoding="utf-8"))
    assert [path for path in named if path not in WRITTEN and not leads_somewhere(path)] == []


def test_public_names_of_the_pages_exist() -> None:
    pages = [ROOT / "README.md", ROOT / "ARCHITECTURE.md", *PAGES]
    named = {
        (page.name, name) for page in pages for name in re.findall(r"\blw\.(\w+)", page.read_text("utf-8"))
    }
    assert len(named) > 50
    assert [(page, name) for page, name in sorted(named) if not hasattr(lw, name)] == []


def test_a_wrong_path_is_found() -> None:
    assert paths("`cam/{model,nowhere}.py`, `lw.cam`, `--out DIR`") == ["cam/model.py", "cam/nowhere.py"]
    assert leads_somewhere("cam/core.py")
    assert leads_somewhere("kernel/lanes.rs")
    assert not leads_somewhere("cam/nowhere.py")


def test_worked_examples_are_the_code() -> None:
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    examples = re.findall(r"```python\n\s*# (\S+\.py)\n(.*?)```", text, re.DOTALL)
    assert len(examples) == text.count("```python") == 4
    for place, example in examples:
        source = (ROOT / "python" / "linkwright" / place).read_text(encoding="utf-8")
        assert " ".join(example.split()) in " ".join(source.split()), place


def test_accuracies_of_the_page_are_the_defaults() -> None:
    """The table of docs/choose.md against functions, commands and the file format."""
    text = (ROOT / "docs" / "choose.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (`[^|]+`) \| (1e-\d+) \|", text, re.MULTILINE)
    listed = {name: float(value) for names, value in rows for name in re.findall(r"`([^`]+)`", names)}
    defaults = {
        name: inspect.signature(getattr(lw, name)).parameters["accuracy"].default
        for name in ("steady_state", "steady_states", "study", "transient")
    }
    defaults["linkwright run"] = inspect.signature(run).parameters["accuracy"].default
    defaults["linkwright transient"] = inspect.signature(transient).parameters["accuracy"].default
    defaults["torsion_transient"] = TrainTransient.model_fields["accuracy"].default
    assert listed == defaults
    followed = [float(value) for value in re.findall(r"run-(?:up|down) with (1e-\d)", text)]
    assert followed == [run_up._ACCURACY, run_up._RUN_DOWN_ACCURACY]
