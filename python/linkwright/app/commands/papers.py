"""``linkwright papers``: published numbers against computed ones."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Annotated

from linkwright.kernel.command.answer import Answer
from linkwright.kernel.command.common import FolderOutput, to_folder
from linkwright.kernel.command.console import progress
from linkwright.kernel.command.parameter import Argument
from linkwright.kernel.later import at_place
from linkwright.kernel.page.table import Row, Table

if TYPE_CHECKING:
    from linkwright.papers.paper import Paper
    from linkwright.papers.paper import Table as PaperTable

Number = Annotated[
    int | None,
    Argument("[N]", "Number of the paper. Default: a list of all."),
]
To = Annotated[FolderOutput, to_folder("Write figures as SVG and PNG and a page there.")]


def papers(number: Number = None, *, to: To) -> None:
    """Recompute a published paper and compare with its printed results.

    Each value with its deviation and a verdict. That a value is not reproduced is a result, not an error.
    """
    from linkwright.papers.paper import PAPERS, known_paper, paper

    if number is None:
        titles = {f"paper{n}": title for n, title in PAPERS.items()}
        rows: list[Row] = [(str(n), "", title) for n, title in PAPERS.items()]
        listed = Table("papers", "Recomputed papers", ("paper", "", "title"), rows, is_whole=True)
        to.hand_over(Answer(machine=None, results={"papers": titles}, tables=listed))
        return
    known = known_paper(number)
    with progress(f"paper {known}"):
        of = paper(known)
    # Drawn once, for themselves and for the page.
    figures = cache(of.figures)
    notes = [note for table in of.tables for note in table.notes]
    conclusions = [f"{nth}. {text}" for nth, text in enumerate(of.conclusions, start=1)]
    answer = Answer(
        machine=f"paper {of.number}: {of.title}",
        results={f"paper{of.number}": of.to_dict()},
        head=f"Paper {of.number}: {of.title}",
        tables=lambda: [_claims(of), *map(_numbers, of.tables)],
        tail="\n\n".join([*notes, *conclusions]),
        results_file="",
        files={f"papers{of.number}.html": lambda: at_place("papers.page:page")(of, figures())},
        figures=figures,
    )
    to.hand_over(answer)


def _claims(paper: Paper) -> Table:
    rows: list[Row] = [(row.name, "", row.printed, row.computed, row.verdict) for row in paper.rows]
    return Table(
        "claims", "Printed and computed", ("claim", "", "printed", "computed", "verdict"), rows, True
    )


def _numbers(table: PaperTable) -> Table:
    heads = (table.heads[0], "", *table.heads[1:])
    rows = [(row[0].text, "", *(cell.text for cell in row[1:])) for row in table.rows]
    return Table("numbers", table.title, heads, rows, True)
