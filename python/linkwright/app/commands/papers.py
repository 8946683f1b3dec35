"""``linkwright papers``: published numbers against computed ones."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from linkwright.kernel.command.answer import Answer, hand_over
from linkwright.kernel.command.common import Json
from linkwright.kernel.command.console import progress
from linkwright.kernel.command.out import Force, out_option, output_folder
from linkwright.kernel.command.parameter import Argument
from linkwright.kernel.page.table import Row, Table

if TYPE_CHECKING:
    from linkwright.papers.paper import Paper
    from linkwright.papers.paper import Table as PaperTable

Number = Annotated[
    int | None,
    Argument(metavar="[N]", help="Number of the paper. Default: a list of all."),
]
Folder = Annotated[Path | None, out_option("Write figures as SVG and PNG and a page there.")]


def papers(number: Number = None, json: Json = False, out: Folder = None, force: Force = False) -> None:
    """Recompute a published paper and compare with its printed results.

    Each value with its deviation and a verdict. That a value is not reproduced is a result, not an error.
    """
    from linkwright.papers.paper import PAPERS, known_paper, paper

    if number is None:
        titles = {f"paper{n}": title for n, title in PAPERS.items()}
        rows: list[Row] = [(str(n), "", title) for n, title in PAPERS.items()]
        listed = Table("papers", "Recomputed papers", ("paper", "", "title"), rows, is_whole=True)
        answer = Answer(machine=None, results=lambda _: {"papers": titles}, tables=lambda: [listed])
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
        head=lambda: f"Paper {paper.number}: {paper.title}",
        tables=lambda: [_claims(paper), *map(_numbers, paper.tables)],
        tail=lambda: "\n\n".join([*_notes(paper), *_conclusions(paper)]) + "\n",
        results_file="",
        files=lambda: {f"papers{paper.number}.html": page(paper, figures())},
        figures=figures,
    )


def _claims(paper: Paper) -> Table:
    """A row for each printed value: what is computed, and how near that is."""
    rows: list[Row] = [(row.name, "", row.printed, row.computed, row.verdict) for row in paper.rows]
    return Table(
        "claims", "Printed and computed", ("claim", "", "printed", "computed", "verdict"), rows, True
    )


def _numbers(table: PaperTable) -> Table:
    """A further table of a paper."""
    heads = (table.heads[0], "", *table.heads[1:])
    rows = [(row[0].text, "", *(cell.text for cell in row[1:])) for row in table.rows]
    return Table("numbers", table.title, heads, rows, True)


def _notes(paper: Paper) -> list[str]:
    return [note for table in paper.tables for note in table.notes]


def _conclusions(paper: Paper) -> list[str]:
    return [f"{number}. {text}" for number, text in enumerate(paper.conclusions, start=1)]
