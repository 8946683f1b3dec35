"""The command line, ``linkwright COMMAND …``: one command a file.

A module of a command is imported at every start, so it imports what it computes with inside its function.
To add a command, write its file and put its function into `COMMANDS`, or with its own commands into `GROUPS`.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from io import TextIOWrapper
from typing import Annotated, Any

import typer

from linkwright.cli.balance import balance
from linkwright.cli.check import check
from linkwright.cli.common import reports_errors
from linkwright.cli.forces import forces
from linkwright.cli.motion import motion
from linkwright.cli.new import new
from linkwright.cli.papers import papers
from linkwright.cli.run import run
from linkwright.cli.schema import schema
from linkwright.cli.size import size
from linkwright.cli.synthesise import SYNTHESISE, synthesise

# In the order of the help.
COMMANDS: tuple[Callable[..., Any], ...] = (run, check, motion, forces, balance, size, papers, new, schema)

# Commands that have commands of their own: what the group does, and its commands.
GROUPS: tuple[tuple[Callable[..., Any], tuple[Callable[..., Any], ...]], ...] = ((synthesise, SYNTHESISE),)


def _version(wanted: bool) -> None:
    """Print the version and end."""
    if wanted:
        from importlib.metadata import PackageNotFoundError, version

        try:
            typer.echo(f"linkwright {version('linkwright')}")
        except PackageNotFoundError:
            typer.echo("linkwright, run from its source without being installed")
        raise typer.Exit


Version = Annotated[
    bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version and end.")
]


def _top(version: Version = False) -> None:
    """Computes how machines move: from the motor through gearbox and shaft to the mechanism and its work."""


def application() -> typer.Typer:
    """The command line with all its commands."""
    # Plain help: the boxes of rich cost more time than the whole of `check`.
    app = typer.Typer(
        add_completion=False, no_args_is_help=True, rich_markup_mode=None, pretty_exceptions_enable=False
    )
    app.callback()(_top)
    for command in COMMANDS:
        app.command()(reports_errors(command))
    for group, commands in GROUPS:
        below = typer.Typer(no_args_is_help=True, rich_markup_mode=None)
        for command in commands:
            below.command()(reports_errors(command))
        app.add_typer(below, name=group.__name__, help=group.__doc__)
    return app


def main() -> None:
    """Run the command line, for the console script."""
    # Looking for plugins of pydantic among all installed packages costs more than reading a machine file.
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    # Names may hold letters that the terminal has not; they are no reason to fail.
    if isinstance(sys.stdout, TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")
    application()()
