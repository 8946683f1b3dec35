"""What `size` writes is what it checked, and its headline says what decides."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from command_line import invoke

import linkwright as lw
from linkwright.sizing.checks import motion_checks

FOUND = Path(__file__).parents[1] / "found" / "use"
ONLY = "if the machine starts from its start angle only, use --by fixed-start"
PRESS = str(FOUND / "punch_press.toml")


def size(*words: str) -> tuple[int, str]:
    result = invoke("size", *words)
    return result.exit_code, " ".join(result.stdout.split())


def sized(*words: str) -> Any:
    return json.loads(invoke("size", *words, "--json").stdout)["results"]


@pytest.mark.parametrize(
    "words",
    [
        (PRESS,),
        (PRESS, "--together"),
        (PRESS, "--by", "fixed-start"),
        (PRESS, "--by", "fixed-start", "--together", "--unevenness", "0.02"),
        ("roller_one_cart",),
        ("roller_one_cart", "--together"),
    ],
)
def test_the_machine_that_is_written_has_the_checks_that_are_reported(
    tmp_path: Path, words: tuple[str, ...]
) -> None:
    """The flywheel of a press was taken off after the checks: 116 % of the peak torque reported as passed."""
    out = tmp_path / "sized.toml"
    chosen = sized(*words, "--out", str(out))["motor"]["chosen"]
    again = {check.name: check for check in motion_checks(lw.read(out)).checks}
    told = {check["name"]: check for check in chosen["checks"]}
    assert len(again) > 4
    for name, check in again.items():
        assert told[name]["passed"] == check.passed, name
        # The flywheel is found twice, to 1e-9 of its speed fluctuation.
        assert told[name]["value"] == pytest.approx(check.value, rel=1e-5), name


@pytest.mark.parametrize("by", ["all", "fixed-start"])
def test_together_never_takes_more_than_alone(by: str) -> None:
    for name in (PRESS, "roller_one_cart"):
        alone, together = (
            sized(name, "--by", by, *more)["motor"]["chosen"] for more in ((), ("--together",))
        )
        assert together["power_rated"] <= alone["power_rated"]


def test_a_press_with_its_own_flywheel(tmp_path: Path) -> None:
    """Started from its start angle 5.5 kW do, with the flywheel of the file, which stays."""
    out = tmp_path / "sized.toml"
    found = sized(PRESS, "--by", "fixed-start", "--out", str(out))
    assert found["motor"]["chosen"]["power_rated"] == 5500
    assert found["motor"]["chosen"]["flywheel_kept"]
    assert found["flywheel"]["inertia"] == pytest.approx(2.0 * 24**2)
    assert lw.read(out).drive.flywheel == lw.read(PRESS).drive.flywheel  # type: ignore[union-attr]


def test_the_headline_names_the_check_that_decides() -> None:
    for more in ((), ("--together",)):
        code, text = size(PRESS, *more)
        assert code == 0
        head = text[: text.index("The motor in the file")]
        assert "decisive check: starting torque, worst angle; IE2 5.5 kW 4-pole frame 132S, 5.5 kW" in head
        assert "is unknown and counts as failed" in head
        assert "its rated power is 24.3 times the power required is a start under load meant?" in head
        assert "use --by fixed-start" in head
    assert sized(PRESS)["motor"]["decided_by"] == "starting_torque_worst"


def test_not_all_checks_are_passed_where_a_row_fails() -> None:
    _, text = size(str(FOUND / "servo_carriage.toml"), "--catalogue", str(FOUND / "motors.csv"))
    assert "passes all checks" not in text
    assert "passes all decisive checks not decisive: inertia ratio 227 % of the limit" in text


@pytest.mark.parametrize("more", [(), ("--by", "fixed-start")])
def test_the_headline_in_ukrainian(more: tuple[str, ...]) -> None:
    """No part of the headline stays English."""
    from linkwright.kernel.reader.language import language

    ukrainian = language("uk")
    _, text = size(PRESS, *more)
    head = text[text.index("IE") : text.index("The motor in the file")]
    for line in head.split(" decisive check: ")[0].split("; "):
        assert ukrainian(line) != line
    for line in ("its rated power is 24.3 times the power required", "is a start under load meant? " + ONLY):
        assert (line in text) == (not more)
        assert ukrainian(line) != line
    assert ukrainian("decisive check: starting torque, worst angle").isascii() is False
    assert "known" not in ukrainian("not decisive: starting torque, worst angle not known")
