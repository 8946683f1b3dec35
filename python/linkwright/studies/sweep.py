"""A sweep: the rows of a study, computed file by file into a folder; one that was stopped goes on.

Files are computed in the order of their numbers; while one is computed, the one before is written.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

from linkwright.kernel.errors import FindingError, InputError, InternalError
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.studies.engine import evaluate, numbers
from linkwright.studies.folder import SweepFolder, new_folder
from linkwright.studies.parquet import columns_of, one_by_one
from linkwright.studies.plan import StudyPlan, require_variables
from linkwright.studies.rows import SOLVED, FastStarts, OneByOne, counted_fast_starts

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class Sweep(Result):
    """What a sweep has found so far."""

    path: Annotated[str, About("The folder of the results.")]
    n_rows: Annotated[int, Label("rows of the sweep", "", "")]
    n_done: Annotated[int, Label("rows computed so far", "", "")]
    n_failed: Annotated[int, Label("rows without a result", "", "", "Each keeps its reason.")]
    reasons: Annotated[dict[str, int], About("Reason of failed rows → number of rows.")]
    extremes: Annotated[
        dict[str, dict[str, float]],
        About("Response → its minimum and maximum [SI], and the rows that have them."),
    ]
    fast_starts: FastStarts
    repaired: Annotated[tuple[str, ...], About("Truncated or damaged files that were computed again.")] = ()
    truncated: Annotated[
        tuple[str, ...], About("Truncated or damaged files, whose rows are not computed yet.")
    ] = ()
    one_by_one: OneByOne = field(default_factory=dict)

    @property
    def is_complete(self) -> bool:
        """Whether all rows are there."""
        return self.n_done == self.n_rows

    def plot(self, *names: str) -> Figure:
        """A response over what varies, as `linkwright sweep show` draws it: curve, map, or an overview.

        Parameters
        ----------
        *names : str
            The response, such as ``"unevenness"``; the first of the study, or all in one, without it.

        Returns
        -------
        matplotlib.figure.Figure
            A notebook shows it; ``figure.savefig(path)`` writes it.

        Raises
        ------
        InputError
            There is no such response.
        """
        from linkwright.kernel.figure.figure_of import plotted_figure

        return plotted_figure(self, *names)

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """Counts, reasons and extremes by name, ready for JSON; no `curves`: rows are in the folder."""
        names = ("reasons", "extremes", "fast_starts", "one_by_one")
        return {**super().to_dict(), **{name: getattr(self, name) for name in names}}


@public
def sweep(
    plan: StudyPlan,
    folder: str | os.PathLike[str],
    *,
    chunks: tuple[int, int] | None = None,
    workers: int = 1,
    cluster: str = "",
    watch: Callable[..., None] | None = None,
) -> Sweep:
    """Compute the missing rows of a study into a folder.

    Parameters
    ----------
    plan : StudyPlan
        The study, from `read_study`.
    folder : path
        Folder of the results; made if there is none. One of an interrupted run of the same study is
        completed.
    chunks : tuple of int, optional
        First number of the files to compute, and the one after the last: a share of the work, as for one job
        of many.
    workers : int
        Processes that compute, 1 to 1000; one is this one, whose core uses all processors where it can.
    cluster : str
        Address of a Dask scheduler, such as ``"tcp://host:8786"``, whose workers compute instead.
    watch : callable, optional
        Told rows done, rows in all, and rows a second.

    Returns
    -------
    Sweep
        What is in the folder in the end.

    Raises
    ------
    InputError
        The folder is that of another study, cannot be written to, or another process computes the same files
        of it; an analysis needs what the machine does
        not have; there is no such cluster, or processes were lost again and again.
    """
    if workers > 1 and cluster:
        raise InputError("cluster: found it beside workers, expected one of them")
    if not 1 <= workers <= 1000:
        raise InputError(f"workers {workers}: expected 1 to 1000 processes")
    sweeps = begun(plan, folder)
    first, last = _share(sweeps, chunks)
    with sweeps.claimed(first, last):
        missing, repaired = _missing(sweeps, first, last)
        if workers == 1 and not cluster:
            _compute(plan, sweeps, missing, watch)
        else:
            _compute_beside(sweeps, missing, _elsewhere(plan, sweeps, missing, workers, cluster), watch)
    return summary(sweeps, plan.responses, repaired)


def begun(plan: StudyPlan, folder: str | os.PathLike[str]) -> SweepFolder:
    """The folder of a sweep, made if need be; the study is tried on its machine first."""
    require_variables(plan)
    if not plan.n_rows:
        raise InputError("sweep: found no rows; give ranges `steps`, or name another method in [sweep]")
    made = new_folder(Path(folder), plan)
    _try(plan)
    made.begin()
    return made


def _try(plan: StudyPlan) -> None:
    """Refuse a study whose analyses make no sense for its machine, before anything is written."""
    try:
        numbers(plan.machine, list(plan.asked))
    except FindingError:
        # silent: what a machine cannot do as it is, its variants may, and each row says so
        # What the machine cannot do as it is, variants of it may.
        return


def _share(folder: SweepFolder, chunks: tuple[int, int] | None) -> tuple[int, int]:
    first, last = chunks or (0, folder.n_parts)
    if not 0 <= first < last or first >= folder.n_parts:
        raise InputError(
            f"chunks {first}:{last}: expected numbers from 0 to {folder.n_parts}, the first smaller"
        )
    return first, min(last, folder.n_parts)


def _missing(folder: SweepFolder, first: int, last: int) -> tuple[list[int], tuple[str, ...]]:
    """Numbers of missing files, and names of those that are truncated."""
    numbers = [number for number in range(first, last) if not folder.is_done(number)]
    return numbers, tuple(folder.part(number).name for number in numbers if folder.part(number).exists())


def compute_part(plan: StudyPlan, folder: SweepFolder, number: int) -> None:
    """Compute the rows of a file, and write it."""
    folder.write(number, evaluate(plan, plan.rows(*folder.rows_of(number))))


def _compute(
    plan: StudyPlan, folder: SweepFolder, missing: Iterable[int], watch: Callable[..., None] | None
) -> None:
    """Compute and write files; one is written while the next is computed."""
    listed = list(missing)
    total = sum(stop - start for start, stop in map(folder.rows_of, listed))
    done, began = 0, monotonic()
    with ThreadPoolExecutor(1) as writer:
        writing: Future[None] | None = None
        for number in listed:
            start, stop = folder.rows_of(number)
            rows = evaluate(plan, plan.rows(start, stop))
            if writing is not None:
                writing.result()
            writing = writer.submit(folder.write, number, rows)
            done += stop - start
            if watch is not None:
                watch(done, total, done / max(monotonic() - began, 1e-9))
        if writing is not None:
            writing.result()


def _elsewhere(
    plan: StudyPlan, folder: SweepFolder, missing: list[int], workers: int, cluster: str
) -> Iterator[int]:
    """Numbers of files as they are written by processes here, or by a cluster."""
    if cluster:
        from linkwright.studies.workers import computed_on

        return computed_on(plan, folder, missing, cluster)
    from linkwright.studies.workers import computed

    return computed(plan, folder, missing, workers)


def _compute_beside(
    folder: SweepFolder, missing: list[int], written: Iterable[int], watch: Callable[..., None] | None
) -> None:
    rows = {number: stop - start for number in missing for start, stop in [folder.rows_of(number)]}
    done, total, began = 0, sum(rows.values()), monotonic()
    for number in written:
        done += rows[number]
        if watch is not None:
            watch(done, total, done / max(monotonic() - began, 1e-9))


def summary(folder: SweepFolder, responses: Iterable[str], repaired: tuple[str, ...] = ()) -> Sweep:
    """What is in a folder: counts, reasons, extremes."""
    names = list(responses)
    n_done, reasons, alone, truncated = 0, Counter[str](), Counter[str](), []
    unsettled = Counter[str]()
    lows: dict[str, tuple[float, int]] = {}
    highs: dict[str, tuple[float, int]] = {}
    for number in range(folder.n_parts):
        path = folder.part(number)
        if not folder.is_done(number):
            truncated += [path.name] if path.exists() else []
            continue
        columns = columns_of(path, ["row", *names, "status", "reason", "fast_starts"])
        solved = columns["status"] == SOLVED
        n_done += len(solved)
        alone.update(one_by_one(path))
        unsettled.update(counted_fast_starts(columns["fast_starts"]))
        reasons.update(columns["reason"][~solved])
        if solved.any():
            for name in names:
                values, rows = columns[name][solved], columns["row"][solved]
                low, high = int(values.argmin()), int(values.argmax())
                lows[name] = min(lows.get(name, (np.inf, 0)), (float(values[low]), int(rows[low])))
                highs[name] = max(highs.get(name, (-np.inf, 0)), (float(values[high]), int(rows[high])))
    extremes = {
        name: {"min": low, "min_row": at, "max": highs[name][0], "max_row": highs[name][1]}
        for name, (low, at) in lows.items()
    }
    if n_done > folder.n_rows:
        raise InternalError("sweep", f"{n_done} rows in place of {folder.n_rows}")
    return Sweep(
        path=str(folder.path),
        n_rows=folder.n_rows,
        n_done=n_done,
        n_failed=sum(reasons.values()),
        reasons=dict(reasons.most_common()),
        extremes=extremes,
        fast_starts=dict(unsettled),
        repaired=repaired,
        truncated=tuple(truncated),
        one_by_one=dict(alone.most_common()),
    )
