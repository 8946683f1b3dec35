"""What the commands share: options, and the way from an error to a message and an exit code.

| exit code | means |
| --- | --- |
| 0 | done |
| 1 | the machine cannot do it: it does not close, does not start |
| 2 | the input is wrong |
| 70 | the program contradicted itself |
| 130 | interrupted from the keyboard |
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, ParamSpec, TypeVar

import typer

from linkwright.cli.interrupt import EXIT_CODE
from linkwright.errors import InputError, LinkwrightError, UnitError

if TYPE_CHECKING:
    from linkwright.units import Kind

P = ParamSpec("P")
R = TypeVar("R")

File = Annotated[Path, typer.Argument(metavar="FILE", help="The machine file.", show_default=False)]
Sets = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="PATH=VALUE",
        help="Override an entry of the file, such as drive.gearbox.ratio=10 or "
        'mechanism.cranks.A2.phase="80 deg". May be given again.',
        show_default=False,
    ),
]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON object in SI, and nothing else.")]
Out = Annotated[Path | None, typer.Option("--out", metavar="PATH", help="Write there.", show_default=False)]
Force = Annotated[bool, typer.Option("--force", help="Replace a file that exists.")]


def reports_errors(command: Callable[P, R]) -> Callable[P, R]:
    """Let a command end with a message on standard error and its exit code, without a traceback.

    Parameters
    ----------
    command : callable
        A command; errors that this package does not raise on purpose pass through.

    Returns
    -------
    callable
        The same command.
    """

    @wraps(command)
    def run(*args: P.args, **kwargs: P.kwargs) -> R:
        try:
            return command(*args, **kwargs)
        except LinkwrightError as error:
            typer.echo(error, err=True)
            raise typer.Exit(error.exit_code) from None
        except BrokenPipeError:
            # Whoever read the output has enough.
            raise
        except OSError as error:
            typer.echo(f"cannot read or write: {error}", err=True)
            raise typer.Exit(InputError.exit_code) from None
        except KeyboardInterrupt:
            raise typer.Exit(EXIT_CODE) from None

    return run


def option_value(option: str, text: str, kind: Kind) -> float:
    """The value of an option that is a quantity; a bare number is SI.

    Raises
    ------
    InputError
        It is not such a quantity; names the option.
    """
    from linkwright.units import parse

    try:
        return parse(float(text) if _is_number(text) else text, kind)
    except UnitError as error:
        problem = error.problem
        raise InputError(f"{option}: found {problem.found}, expected {problem.expected}") from None


def _is_number(text: str) -> bool:
    """Whether a text is a number without a unit."""
    try:
        float(text)
    except ValueError:
        return False
    return True


def put(text: str, out: Path | None, *, force: bool = False) -> None:
    """Print a text, or write it to a file.

    Parameters
    ----------
    text : str
        What to put; ends in a line break.
    out : path or None
        The file; None for standard output.
    force : bool
        Replace a file that exists.

    Raises
    ------
    InputError
        The file exists, or cannot be written.
    """
    if out is None:
        typer.echo(text, nl=False)
        return
    try:
        with out.open("w" if force else "x", encoding="utf-8") as file:
            file.write(text)
    except FileExistsError:
        raise InputError(f"{out}: exists already; --force replaces it") from None
    except OSError as error:
        raise InputError(f"{out}: cannot be written ({error.strerror or error})") from None
