"""Cards of a field day by the command: files, table, verdicts, wrong cards, what is written."""

from __future__ import annotations

import csv
import json

import numpy as np
import pytest
from tests.rods.test_many_cards import card_of
from tests.samples.command_line import invoke
from tests.samples.wells import well

import linkwright as lw
from linkwright.rods.card import SurfaceCard

HEAD = "position [in], load [lbf]"


@pytest.fixture(scope="module")
def day(tmp_path_factory):
    """A well, and cards of three fillages with one that is not closed and one that is no card."""
    folder = tmp_path_factory.mktemp("well")
    lw.write(well(), folder / "well.toml")
    cards = folder / "day"
    cards.mkdir()
    for n, fillage in enumerate((1.0, 0.8, 0.6)):
        card = card_of(fillage, 200)
        rows = zip(card.position / 0.0254, card.load / 4.4482216152605, strict=True)
        (cards / f"{n}.csv").write_text("\n".join([HEAD, *(f"{u:.17g}, {f:.17g}" for u, f in rows)]), "utf-8")
    half = (cards / "0.csv").read_text("utf-8").splitlines()[:110]
    (cards / "half.csv").write_text("\n".join(half), "utf-8")
    (cards / "text.csv").write_text(f"{HEAD}\n1, 2\n3\n", "utf-8")
    (folder / "list.csv").write_text("file\nday/1.csv\nday/2.csv\n", "utf-8")
    return folder


def answer_of(folder, cards, *words):
    """Exit code, and what the command says as JSON of cards below a folder."""
    done = invoke("rods", folder / "well.toml", "--cards", folder / cards, "--json", *words)
    return done.exit_code, json.loads(done.stdout)


def test_cards_of_a_folder_are_diagnosed_and_wrong_ones_stop_none(day):
    """Each number is that of the single card; wrong cards are findings, with exit code 1."""
    code, answer = answer_of(day, "day", "--damping", "0.5")
    found = answer["results"]["card_diagnoses"]
    assert code == 1
    assert answer["findings"] == ["2 of 5 cards were not diagnosed."]
    assert found["names"] == ["0.csv", "1.csv", "2.csv", "half.csv", "text.csv"]
    assert found["verdicts"] == ["full pump", "partial fillage", "partial fillage", *["not diagnosed"] * 2]
    assert "does not close" in found["faults"][3]
    assert "text.csv:3" in found["faults"][4]
    assert found["fillage"]["text.csv"] is None
    card = lw.read_card(day / "day" / "1.csv")
    one = lw.diagnose_card(well(), card.position, card.load, damping=0.5)
    for name in ("load_max", "plunger_stroke", "fluid_load", "production", "power_pump"):
        assert found[name]["1.csv"] == pytest.approx(getattr(one, name), rel=4e-3), name
    assert found["loading_max"]["1.csv"] == pytest.approx(one.stress.loading_max, rel=5e-3)


def test_a_pattern_and_a_list_take_some_cards_of_the_day(day):
    """The same numbers as in the folder, exit code 0 where all are cards."""
    code, listed = answer_of(day, "list.csv", "--damping", "0.5")
    assert code == 0
    _, patterned = answer_of(day, "day/[12].csv", "--damping", "0.5")
    assert listed["results"] == patterned["results"]
    assert listed["results"]["card_diagnoses"]["names"] == ["1.csv", "2.csv"]


def test_overloaded_rods_are_a_verdict_of_each_card(day):
    """With half the service factor no section keeps the Goodman diagram: permissible (T/4 + 0.5625 S) SF."""
    words = ("--damping", "0.5", "--set", "rod_string.service_factor=0.5")
    code, answer = answer_of(day, "list.csv", *words)
    found = answer["results"]["card_diagnoses"]
    assert code == 1
    assert found["verdicts"] == ["rods overloaded"] * 2
    assert all(loading > 1 for loading in found["loading_max"].values())
    assert answer["findings"][0].startswith("2 of 2 cards show overloaded rods")


def test_the_tables_that_are_written_hold_the_numbers_of_json(day, tmp_path):
    """CSV and Parquet, a row a card, read back exactly."""
    parquet = pytest.importorskip("pyarrow.parquet")
    out = tmp_path / "out"
    _, answer = answer_of(day, "day", "--damping", "0.5", "--parquet", "--out", out)
    found = answer["results"]["card_diagnoses"]
    with (out / "cards.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    columns = parquet.read_table(out / "cards.parquet").to_pydict()
    assert [row["verdict"] for row in rows] == columns["verdict"] == found["verdicts"]
    for head, name in (("load_max [N]", "load_max"), ("production [m³/s]", "production")):
        numbers = [found[name][card] for card in found["names"]]
        assert [float(row[head]) if row[head] else None for row in rows] == numbers
        assert [None if np.isnan(x) else x for x in columns[head]] == numbers


def test_the_damping_is_fitted_to_the_cards_that_are_sound():
    """Wrong cards at all places that are looked at first: the others are fitted, as they are alone."""
    card = card_of(0.7, 144)
    wrong = SurfaceCard(card.position[::-1], card.load[::-1], card.period)
    alone = lw.diagnose_cards(well(), [card])
    many = lw.diagnose_cards(well(), [*[wrong] * 5, card, *[wrong] * 5])
    assert many.damping == alone.damping
    assert many.fillage[5] == alone.fillage[0]
    assert [*map(bool, many.faults)] == [True] * 5 + [False] + [True] * 5


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--cards", "{day}/0.csv"), "--card reads a single card"),
        (("--cards", "{day}/t*.csv"), "none of 1 could be fitted"),
        (("--cards", "{day}/t*.csv", "--damping", "0.5"), "none of 1 could be diagnosed"),
        (("--cards", "{day}/*.txt"), "found no files"),
        (("--cards", "{day}/nothing.csv"), "no such file"),
        (("--cards", "{day}", "--card", "{day}/0.csv"), "expected one of them"),
        (("--cards", "{day}", "--harmonics", "9"), "it belongs to --card"),
        (("--parquet",), "it belongs to --cards"),
        (("--damping", "0.5"), "it belongs to --card or --cards"),
    ],
)
def test_wrong_words_of_a_day_are_refused(day, words, message):
    """Exit code 2, and a message that says what to do."""
    done = invoke("rods", day / "well.toml", *(word.format(day=day / "day") for word in words))
    assert done.exit_code == 2
    assert message in done.stderr


def test_a_report_of_the_day_has_its_tables_in_both_languages(day, tmp_path):
    """Ranges, cards and reasons; Ukrainian leaves no English verdict."""
    for lang, verdict in (("en", "partial fillage"), ("uk", "часткове наповнення")):
        page = tmp_path / f"{lang}.html"
        words = ("--to", page, "--lang", lang, "rods", day / "well.toml", "--cards", day / "day")
        assert invoke("report", *words).exit_code == 1
        text = page.read_text("utf-8")
        assert verdict in text
        assert "half.csv" in text
        assert ("partial fillage" in text) == (lang == "en")
