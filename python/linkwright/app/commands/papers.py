"""``linkwright papers``: published numbers against computed ones."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer

from linkwright.kernel.command.answer import Answer, hand_over
from linkwright.kernel.command.common import Json
from linkwright.kernel.command.console import console, styled
from linkwright.kernel.command.out import Force, out_option, output_folder

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    from linkwright.papers.paper1.paper import Drive, Paper1
    from linkwright.papers.paper2.paper import Paper2
    from linkwright.papers.paper3.paper import Paper3
    from linkwright.papers.paper4.paper import Paper4
    from linkwright.papers.paper5.paper import Paper5
    from linkwright.papers.published import PublishedDrive

Number = Annotated[
    int | None,
    typer.Argument(metavar="[N]", help="Number of the paper; without it, what there is.", show_default=False),
]
Folder = Annotated[Path | None, out_option("Write figures as SVG and PNG and a page there.")]


def papers(number: Number = None, json: Json = False, out: Folder = None, force: Force = False) -> None:
    """Compute a paper anew and set it beside what it prints.

    Each value with its deviation and a verdict. That a value is not reproduced is a result, not an error.
    """
    from linkwright.papers.published import PAPERS, known_paper

    if number is None:
        titles = {f"paper{n}": title for n, title in PAPERS.items()}
        listed = "\n".join(f"  {n}  {title}" for n, title in PAPERS.items())
        answer = Answer(machine=None, results=lambda _: {"papers": titles}, show=lambda: typer.echo(listed))
        hand_over(answer, json=json)
        return
    folder = output_folder(out, force=force)
    paper = {1: _first, 2: _second, 3: _third, 4: _fourth, 5: _fifth}[known_paper(number)]()
    hand_over(_answer(paper), json=json, folder=folder)


class _Shown(NamedTuple):
    """A paper computed anew, and how it is shown."""

    number: int
    title: str
    entries: dict[str, Any]
    figures: Callable[[], dict[str, Figure]]
    page: Callable[[dict[str, Figure]], str]
    show: Callable[[], None]


def _first() -> _Shown:
    """Paper 1."""
    from linkwright.papers.paper1.figures import drive_figure, evenness_figure
    from linkwright.papers.paper1.page import page
    from linkwright.papers.paper1.paper import paper1

    paper = paper1(track=_tracked)

    def figures() -> dict[str, Figure]:
        drawn = {each.published.machine: drive_figure(each) for each in paper.drives}
        return drawn | {"evenness": evenness_figure(paper)}

    return _Shown(
        paper.published.number,
        paper.published.title,
        paper.to_dict(),
        figures,
        partial(page, paper),
        partial(_print, paper),
    )


def _second() -> _Shown:
    """Paper 2."""
    from linkwright.papers.paper2.paper import paper2
    from linkwright.papers.sheet import page

    paper = paper2()
    (table,) = paper.tables
    grid = _grid(table.heads, [[each.text for each in row] for row in table.rows], numbers=True)
    return _Shown(
        paper.number,
        paper.title,
        paper.to_dict(),
        paper.figures,
        partial(page, paper),
        partial(_print_rows, paper, paper.conclusions, [grid]),
    )


def _third() -> _Shown:
    """Paper 3."""
    from linkwright.papers.paper3.paper import paper3
    from linkwright.papers.sheet import page

    paper = paper3()
    (table,) = paper.tables
    grid = _grid(table.heads, [[each.text for each in row] for row in table.rows], numbers=True)
    return _Shown(
        paper.number,
        paper.title,
        paper.to_dict(),
        paper.figures,
        partial(page, paper),
        partial(_print_rows, paper, paper.conclusions, [grid]),
    )


def _fourth() -> _Shown:
    """Paper 4."""
    from linkwright.papers.paper4.paper import paper4
    from linkwright.papers.sheet import page

    paper = paper4()
    return _Shown(
        paper.number,
        paper.title,
        paper.to_dict(),
        paper.figures,
        partial(page, paper),
        partial(_print_rows, paper, paper.conclusions),
    )


def _fifth() -> _Shown:
    """Paper 5."""
    from linkwright.papers.paper5.paper import paper5
    from linkwright.papers.sheet import page

    paper = paper5()
    grids = [
        _grid(
            table.heads, [[each.text for each in row] for row in table.rows], numbers=True, title=table.title
        )
        for table in paper.tables
    ]
    return _Shown(
        paper.number,
        paper.title,
        paper.to_dict(),
        paper.figures,
        partial(page, paper),
        partial(_print_rows, paper, paper.conclusions, grids),
    )


def _tracked(drives: Sequence[PublishedDrive]) -> Iterator[PublishedDrive]:
    """The drives one by one, with a bar on standard error if someone looks at it."""
    from rich.progress import track

    if not sys.stderr.isatty():
        yield from drives
        return
    yield from track(drives, "drives", console=console(error=True), transient=True)


def _answer(paper: _Shown) -> Answer:
    """What was computed anew; the figures are drawn once, for themselves and for the page."""
    figures = cache(paper.figures)
    return Answer(
        machine=f"paper {paper.number}: {paper.title}",
        results=lambda _: {f"paper{paper.number}": paper.entries},
        show=paper.show,
        results_file="",
        files=lambda: {f"papers{paper.number}.html": paper.page(figures())},
        figures=figures,
    )


def _print_rows(
    paper: Paper2 | Paper3 | Paper4 | Paper5, conclusions: Sequence[str], tables: Sequence[Table] = ()
) -> None:
    """A row for each printed number, further tables, and what follows."""
    out = console()
    out.print(f"Paper {paper.number}: {paper.title}\n", style="bold")
    rows = [(row.name, row.printed, row.computed, _coloured(row.verdict, row.kind)) for row in paper.rows]
    for table in (_grid(("printed", "", "computed", "verdict"), rows), *tables):
        out.print(table)
        out.print()
    for number, text in enumerate(conclusions, start=1):
        out.print(f"{number}. {text}\n")


def _coloured(text: str, kind: str) -> Text:
    """A text in the colour of its verdict."""
    colours = {"reproduced": "green", "near": "yellow", "far": "red", "none": "dim"}
    return styled((text, colours[kind]))


def _grid(
    heads: Sequence[str],
    rows: Sequence[Sequence[str | Text]],
    *,
    numbers: bool = False,
    title: str | None = None,
) -> Table:
    """A table without lines; with numbers all columns but the first stand to the right."""
    from rich.table import Table

    padding = (0, 1, 0, 0) if numbers else (0, 2, 0, 0)
    table = Table(box=None, padding=padding, title=title, title_justify="left", title_style="bold")
    for i, head in enumerate(heads):
        table.add_column(head, justify="right" if numbers and i else "left")
    for row in rows:
        table.add_row(*row)
    return table


def _print(paper: Paper1) -> None:
    """A table for each drive, and what follows."""
    from linkwright.papers.paper1.conclusions import conclusions
    from linkwright.papers.paper1.page import reasons

    out = console()
    out.print(f"Paper {paper.published.number}: {paper.published.title}", style="bold")
    for drive in paper.drives:
        out.print(_table(drive))
        for reason in reasons(drive):
            out.print(f"  {reason}", style="dim")
    _print_intermediates(out, paper)
    out.print()
    for number, text in enumerate(conclusions(paper), start=1):
        out.print(f"{number}. {text}\n")


def _print_intermediates(out: Console, paper: Paper1) -> None:
    """The values printed on the way."""
    out.print("\nValues printed on the way, two carts", style="bold")
    for each in paper.published.intermediates:
        cell = paper.intermediates[each["name"]]
        text = f"{each['name']}: {cell.published:g} {each['unit']} published, {cell.computed:.6g} computed"
        out.print(f"  {text}, {cell.verdict}. {each.get('note', '')}")


def _table(drive: Drive) -> Table:
    """A line for each quantity: published, and each way with its deviation."""
    from rich.table import Table

    from linkwright.papers.paper1.page import number, percent
    from linkwright.papers.paper1.paper import WAYS
    from linkwright.papers.published import QUANTITIES

    title = f"\n{drive.published.name}"
    table = Table(title=title, title_justify="left", title_style="bold", box=None, padding=(0, 1, 0, 0))
    table.add_column("", no_wrap=True)
    table.add_column("published", justify="right", no_wrap=True)
    for words in WAYS.values():
        table.add_column(words, justify="right", max_width=9)
        table.add_column("", justify="right", no_wrap=True)
    for name, (symbol, unit) in QUANTITIES.items():
        texts: list[str | Text] = []
        for cell in (drive.cells[way][name] for way in WAYS):
            texts += [number(cell.computed), _coloured(percent(cell), cell.kind)]
        label = f"{symbol} [{unit}]" if unit else symbol
        table.add_row(label, f"{drive.published.values[name]}", *texts)
    return table
