"""Random cases of all tests: how many, from which seeds, and what a failing test prints.

Few cases, always the same, in `make test`, many in `make test-deep`. A failing test prints the seeds of its
case, with which `generator` makes it again, and the machine that it was at as a file.
"""

import os
from collections.abc import Iterator
from contextlib import suppress
from traceback import walk_tb

import numpy as np
from numpy.random import Generator

from linkwright import Machine
from linkwright.machine import dumps

# Set by `make test-deep`, which runs the tests that are marked `deep`.
DEEP = os.environ.get("LINKWRIGHT_DEEP") == "1"

# Seeds of the newest generator of the test that runs.
newest: list[int] = []


def cases(few: int, many: int) -> int:
    """How many to look at: a few find what is broken for most, many what is broken for some."""
    return many if DEEP else few


def generator(*seeds: int) -> Generator:
    """Random numbers of a case: the kind of its test and its own number give the same case each time."""
    newest[:] = seeds
    return np.random.default_rng(seeds)


def random_cases(
    kind: int, few: int, many: int, also: tuple[int, ...] = ()
) -> Iterator[tuple[int, Generator]]:
    """Numbers of the cases of a test, and some that campaigns found, each with its random numbers."""
    for number in (*range(cases(few, many)), *also):
        yield number, generator(kind, number)


def told(error: BaseException) -> dict[str, str]:
    """What a failed test was at: files of a broken promise, the seeds of its case, its innermost machine."""
    texts = {name: str(content) for name, content in getattr(error, "inputs", {}).items()}
    if newest:
        texts["random case"] = f"generator({', '.join(map(str, newest))})"
    locals_ = [frame.f_locals.values() for frame, _ in walk_tb(error.__traceback__)]
    machines = [value for values in locals_ for value in values if isinstance(value, Machine)]
    # silent: a machine that cannot be written is not shown.
    with suppress(Exception):
        texts["machine.toml"] = dumps(machines[-1])
    return texts
