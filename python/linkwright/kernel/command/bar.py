"""A bar on standard error that shows how much is done, once that takes long."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from linkwright.kernel.command.console import progress_bar

# From when on a bar is shown [s].
_PATIENCE = 1.0


@contextmanager
def bar(words: str) -> Iterator[Callable[[float], None]]:
    """Show progress while something takes long; nothing where nobody looks.

    Parameters
    ----------
    words : str
        What is being done.

    Yields
    ------
    callable
        To be told how much is done, from 0 to 1.
    """
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
