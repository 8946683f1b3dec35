"""Files of a sweep computed by processes beside this one.

Each process opens the folder, makes its study from the description there, and computes files by their
numbers; a file does not depend on who computes it. If a process is lost, killed or out of memory, new ones
compute what is missing. A file at which that happens again and again is given up, and the others stay.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.errors import InputError
from linkwright.studies.folder import SweepFolder, plan_of
from linkwright.studies.plan import StudyPlan, plan

Floats = NDArray[np.float64]

# How often processes may be lost before it is no accident.
_LOSSES = 10

# The folder and the study of a process that computes.
_own: tuple[StudyPlan, SweepFolder] | None = None


def computed(ready: StudyPlan, folder: SweepFolder, numbers: list[int], workers: int) -> Iterator[int]:
    """Compute files of a folder; gives the number of each as it is there.

    Raises InputError: processes were lost ten times, or a file cannot be written.
    """
    left, losses = set(numbers), 0
    while left:
        try:
            for number in _round(ready, folder, sorted(left), workers):
                left.discard(number)
                yield number
        except BrokenProcessPool:
            losses += 1
            if losses > _LOSSES:
                raise InputError(
                    f"{folder.path}: processes were lost {losses} times, with {len(left)} files missing; "
                    "what is written stays, the same command goes on; fewer --workers have more memory each"
                ) from None


def _round(ready: StudyPlan, folder: SweepFolder, numbers: list[int], workers: int) -> Iterator[int]:
    """The same until a process is lost."""
    given = (folder.path, folder.manifest, ready.listed, workers)
    # Started afresh: a copy of a process with threads may hang.
    with ProcessPoolExecutor(workers, get_context("spawn"), initializer=_begin, initargs=given) as pool:
        try:
            waiting = {pool.submit(_compute, number): number for number in numbers}
            for done in as_completed(waiting):
                done.result()
                yield waiting[done]
        finally:
            pool.shutdown(wait=False, cancel_futures=True)


def _begin(path: Path, manifest: dict[str, Any], listed: Floats | None, workers: int) -> None:
    """What a process does first: the study from its description, and its share of the processors."""
    global _own
    # Read by the core when it starts its threads, which is after this.
    os.environ.setdefault("RAYON_NUM_THREADS", str(max(1, (os.cpu_count() or 1) // workers)))
    known = plan_of(manifest)
    _own = (
        (known if listed is None else plan(known.machine, known.study, listed)),
        SweepFolder(path, manifest),
    )


def _compute(number: int) -> None:
    """Compute a file, in a process that has begun."""
    from linkwright.studies.sweep import compute_part

    assert _own is not None
    compute_part(*_own, number)
