"""``linkwright papers``: published numbers against computed ones."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from linkwright.cli.common import Json

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

    from linkwright.papers.paper1 import Drive, Paper1
    from linkwright.papers.published import PublishedDrive

Number = Annotated[
    int | None,
    typer.Argument(metavar="[N]", help="Number of the paper; without it, what there is.", show_default=False),
]
Folder = Annotated[
    Path | None,
    typer.Option(
        "--out", metavar="DIR", help="Write figures as SVG and PNG and a page there.", show_default=False
    ),
]

# Dots per inch of the PNG files, enough for print.
_DPI = 200

# Letters in a line where there is no terminal to ask.
_WIDTH = 100


def papers(number: Number = None, json: Json = False, out: Folder = None) -> None:
    """Compute a paper anew and set it beside what it prints.

    Each value with its deviation and a verdict. That a value is not reproduced is a result, not an error.
    """
    from linkwright.papers.published import PAPERS, published

    if number is None:
        typer.echo("\n".join(f"  {n}  {title}" for n, title in PAPERS.items()))
        return
    published(number)
    from linkwright.papers.paper1 import paper1

    paper = paper1(track=_tracked)
    if out:
        _write(paper, out)
    if json:
        _print_json(paper)
    else:
        _print(paper)
        if out:
            typer.echo(f"\nwritten: {out / f'papers{number}.html'} and its figures")


def _tracked(drives: Sequence[PublishedDrive]) -> Iterator[PublishedDrive]:
    """The drives one by one, with a bar on standard error if someone looks at it."""
    from rich.console import Console
    from rich.progress import track

    console = Console(stderr=True)
    if not sys.stderr.isatty():
        yield from drives
        return
    yield from track(drives, "drives", console=console, transient=True)


def _print_json(paper: Paper1) -> None:
    """One object on standard output."""
    from json import dumps

    name = f"paper {paper.published.number}: {paper.published.title}"
    found = {"machine": name, "results": {f"paper{paper.published.number}": paper.to_dict()}, "warnings": []}
    typer.echo(dumps(found, allow_nan=False, ensure_ascii=False))


def _write(paper: Paper1, folder: Path) -> None:
    """Figures and page."""
    from linkwright.errors import InputError
    from linkwright.papers.page import page
    from linkwright.papers.paper1_figures import drive_figure, evenness_figure
    from linkwright.plot.svg import svg

    figures = {each.published.machine: drive_figure(each) for each in paper.drives}
    figures["evenness"] = evenness_figure(paper)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, figure in figures.items():
            (folder / f"{name}.svg").write_text(svg(figure), encoding="utf-8")
            figure.savefig(folder / f"{name}.png", dpi=_DPI)
        text = page(paper, figures)
        (folder / f"papers{paper.published.number}.html").write_text(text, encoding="utf-8")
    except OSError as error:
        raise InputError(f"{folder}: cannot be written ({error.strerror or error})") from None


def _print(paper: Paper1) -> None:
    """A table for each drive, and what follows."""
    from rich.console import Console

    from linkwright.papers.page import reasons
    from linkwright.papers.paper1_conclusions import conclusions

    console = Console(highlight=False, width=None if sys.stdout.isatty() else _WIDTH)
    console.print(f"[bold]Paper {paper.published.number}: {paper.published.title}[/bold]")
    for drive in paper.drives:
        console.print(_table(drive))
        for reason in reasons(drive):
            console.print(f"  [dim]{reason}[/dim]")
    _print_intermediates(console, paper)
    console.print()
    for number, text in enumerate(conclusions(paper), start=1):
        console.print(f"{number}. {text}\n")


def _print_intermediates(console: Console, paper: Paper1) -> None:
    """The values printed on the way."""
    console.print("\n[bold]Values printed on the way, two carts[/bold]")
    for each in paper.published.intermediates:
        cell = paper.intermediates[each["name"]]
        text = f"{each['name']}: {cell.published:g} {each['unit']} published, {cell.computed:.6g} computed"
        console.print(f"  {text}, {cell.verdict}. {each.get('note', '')}")


def _table(drive: Drive) -> Table:
    """A line for each quantity: published, and each way with its deviation."""
    from rich.table import Table

    from linkwright.papers.page import number, percent
    from linkwright.papers.paper1 import WAYS
    from linkwright.papers.published import QUANTITIES

    title = f"\n[bold]{drive.published.name}[/bold]"
    table = Table(title=title, title_justify="left", title_style="", box=None, padding=(0, 1, 0, 0))
    table.add_column("", no_wrap=True)
    table.add_column("published", justify="right", no_wrap=True)
    for words in WAYS.values():
        table.add_column(words, justify="right", max_width=9)
        table.add_column("", justify="right", no_wrap=True)
    colours = {"reproduced": "green", "near": "yellow", "far": "red", "none": "dim"}
    for name, (symbol, unit) in QUANTITIES.items():
        texts = []
        for cell in (drive.cells[way][name] for way in WAYS):
            texts += [number(cell.computed), f"[{colours[cell.kind]}]{percent(cell)}[/]"]
        label = f"{symbol} \\[{unit}]" if unit else symbol
        table.add_row(label, f"{drive.published.values[name]}", *texts)
    return table
