"""The option ``--out`` of all commands, and what is written there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import click

from linkwright.kernel.command.parameter import Option
from linkwright.kernel.errors import InputError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from linkwright.kernel.files.output import OutputFolder


def out_option(words: str, metavar: str = "DIR", name: str = "--out") -> Any:
    """The option for a folder (``"DIR"``) or ``"FILE"`` to write; `words`: what is written, for the help."""

    def place(text: str) -> Path:
        """A path that says something: an empty one would be the folder in which the command runs."""
        if not text.strip():
            raise click.BadParameter("found nothing, expected a path", param_hint=name)
        return Path(text)

    return Option(name, metavar, words, parser=place)


Out = Annotated[Path | None, out_option("Write there.", "FILE")]
Force = Annotated[bool, Option("--force", help="Overwrite existing files.")]


def output_folder(out: Path | None, *, force: bool) -> OutputFolder | None:
    """The folder of ``--out``; an `InputError` before computing if it is none, or holds files of others."""
    if out is None:
        return None
    from linkwright.kernel.files.output import OutputFolder

    folder = OutputFolder(out, force)
    folder.require()
    return folder


def output_files(option: str, names: Sequence[str], endings: Sequence[str], *, force: bool) -> list[Path]:
    """The files that an option names.

    Raises `InputError`, before anything is computed, for one that ends in none of the endings, has no folder,
    or exists and is not to be replaced.
    """
    for name in names:
        place = Path(name)
        if place.suffix.lower() not in endings:
            listed = f"{', '.join(endings[:-1])} or {endings[-1]}"
            raise InputError(f'{option}: found "{name}", expected a file that ends in {listed}')
        if not place.parent.is_dir():
            raise InputError(f"{option}: there is no folder {place.parent}")
        if place.exists() and not force:
            raise InputError(f"{place}: exists already; --force replaces it")
    return [Path(name) for name in names]


def write_folder(
    folder: OutputFolder,
    contents: Mapping[str, str | bytes],
    figures: Mapping[str, Figure] | None = None,
    *,
    quiet: bool,
    remarks: Mapping[str, str] | None = None,
) -> None:
    """Write files, and figures as SVG and PNG; say where they are, with remarks beside their names.

    `contents`, `figures`: by name, figures without ending; `quiet`: say it on standard error, since standard
    output is JSON. Raises `InputError` if the folder cannot be written to.
    """
    drawn: dict[str, str | bytes] = {}
    if figures:
        from linkwright.kernel.figure.svg import png, svg
        from linkwright.kernel.files.output import file_names

        # A name may hold letters that no file can have.
        names = file_names(dict.fromkeys(figures, ""))
        for name, figure in ((names[name], figure) for name, figure in figures.items()):
            drawn |= {f"{name}.svg": svg(figure), f"{name}.png": png(figure)}
    say_written(folder.write({**contents, **drawn}), quiet=quiet, remarks=remarks)


def say_written(paths: Sequence[Path], *, quiet: bool, remarks: Mapping[str, str] | None = None) -> None:
    """Say where files are, on standard error if `quiet`; `remarks`: name → words beside it."""
    words = remarks or {}
    rows = [f"  {path}" + (f": {words[path.name]}" if path.name in words else "") for path in paths]
    click.echo("Written:\n" + "\n".join(rows), err=quiet)


def put(text: str | bytes, out: Path | None, *, force: bool = False) -> None:
    """Print a text, or write it to a file; an `InputError` if it exists, not forced, or cannot be written."""
    if out is None:
        click.echo(text, nl=False)
        return
    from linkwright.kernel.files.output import write_file

    write_file(out, text, replace=force)


def command_line() -> str:
    """The command line as it was given, to be repeated."""
    import sys

    from linkwright.kernel.system import quoted

    # A name of a file may be bytes that are no UTF-8; a report is.
    return quoted(["linkwright", *sys.argv[1:]]).encode("utf-8", "backslashreplace").decode()
