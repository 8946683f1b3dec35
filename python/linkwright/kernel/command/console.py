"""The terminal, by rich: words of a file are printed as they are, whatever rich would make of them.

`[red]` in a name is a name. Style comes from `rich.text.Text` and from the ``style`` of columns alone; a test
sees to it that no other module makes a console.
"""

from __future__ import annotations

import sys
from contextlib import AbstractContextManager, nullcontext
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console
    from rich.progress import Progress
    from rich.text import Text

# Width for files and pipes, which have none of their own.
_WIDTH = 100


def console(*, error: bool = False) -> Console:
    """A console that reads no markup, no emoji codes and no numbers in what it prints.

    Parameters
    ----------
    error : bool
        Standard error in place of standard output.
    """
    from rich.console import Console

    stream = sys.stderr if error else sys.stdout
    width = None if stream.isatty() else _WIDTH
    return Console(stderr=error, markup=False, emoji=False, highlight=False, width=width)


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
    """A bar on standard error that vanishes when it is stopped; its task is the first.

    Parameters
    ----------
    words : str
        What is being done; words of this package, never of a file.
    total : float
        At which it is done.
    """
    from rich.progress import Progress

    drawn = Progress(console=console(error=True), transient=True)
    drawn.add_task(words, total=total)
    drawn.start()
    return drawn
