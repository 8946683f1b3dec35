"""The terminal, by rich: texts, progress, tables; findings in red, warnings in yellow.

Words of a file are printed as they are, whatever rich would make of them: `[red]` in a name is a name. Style
comes from `rich.text.Text` and from the ``style`` of columns alone; a test sees to it that no other module
makes a console.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from textwrap import fill
from typing import TYPE_CHECKING, Any, NoReturn

from linkwright.kernel.limits import SENTENCES, TABLE_ROWS, TABLES, grouped
from linkwright.kernel.page.table import Table

if TYPE_CHECKING:
    from rich.console import Console, RenderableType
    from rich.progress import Progress
    from rich.text import Text


# Width for files and pipes, which have none of their own.
_WIDTH = 100


def console(*, error: bool = False) -> Console:
    """A console on standard output or `error` that reads no markup, emoji codes or numbers in texts."""
    from rich.console import Console

    stream = sys.stderr if error else sys.stdout
    width = None if stream.isatty() else _WIDTH
    made = Console(stderr=error, markup=False, emoji=False, highlight=False, width=width)
    # rich would end the program with exit code 1, which stands for findings.
    made.on_broken_pipe = _unread  # type: ignore[method-assign]
    return made


def _unread() -> NoReturn:
    raise BrokenPipeError


def styled(*parts: str | tuple[str, str]) -> Text:
    """A text of plain parts and of pairs of a part and its style, such as ``("fails", "red")``."""
    from rich.text import Text

    return Text.assemble(*parts)


def progress(words: str) -> AbstractContextManager[Any]:
    """A moving sign on standard error while something takes long; nothing where nobody looks."""
    # Asked of the stream itself: a console is large, and JSON for programs needs none.
    if not sys.stderr.isatty():
        return nullcontext()
    out = console(error=True)
    return out.status(words) if out.is_terminal else nullcontext()


def progress_bar(words: str, total: float) -> Progress:
    """A bar on standard error that vanishes when it is stopped; its task, of size `total`, is the first.

    `words`: what is being done; words of this package, never of a file.
    """
    from rich.progress import Progress

    drawn = Progress(console=console(error=True), transient=True)
    drawn.add_task(words, total=total)
    drawn.start()
    return drawn


# From when on a bar is shown [s].
_PATIENCE = 1.0


@contextmanager
def bar(words: str) -> Iterator[Callable[[float], None]]:
    """Show progress while something takes long and somebody looks; yields a call that takes the share."""
    from time import monotonic

    start, shown = monotonic(), None

    def watch(done: float) -> None:
        nonlocal shown
        if shown is None and monotonic() - start > _PATIENCE and sys.stderr.isatty():
            shown = progress_bar(words, 1.0)
        if shown is not None:
            shown.update(shown.task_ids[0], completed=done)

    try:
        yield watch
    finally:
        if shown is not None:
            shown.stop()


# Letters in a line of a column's head; letters of a name that are kept in one line.
_HEAD, _NAME = 12, 24


def print_tables(
    head: str, tables: Sequence[Table], findings: Sequence[str], warnings: Sequence[str] = ()
) -> None:
    """Print a head, tables, and sentences below them."""
    out = console()
    if head:
        out.print(head)
    for nth, table in enumerate(tables[: TABLES.most]):
        if head or nth:
            out.print()
        out.print(_drawn(table))
        _print_more(len(table.rows) - _most(table), "rows")
    _print_more(len(tables) - TABLES.most, "tables")
    for part in _sentences(findings, warnings):
        out.print()
        out.print(part)


def _most(table: Table) -> int:
    return len(table.rows) if table.is_whole else TABLE_ROWS.most


def _print_more(count: int, words: str) -> None:
    if count > 0:
        console().print(f"… and {grouped(count)} more {words}; --json has all")


def _drawn(table: Table) -> RenderableType:
    from rich import box
    from rich.table import Table as Drawn

    rows = table.rows[: _most(table)]
    # A column without any entry takes no room, such as that of symbols where nothing has one.
    kept = [n for n, head in enumerate(table.heads) if n == 0 or head or any(row[n] for row in rows)]
    heads = [_head(table, n).partition("\n")[0] for n in kept]
    wide = [
        max(len(x) for x in (head, *(row[n] for row in rows))) for n, head in zip(kept, heads, strict=True)
    ]
    drawn = Drawn(
        title=table.title,
        title_justify="left",
        title_style="bold",
        box=box.SIMPLE_HEAD,
        show_edge=False,
        pad_edge=False,
        collapse_padding=sum(wide) + 3 * (len(kept) - 1) > console().width,
    )
    for n in kept:
        drawn.add_column(_head(table, n) if n > 1 else table.heads[n], **_manner(table, n))
    for row in rows:
        drawn.add_row(*(row[n] for n in kept))
    return drawn


def _head(table: Table, n: int) -> str:
    return fill(table.heads[n], _HEAD, break_long_words=False)


def _manner(table: Table, n: int) -> dict[str, Any]:
    """How a column is set: a narrow terminal may break words and lists of them, never a number."""
    # A name without a space is broken where the line ends, never cut.
    if n == 0:
        longest = max((len(word) for row in table.rows for word in row[0].split()), default=0)
        return {"overflow": "fold", "min_width": min(longest, _NAME)}
    if n == 1:
        return {"style": "cyan", "no_wrap": True}
    return {"no_wrap": not any(", " in row[n] or " to " in row[n] for row in table.rows)}


def _sentences(findings: Sequence[str], warnings: Sequence[str]) -> Iterator[RenderableType]:
    for word, colour, texts in (("FINDING", "red", findings), ("WARNING", "yellow", warnings)):
        for text in texts[: SENTENCES.most]:
            yield styled((f"{word}  ", f"bold {colour}"), (text, colour))
        if (more := len(texts) - SENTENCES.most) > 0:
            yield styled((f"… and {grouped(more)} more of these; --json has all", colour))
