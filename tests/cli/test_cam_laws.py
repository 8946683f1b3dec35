"""``linkwright cam laws``, and how a group hands a file to its default command."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Annotated

import click
import pytest
from click.testing import CliRunner
from command_line import invoke

from linkwright.cam import LAWS
from linkwright.kernel.command.group import Commands, Entry
from linkwright.kernel.command.parameter import Option, command
from linkwright.machine import File

RUNNER = CliRunner()


def run(*words: str) -> tuple[int, str]:
    result = invoke("cam", "laws", *words)
    return result.exit_code, result.output


def test_json_has_every_law_with_all_digits() -> None:
    code, output = run("--json")
    found = json.loads(output)
    assert code == 0
    assert found["machine"] is None
    assert found["warnings"] == []
    laws = found["results"]["cam_laws"]
    assert list(laws) == list(LAWS)
    assert laws["cycloidal"]["C_a"] == pytest.approx(2 * math.pi, rel=1e-15)
    assert laws["modified_sine"]["parameters"] == {"share": 0.125}
    assert laws["harmonic"]["C_j"] is None
    assert laws["harmonic"]["C_j_inside"] == pytest.approx(math.pi**3 / 2, rel=1e-15)
    bounds = found["results"]["cam_law_bounds"]
    assert {name: each["value"] for name, each in bounds.items()} == {
        "C_v": 1,
        "C_a": 4,
        "C_j": 32,
        "acceleration_squared": 12,
        "jerk_squared": 720,
    }


def test_the_table_shows_laws_and_bounds() -> None:
    code, output = run()
    assert code == 0
    for name in LAWS:
        assert name in output
    for text in ("∞", "4.888", "5.528", "720", "velocity and acceleration zero at both ends"):
        assert text in output


def test_some_laws_and_files(tmp_path: Path) -> None:
    code, output = run("--law", "cycloidal", "--law", "harmonic", "--json", "--out", str(tmp_path / "new"))
    assert code == 0
    assert list(json.loads(output.splitlines()[-1])["results"]["cam_laws"]) == ["cycloidal", "harmonic"]
    assert (tmp_path / "new" / "cam_laws.svg").read_text(encoding="utf-8").startswith("<svg")
    assert (tmp_path / "new" / "cam_laws.png").stat().st_size > 5000
    assert (
        "cycloidal"
        in json.loads((tmp_path / "new" / "cam_laws.json").read_text("utf-8"))["results"]["cam_laws"]
    )


def test_an_unknown_law_and_a_folder_that_is_a_file(tmp_path: Path) -> None:
    code, output = run("--law", "cyclodial")
    assert code == 2
    assert 'did you mean "cycloidal"?' in output
    (tmp_path / "file").write_text("")
    code, output = run("--out", str(tmp_path / "file"))
    assert code == 2
    assert "found a file, expected a folder for --out" in output


def group(default: Callable[..., None] | None) -> Commands:
    """A group with a command and perhaps one for what is none."""
    load = None if default is None else lambda: command(default)
    return Commands("group", "A group.", {"one": Entry("One.", lambda: command(one))}, load)


def one() -> None:
    """One."""
    click.echo("one")


def other(file: File, fast: Annotated[bool, Option("--fast")] = False) -> None:
    """Other."""
    click.echo(f"{file.file} {fast}")


@pytest.mark.parametrize(
    ("words", "output"),
    [
        (["one"], "one\n"),
        (["x.toml"], "x.toml False\n"),
        (["x.toml", "--fast"], "x.toml True\n"),
        (["--fast", "x.toml"], "x.toml True\n"),
    ],
)
def test_a_word_that_is_no_command_goes_to_the_default(words: list[str], output: str) -> None:
    assert RUNNER.invoke(group(other), words).output == output


def test_help_of_a_group_with_a_default_lists_its_commands() -> None:
    for words in (["--help"], []):
        text = RUNNER.invoke(group(other), words).output
        assert "one" in text
        assert "a file" not in text


def test_without_a_default_an_unknown_word_is_an_error() -> None:
    result = RUNNER.invoke(group(None), ["two"])
    assert result.exit_code == 2
    assert "two" in result.output
