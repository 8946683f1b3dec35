"""Progress of rows on standard error: a bar with rate and remaining time; in a log, a line now and then."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from time import monotonic

import click

from linkwright.kernel.command.console import progress_bar

# From when on progress is shown [s], and how far apart lines in a log are.
_PATIENCE, _LINES = 1.0, 30.0


@contextmanager
def rows_bar() -> Iterator[Callable[[int, int, float], None]]:
    """Show how many rows are done.

    Yields
    ------
    callable
        To be told rows done, rows in all, and rows a second.
    """
    start = monotonic()
    shown = None
    told = start

    def watch(done: int, total: int, rate: float) -> None:
        nonlocal shown, told
        now = monotonic()
        if not sys.stderr.isatty():
            if now - told > _LINES:
                told = now
                left = (total - done) / rate
                click.echo(f"{done} of {total} rows, {rate:.4g} rows/s, {left:.0f} s left", err=True)
            return
        if shown is None and now - start > _PATIENCE:
            shown = progress_bar("rows", total)
        if shown is not None:
            shown.update(shown.task_ids[0], completed=done, description=f"{rate:,.0f} rows/s")

    try:
        yield watch
    finally:
        if shown is not None:
            shown.stop()
