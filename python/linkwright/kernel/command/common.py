"""What the commands share: options, and the way from an error to a message and an exit code.

| exit code | means |
| --- | --- |
| 0 | done |
| 1 | the machine cannot do it: it does not close, does not start |
| 2 | the input is wrong |
| 70 | the program contradicted itself |
| 130 | interrupted from the keyboard |
| 141 | nobody reads the output any more, as with `| head` |
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import wraps
from pathlib import Path
from typing import Annotated, Any, ParamSpec, TypeVar

import click
from click.core import ParameterSource

from linkwright.kernel import system
from linkwright.kernel.command.answer import Answer, hand_over, is_taken, json_text
from linkwright.kernel.command.interrupt import EXIT_CODE
from linkwright.kernel.command.out import Force, out_option, output_folder
from linkwright.kernel.command.parameter import Group, Option
from linkwright.kernel.errors import FindingError, InputError, LinkwrightError, printable

P = ParamSpec("P")
R = TypeVar("R")

Sets = Annotated[
    list[str] | None,
    Option(
        "--set",
        "PATH=VALUE",
        "Override an entry of the file, such as drive.gearbox.ratio=10 or "
        'mechanism.cranks.A2.phase="80 deg". Repeatable.',
    ),
]
Curves = Annotated[bool, Option("--curves", help="With --json: include curves.")]
Outside = Annotated[
    bool,
    Option(
        "--allow-outside",
        help="Permit entries `file` and `machine` outside the folder of the file.",
    ),
]
Level = Annotated[float, Option("--level", "P", "Confidence level of the intervals.")]
Seed = Annotated[int, Option("--seed", "N", "Seed of the random generator.", min=0)]
Json = Annotated[bool, Option("--json", help="Print one JSON object in SI units.")]
ZeroAt = Annotated[
    str | None,
    Option(
        "--zero",
        '"[OUTPUT] END"',
        "Count crank angles from a dead centre: outer, inner, top or bottom, with the name of a slide "
        'or rocker before it if there are several, as in "ram top".',
    ),
]


@dataclass(frozen=True)
class Output:
    """What becomes of the answer of a command: shown, printed as JSON, a machine written to a file."""

    json: bool = False
    curves: bool = False
    out: Path | None = None
    force: bool = False

    def hand_over(self, answer: Answer) -> None:
        """Print the answer, write its files, and end the command, with exit code 1 if there are findings."""
        hand_over(answer, json=self.json, curves=self.curves, out=self.out, force=self.force)


@dataclass(frozen=True)
class FolderOutput(Output):
    """The same with a folder for all files, which is examined before anything is computed."""

    def __post_init__(self) -> None:
        output_folder(self.out, force=self.force)

    def hand_over(self, answer: Answer) -> None:
        """Print the answer, write its files, and end the command, with exit code 1 if there are findings."""
        folder = output_folder(self.out, force=self.force)
        hand_over(answer, json=self.json, curves=self.curves, folder=folder)


def to_screen() -> Group:
    """The option of a command that writes no file."""
    return Group(Output, {"json": Json})


def to_file(words: str, *, curves: Any = None) -> Group:
    """Options of a command that writes one file; `words`: what ``--out`` does, `curves`: ``--curves``."""
    return _output(Output, out_option(words, "FILE"), curves)


def to_folder(words: str, *, curves: Any = None) -> Group:
    """The same of a command that writes several files."""
    return _output(FolderOutput, out_option(words), curves)


def _output(make: type[Output], out: Option, curves: Any) -> Group:
    given = {"curves": curves} if curves is not None else {}
    return Group(make, {"json": Json, **given, "out": Annotated[Path | None, out], "force": Force})


def reports_errors(
    command: Callable[P, R],
    machine_name: Callable[..., str | None] = lambda **_: None,
    place: Callable[..., str] = lambda *_, **__: "",
) -> Callable[P, R | None]:
    """Let a command end with a message on standard error and its exit code, without a traceback.

    A finding that ends a command is its answer all the same, and with ``--json`` it is reported as any other.
    Errors that this package does not raise on purpose pass through. `machine_name`: arguments of the command
    → name of its machine, None where there is none; `place`: error and arguments → file and line of what it
    is about, empty where these are in its message or unknown.
    """

    @wraps(command)
    def run(*args: P.args, **kwargs: P.kwargs) -> R | None:
        try:
            _require_out(**kwargs)
            return command(*args, **kwargs)
        except LinkwrightError as error:
            if isinstance(error, FindingError):
                stopped = Answer(machine=machine_name(**kwargs), findings=[printable(str(error))])
                if is_taken(stopped):
                    return None
                if kwargs.get("json"):
                    click.echo(json_text(stopped), nl=False)
            click.echo(printable(place(error, **kwargs) + _by_options(error)), err=True)
            raise click.exceptions.Exit(error.exit_code) from None
        except OSError as error:
            if system.is_unread(error):
                raise _unread() from None
            click.echo(printable(f"cannot read or write: {error}"), err=True)
            raise click.exceptions.Exit(InputError.exit_code) from None
        except KeyboardInterrupt:
            raise click.exceptions.Exit(EXIT_CODE) from None

    return run


def _require_out(out: object = None, force: object = False, **_: object) -> None:
    """Refuse a file of ``--out`` that cannot be written, before the command computes its content."""
    context = click.get_current_context(silent=True)
    options = context.command.params if context else []
    is_file = any(option.name == "out" and option.metavar == "FILE" for option in options)
    if is_file and isinstance(out, Path):
        from linkwright.kernel.files.output import require_place

        require_place(out, replace=bool(force))


# What a shell reports for a program that writes to a pipe which nobody reads any more: 128 + SIGPIPE.
_UNREAD = 141


def _unread() -> click.exceptions.Exit:
    """The end of a command whose output nobody reads any more, as in ``linkwright run FILE | head``."""
    # What is still to be written goes nowhere, so that nothing is said of it when the program ends.
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, sys.stdout.fileno())
    os.close(nowhere)
    return click.exceptions.Exit(_UNREAD)


# What a message about arguments begins with: their names, each perhaps with its number, up to a colon or the
# end of the line. That of a file begins with its place: a name, a colon and a line.
_ARGUMENTS = re.compile(r"\w+(?: [-+.e\d]+)?(?:, \w+(?: [-+.e\d]+)?)*(?=:(?!\d)|\n)")


def _by_options(error: LinkwrightError) -> str:
    """The message of an error; arguments of the Python function by the options that they were given as."""
    context = click.get_current_context(silent=True)
    head = _ARGUMENTS.match(str(error))
    if not isinstance(error, InputError) or context is None or head is None:
        return str(error)
    options = {
        option.name: option.opts[0] for option in context.command.params if isinstance(option, click.Option)
    }
    named = re.sub(r"[^\W\d]\w*", lambda word: options.get(word[0], word[0]), head[0])
    return named + str(error)[head.end() :]


def belong_to(owner: str, *names: str) -> None:
    """Refuse those of the options that were given, since without their owner they would say nothing."""
    context = click.get_current_context(silent=True)
    if context is None:
        return
    for option in context.command.params:
        is_given = context.get_parameter_source(option.name or "") is ParameterSource.COMMANDLINE
        if option.name in names and is_given:
            raise InputError(f"{option.opts[0]}: it belongs to {owner}")


def named_entries(option: str, text: str, example: str) -> tuple[str, list[str]]:
    """Name and overrides of ``"NAME: PATH=VALUE; …"``; an `InputError` without colon, or name before it."""
    name, colon, entries = text.partition(":")
    if not colon or not name.strip():
        raise InputError(f'{option}: found "{text}", expected a name, a colon and entries, as in "{example}"')
    return name.strip(), [entry.strip() for entry in entries.split(";") if entry.strip()]
