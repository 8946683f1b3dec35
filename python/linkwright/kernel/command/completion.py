"""Completion in the shell: ``linkwright --show-completion bash``, ``--install-completion bash``.

A shell asks the program itself what a word may go on with; the script that does so is click's.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import click

# Shell → file that it reads by itself, below the user's folder, and what is needed for that.
_PLACES = {
    "bash": (
        ".local/share/bash-completion/completions/linkwright",
        "Open a new terminal. bash reads it where the package bash-completion is installed.",
    ),
    "zsh": (
        ".zfunc/_linkwright",
        "zsh reads it if ~/.zshrc has: fpath=(~/.zfunc $fpath); autoload -Uz compinit; compinit",
    ),
    "fish": (".config/fish/completions/linkwright.fish", "Open a new terminal."),
}


def completion_options() -> tuple[click.Option, click.Option]:
    """The options that print and that install what a shell needs."""
    return (
        _option("--show-completion", "Print the script that completes words in a shell.", _show),
        _option("--install-completion", "Write that script where the shell reads it.", _install),
    )


def _option(name: str, words: str, act: Callable[[str], None]) -> click.Option:
    """An option that does something for a shell and ends."""

    def ask(context: click.Context, option: click.Parameter, shell: str | None) -> None:
        if shell is not None and not context.resilient_parsing:
            act(shell)
            context.exit()

    shells = click.Choice(tuple(_PLACES))
    return click.Option([name], type=shells, is_eager=True, expose_value=False, callback=ask, help=words)


def _show(shell: str) -> None:
    """Print the script."""
    click.echo(_script(shell))


def _install(shell: str) -> None:
    """Write the script, and say what is needed besides."""
    place, words = _PLACES[shell]
    path = Path.home() / place
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(_script(shell), encoding="utf-8")
    click.echo(f"Written:\n  {path}\n{words}")


def _script(shell: str) -> str:
    """The script of a shell."""
    from click.shell_completion import get_completion_class

    kind = get_completion_class(shell)
    assert kind is not None
    # The script calls the program that it completes; no command of it is asked for here.
    return kind(click.Command("linkwright"), {}, "linkwright", "_LINKWRIGHT_COMPLETE").source()
