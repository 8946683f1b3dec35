"""Groups of commands: those of the whole program, and those of a subject with a command for a file.

In a group with a default, a word that is none of its commands goes to that one: ``linkwright cam FILE``. A
shell asks the program itself what a word may go on with (``linkwright --install-completion bash``); the
script that does so is click's.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from inspect import cleandoc
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import click

from linkwright.kernel.command.parameter import HELP
from linkwright.kernel.files.output import write_file

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem


# Name of the default command; never a word that somebody writes: a blank is in it.
_FILE = "a file"


class Entry(NamedTuple):
    """A command of a group: one sentence for the list of commands, and what imports it."""

    about: str
    load: Callable[[], click.Command]


class _FileContext(click.Context):
    """Context of a default command, which has no name of its own in its usage."""

    @property
    def command_path(self) -> str:
        return super().command_path.rstrip()


class Commands(click.Group):
    """A group that imports a command when it is asked for.

    Parameters
    ----------
    name : str
        Of the group.
    about : str
        Help of the group.
    entries : mapping of str to Entry
        Its commands by name, in the order of the help.
    default : callable, optional
        Imports the command that takes what is none of these.
    params : sequence of click.Parameter
        Options of the group itself.
    """

    def __init__(
        self,
        name: str,
        about: str,
        entries: Mapping[str, Entry],
        default: Callable[[], click.Command] | None = None,
        params: tuple[click.Parameter, ...] = (),
    ) -> None:
        super().__init__(
            name, help=cleandoc(about), params=list(params), no_args_is_help=True, context_settings=HELP
        )
        self.entries = dict(entries)
        self.default = default

    def list_commands(self, context: click.Context) -> list[str]:
        """Names of the commands, without the default."""
        return list(self.entries)

    def get_command(self, context: click.Context | None, name: str) -> click.Command | None:
        """The command of that name, imported."""
        load = self.default if name == _FILE else None
        if name in self.entries:
            load = self.entries[name].load
        if name not in self.commands and load is not None:
            self.commands[name] = load()
            if name == _FILE:
                self.commands[name].context_class = _FileContext
        return self.commands.get(name)

    @property
    def for_a_file(self) -> click.Command | None:
        """The default command, imported; None without one."""
        return self.get_command(None, _FILE)

    def parse_args(self, context: click.Context, args: list[str]) -> list[str]:
        """Put the default command in front where none is named."""
        if self.default and args and args[0] not in (*self.entries, *HELP["help_option_names"]):
            args = [_FILE, *args]
        return super().parse_args(context, args)

    def resolve_command(
        self, context: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Command and its words; the name of the default is left out of what is shown as its usage."""
        if self.get_command(context, args[0]) is None and not context.resilient_parsing:
            raise click.exceptions.NoSuchCommand(args[0], possibilities=self.entries, ctx=context)
        name, command, rest = super().resolve_command(context, args)
        return None if name == _FILE else name, command, rest

    def format_usage(self, context: click.Context, formatter: click.HelpFormatter) -> None:
        """How the group is called, with a file and with a command."""
        if self.for_a_file is not None:
            words = self.for_a_file.collect_usage_pieces(context)
            formatter.write_usage(context.command_path, " ".join(words))
        super().format_usage(context, formatter)

    def format_arguments(self, context: click.Context, formatter: click.HelpFormatter) -> None:
        """The arguments of the default command."""
        if self.for_a_file is not None:
            self.for_a_file.format_arguments(context, formatter)

    def format_options(self, context: click.Context, formatter: click.HelpFormatter) -> None:
        """The options of the default command or of the group, and the commands."""
        if self.for_a_file is None:
            super().format_options(context, formatter)
        else:
            self.for_a_file.format_options(context, formatter)
            self.format_commands(context, formatter)

    def format_commands(self, context: click.Context, formatter: click.HelpFormatter) -> None:
        """The commands, one sentence each; none is imported."""
        with formatter.section("Commands"):
            formatter.write_dl([(name, entry.about) for name, entry in self.entries.items()])

    def shell_complete(self, context: click.Context, incomplete: str) -> list[CompletionItem]:
        """Commands that begin so, and what the default command may begin with."""
        from click.shell_completion import CompletionItem

        items = [
            CompletionItem(name, help=entry.about)
            for name, entry in self.entries.items()
            if name.startswith(incomplete)
        ]
        first = self.for_a_file.params[0] if self.for_a_file else None
        files = first.shell_complete(context, incomplete) if isinstance(first, click.Argument) else []
        return [*items, *files, *click.Command.shell_complete(self, context, incomplete)]


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

    def ask(context: click.Context, option: click.Parameter, shell: str | None) -> None:
        if shell is not None and not context.resilient_parsing:
            act(shell)
            context.exit()

    shells = click.Choice(tuple(_PLACES))
    return click.Option([name], type=shells, is_eager=True, expose_value=False, callback=ask, help=words)


def _show(shell: str) -> None:
    click.echo(_script(shell))


def _install(shell: str) -> None:
    place, words = _PLACES[shell]
    path = Path.home() / place
    path.parent.mkdir(parents=True, exist_ok=True)
    # With the ends of lines of the script: shells read no other, on Windows neither.
    write_file(path, _script(shell))
    click.echo(f"Written:\n  {path}\n{words}")


def _script(shell: str) -> str:
    from click.shell_completion import get_completion_class

    kind = get_completion_class(shell)
    assert kind is not None
    # The script calls the program that it completes; no command of it is asked for here.
    return kind(click.Command("linkwright"), {}, "linkwright", "_LINKWRIGHT_COMPLETE").source()
