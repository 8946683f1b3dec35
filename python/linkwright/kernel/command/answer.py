"""What a command answers: printed, given as JSON, written and ended in one way.

A command makes an `Answer` and hands it over; all of its parts that cost something are made when they are
asked for, so that JSON needs no tables and no drawing.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from contextvars import ContextVar
from dataclasses import dataclass, field
from json import dumps
from typing import TYPE_CHECKING, Any, Protocol

import click

from linkwright.kernel.command.out import put, write_folder
from linkwright.kernel.command.parameter import UNITS
from linkwright.kernel.errors import InputError, InternalError
from linkwright.kernel.reader.angle_zero import Zero, counting

if TYPE_CHECKING:
    from pathlib import Path

    from pydantic import BaseModel

    from linkwright.kernel.figure.style import CaptionedFigure
    from linkwright.kernel.files.output import OutputFolder
    from linkwright.kernel.page.content import Content
    from linkwright.kernel.page.table import Table


_FILE_ZERO = Zero()

# A table, or a function that gives one or several, or several of these.
Shown = Any


class Described(Protocol):
    """A machine, as an answer needs it."""

    @property
    def name(self) -> str:
        """Its name."""

    @property
    def units(self) -> BaseModel | None:
        """The table `[units]` of its file."""


@dataclass(frozen=True, kw_only=True)
class Answer:
    """What a command found.

    Parts that cost something are functions, called when they are asked for: `later` names one by its place.
    """

    machine: Described | str | None  # the machine, or a name in its place; None where there is none
    names: Collection[str] = ()  # names that its author gave, which stay in every language
    is_described: bool = False  # whether a report has drawing, data and assumptions of the machine
    # Results by name, in SI: plain numbers, texts, tables and lists, and results with or without their
    # curves; or a function of whether curves are wanted.
    results: Mapping[str, Any] | Callable[[bool], Mapping[str, Any]] = field(default_factory=dict)
    # What the machine cannot do, in sentences; with any, the command ends with exit code 1.
    findings: Sequence[str] = ()
    warnings: Sequence[str] = ()  # what its designer should know besides
    extra: Mapping[str, Any] = field(default_factory=dict)  # further keys of the JSON object
    # What people are shown: words, tables, and below them such as lines of a machine file.
    head: str | Callable[[], str] = ""
    tables: Shown = ()
    tail: str | Callable[[], str] = ""
    # Content of the file that `--out FILE` asks for: a machine file, an export.
    machine_file: Callable[[], str | bytes] | None = None
    results_file: str = "results.json"  # name of the file with the JSON object; empty if none is written
    # Further files by name; figures by name without ending, or with their captions; each, or all, may be made
    # by a function.
    files: Mapping[str, Any] | Callable[[], Mapping[str, Any]] = field(default_factory=dict)
    figures: Mapping[str, Any] | Callable[[], Any] = field(default_factory=dict)
    # What a report of it says, where that is more than the tables and figures.
    report: Callable[[], Content] | None = None
    # Name of a file → words beside it where the files are listed.
    remarks: Mapping[str, str] = field(default_factory=dict)
    zero: Zero = _FILE_ZERO  # from where crank angles are counted for people; JSON counts as the file does

    @property
    def name(self) -> str | None:
        """Name of the machine; None where there is none."""
        return self.machine if self.machine is None or isinstance(self.machine, str) else self.machine.name

    @property
    def units(self) -> BaseModel | None:
        """The table `[units]` of the machine file."""
        return None if self.machine is None or isinstance(self.machine, str) else self.machine.units

    def results_of(self, curves: bool) -> Any:
        """The results by name, ready for JSON, with curves or without."""
        return _plain(self.results(curves) if callable(self.results) else self.results, curves)

    def all_tables(self) -> list[Table]:
        """The tables."""
        return list(_tables(self.tables))

    def all_figures(self) -> list[CaptionedFigure]:
        """The figures, with titles and captions."""
        from linkwright.kernel.figure.style import CaptionedFigure

        made = self.figures() if callable(self.figures) else self.figures
        if not isinstance(made, Mapping):
            return list(made)
        return [CaptionedFigure(name, _title(name), "", figure) for name, figure in _called(made).items()]

    def all_files(self) -> dict[str, str | bytes]:
        """Further files by name."""
        return _called(self.files)


def _plain(value: Any, curves: bool) -> Any:
    if isinstance(value, Mapping) and not hasattr(value, "to_dict"):
        return {key: _plain(entry, curves) for key, entry in value.items()}
    if isinstance(value, list):
        return [_plain(entry, curves) for entry in value]
    return value.to_dict(curves=curves) if hasattr(value, "to_dict") else value


def _tables(shown: Any) -> Iterator[Table]:
    from linkwright.kernel.page.table import Table

    made = shown() if callable(shown) else shown
    if isinstance(made, Table):
        yield made
    else:
        for each in made:
            yield from _tables(each)


def _called(parts: Any) -> dict[str, Any]:
    made = parts() if callable(parts) else parts
    return {name: part() if callable(part) else part for name, part in made.items()}


def _title(name: str) -> str:
    words = name.replace("_", " ")
    return words[:1].upper() + words[1:]


def _text(part: str | Callable[[], str]) -> str:
    return part() if callable(part) else part


# Who takes the answer of a command instead of the terminal: a report.
_TAKER: ContextVar[Callable[[Answer], None] | None] = ContextVar("taker", default=None)


@contextmanager
def taken(take: Callable[[Answer], None]) -> Iterator[None]:
    """Within this, a command hands its answer over here; nothing is printed, written or ended."""
    token = _TAKER.set(take)
    try:
        yield
    finally:
        _TAKER.reset(token)


def is_reported() -> bool:
    """Whether somebody takes the answer of the command in place of the terminal."""
    return _TAKER.get() is not None


def is_taken(answer: Answer) -> bool:
    """Hand an answer to who takes it, if there is somebody."""
    take = _TAKER.get()
    if take is None:
        return False
    with as_wanted(answer.units), counting(answer.zero):
        take(answer)
    return True


def json_text(answer: Answer, *, curves: bool = False) -> str:
    """One JSON object on one line: machine, results (with ``curves`` those too), findings, warnings.

    Ends in a line break. Findings stand first among the warnings, too; what is not finite is null.
    """
    from linkwright.kernel.result import finite

    fields = {
        "machine": answer.name,
        "results": answer.results_of(curves),
        "findings": list(answer.findings),
        "warnings": [*answer.findings, *answer.warnings],
        **({"angle_zero": answer.zero.angle, "zero": answer.zero.words} if answer.zero.words else {}),
        **answer.extra,
    }
    return dumps(finite(fields), allow_nan=False, ensure_ascii=False) + "\n"


def as_wanted(table: BaseModel | None) -> AbstractContextManager[None]:
    """Show numbers in the units of ``--units``, and of the table ``[units]`` where these leave some open."""
    context = click.get_current_context(silent=True)
    asked = context.meta.get(UNITS) if context else None
    if asked is None and table is None:
        return nullcontext()
    from linkwright.kernel.reader.out_units import OutUnits, reading

    return reading((asked or OutUnits()).over(OutUnits.of_table(table)))


def shown_head(answer: Answer) -> str:
    """The head of an answer, and from where its crank angles are counted."""
    from linkwright.kernel.reader.numbers import zero_words

    return "\n".join(filter(None, (_text(answer.head), zero_words(answer.zero))))


def print_answer(answer: Answer) -> None:
    """Print an answer for people: tables, findings in red, warnings in yellow."""
    from linkwright.kernel.command.console import print_tables
    from linkwright.kernel.reader.sentences import sentences

    findings, warnings = sentences(answer.findings), sentences(answer.warnings)
    print_tables(shown_head(answer), answer.all_tables(), findings, warnings)
    if tail := _text(answer.tail):
        click.echo("\n" + tail.rstrip("\n"))


def write(answer: Answer, folder: OutputFolder, *, quiet: bool) -> None:
    """Write the JSON object with all curves, the further files and the figures; say where they are.

    `quiet`: say it on standard error, since standard output is JSON. Raises `InputError` if the folder cannot
    be written to.
    """
    contents: dict[str, str | bytes] = {}
    if answer.results_file:
        contents[answer.results_file] = json_text(answer, curves=True)
    with as_wanted(answer.units), counting(answer.zero):
        contents |= answer.all_files()
        figures = {figure.name: figure.figure for figure in answer.all_figures()}
        write_folder(folder, contents, figures, quiet=quiet, remarks=answer.remarks)


def finish(answer: Answer) -> None:
    """End the command with exit code 1 (`click.exceptions.Exit`) if there are findings."""
    if answer.findings:
        raise click.exceptions.Exit(1)


def hand_over(
    answer: Answer,
    *,
    json: bool = False,
    curves: bool = False,
    folder: OutputFolder | None = None,
    out: Path | None = None,
    force: bool = False,
) -> None:
    """Print an answer, write its files, and end the command; with exit code 1 if there are findings.

    With `json` the object is printed in place of tables, with `curves` those too, when all files are written:
    whoever reads an object on standard output has the whole answer. `folder`, `out`: where files and the
    machine file are wanted; `force`: replace a machine file that exists. Raises `InputError` if one cannot be
    written, `InternalError` if there is no finding and no machine to write where one is wanted.
    """
    if is_reported() and (json or folder is not None or out is not None):
        raise InputError("a report is written where its own --to says; leave out --json and --out")
    if is_taken(answer):
        return
    if out is not None and answer.machine_file is not None:
        put(answer.machine_file(), out, force=force)
    elif out is not None and not answer.findings:
        raise InternalError(
            "files of an answer", f"{out} is wanted, and the answer has no machine to write there"
        )
    if not json:
        with as_wanted(answer.units), counting(answer.zero):
            print_answer(answer)
    if folder is not None:
        write(answer, folder, quiet=json)
    if json:
        click.echo(json_text(answer, curves=curves), nl=False)
    finish(answer)
