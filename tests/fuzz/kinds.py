"""The kinds of cases by name: a case takes a random generator and raises `PromiseError`, or ends."""

from __future__ import annotations

import zlib
from collections.abc import Callable
from typing import NamedTuple

import drive_laws
import features
import plans
import random_parts
import stiff_drives
import studies
import texts
from numpy.random import Generator
from sizes import generator


class Kind(NamedTuple):
    """A kind of case.

    Attributes
    ----------
    case : callable
        Takes a generator of random numbers.
    few : int
        How many the ordinary tests run.
    weight : int
        How often it comes among the deep ones.
    """

    case: Callable[[Generator], None]
    few: int
    weight: int


KINDS: dict[str, Kind] = {
    "file": Kind(texts.file_of_a_machine, 80, 8),
    "override": Kind(texts.override, 60, 8),
    "bytes": Kind(texts.bytes_of_a_file, 60, 1),
    "table": Kind(texts.table, 60, 1),
    "formula text": Kind(texts.formula_text, 1000, 1),
    "formula value": Kind(texts.formula_value, 300, 1),
    "results": Kind(texts.results, 60, 6),
    "plan": Kind(plans.plan, 1500, 2),
    "train": Kind(random_parts.train, 60, 2),
    "cam": Kind(random_parts.cam, 60, 2),
    "drive": Kind(drive_laws.drive, 15, 8),
    "stiff drive": Kind(stiff_drives.stiff, 2, 2),
    "batch": Kind(drive_laws.batch, 40, 4),
    "study": Kind(studies.study, 12, 6),
    "record": Kind(studies.record, 4, 2),
    "options": Kind(studies.options, 30, 6),
    "motors": Kind(features.motors, 20, 2),
    "lift": Kind(features.lift, 20, 2),
    "written": Kind(features.written, 6, 4),
    "topper": Kind(random_parts.topper, 2, 1),
}


def run(kind: str, seed: int) -> None:
    KINDS[kind].case(generator(zlib.crc32(kind.encode()), seed))
