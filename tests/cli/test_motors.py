"""``linkwright motors``: what is asked for and no other, in SI, estimated inertias marked."""

from __future__ import annotations

import json
from typing import Any

import pytest
from command_line import invoke

import linkwright as lw


def asked(*words: str) -> list[dict[str, Any]]:
    done = invoke("motors", *words, "--json")
    assert done.exit_code == 0, done.output
    found: list[dict[str, Any]] = json.loads(done.stdout)["results"]["motors"]
    return found


def test_all_motors_are_listed_once_with_an_inertia() -> None:
    found = asked()
    assert sorted(each["type"] for each in found) == sorted(each.type for each in lw.motors())
    assert all(each["inertia"] > 0 for each in found)
    printed = {each.type for each in lw.motors() if each.inertia is not None}
    assert {each["type"] for each in found if not each["inertia_is_estimated"]} == printed


def test_what_is_asked_for_narrows_the_list() -> None:
    found = asked("--poles", "6", "--power-min", "5.5 kW", "--series", "4A")
    wanted = [
        each.type
        for each in lw.motors()
        if each.poles == 6 and each.power_rated >= 5500 and each.series == "4A"
    ]
    assert sorted(each["type"] for each in found) == sorted(wanted)
    powers = [each["power_rated"] for each in found]
    assert powers == sorted(powers)


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--poles", "3"], "2, 4, 6, 8 poles"),
        (["--series", "AIQ"], '"AIR"'),
        (["--series", "AIR", "--poles", "4"], "2, 6, 8 poles"),
        (["--power-min", "9 MW"], '--power-min: found "9 MW", expected at most 75 kW'),
        (["--power-min", "9 kg"], "a power"),
    ],
)
def test_what_the_catalogue_does_not_have_is_told(words: list[str], told: str) -> None:
    done = invoke("motors", *words)
    assert done.exit_code == 2
    assert told in done.stderr


def test_a_dash_and_one_letter_ask_for_help() -> None:
    for words in (["-h"], ["run", "-h"], ["cam", "search", "-h"]):
        done = invoke(*words)
        assert done.exit_code == 0
        assert "Usage" in done.stdout
