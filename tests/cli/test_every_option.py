"""Every option of every command, as the commands declare them: nonsense is refused, with the option's name.

An option that says nothing beside the others would be passed over without a word: it is refused as well.
"""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable

import click
import pytest
from click.testing import Result
from tests.cli.test_answer import CASES, ask, commands, known

__all__ = ["ask", "known"]

# No number of a machine, and no name in one.
NONSENSE = ("nan", "inf", "-1e308", "1e308", "[/x]")

# Options whose value is a place for a file, or what `--set` and `--units` take: their tests are elsewhere.
ELSEWHERE = {
    "--set",
    "--units",
    "--out",
    "--log",
    "--task",
    "--record",
    "--measured",
    "--catalogue",
    "--gearboxes",
    "--study",
    "--table",
}

# Beside the first calls of the answers: the other ways of commands that have two.
OTHERS = {
    "balance": ("{roller_two_carts} --slider cart1",),
    "synthesise dead-centre": ("--stroke 1m",),
    "tolerance": ("{scatter.toml} --rows 200 --allocate 0.9",),
    "run": ("{topper}", "{roller_two_carts} --method baranov"),
    "motion": ("{roller_two_carts} --law 2*t --duration 1s", "{roller_two_carts} --at 10deg"),
    "optimise": ("{best.toml} --evaluations 20 --method global", "{best.toml} --method gradient"),
    "size": ("{roller_two_carts} --minimum-cost",),
}

# Addresses are read before anything is computed, and name themselves; a machine without damper has no shaft
# to protect.
BY_ITSELF = {"--vary", "--case", "--shaft"}

Ask = Callable[[str, str], Result]


def options() -> list[tuple[str, str, click.Option]]:
    return [
        (name, words, option)
        for name, command in commands().items()
        if name in CASES
        for words in (CASES[name].right, *OTHERS.get(name, ()))
        for option in command.params
        if isinstance(option, click.Option) and not option.is_flag and option.opts[0] not in ELSEWHERE
    ]


OPTIONS = options()


def test_all_are_here() -> None:
    assert len({(name, option.opts[0]) for name, _, option in OPTIONS}) > 80


@pytest.mark.parametrize(
    ("name", "words", "option"),
    OPTIONS,
    ids=[f"{name} {words[:30]} {o.opts[0]}" for name, words, o in OPTIONS],
)
def test_nonsense_is_refused(name: str, words: str, option: click.Option, ask: Ask) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        for value in NONSENSE:
            done = ask(name, f"{words} {option.opts[0]}={value}")
            assert done.exception is None or isinstance(done.exception, SystemExit), (value, done.exception)
            assert done.exit_code == 2, f"{option.opts[0]} {value}: {done.output[:200]}"
            assert done.stderr.strip()
            assert len(done.stderr) < 2000
            told = done.stderr.replace(value, "")
            assert not re.search(r"(?<!\w)(nan|inf|numpy)(?!\w)", told), done.stderr
            if option.opts[0] not in BY_ITSELF:
                assert option.opts[0].strip("-") in told or value in done.stderr, done.stderr


# Numbers of which a negative one has a meaning: an angle, a place, a speed or an acceleration the other way
# about, a formula.
SIGNED = {"--at", "--from-angle", "--from-speed", "--speed", "--acceleration", "--planes", "--law"}
UNITS = ("", "m", "deg", "rpm", "s", "kW", "kg*m^2", "Pa")


@pytest.mark.parametrize(
    ("name", "words", "option"),
    OPTIONS,
    ids=[f"{name} {words[:30]} {o.opts[0]}" for name, words, o in OPTIONS],
)
def test_sizes_below_zero_are_refused(name: str, words: str, option: click.Option, ask: Ask) -> None:
    if option.opts[0] in SIGNED:
        return
    for unit in UNITS:
        done = ask(name, f"{words} {option.opts[0]}=-1{unit}")
        assert done.exit_code == 2, f"{option.opts[0]} -1 {unit}: {done.output[:200]}"


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("cam search {roller_cam} --vary base_radius=0.3:0.4:3 --curvature-radius -1m", "greater than 0"),
        ("cam search {roller_cam} --vary base_radius=0.3:0.4:3 --pressure-angle -1deg", "between 0 and 90"),
        ("cam {roller_cam} --step -1deg", "greater than 0"),
        ("cam {roller_cam} --step 0deg", "greater than 0"),
        ("motors --power-min -1kW", "of 0 or more"),
    ],
)
def test_the_bound_of_a_quantity_is_said(words: str, expected: str, ask: Ask) -> None:
    name = max((name for name in CASES if words.startswith(f"{name} ")), key=len)
    done = ask(name, words.removeprefix(name))
    assert done.exit_code == 2
    assert done.stderr.startswith(f"{words.split()[-2]}: found {words.split()[-1]}, expected ")
    assert expected in done.stderr


# Options that a command does not look at, beside those that make it so.
UNUSED = (
    ("run {roller_two_carts}", "--step 3deg"),
    ("balance {roller_two_carts} --links A1", "--share 0.4"),
    ("synthesise dead-centre --swing 60deg", "--rod 3m"),
    ("synthesise dead-centre --stroke 1m", "--frame 3m"),
    ("synthesise dead-centre --stroke 1m", "--coupler-max 3"),
    ("size {roller_two_carts} --minimum-cost", "--by power"),
    ("size {roller_two_carts} --minimum-cost", "--power-reserve 2"),
    ("size {roller_two_carts} --minimum-cost", "--together"),
    ("size {roller_cam} --pressure-angle 30deg", "--unevenness 0.1"),
    ("tolerance {scatter.toml} --rows 20", "--cost-power 2"),
    ("tolerance {scatter.toml} --rows 200 --allocate 0.9", "--indices 10"),
    ("optimise {best.toml}", "--points 5"),
    ("optimise {best.toml} --method global", "--starts 5"),
    ("optimise {best.toml} --method gradient", "--evaluations 100"),
)


@pytest.mark.parametrize(("words", "unused"), UNUSED, ids=lambda each: each[-40:])
def test_what_would_say_nothing_is_refused(words: str, unused: str, ask: Ask) -> None:
    name = max((name for name in CASES if words.startswith(f"{name} ")), key=len)
    done = ask(name, f"{words.removeprefix(name)} {unused}")
    assert done.exit_code == 2, done.output[:200]
    assert done.stderr.startswith(f"{unused.split()[0]}: it belongs to "), done.stderr
