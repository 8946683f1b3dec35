"""Names of motors that the catalogue does not have, and a screw whose travel ends."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from command_line import invoke

from linkwright import MachineError, motors
from linkwright.drive import motor

LIFT = str(Path(__file__).parents[2] / "examples" / "scissor_lift" / "machine.toml")


@pytest.mark.parametrize(
    ("name", "poles"),
    [
        ("IE3 5.5 kW 6-pole", 6),
        ("IE3 7 kW 4-pole frame 132", 4),
        ("IE3 5.5 kW 4-pole", 4),
        ("4A999S6U3", 6),
        ("AIR 6 kW 2-pole", 2),
        ("4A160X8U3", 8),
    ],
)
def test_motors_of_that_number_of_poles_are_named(name: str, poles: int) -> None:
    with pytest.raises(MachineError) as error:
        motor(name)
    said = str(error.value)
    named = [one for one in motors() if f'"{one.type}"' in said or f"mean {one.type}?" in said]
    assert named, str(error.value)
    assert {one.poles for one in named} == {poles}


def test_a_number_of_poles_that_no_motor_has() -> None:
    with pytest.raises(MachineError, match="the catalogue has motors with 2, 4, 6, 8 poles"):
        motor("IE3 5.5 kW 10-pole")


def test_a_screw_that_ends_is_no_finding() -> None:
    """The lift closes over 300 revolutions of its screw, and no crank is asked to rotate."""
    for command in ("run", "check"):
        result = invoke(command, LIFT, "--json")
        assert result.exit_code == 0, result.stdout
        said = json.loads(result.stdout)
        assert said["findings"] == []
        (words,) = [text for text in said["warnings"] if "closes only" in text]
        assert "drive angles -4500.00° to 103500.00°" in words
        assert "crank" not in words


def test_a_screw_has_no_crank(tmp_path: Path) -> None:
    """Tables, warnings and report of the lift speak of its drive; only keys say crank."""
    invoke("run", LIFT, "--out", tmp_path / "out")
    for command in ("run", "check", "motion"):
        said = invoke(command, LIFT).stdout
        assert said
        assert "crank" not in said.replace("crank_angle", ""), command
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    text = re.sub(r"<(script|style|math).*?</\1>", "", page, flags=re.DOTALL)
    text = re.sub(r"<[^>]+>", " ", text)
    # A formula is headed by it, motion reduced to the crank, and a key of the data has it.
    assert len(re.findall(r"[Cc]rank (?!&|=|\w+ rod)", text)) <= 2
