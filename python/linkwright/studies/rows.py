"""Rows of a study: numbers of many machines, why rows fail, and what becomes of fast starts.

A row that fails keeps its reason and is NaN: 1 where the machine cannot do it, 2 where there is no such
machine.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from linkwright.drive.batch import FAST_STARTS
from linkwright.kernel.arrays import Floats, Integers
from linkwright.kernel.errors import FindingError
from linkwright.kernel.quantities import About

# Layout of rows in files and logs: 2 with what becomes of fast starts. Another layout is not read.
LAYOUT = 2

# Status of a row.
SOLVED, FAILED, IMPOSSIBLE = 0, 1, 2

# What a result says of rows that took longer than they do as a rule.
OneByOne = Annotated[
    dict[str, int],
    About("Reasons for computing rows one by one instead of as a batch → number of rows."),
]

# What a result says of rows that do not settle from all starts.
FastStarts = Annotated[
    dict[str, int],
    About("Behaviour of fast starts that do not settle to the steady motion → number of rows."),
]

# What a row says that has no finite number.
NO_NUMBER = "{} is no finite number"


@dataclass
class Rows:
    """Rows of a study; arrays (n,).

    Attributes
    ----------
    columns : dict of str to ndarray
        Variables, derived numbers and responses in SI; responses of a row that fails are NaN.
    status : ndarray of uint8
        0 solved, 1 the machine cannot do it, 2 no such machine.
    reason : ndarray of int32
        Place of its sentence in ``reasons``; 0 where solved.
    reasons : list of str
        Sentences; the first is empty.
    fast_starts : ndarray of uint8
        Where a response needs steady motion: 1 if the machine runs away from fast starts, 2 if that was
        not decided (`linkwright.drive.batch.FAST_STARTS`); 0 otherwise.
    one_by_one : Counter of str
        Why rows were computed one by one that are computed at once as a rule → how many.
    """

    columns: dict[str, Floats]
    status: NDArray[np.uint8]
    reason: Integers
    reasons: list[str]
    fast_starts: NDArray[np.uint8]
    one_by_one: Counter[str] = field(default_factory=Counter)

    def __len__(self) -> int:
        return len(self.status)

    def fail(self, rows: Any, status: int, text: str) -> None:
        """Let rows fail that have not failed yet."""
        which = np.zeros(len(self.status), dtype=bool)
        which[rows] = True
        which &= self.status == SOLVED
        if not which.any():
            return
        if text not in self.reasons:
            self.reasons.append(text)
        self.status[which] = status
        self.reason[which] = self.reasons.index(text)

    def why(self, row: int) -> str:
        """Why a row failed; empty if it did not."""
        return self.reasons[int(self.reason[row])]

    def failures(self) -> Counter[str]:
        """How many rows failed for each reason."""
        return Counter(self.reasons[place] for place in self.reason[self.status != SOLVED])

    def not_settling(self) -> dict[str, int]:
        """What becomes of fast starts that do not settle → of how many rows."""
        return counted_fast_starts(self.fast_starts)

    def require_solved(self, place: Callable[[int], str]) -> None:
        """Raise a `FindingError` if a row failed, with the place of the first one in words."""
        for row in np.flatnonzero(self.status != SOLVED)[:1].tolist():
            raise FindingError(f"the machine {place(row)} has no result: {self.why(row)}")


def counted_fast_starts(numbers: NDArray[np.uint8]) -> dict[str, int]:
    """What becomes of fast starts that do not settle → of how many rows, of numbers per row."""
    counts = np.bincount(numbers, minlength=max(FAST_STARTS) + 1)
    return {text: int(counts[number]) for number, text in FAST_STARTS.items() if counts[number]}


def fast_start_warnings(counts: Mapping[str, int]) -> list[str]:
    """The same in words."""
    return [f"{n} {'row' if n == 1 else 'rows'}: {text}" for text, n in counts.items()]
