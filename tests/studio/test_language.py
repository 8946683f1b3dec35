"""The studio in another language: nothing that it says is left in English."""

import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import linkwright as lw
from linkwright.studio import analyses, worker
from linkwright.studio.controls import controls
from linkwright.studio.language import in_words, page_texts, spoken

from .conftest import Tab

ROOT = Path(__file__).parents[2]
MACHINES = sorted([*ROOT.glob("machines/*.toml"), *ROOT.glob("examples/*/machine.toml")])

# What stands as files have it: words in quotes, names of tables and entries; and the words of choices.
KEPT = re.compile(r'"[^"]*"|`[^`]*`|\[[\w.]+\]|[A-Za-z_]*_\w+|\b(?:true|false|alloy|carbon|other)\b')


def english(text: str) -> list[str]:
    """English words of a text; units, symbols and functions are shorter."""
    return re.findall(r"\b[a-z]{4,}\b", KEPT.sub(" ", text))


def texts(group: dict[str, Any]) -> Iterator[str]:
    """What the controls of a file say."""
    for entry in (group, *group.get("entries", ()), *group.get("missing", ())):
        yield from (entry[key] for key in ("about", "expected") if entry.get(key))
    for inner in group["groups"]:
        yield from texts(inner)


@pytest.mark.parametrize("path", MACHINES, ids=lambda path: path.parent.name + "." + path.stem)
def test_controls_are_translated(path: Path) -> None:
    said = {text: in_words(text, "uk", "about") for text in texts(controls(tomllib.loads(path.read_text())))}
    assert not {text: words for text, words in said.items() if english(words)}


# What has a name in the rules, and formulas and laws that are named after their authors.
NAMED = re.compile(
    r"PC\d|IA super|iacs m68|kr crankshaft|mark ii|carter|ker wilson|woschni|wiebe|zimanenko|[\d /]+|.{1,2}"
)


def labels(group: dict[str, Any]) -> Iterator[str]:
    """Keys and choices of the controls of a file; a table without a description is named by its author."""
    for entry in (*group["entries"], *group.get("missing", ())):
        yield from (entry["key"], *(entry.get("choices") or ()))
    for inner in group["groups"]:
        yield from (*([inner["key"]] if inner["about"] else []), *labels(inner))


@pytest.mark.parametrize("path", MACHINES, ids=lambda path: path.parent.name + "." + path.stem)
def test_keys_and_choices_of_controls_are_translated(path: Path) -> None:
    words = {label.replace("_", " ") for label in labels(controls(tomllib.loads(path.read_text())))}
    assert not {word for word in words - page_texts("uk")["texts"].keys() if not NAMED.fullmatch(word)}


def test_what_is_quoted_stays_as_files_have_it() -> None:
    text = 'an angle greater than 0, such as "30 deg" or a number in radians'
    assert in_words(text, "uk", "expected") == 'кут, більше 0, наприклад "30 deg", або число в радіанах'


def test_a_list_is_translated_part_by_part() -> None:
    title = "torque of the motor, driving torque at the crank, …"
    assert in_words(title, "uk", "title") == "момент двигуна, рушійний момент на кривошипі, …"


def test_only_texts_are_translated() -> None:
    body = {"of": "machine", "results": [{"name": "steady_state", "word": "crank angle", "unit": "rad"}]}
    said = in_words(body, "uk")
    assert said["results"] == [{"name": "steady_state", "word": "кут кривошипа", "unit": "rad"}]
    assert said["of"] == "machine"


def test_the_page_has_its_units_and_decimal_sign() -> None:
    texts = page_texts("uk")
    assert (texts["decimal"], texts["units"]["N"], texts["texts"]["Save"]) == (",", "Н", "Зберегти")


def test_an_unknown_language_is_refused() -> None:
    """A language without a catalogue leaves the tab in the one that it speaks."""
    from linkwright.studio.files import Folder
    from linkwright.studio.session import Session
    from linkwright.studio.wire import packed

    session = Session(Folder.of(ROOT), lambda _: None)
    session.take(packed(1, {"ask": "language", "code": "uk"}))
    assert session.language == "uk"
    session.take(packed(2, {"ask": "language", "code": "../uk"}))
    assert session.language == "uk"


def test_another_language_says_slow_analyses_anew_and_computes_nothing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    text = (ROOT / "machines" / "roller_two_carts.toml").read_text()
    computed = []
    study = analyses._LANES["study"]
    counted = study._replace(found=lambda machine: computed.append(machine) or study.found(machine))
    monkeypatch.setitem(analyses._LANES, "study", counted)
    worker._found.cache_clear()
    english, ukrainian = (
        analyses.said(worker._found(text, "", "study"), "study", spoken(code)) for code in ("en", "uk")
    )
    assert len(computed) == 1
    assert english.results == ukrainian.results
    assert english.tables[0]["title"] != ukrainian.tables[0]["title"]


def test_slow_analyses_answer_in_the_language_that_was_chosen_last(tab: Tab) -> None:
    text = (ROOT / "machines" / "v8_diesel.toml").read_text()
    tab.ask(ask="compute", text=text)
    tab.send(ask="language", code="uk")
    last = tab.send(ask="compute", text=text)
    while True:
        number, answer = tab.hear()
        if answer["of"] == "beside":
            break
    assert number == last
    assert not [words for words, *_ in answer["headline"] if english(words)]


def test_plots_of_forces_say_of_what_and_names_stay() -> None:
    results = analyses.fast(lw.read("roller_cam"), held=False).results
    plots = {plot["key"]: plot for result in results for plot in result["plots"]}
    pushed = plots["forces.cart_drive"]
    assert (pushed["title"], pushed["unit"]) == ("force of the drive cart", "N")
    assert plots["forces.cart.guide_x"]["title"] == "force in cart.guide"
    assert plots["forces.loads.rolling"]["title"] == "load rolling"
    assert plots["forces.shaking_force_x"]["title"] == "shaking force"
    spoken = in_words({"plots": list(plots.values())}, "uk")["plots"]
    assert next(plot["title"] for plot in spoken if plot["key"] == "forces.cart_drive") == "сила приводу cart"
    # A disc may be called "motor": it stays so in its curves.
    curve = {"name": "motor", "word": "motor", "own": True}
    assert in_words(curve, "uk") == curve
    turned = analyses.fast(lw.read("roller_two_carts"), held=False).results
    units = {plot["key"]: plot["unit"] for result in turned for plot in result["plots"]}
    assert units["forces.A1_drive"] == "N m"
