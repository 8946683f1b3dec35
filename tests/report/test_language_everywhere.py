"""Reports of all machines and of all commands, also of what these cannot do, have no English in Ukrainian."""

from __future__ import annotations

import re
import tomllib
from collections import Counter
from collections.abc import Iterator
from dataclasses import fields, is_dataclass, replace
from itertools import chain
from pathlib import Path

import click
import pytest
from matplotlib.figure import Figure
from matplotlib.text import Text
from sizes import DEEP
from tests.cli.test_answer import CASES, NEVER, call, known
from tests.report.test_language import UKRAINIAN
from tests.samples.provoked import provoked, shaken

import linkwright as lw
from linkwright import LinkwrightError, straight_lines
from linkwright.app.commands.report import _content
from linkwright.drive import FAST_STARTS, STATUS
from linkwright.kernel.figure.style import CaptionedFigure
from linkwright.kernel.page.content import Content
from linkwright.kernel.page.formulas import Formula
from linkwright.kernel.page.table import Table
from linkwright.kernel.page.translation import in_language
from linkwright.machine.table import Part
from linkwright.studies.point_responses import OPEN
from linkwright.studies.rows import NO_NUMBER

__all__ = ["known"]

ROOT = Path(__file__).parents[2]
MACHINES = sorted([*ROOT.glob("machines/*.toml"), *ROOT.glob("examples/*/machine.toml")])
FOUND = [path for path in sorted(ROOT.glob("tests/found/**/*.toml")) if "format" in path.read_text("utf-8")]

# What is no word: names with digits, with points or underscores, symbols with an index, addresses, options,
# what stands in quotes, formulas.
_NO_WORDS = re.compile(
    r"[\"«`“][^\"»`”]*[\"»`”]|\S*[/._\d=^$\\*]\S*|--[a-z]+|\b\w+\((?:[^()]|\([^()]*\))*\)|\b\w+ = "
)
_WORD = re.compile(r"(?<![A-Za-z])[A-Za-z]{3,}(?![A-Za-z])")
_FORMULA = re.compile(r"[*^]|\w\(|\w = ")
_POINT = re.compile(r"(?<![\w.])\d+\.\d+(?![\w.])")
# Symbols, rules, methods and authors; a part of a table that its task names.
_NAMES = re.compile(
    r"\b(API|RP|PPRL|MPRL|CBE|IACS|IIA|FMU|FMI|phi|IEC|DNV|DXF|SVG|CSV|STEP|JSON|PDF|CLF|DOP|TF|cos|sin|tan|arctan|min|max|Hz|rpm|Linkwright|linkwright|"
    r"pole|ground|torsiograph|true|false)\b"
)


