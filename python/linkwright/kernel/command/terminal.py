"""An answer on the terminal: tables, findings in red, warnings in yellow; by rich."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from textwrap import fill
from typing import TYPE_CHECKING

from linkwright.kernel.command.console import console, styled
from linkwright.kernel.limits import SENTENCES, TABLE_ROWS, TABLES, grouped
from linkwright.kernel.page.table import Table

if TYPE_CHECKING:
    from rich.console import RenderableType

# Letters in a line of a column's head.
_HEAD = 12


def print_tables(
    head: str, tables: Sequence[Table], findings: Sequence[str], warnings: Sequence[str] = ()
) -> None:
    """Print a head, tables, findings and warnings.

    Parameters
    ----------
    head : str
        What stands above the tables.
    tables : sequence of Table
        The tables.
    findings, warnings : sequence of str
        Sentences below them.
    """
    out = console()
    if head:
        out.print(head)
    for nth, table in enumerate(tables[: TABLES.most]):
        if head or nth:
            out.print()
        out.print(_drawn(table))
        _print_more(len(table.rows) - TABLE_ROWS.most, "rows")
    _print_more(len(tables) - TABLES.most, "tables")
    for part in _sentences(findings, warnings):
        out.print()
        out.print(part)


def _print_more(count: int, words: str) -> None:
    """How much is not shown."""
    if count > 0:
        console().print(f"… and {grouped(count)} more {words}; --json has all")


def _drawn(table: Table) -> RenderableType:
    """A table of words, symbols and numbers."""
    from rich import box
    from rich.table import Table as Drawn

    drawn = Drawn(
        title=table.title,
        title_justify="left",
        title_style="bold",
        box=box.SIMPLE_HEAD,
        show_edge=False,
        pad_edge=False,
    )
    drawn.add_column(table.heads[0])
    drawn.add_column(table.heads[1], style="cyan", no_wrap=True)
    for n, head in enumerate(table.heads[2:], start=2):
        # A narrow terminal may break words and lists of them, never a number.
        listed = any(", " in row[n] for row in table.rows)
        drawn.add_column(fill(head, _HEAD), no_wrap=not listed)
    for row in table.rows[: TABLE_ROWS.most]:
        drawn.add_row(*row)
    return drawn


def _sentences(findings: Sequence[str], warnings: Sequence[str]) -> Iterator[RenderableType]:
    for word, colour, texts in (("FINDING", "red", findings), ("WARNING", "yellow", warnings)):
        for text in texts[: SENTENCES.most]:
            yield styled((f"{word}  ", f"bold {colour}"), (text, colour))
        if (more := len(texts) - SENTENCES.most) > 0:
            yield styled((f"… and {grouped(more)} more of these; --json has all", colour))
