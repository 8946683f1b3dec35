"""Claims of all papers: verdicts and texts follow from the numbers."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from linkwright import InputError
from linkwright.papers.claim import judged, tolerance
from linkwright.papers.page import conclusion, filled, rounded_up, shown
from linkwright.papers.paper import PAPERS, Paper, paper, printed_values

# Keys of the files of data whose texts are prose of ours; what is printed is quoted as it is.
PROSE = ("name", "text", "computed", "because", "verdict", "about", "title", "about_figures", "captions")

# A number that somebody measured or computed: with a decimal point, or before a unit.
TYPED = re.compile(r"\d+\.\d|\d+\s?(?:°|%|mm\b|m\b|m/s|N\b|kN\b|rpm\b|Hz\b|rad/s|times\b|turns?\b)")


@pytest.fixture(scope="module")
def papers() -> dict[int, Paper]:
    return {number: paper(number) for number in PAPERS}


def prose(data: Any, key: str = "") -> Iterator[str]:
    """All texts under the keys of `PROSE`, titles of the papers and names of drives aside."""
    if isinstance(data, dict):
        for name, value in data.items():
            yield from prose(value, key if key in ("verdict", "captions") else name)
    elif isinstance(data, list):
        for each in data:
            yield from prose(each, key)
    elif isinstance(data, str) and key in PROSE:
        yield data


@pytest.mark.parametrize("number", PAPERS)
def test_no_number_is_typed_into_prose(number: int) -> None:
    texts = [re.sub(r"\{[^}]*\}", "", text) for text in prose(printed_values(number))]
    assert texts
    assert [text for text in texts if TYPED.search(text)] == []


@pytest.mark.parametrize("number", PAPERS)
def test_every_claim_has_its_place_and_what_judges_it_a_reason(number: int) -> None:
    for claim in printed_values(number)["claim"]:
        assert claim["where"]
        if {"quantity", "difference", "deviation"} & set(claim):
            assert len(tolerance(claim["tolerance"]).why) > 20
        if {"quantity", "difference"} & set(claim):
            assert claim["because"]
        if "holds" in claim:
            # Words for what the statement comes to, but for those that are plainly reproduced or not.
            assert claim.get("verdict") or "in_part" not in claim


@pytest.mark.parametrize("number", PAPERS)
def test_every_conclusion_holds(papers: dict[int, Paper], number: int) -> None:
    assert papers[number].conclusions
    for text in papers[number].conclusions:
        assert not text.startswith("Not so")
        assert not re.search(r"[{}]|\bnan\b|\bNone\b", text)


@pytest.mark.parametrize("number", PAPERS)
def test_a_conclusion_that_the_numbers_contradict_says_so(papers: dict[int, Paper], number: int) -> None:
    for data in papers[number].published["conclusion"]:
        values = dict(papers[number].values)
        *steps, last = data["holds"].split(".")
        assert not steps or steps[0] == "demands"
        at = values
        for step in steps:
            at[step] = dict(at[step])
            at = at[step]
        at[last] = False
        assert conclusion(data, values).startswith("Not so by the numbers computed")


def test_a_verdict_follows_the_printed_number(papers: dict[int, Paper]) -> None:
    """Every printed number, changed by a percent and by half, becomes near and far."""
    tried = 0
    for found in papers.values():
        for claim in found.published["claim"]:
            if "quantity" in claim and judged(claim, found.values).kind == "reproduced":
                value = judged({**claim, "value": claim["quantity"]}, found.values)
                assert value.verdict == "reproduced"
                computed = float(re.split("[…  ]", value.printed)[0])
                kinds = [judged({**claim, "value": computed * by}, found.values).kind for by in (1.01, 1.5)]
                assert kinds == ["near", "far"]
                tried += 1
    assert tried == 14


def test_a_verdict_follows_the_difference_and_the_statement(papers: dict[int, Paper]) -> None:
    for found in papers.values():
        for claim in found.published["claim"]:
            if "difference" in claim or "deviation" in claim:
                form = "difference" if "difference" in claim else "deviation"
                values = found.values | {"off": 0.5, "none": 0.0}
                assert judged({**claim, form: "off"}, values).kind == "far"
                assert judged({**claim, form: "none"}, values).kind == "reproduced"
            elif "holds" in claim:
                values = found.values | {"yes": True, "no": False}
                assert judged({**claim, "holds": "yes"}, values).kind == "reproduced"
                assert judged({**claim, "holds": "no", "in_part": "yes"}, values).kind == "near"
                assert judged({**claim, "holds": "no", "in_part": "no"}, values).kind == "far"


def test_no_such_paper() -> None:
    for number in (0, 6):
        with pytest.raises(InputError, match=f"no paper {number}; there is 1, 2, 3, 4, 5"):
            paper(number)


def test_words_of_values() -> None:
    assert shown(None, ".2f") == "–"
    assert shown(0.0123, ".1f %") == "1.2 %"
    assert shown(0.0123, ".1f (mm)") == "12.3"
    assert shown(-np.pi / 6, ".0f °") == "−30°"
    assert shown((0.25, 0.3), ".2f") == "0.25…0.30"
    assert shown((0.1, 0.2), ".0f mm") == "100…200 mm"
    assert shown([1, 2, 3], "") == "1, 2, 3"
    assert shown((), ".0f mm") == "none"
    assert shown(np.bool_(False), "yes|no") == "no"
    assert shown(0.000071, "up1 %") == "0.008 %"
    assert rounded_up(0.041, 1) == "0.05"
    with pytest.raises(KeyError):
        shown(1.0, ".1f furlong")


def test_a_field_is_a_name_with_points() -> None:
    values = {"a": [{"b c": 1.5}], "d": np.array([2.0, 3.0])}
    assert filled("{a.0.b c:.1f}\n  and {d.1:g}, {d.size}", values) == "1.5 and 3, 2"
    with pytest.raises(KeyError):
        filled("{nothing}", values)
