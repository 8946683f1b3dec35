"""The report: it holds the numbers that were computed, is sound HTML, and needs nothing from outside."""

from __future__ import annotations

import json
import re
from functools import cache
from html.parser import HTMLParser
from pathlib import Path

import pytest

from linkwright import InputError, loads, read, study, write_report
from linkwright.app.report.page import report_html
from linkwright.app.study import Study
from linkwright.kernel.files.library import template, templates
from linkwright.kernel.reader.numbers import number
from linkwright.kernel.reader.sentences import sentence

TWO_CARTS = Path(__file__).parents[2] / "machines" / "roller_two_carts.toml"

ALONE = 'format = 1\nname = "A crank & nothing else <b>"\n[mechanism.cranks.A]\nradius = 0.1\n'

# Name of the case → machine text and overrides.
CASES: dict[str, tuple[str, tuple[str, ...]]] = {
    **{name: (template(name), ()) for name in templates() if loads(template(name)).train is None},
    "alone": (ALONE, ()),
    "no motor": (TWO_CARTS.read_text(encoding="utf-8"), ("drive={}",)),
    "does not start": (TWO_CARTS.read_text(encoding="utf-8"), ("drive.motor.torque_start=40 N m",)),
    "stalls": (
        TWO_CARTS.read_text(encoding="utf-8"),
        ("drive.motor.torque_start=90 N m", "drive.motor.torque_breakdown=135 N m"),
    ),
    "no steady motion": (TWO_CARTS.read_text(encoding="utf-8"), ("drive.gearbox.ratio=3",)),
    "does not close": (TWO_CARTS.read_text(encoding="utf-8"), ("mechanism.sliders.cart1.rod=0.1",)),
    "closes nowhere": (
        template("four-bar"),
        ("mechanism.rockers.C.coupler=0.01", "mechanism.rockers.C.rocker=0.01"),
    ),
    "constant speed": (
        ALONE,
        ('drive.motor={kind="constant_speed", speed=5}', "bodies.A.mass=1"),
    ),
}

# Elements of HTML that have no end.
VOID = {"meta", "input", "link", "br", "hr", "img"}


class Page(HTMLParser):
    """Reads a page: elements that are open, what is loaded, names that are given twice, the words."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.wrong: list[str] = []
        self.loaded: list[str] = []
        self.names: list[str] = []
        self.words: list[str] = []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        self.names += [given["id"] or ""] if "id" in given else []
        self.loaded += [
            value or "" for key, value in attrs if key in ("src", "href", "srcset", "data", "action")
        ]
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.handle_starttag(tag, attrs)
        if tag not in VOID:
            self.open.pop()

    def handle_endtag(self, tag: str) -> None:
        if not self.open or self.open.pop() != tag:
            self.wrong.append(f"</{tag}> at {self.getpos()}")

    def handle_data(self, data: str) -> None:
        self.words.append(data)


@cache
def studied(case: str) -> Study:
    text, overrides = CASES[case]
    return study(loads(text, overrides))


@cache
def page(case: str) -> str:
    return report_html(studied(case))


@pytest.mark.parametrize("case", CASES)
def test_page_is_well_formed(case: str) -> None:
    found = Page(page(case))
    assert not found.wrong
    assert not found.open
    twice = {name for name in found.names if found.names.count(name) > 1}
    assert not twice


@pytest.mark.parametrize("case", CASES)
def test_page_needs_nothing_from_outside(case: str) -> None:
    text = page(case)
    assert all(target.startswith("#") for target in Page(text).loaded)
    assert not re.search(r"@import|url\((?!#)", text)
    # A name of a vocabulary loads nothing, but is not needed either.
    assert not re.search(r"https?://", text)


@pytest.mark.parametrize("case", CASES)
def test_page_tells_findings_and_warnings(case: str) -> None:
    words = "".join(Page(page(case)).words)
    for text in (*studied(case).findings, *studied(case).warnings, studied(case).machine.name):
        assert sentence(text) in words


def test_page_holds_the_numbers() -> None:
    found, words = studied("two-carts"), "".join(Page(page("two-carts")).words)
    steady, reduced, run_up = found.steady_state, found.reduction, found.run_up
    assert steady is not None
    assert reduced is not None
    assert run_up is not None
    values = [steady.unevenness, steady.dynamism, steady.motion_coefficient, steady.unevenness_time]
    values += [steady.speed_min, steady.speed_max, steady.acceleration_min, steady.torque_motor_rms]
    values += [reduced.inertia_min, reduced.torque_load_mean, run_up.time, run_up.turns]
    for value in values:
        assert number(value) in words


def test_page_is_the_same_in_every_run() -> None:
    assert report_html(studied("press")) == page("press")


def test_page_says_how_to_repeat_it() -> None:
    text = report_html(studied("alone"), command="linkwright run a.toml --set 'x=1 & 2'")
    words = "".join(Page(text).words)
    assert "linkwright run a.toml --set 'x=1 & 2'" in words


def test_machine_in_the_page_is_the_machine_computed() -> None:
    words = "".join(Page(page("does not start")).words)
    text = words[words.index("format = 1") :].split("\n\n\n")[0]
    assert loads(text.rstrip()) == studied("does not start").machine


@pytest.mark.parametrize("case", CASES)
def test_words_of_a_file_are_no_markup(case: str) -> None:
    assert "else <b>" not in page(case)


def test_figures_are_those_that_there_is_something_to_show_for() -> None:
    figures = {case: set(re.findall(r'id="figure-(\w+)"', page(case))) for case in CASES}
    forces = {"forces", "hodograph", "polar"}
    motion = {"motion_1", "transmission"}
    everything = {"reduction", "speed", "torque", "time", "motor", "run_up"} | motion | forces
    assert figures["two-carts"] == everything
    assert figures["stalls"] == everything
    assert figures["does not start"] == everything - {"run_up"}
    assert figures["no steady motion"] == {"reduction", "motor"} | motion
    # Without mass, load and motor there is nothing but motion, and of a crank alone not even that to show.
    assert figures["alone"] == set()
    assert figures["constant speed"] == {"reduction", "speed", "torque", "time"} | forces
    assert figures["does not close"] == motion


def test_write_report(tmp_path: Path) -> None:
    path = tmp_path / "report.html"
    write_report(studied("alone"), path)
    assert path.read_text(encoding="utf-8") == page("alone")
    with pytest.raises(InputError, match="cannot be written"):
        write_report(studied("alone"), tmp_path / "missing" / "report.html")


def test_sketch_data_is_in_the_page() -> None:
    found = re.search(r'<script type="application/json" id="scene">(.*?)</script>', page("press"))
    assert found is not None
    assert set(json.loads(found[1])["points"]) == {"O", "A", "ram"}
    assert 'id="scene"' not in page("closes nowhere")


def test_overrides_reach_the_page() -> None:
    changed = study(read(TWO_CARTS, ["bodies.cart1.mass=1234 kg"]))
    assert "1234 kg" in report_html(changed)
