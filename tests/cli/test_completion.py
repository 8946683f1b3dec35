"""Completion in the shell, and the lists of commands that help and completion show without importing any."""

from __future__ import annotations

from pathlib import Path

import click
import pytest
from click.shell_completion import BashComplete
from command_line import invoke

from linkwright.app.application import application
from linkwright.kernel.command.group import Commands


def completions(*words: str) -> list[str]:
    asked = BashComplete(application(), {}, "linkwright", "_LINKWRIGHT_COMPLETE")
    return [each.value for each in asked.get_completions(list(words[:-1]), words[-1])]


def test_words_go_on() -> None:
    assert completions("sy") == ["synthesise"]
    assert completions("run", "--acc") == ["--accuracy"]
    assert completions("run", "--method", "b") == ["baranov"]
    assert {"laws", "search"} <= set(completions("cam", ""))


def test_a_group_goes_on_with_a_file() -> None:
    asked = BashComplete(application(), {}, "linkwright", "_LINKWRIGHT_COMPLETE")
    assert "file" in {each.type for each in asked.get_completions(["cam"], "")}
    assert "--formats" in {each.value for each in asked.get_completions(["cam", "x.toml"], "--for")}


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_the_script_calls_the_program(shell: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("USERPROFILE", str(tmp_path))
    shown = invoke("--show-completion", shell)
    assert shown.exit_code == 0
    assert f"_LINKWRIGHT_COMPLETE={shell}_complete" in shown.output
    installed = invoke("--install-completion", shell)
    assert installed.exit_code == 0
    written = [path for path in tmp_path.rglob("*linkwright*") if path.is_file()]
    assert [path.read_text() for path in written] == [shown.output.removesuffix("\n")]
    assert str(written[0]) in installed.output


def test_help_of_a_group_shows_the_options_for_a_file() -> None:
    shown = invoke("cam", "--help").output
    for words in ("cam [OPTIONS] FILE", "cam [OPTIONS] COMMAND", "--tolerance LENGTH", "--formats", "search"):
        assert words in shown


def test_every_command_is_named_as_in_its_list() -> None:
    top = application()
    for name, entry in top.entries.items():
        command = top.get_command(None, name)
        assert isinstance(command, click.Command)
        assert command.name == name
        assert entry.about.endswith(".")
        # With the longest name beside it, a line of the help.
        assert len(entry.about) <= 64
        for part in command.entries if isinstance(command, Commands) else ():
            inner = command.get_command(None, part)
            assert inner is not None
            assert inner.name == part
