"""Random cases of every kind, always the same ones; `deep.py` runs other ones for hours."""

from __future__ import annotations

import kinds
import pytest
from sizes import cases

# A failure names its seed: `python tests/fuzz/deep.py --kind KIND --seed SEED` runs the case again.
CHUNK = 50

CHUNKS = [
    (name, start, min(start + CHUNK, count))
    for name, count in ((name, cases(-(-kind.few // 2), 4 * kind.few)) for name, kind in kinds.KINDS.items())
    for start in range(0, count, CHUNK)
]


@pytest.mark.deep
@pytest.mark.parametrize(("kind", "start", "end"), CHUNKS)
def test_cases(kind: str, start: int, end: int) -> None:
    for seed in range(start, end):
        kinds.run(kind, seed)
