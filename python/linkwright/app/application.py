"""All commands, one a file.

A module of a command is imported at every start, so it imports what it computes with inside its function.
To add a command, write its file and put its function into `COMMANDS`, or with its own commands into `GROUPS`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Any

import typer

from linkwright.app.commands.check import check
from linkwright.app.commands.new import new
from linkwright.app.commands.papers import papers
from linkwright.app.commands.run import run
from linkwright.app.commands.schema import schema
from linkwright.cam.commands.file import cam_file
from linkwright.cam.commands.laws import CAM, cam
from linkwright.kernel.command.common import reports_errors
from linkwright.kernel.command.default_command import group_with_default
from linkwright.kinetostatics.commands.balance import balance
from linkwright.kinetostatics.commands.forces import forces
from linkwright.linkages.commands import motion
from linkwright.sizing.commands import size
from linkwright.synthesis.commands.synthesise import SYNTHESISE, synthesise
from linkwright.topping.commands.best import best
from linkwright.topping.commands.field import field, topper
from linkwright.torsion.commands.damper import TORSION
from linkwright.torsion.commands.damper import torsion as torsion_group
from linkwright.torsion.commands.diagnose import diagnose
from linkwright.torsion.commands.torsion import torsion

# In the order of the help.
COMMANDS: tuple[Callable[..., Any], ...] = (
    run,
    check,
    motion,
    forces,
    balance,
    size,
    papers,
    new,
    schema,
)

# Commands that have commands of their own: what the group does, and its commands.
GROUPS: tuple[tuple[Callable[..., Any], tuple[Callable[..., Any], ...]], ...] = (
    (synthesise, SYNTHESISE),
    (cam, CAM),
    (torsion_group, (*TORSION, diagnose)),
    (topper, (field, best)),
)

# Group → its command for a first word that names none of its commands, such as a file.
_DEFAULTS: dict[str, Callable[..., Any]] = {"cam": cam_file, "torsion": torsion, "topper": run}


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
        app.add_typer(
            _group(commands, _DEFAULTS.get(group.__name__)), name=group.__name__, help=group.__doc__
        )
    return app


def _group(commands: tuple[Callable[..., Any], ...], default: Callable[..., Any] | None) -> typer.Typer:
    """A group of commands, with a command for what is none of them."""
    # Never a word that somebody writes: a blank is in it.
    hidden = "a file"
    kind = None if default is None else group_with_default(hidden)
    group = typer.Typer(cls=kind, no_args_is_help=True, rich_markup_mode=None)
    group.callback()(_nothing)
    for command in commands:
        group.command()(reports_errors(command))
    if default is not None:
        group.command(hidden, hidden=True)(reports_errors(default))
    return group


def _nothing() -> None:
    """A group with a single command is a group all the same."""
