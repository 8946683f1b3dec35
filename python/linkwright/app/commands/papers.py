"""``linkwright papers``: published numbers against computed ones."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import click

from linkwright.kernel.command.answer import Answer, hand_over
from linkwright.kernel.command.common import Json
from linkwright.kernel.command.console import console, progress, styled
from linkwright.kernel.command.out import Force, out_option, output_folder
from linkwright.kernel.command.parameter import Argument

if TYPE_CHECKING:
    from rich.table import Table as Grid
    from rich.text import Text as Styled

    from linkwright.papers.paper import Paper, Table, Text

Number = Annotated[
    int | None,
    Argument(metavar="[N]", help="Number of the paper; without it, a list of all."),
]
Folder = Annotated[Path | None, out_option("Write figures as SVG and PNG and a page there.")]

# Kind of a verdict → its colour.
_COLOURS = {"reproduced": "green", "near": "yellow", "far": "red", "none": "dim", "": ""}


def papers(number: Number = None, json: Json = False, out: Folder = None, force: Force = False) -> None:
    """Recompute a published paper and compare with its printed results.

    Each value with its deviation and a verdict. That a value is not reproduced is a result, not an error.
    """
    from linkwright.papers.paper import PAPERS, known_paper, paper

    if number is None:
        titles = {f"paper{n}": title for n, title in PAPERS.items()}
        listed = "\n".join(f"  {n}  {title}" for n, title in PAPERS.items())
        answer = Answer(machine=None, results=lambda _: {"papers": titles}, show=lambda: click.echo(listed))
        hand_over(answer, json=json)
        return
    folder, known = output_folder(out, force=force), known_paper(number)
    with progress(f"paper {known}"):
        recomputed = paper(known)
    hand_over(_answer(recomputed), json=json, folder=folder)


def _answer(paper: Paper) -> Answer:
    """What was computed anew; the figures are drawn once, for themselves and for the page."""
    from linkwright.papers.page import page

    figures = cache(paper.figures)
    return Answer(
        machine=f"paper {paper.number}: {paper.title}",
        results=lambda _: {f"paper{paper.number}": paper.to_dict()},
        show=lambda: _print(paper),
        results_file="",
        files=lambda: {f"papers{paper.number}.html": page(paper, figures())},
        figures=figures,
    )


def _print(paper: Paper) -> None:
    """A row for each claim, further tables, and what follows."""
    out = console()
    out.print(f"Paper {paper.number}: {paper.title}\n", style="bold")
    rows: list[list[str | Styled]] = [
        [row.name, row.printed, row.computed, styled((row.verdict, _COLOURS[row.kind]))] for row in paper.rows
    ]
    out.print(_grid(("claim", "printed", "computed", "verdict"), rows))
    for table in paper.tables:
        out.print()
        out.print(_numbers(table))
        for note in table.notes:
            out.print(f"  {note}", style="dim")
    out.print()
    for number, text in enumerate(paper.conclusions, start=1):
        out.print(f"{number}. {text}\n")


def _numbers(table: Table) -> Grid:
    """A table of numbers: all columns but the first stand to the right."""
    rows = [[_cell(value) for value in row] for row in table.rows]
    grid = _grid(table.heads, rows, padding=1)
    grid.title, grid.title_justify, grid.title_style = table.title or None, "left", "bold"
    for column in grid.columns[1:]:
        column.justify = "right"
    return grid


def _cell(text: Text) -> Styled:
    return styled((text.text, _COLOURS[text.kind]))


def _grid(heads: Sequence[str], rows: Sequence[Sequence[str | Styled]], padding: int = 2) -> Grid:
    """A table without lines."""
    from rich.table import Table

    grid = Table(*heads, box=None, padding=(0, padding, 0, 0))
    for row in rows:
        grid.add_row(*row)
    return grid
