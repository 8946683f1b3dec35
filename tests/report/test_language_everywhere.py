"""Reports of all machines and of all commands, also of what these cannot do, have no English in Ukrainian."""

from __future__ import annotations

import re
import tomllib
from functools import cache
from pathlib import Path

import pytest
from tests.cli.test_answer import CASES, NEVER, call, known
from tests.report.test_language import UKRAINIAN, Watched

import linkwright as lw
from linkwright.app.commands.report import _content
from linkwright.drive.batch import FAST_STARTS, STATUS
from linkwright.kernel.page.content import Content
from linkwright.kernel.page.language import in_language
from linkwright.studies.point_responses import OPEN
from linkwright.studies.rows import NO_NUMBER
from linkwright.synthesis.straight_line import straight_lines

__all__ = ["known"]

ROOT = Path(__file__).parents[2]
MACHINES = sorted([*ROOT.glob("machines/*.toml"), *ROOT.glob("examples/*/machine.toml")])
PAPERS = [path.read_text(encoding="utf-8") for path in ROOT.glob("python/linkwright/papers/*/paper?.toml")]

# What is no word: addresses, paths, names with digits, symbols with an index, what stands in quotes.
_NO_WORDS = re.compile(r"\"[^\"]*\"|\S*[/._\d]\S*|--[a-z]+")
_WORD = re.compile(r"[A-Za-z]{4,}")
# Names of rules, formulas and motors, of parts that a pumping unit stands for, and of the tasks here.
_NAMES = {
    "Linkwright",
    "IACS",
    "pole",
    "carter",
    "zimanenko",
    "hoeken",
    "beam",
    "rotator",
    "saddle",
    "delta",
    "torsiograph",
}


@cache
def _said_by(text: str) -> list[str]:
    """Name and description of a machine file, or the title of a paper, as far as it is one."""
    try:
        tables = tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        return []
    return [str(tables.get(key, "")) for key in ("name", "description", "title")]


def _is_names(text: str, files: str) -> bool:
    """Whether a text is a list of names of the files, of parts of what they name, or of their keywords."""
    return all(part.split(".")[0].replace("_", " ") in files for part in re.split(r", | \(|\)|:", text))


def _english(words: list[str]) -> set[str]:
    """Texts of the report of a command that are English still in Ukrainian."""
    content = _content(words, "")
    watched = Watched(
        UKRAINIAN.code, UKRAINIAN.texts, UKRAINIAN.units, UKRAINIAN.decimal, UKRAINIAN.keys, UKRAINIAN.titles
    )
    in_language(content, watched)
    files = [path.read_text(encoding="utf-8") for path in map(Path, words) if path.is_file()]
    # What files say of themselves, and what they name: a name in a sentence is asked for by itself.
    machines = [*(path.read_text(encoding="utf-8") for path in MACHINES), *files]
    said = [text for file in machines + PAPERS for text in _said_by(file)]
    own = " ".join([*said, content.source, content.papers, str(content.groups)])
    listed = " ".join(files).replace("_", " ")
    named = [*content.names, *(part.name for _, parts in content.groups for part in parts)]
    names = _NAMES | {word for name in named for word in name.split()}
    left = (text for text in watched.left if text.rstrip(".") not in own and not _is_names(text, listed))
    return {text for text in left if set(_WORD.findall(_NO_WORDS.sub(" ", text))) - names}


def _calls() -> list[tuple[str, str]]:
    """A study of each machine, and the vibration of each train."""
    texts = {str(path): path.read_text(encoding="utf-8") for path in MACHINES}
    trains = [path for path, text in texts.items() if "[train" in text]
    others = [path for path, text in texts.items() if path not in trains or "[mechanism" in text]
    return [*(("run", path) for path in others), *(("torsion", path) for path in trains)]


@pytest.mark.parametrize(("command", "path"), _calls(), ids=lambda text: "/".join(Path(text).parts[-2:]))
def test_a_machine(command: str, path: str) -> None:
    assert not _english([command, path])


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
        "4 machines computed, 2 without an answer",
        "x is at its maximum, 0.1 m; y is at the lower end of its range, 3 kg",
        "0.001 m more at the upper end of y would make x 0.001 m larger",
        "derivatives exact",
        "cost 3 instead of 4.2; yield 99 % (98 to 100 %) instead of 97 %",
        "held down by x, y",
        "no constraint holds them down: they are as wide as the search goes",
        "6 samples of speed; derivatives by differences, to 3e-09; noise 0.0177 rad/s in speed",
        "in row",
        "Known worst: 2 % more mass is known to ±0.31 % (standard deviation)",
        "Known worst: 1 % more a and 0.3 % less b and 0.345 kg more c together are known to ±0.31 % "
        "(standard deviation)",
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
