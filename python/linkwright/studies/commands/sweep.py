"""``linkwright sweep``: many machines into a folder of Parquet files; ``linkwright sweep show``: pictures."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, Annotated, Any

import click

from linkwright.kernel.command.answer import Answer
from linkwright.kernel.command.common import FolderOutput, Output, to_folder, to_screen
from linkwright.kernel.command.console import progress_bar
from linkwright.kernel.command.out import out_option
from linkwright.kernel.command.parameter import Argument, Option
from linkwright.kernel.later import at_place, later
from linkwright.studies.commands.study_file import Study

if TYPE_CHECKING:
    from linkwright.studies.figures import StudyRows
    from linkwright.studies.folder import SweepFolder
    from linkwright.studies.plan import StudyPlan
    from linkwright.studies.sweep import Sweep


Folder = Annotated[Path, Argument("DIR", "Folder of a sweep.")]
Into = Annotated[Path, out_option("Folder of the results; an incomplete one is resumed.")]
Drawn = Annotated[FolderOutput, to_folder("Write figures and results.json there.")]
Chunks = Annotated[
    str | None,
    Option("--chunks", "A:B", "Compute only the files A to B - 1, as one of many jobs."),
]
Workers = Annotated[int, Option("--workers", "N", "Number of processes.", min=1)]
Cluster = Annotated[
    str,
    Option("--cluster", "ADDRESS", 'Dask scheduler whose workers compute, such as "tcp://host:8786".'),
]


def sweep(
    file: Study,
    out: Into,
    chunks: Chunks = None,
    workers: Workers = 1,
    cluster: Cluster = "",
    *,
    to: Annotated[Output, to_screen()],
) -> None:
    """Compute the rows of a study into a folder; one that was stopped goes on.

    Rows that fail keep their reason. Exit code 1 if none has an answer.
    """
    from linkwright.studies.sweep import sweep as compute

    plan = file.study()
    with rows_bar() as watch:
        share = _share(chunks)
        swept = compute(plan, out, chunks=share, workers=workers, cluster=cluster, watch=watch)
    to.hand_over(_answer(plan, swept, plan.units))


def show(folder: Folder, *, to: Drawn) -> None:
    """Show a sweep: its extremes, why rows failed, and pictures that suit it.

    One variable gives curves, a grid of two gives maps with contours, and more give a scatter matrix and
    parallel coordinates. Exit code 1 if no row has an answer.
    """
    from linkwright.studies.folder import opened, plan_of
    from linkwright.studies.sweep import summary

    known = opened(folder)
    plan = plan_of(known.manifest)
    extremes = summary(known, plan.responses)
    answer = _answer(plan, extremes, known.units)
    to.hand_over(replace(answer, figures=lambda: at_place("studies.figures:figures")(shown_of(known))))


def one_by_one_warnings(one_by_one: dict[str, int]) -> list[str]:
    """That rows took longer than they do as a rule, with the most frequent reason."""
    # Reasons name the numbers that do not go together: each batch of a search has its own.
    why = max(one_by_one, key=one_by_one.__getitem__, default="")
    n = sum(one_by_one.values())
    return (
        [f"{n} rows were computed one by one instead of as a batch, which takes longer: {why}"] if n else []
    )


def unwatched_contacts(plan: StudyPlan) -> list[str]:
    """That steady motion alone does not tell whether followers stay on their cams."""
    from linkwright.kinetostatics.contact import contacts
    from linkwright.studies.engine import IN_CONTACT

    analyses = {asked.analysis for asked in plan.asked}
    watched = contacts(plan.machine)
    if not watched or "steady_state" not in analyses or analyses.intersection(IN_CONTACT):
        return []
    names = ", ".join(f"{kind} {name}" for kind, name in watched)
    return [
        f"Rows do not show loss of contact ({names}): steady motion assumes contact. With a force "
        "response, such as forces.torque_drive_max, a row that loses contact has no result"
    ]


def _share(text: str | None) -> tuple[int, int] | None:
    """Numbers of files out of ``A:B``."""
    from linkwright.kernel.errors import InputError

    if text is None:
        return None
    first, _, last = text.partition(":")
    if not (first.isdecimal() and last.isdecimal() and len(text) < 20):
        raise InputError(f'--chunks: found "{text}", expected A:B, such as 0:100 for files 0 to 99')
    return int(first), int(last)


def _answer(plan: StudyPlan, swept: Sweep, units: dict[str, str]) -> Answer:
    from linkwright.studies.rows import fast_start_warnings

    solved = swept.n_done - swept.n_failed
    missing = swept.n_rows - swept.n_done
    warnings = [f"{name} was truncated or damaged, and is computed again." for name in swept.repaired]
    warnings += [*fast_start_warnings(swept.fast_starts), *one_by_one_warnings(swept.one_by_one)]
    warnings += unwatched_contacts(plan)
    warnings += [
        f"{name} is truncated or damaged; the same sweep computes it again." for name in swept.truncated
    ]
    if missing:
        warnings.append(f"{missing} rows of {swept.n_rows} are not computed yet.")
    return Answer(
        machine=plan.machine,
        names=plan.columns,
        results={"sweep": swept},
        findings=[] if solved else ["No row has a result."],
        warnings=warnings,
        head=f"{plan.machine.name}\n{swept.n_done} of {swept.n_rows} rows in {swept.path}, {solved} solved",
        tables=later("studies.tables:sweep_tables", swept, plan, units),
    )


def shown_of(folder: SweepFolder) -> StudyRows:
    """Rows of a folder with their labels, angles in degrees."""
    import numpy as np

    from linkwright.studies.choices import choice_names
    from linkwright.studies.figures import StudyRows, rows_of
    from linkwright.studies.folder import plan_of

    plan, rows = plan_of(folder.manifest), rows_of(folder)
    names = [*(axis.name for axis in plan.axes), *plan.responses]
    units = {name: "°" if unit == "rad" else unit for name, unit in folder.units.items()}
    columns: dict[str, Any] = {
        name: np.degrees(rows[name]) if folder.units[name] == "rad" else rows[name] for name in names
    }
    choices = {axis.name: choice_names(axis.choices) for axis in plan.axes if not axis.is_number}
    return StudyRows(
        columns,
        {name: name if name in choices else f"{name} [{units[name] or '–'}]" for name in names},
        tuple(axis.name for axis in plan.axes),
        plan.responses,
        plan.sweep.method == "grid",
        choices,
        folder.n_rows,
    )


# From when on progress is shown [s], and how far apart lines in a log are.
_PATIENCE, _LINES = 1.0, 30.0


@contextmanager
def rows_bar() -> Iterator[Callable[[int, int, float], None]]:
    """Show how many rows are done; yields a call that takes rows done, rows in all and rows a second."""
    start = monotonic()
    shown = None
    last = start

    def watch(done: int, total: int, rate: float) -> None:
        nonlocal shown, last
        now = monotonic()
        if not sys.stderr.isatty():
            if now - last > _LINES:
                last = now
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
