"""Reports of all machines and of all commands, also of what these cannot do, have no English in Ukrainian."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from tests.cli.test_answer import CASES, NEVER, call, known
from tests.report.test_language import UKRAINIAN, Watched

from linkwright.app.commands.report import _content
from linkwright.drive.batch import FAST_STARTS, STATUS
from linkwright.kernel.page.language import in_language
from linkwright.studies.rows import NO_NUMBER, OPEN

__all__ = ["known"]

ROOT = Path(__file__).parents[2]
MACHINES = sorted([*ROOT.glob("machines/*.toml"), *ROOT.glob("examples/*/machine.toml")])

# What is no word: addresses, paths, names with digits, symbols with an index, what stands in quotes.
_NO_WORDS = re.compile(r"\"[^\"]*\"|\S*[/._\d]\S*|--[a-z]+")
_WORD = re.compile(r"[A-Za-z]{4,}")
# Names of rules, formulas and motors, of parts that a pumping unit stands for, and of the tasks here.
_NAMES = {"IACS", "pole", "carter", "zimanenko", "hoeken", "beam", "delta", "torsiograph"}


def _english(words: list[str]) -> set[str]:
    """Texts of the report of a command that are English still in Ukrainian."""
    content = _content(words, "")
    watched = Watched(UKRAINIAN.code, UKRAINIAN.texts, UKRAINIAN.units, UKRAINIAN.decimal)
    in_language(content, watched)
    # What the file says of itself, and what it names: a name in a sentence is asked for by itself.
    own = " ".join([content.title, content.lead, content.source, content.papers, str(content.groups)])
    files = " ".join(path.read_text(encoding="utf-8") for path in map(Path, words) if path.is_file())
    named = set(re.findall(r"\w+", files))
    names = _NAMES | {word for _, parts in content.groups for part in parts for word in part.name.split()}
    left = (text for text in watched.left if text not in own and text.strip(":") not in named)
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
    ],
)
def test_sentences_of_studies(text: str) -> None:
    said = UKRAINIAN(text)
    assert not re.findall("[A-Za-z]{2,}", said), said


@pytest.mark.parametrize("text", [*list(STATUS.values())[1:], *FAST_STARTS.values(), OPEN, NO_NUMBER])
def test_what_becomes_of_a_row_of_a_study(text: str) -> None:
    said = UKRAINIAN(f"3 rows: {text}").replace("(linkwright transient)", "")
    assert not _WORD.findall(_NO_WORDS.sub(" ", said)), said
