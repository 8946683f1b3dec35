"""The command line as Windows has it: pipes, code pages, interrupts, quotes; its calls are stood in for."""

from __future__ import annotations

import ctypes
import errno
import json
import os
import sys
from io import BytesIO, TextIOWrapper
from pathlib import Path

import click
import pytest
from click.testing import CliRunner

from linkwright.app import _take_all_letters
from linkwright.kernel import system
from linkwright.kernel.command import group, out
from linkwright.kernel.command.common import reports_errors

pytestmark = pytest.mark.skipif(os.name == "nt", reason="stands in for Windows")


@pytest.fixture(autouse=True)
def _windows(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(system, "WINDOWS", True)


@pytest.mark.parametrize(
    ("error", "code"),
    [
        (OSError(errno.EINVAL, "Invalid argument"), 141),
        (BrokenPipeError(), 141),
        (OSError(errno.EINVAL, "Invalid argument", "a?b.toml"), 2),
        (OSError(errno.EIO, "Input/output error"), 2),
    ],
)
def test_output_that_nobody_reads(error: OSError, code: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """What the C library of Windows reports of a pipe without reader; a name that is none is a fault."""
    # Standard output is that of the tests.
    monkeypatch.setattr(os, "dup2", lambda *_: None)
    monkeypatch.setattr(sys.stdout, "fileno", lambda: 1, raising=False)

    def written() -> None:
        raise error

    command = click.Command("written", callback=reports_errors(written))
    monkeypatch.setattr("linkwright.kernel.command.common._unread", lambda: click.exceptions.Exit(141))
    assert CliRunner().invoke(command).exit_code == code


def test_pipes_take_all_letters(monkeypatch: pytest.MonkeyPatch) -> None:
    """JSON is UTF-8, whatever the code page of the computer is."""
    monkeypatch.delenv("PYTHONIOENCODING", raising=False)
    data = BytesIO()
    monkeypatch.setattr(sys, "stdout", TextIOWrapper(data, encoding="cp1252"))
    _take_all_letters()
    print(json.dumps({"φ": "Я"}, ensure_ascii=False))
    sys.stdout.flush()
    assert json.loads(data.getvalue()) == {"φ": "Я"}


def test_an_encoding_that_the_user_names_stays(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONIOENCODING", "cp1252")
    data = BytesIO()
    monkeypatch.setattr(sys, "stdout", TextIOWrapper(data, encoding="cp1252"))
    _take_all_letters()
    print("é φ")
    sys.stdout.flush()
    assert data.getvalue().strip() == b"\xe9 \\u03c6"


class Console:
    """The console of Windows: whether Ctrl+C is left out."""

    def __init__(self) -> None:
        self.is_deaf = False

    def SetConsoleCtrlHandler(self, handler: None, add: bool) -> bool:
        assert handler is None
        self.is_deaf = add
        return True


def test_processes_are_started_deaf(monkeypatch: pytest.MonkeyPatch) -> None:
    console = Console()
    monkeypatch.setattr(ctypes, "WinDLL", lambda name, use_last_error: console, raising=False)
    with system.deaf():
        assert console.is_deaf
    assert not console.is_deaf


def test_the_encoder_is_in_a_group_of_its_own() -> None:
    assert system.apart() == {"creationflags": 0x200}


def test_a_command_line_is_repeated_with_quotes_of_windows(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "argv", ["linkwright", "run", "my machine.toml", "--set", "crank.phase=80 deg"])
    assert out.command_line() == 'linkwright run "my machine.toml" --set "crank.phase=80 deg"'


def test_completion_has_the_ends_of_lines_of_shells(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Path, "home", lambda: tmp_path)
    group._install("fish")
    (script,) = tmp_path.rglob("*.fish")
    text = script.read_bytes()
    assert text.count(b"\n") > 3
    assert b"\r" not in text
