"""All commands, and where they are: one that is asked for is imported, and no other.

To add a command, write its file in the room of its subject and put it into `COMMANDS`, or into a group's.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from importlib import import_module
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import typer

from linkwright.kernel.command.common import reports_errors
from linkwright.kernel.command.default_command import group_with_default

# Name → module and function, in the order of the help.
COMMANDS = {
    "run": "app.commands.run:run",
    "check": "app.commands.check:check",
    "motion": "linkages.commands:motion",
    "forces": "kinetostatics.commands.forces:forces",
    "balance": "kinetostatics.commands.balance:balance",
    "size": "sizing.commands.size:size",
    "motors": "sizing.commands.motors:motors",
    "papers": "app.commands.papers:papers",
    "new": "app.commands.new:new",
    "schema": "app.commands.schema:schema",
    "glossary": "app.commands.glossary:glossary",
}


class Group(NamedTuple):
    """What a group of commands is, its commands, and the one for a word that names none of them."""

    about: str
    commands: tuple[str, ...]
    default: str = ""


GROUPS = {
    "synthesise": Group(
        "synthesis.commands.synthesise:synthesise", ("synthesis.commands.synthesise:SYNTHESISE",)
    ),
    "cam": Group("cam.commands.laws:cam", ("cam.commands.laws:CAM",), "cam.commands.file:cam_file"),
    "torsion": Group(
        "torsion.commands.damper:torsion",
        ("torsion.commands.damper:TORSION", "torsion.commands.diagnose:diagnose"),
        "torsion.commands.torsion:torsion",
    ),
    "topper": Group(
        "topping.commands:topper",
        ("topping.commands:field", "topping.commands:best"),
        "app.commands.run:run",
    ),
}


def _found(place: str) -> Any:
    """What stands at a place ``module:name`` below the package."""
    module, _, name = place.partition(":")
    return getattr(import_module(f"linkwright.{module}"), name)


def _listed(places: Iterable[str]) -> list[Callable[..., Any]]:
    """Commands at places, each a command or several."""
    found = map(_found, places)
    return [command for each in found for command in (each if isinstance(each, tuple) else (each,))]


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


def application(only: str = "") -> typer.Typer:
    """The command line.

    Parameters
    ----------
    only : str
        Name of the only command that it needs; all of them if that names none.
    """
    # Plain help: the boxes of rich cost more time than the whole of `check`.
    app = typer.Typer(
        add_completion=False,
        no_args_is_help=True,
        rich_markup_mode=None,
        pretty_exceptions_enable=False,
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    app.callback()(_top)
    known = only in COMMANDS or only in GROUPS
    for name, place in COMMANDS.items():
        if name == only or not known:
            app.command()(_reporting(_found(place)))
    for name, group in GROUPS.items():
        if name == only or not known:
            default = _found(group.default) if group.default else None
            app.add_typer(
                _group(_listed(group.commands), default), name=name, help=_found(group.about).__doc__
            )
    return app


def _group(commands: Iterable[Callable[..., Any]], default: Callable[..., Any] | None) -> typer.Typer:
    """A group of commands, with a command for what is none of them."""
    # Never a word that somebody writes: a blank is in it.
    hidden = "a file"
    kind = None if default is None else group_with_default(hidden)
    group = typer.Typer(cls=kind, no_args_is_help=True, rich_markup_mode=None)
    group.callback()(_nothing)
    for command in commands:
        group.command()(_reporting(command))
    if default is not None:
        group.command(hidden, hidden=True)(_reporting(default))
    return group


def _reporting(command: Callable[..., Any]) -> Callable[..., Any]:
    """A command whose errors are messages, and findings answers about its machine."""
    return reports_errors(command, _machine_name)


def _machine_name(
    file: Path | None = None, set: list[str] | None = None, allow_outside: bool = False, **_: Any
) -> str | None:
    """Name of the machine that a command was asked about; None where it was none, or none can be read."""
    if file is None:
        return None
    from linkwright.kernel.errors import LinkwrightError
    from linkwright.machine.read import read

    try:
        return read(file, set or (), allow_outside=allow_outside).name
    except LinkwrightError:
        return None


def _nothing() -> None:
    """A group with a single command is a group all the same."""