def _shown(value: object, at: str = "") -> Iterator[str]:
    """All texts of a report that a reader sees, those of figures among them."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, Figure):
        yield from (text.get_text() for text in value.findobj(Text))
        yield from (str(line.get_label()) for axes in value.axes for line in axes.get_lines())
    elif isinstance(value, Formula):
        yield value.words
    elif is_dataclass(value):
        # Keys of programs, sources, files, and what the author of a file wrote.
        kept = {
            "title",
            "about",
            "source",
            "papers",
            "names",
            "file",
            "command",
            "language",
            "heading",
            "scenes",
        }
        yield from (
            one
            for each in fields(value)
            if each.name not in kept
            for one in _shown(getattr(value, each.name))
        )
    elif isinstance(value, Part):
        yield from _shown([value.entries, [] if value.is_named else [value.name]])
    elif isinstance(value, (Table, CaptionedFigure)):
        yield from _shown(value[1:])
    elif isinstance(value, (list, tuple)):
        yield from (one for part in value for one in _shown(part))
    elif callable(value):
        yield from _shown(value())


def _english(words: list[str], *, figures: bool = True) -> set[str]:
    """Texts of the report of a command, in Ukrainian, with a word or a number that is English still."""
    content = _content(words, "")
    if not figures:
        bare = [
            part._replace(figures=[one._replace(figure=None) for one in part.figures])
            for part in content.parts
        ]
        content = replace(content, parts=bare, sketch=None)
    parts = [part for _, parts in content.groups for part in parts]
    entries = [entry for part in parts for entry in part.entries]
    # Motors of a catalogue, constants and formulas are the file's own as well as names.
    given = (entry.value for entry in entries if entry.word == "catalogue" or _FORMULA.search(entry.value))
    names = {*content.names, content.title, *given, *(part.name for part in parts if part.is_named)}
    own = re.compile(
        "|".join(rf"(?<!\w){re.escape(name)}(?!\w)" for name in sorted(names, key=len, reverse=True) if name)
    )
    left = set()
    for text in _shown(in_language(content, UKRAINIAN)):
        bare = _NAMES.sub(" ", own.sub(" ", text))
        if _POINT.search(bare) or _WORD.search(_NO_WORDS.sub(" ", bare)):
            left.add(text)
    return left


def _of(path: Path) -> list[str]:
    """The command for a machine: a study of all that it is, or the vibration of its train."""
    return ["torsion" if "[train" in path.read_text(encoding="utf-8") else "run", str(path)]


@pytest.mark.parametrize("path", MACHINES, ids=lambda path: "/".join(path.parts[-2:]))
def test_a_machine(path: Path) -> None:
    assert not _english(_of(path))


Fault = tuple[Path, str, list[str]]


def _faults(path: Path) -> list[Fault]:
    tables = tomllib.loads(path.read_text(encoding="utf-8"))
    return [(path, what, entries) for what, entries in provoked(tables)]


def _one_each() -> Iterator[Fault]:
    """A fault of each machine, of the kind that fewest others have."""
    used: Counter[str] = Counter()
    for path in MACHINES:
        if options := _faults(path):
            rarest = min(options, key=lambda fault: used[fault[1]])
            used[rarest[1]] += 1
            yield rarest


def _shaken() -> Iterator[Fault]:
    for n, path in enumerate(MACHINES):
        tables = tomllib.loads(path.read_text(encoding="utf-8"))
        yield from ((path, " ".join(entries), entries) for entries in shaken(tables, n, 10))


def _name(value: object) -> str:
    return "/".join(value.parts[-2:]) if isinstance(value, Path) else str(value)[:60]


def _left(path: Path, entries: list[str]) -> set[str]:
    """What stays English where these entries are changed; nothing of what is refused, which has no report."""
    try:
        return _english(
            [*_of(path), *(word for entry in entries for word in ("--set", entry))], figures=False
        )
    except (LinkwrightError, click.exceptions.Exit):
        return set()


@pytest.mark.parametrize(("path", "what", "entries"), list(_one_each()), ids=_name)
def test_a_machine_with_a_fault(path: Path, what: str, entries: list[str]) -> None:
    """Findings and warnings of an overload, a stall, lost contact, an undercut, a resonance, and so on."""
    assert not _left(path, entries)


@pytest.mark.deep
@pytest.mark.parametrize(
    ("path", "what", "entries"), [*chain(*map(_faults, MACHINES)), *_shaken()] if DEEP else [], ids=_name
)
def test_all_faults_of_all_machines(path: Path, what: str, entries: list[str]) -> None:
    assert not _left(path, entries)


@pytest.mark.parametrize("path", FOUND, ids=_name)
def test_machines_in_which_faults_were_found(path: Path) -> None:
    assert not _left(path, [])


@pytest.mark.parametrize("kind", ["right", "finding"])
# A term of the glossary has no report.
@pytest.mark.parametrize("name", sorted(CASES.keys() - {"glossary"}))
def test_a_command(name: str, kind: str, known: dict[str, str]) -> None:
    words = getattr(CASES[name], kind)
    if words != NEVER:
        assert not _english(call(name, words, known))


@pytest.mark.parametrize("name", ["sweep", "sweep show", "optimise", "tolerance"])
def test_what_a_study_says_first(name: str, known: dict[str, str]) -> None:
    content = _content(call(name, CASES[name].right, known), "")
    said = UKRAINIAN(content.lead.removeprefix(f"{content.title}. "))
    assert not _WORD.findall(_NO_WORDS.sub(" ", said)), said


@pytest.mark.parametrize(
    "text",
    [
        "4 machines computed, 2 without a result",
        "x is at its maximum, 0.1 m; y is at the lower end of its range, 3 kg",
        "0.001 m more at the upper end of y would make x 0.001 m larger",
        "derivatives exact",
        "cost 3 instead of 4.2; yield 99 % (98 to 100 %) instead of 97 %",
        "limited by x, y",
        "no constraint limits them: they are at the upper end of the search",
        "6 samples of speed; derivatives by differences, to 3e-09; noise 0.0177 rad/s in speed",
        "in row",
        "Worst determined: 2 % more mass is known to ±0.31 % (standard deviation)",
        "Worst determined: 1 % more a and 0.3 % less b and 0.345 kg more c together are known to "
        "±0.31 % (standard deviation)",
        "1 % more a would change the record by 0.02 of its noise: the record does not determine it",
        "1 % less a and 1 % more b and 2 % less c together would change the record by 0.02 of its noise: "
        "the record does not determine them",
        "No flywheel is needed: there is no steady motion, required is at most 0.05",
        "Flywheel 20 kg m² on the crankshaft for a speed fluctuation of 0.05; without it there is no steady "
        "motion",
    ],
)
def test_sentences_of_studies(text: str) -> None:
    said = UKRAINIAN(text)
    assert not re.findall("[A-Za-z]{2,}", said.replace("mass", "")), said


@pytest.mark.parametrize("text", [*list(STATUS.values())[1:], *FAST_STARTS.values(), OPEN, NO_NUMBER])
def test_what_becomes_of_a_row_of_a_study(text: str) -> None:
    said = UKRAINIAN(f"3 rows: {text}").replace("(linkwright transient)", "")
    assert not _WORD.findall(_NO_WORDS.sub(" ", said)), said


@pytest.mark.parametrize(
    "title",
    [
        *(f"{line.title}, line of 0.2 m" for line in straight_lines(0.2)),
        "Crank-rocker, swing 60°, time ratio 1.5",
        "Slider-crank, stroke 0.2 m, time ratio 1",
        "Four-bar through poses",
        "Slider-crank through poses",
        "Path generator",
        "Function generator, table",
    ],
)
def test_titles_of_machines_that_are_made(title: str) -> None:
    assert not _WORD.findall(in_language(Content(title=title), UKRAINIAN).title)


def test_names_of_machines_stay_as_they_are() -> None:
    """Also where they begin as a text of the catalogue does: "Cam {}"."""
    title = "Cam with dwells"
    said = in_language(Content(title=title, lead=f"{title}. driver formula, load constant torque"), UKRAINIAN)
    assert said.title == title
    assert said.lead == f"{title}. привод: формула, навантаження: сталий момент"


@pytest.mark.parametrize("path", MACHINES, ids=lambda path: "/".join(path.parts[-2:]))
def test_parts_that_a_check_lists(path: Path) -> None:
    """All kinds of elements, motors, toppers and diagrams of the machines that come with the package."""
    # Names that a pumping unit gives to its points are those of the file, too.
    points = set(lw.read(path).linkage.points)
    assert not {text for text in _english(["check", str(path)]) if not set(text.split(", ")) <= points}
