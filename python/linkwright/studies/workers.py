"""Files of a sweep computed by processes beside this one, or by a cluster of Dask [1]_.

Each process opens the folder, makes its study from the description there, and computes files by their
numbers; a file does not depend on who computes it. If a process is lost, killed or out of memory, new ones
compute what is missing. A file at which that happens again and again is given up, and the others stay.

A cluster needs distributed, the extra ``cluster``. A task is a file: a worker sends the file, which is
written here, so that workers need no common disk.

References
----------
.. [1] Rocklin, Dask: parallel computation with blocked algorithms and task scheduling, Proc. 14th Python in
   Science Conf. 2015, 126; distributed.dask.org.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from functools import lru_cache
from multiprocessing import active_children, get_context, parent_process
from pathlib import Path
from threading import Thread
from typing import TYPE_CHECKING, Any

from linkwright import __version__
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError
from linkwright.kernel.extras import require
from linkwright.kernel.system import deaf, safe_path
from linkwright.studies.engine import evaluate
from linkwright.studies.folder import SweepFolder, plan_of
from linkwright.studies.parquet import encoded
from linkwright.studies.plan import StudyPlan, plan

if TYPE_CHECKING:
    from distributed import Client, Future

# How often processes may be lost before it is no accident.
_LOSSES = 10

# The folder and the study of a process that computes.
_own: tuple[StudyPlan, SweepFolder] | None = None


def computed(ready: StudyPlan, folder: SweepFolder, numbers: list[int], workers: int) -> Iterator[int]:
    """Compute files, and give the number of each; `InputError` if ten times lost, or not writable."""
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
    given = (folder.path, folder.manifest, ready.listed, workers)
    others = active_children()
    with safe_path():
        # Started afresh: a copy of a process with threads may hang.
        pool = ProcessPoolExecutor(workers, get_context("spawn"), initializer=_begin, initargs=given)
    with pool:
        try:
            # An interrupt ends this process, and it them: told themselves, they would end in a traceback.
            with deaf(), safe_path():
                waiting = {pool.submit(_compute, number): number for number in numbers}
            for done in as_completed(waiting):
                done.result()
                yield waiting[done]
        except BaseException:
            # Nobody waits for files that are not wanted any more; one that is not finished is not there.
            for process in active_children():
                if process not in others:
                    process.terminate()
            pool.shutdown(cancel_futures=True)
            raise


def _begin(path: Path, manifest: dict[str, Any], listed: Floats | None, workers: int) -> None:
    """Initialise a process: the study from its description, and its share of the processors."""
    global _own
    _end_with_parent()
    # Read by the core when it starts its threads, which is after this.
    os.environ.setdefault("RAYON_NUM_THREADS", str(max(1, (os.cpu_count() or 1) // workers)))
    known = plan_of(manifest)
    _own = (
        (known if listed is None else plan(known.machine, known.study, listed)),
        SweepFolder(path, manifest),
    )


def _end_with_parent() -> None:
    """End this process if the one that started it is killed: no other file would come."""
    parent = parent_process()

    def watch() -> None:
        if parent is not None:
            parent.join()
            os._exit(1)

    Thread(target=watch, daemon=True).start()


def _compute(number: int) -> None:
    from linkwright.studies.sweep import compute_part

    assert _own is not None
    compute_part(*_own, number)


# How often the workers of one file may be lost; Dask itself allows three losses of each try.

# Files that wait at a worker's thread: one computes, one is ready.
_AHEAD = 2

# How long to wait for the scheduler and for a first worker [s].
_PATIENCE = 30


def computed_on(ready: StudyPlan, folder: SweepFolder, numbers: list[int], address: str) -> Iterator[int]:
    """Compute files of a folder on a cluster; gives the number of each as it is written.

    Raises InputError: there is no such cluster, it has another version, workers were lost again and again.
    """
    client = _client(address)
    try:
        _require_workers(client, address)
        yield from _gathered(client, ready, folder, numbers)
    except (OSError, TimeoutError) as error:
        text = " ".join(str(error).split())
        raise InputError(
            f"{address}: the cluster was lost ({text}); what is written stays, the same command goes on"
        ) from None
    finally:
        client.close(timeout=_PATIENCE)


def _client(address: str) -> Client:
    require("distributed", "cluster", "a cluster needs distributed")
    from distributed import Client

    try:
        return Client(address, timeout=_PATIENCE, set_as_default=False)
    except (OSError, ValueError, TimeoutError) as error:
        text = " ".join(str(error).split())
        raise InputError(
            f'{address}: found no scheduler ({text}); expected an address such as "tcp://host:8786"'
        ) from None


def _require_workers(client: Client, address: str) -> None:
    try:
        client.wait_for_workers(1, timeout=_PATIENCE)
    except TimeoutError:
        raise InputError(f"{address}: found no worker; start some: dask worker {address}") from None
    versions = client.run(_version)
    other = {worker: version for worker, version in versions.items() if version != __version__}
    if other:
        worker, version = next(iter(other.items()))
        raise InputError(f"{worker}: found linkwright {version}, expected {__version__} as here")


def _version() -> str:
    return __version__


def _gathered(client: Client, ready: StudyPlan, folder: SweepFolder, numbers: list[int]) -> Iterator[int]:
    from distributed import KilledWorker, as_completed

    losses = dict.fromkeys(numbers, 0)
    left = iter(numbers)
    listed = None if ready.listed is None else client.scatter(ready.listed, broadcast=True)

    def asked(number: int) -> Future[bytes]:
        return client.submit(_part, folder.about, listed, number, pure=False)

    running = {future: number for number in _first(left, _ahead(client)) for future in [asked(number)]}
    waiting = as_completed(running, loop=client.loop)
    for future in waiting:
        number = running.pop(future)
        try:
            data = future.result()
        except KilledWorker:
            losses[number] += 1
            if losses[number] > _LOSSES:
                raise InputError(
                    f"{folder.part(number).name}: its workers were lost {losses[number]} times; what is "
                    "written stays, the same command goes on; workers with more memory may do it"
                ) from None
            again = asked(number)
            running[again] = number
            waiting.add(again)
            continue
        folder.put(number, data)
        for another in _first(left, 1):
            more = asked(another)
            running[more] = another
            waiting.add(more)
        yield number


def _ahead(client: Client) -> int:
    threads: dict[str, int] = client.nthreads()
    return _AHEAD * max(sum(threads.values()), 1)


def _first(numbers: Iterator[int], n: int) -> list[int]:
    return [number for _, number in zip(range(n), numbers, strict=False)]


def _part(about: bytes, listed: Floats | None, number: int) -> bytes:
    folder, ready = _study(about)
    if listed is not None:
        ready = plan(ready.machine, ready.study, listed)
    start, stop = folder.rows_of(number)
    return encoded(evaluate(ready, ready.rows(start, stop)), start, folder.units, about)


@lru_cache(maxsize=4)
def _study(about: bytes) -> tuple[SweepFolder, StudyPlan]:
    manifest = json.loads(about)
    return SweepFolder(Path(), manifest), plan_of(manifest)
