"""How long do the natural frequencies and mode shapes of a train take?"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from common import Row, faster, is_installed, seconds
from scipy.linalg import eigh, eigh_tridiagonal

from linkwright.torsion.core.train import ReferredTrain

# Of SciPy's solvers; the other peers inform.
TARGET = 3.0


def rows(quick: bool) -> list[Row]:
    """Chains of 10 and 50 uneven discs, whose matrix is tridiagonal, the best case of SciPy's solvers."""
    return [row for n in (10, 50) for row in _rows(n, 5 if quick else 15)]


def chain(n: int) -> ReferredTrain:
    """A free chain as the engine hands it to the core."""
    random = np.random.default_rng(n)
    place = np.arange(n, dtype=np.int32)
    ends = np.column_stack([place[:-1], place[1:]])
    names = tuple(f"d{k}" for k in range(n))
    J, k = random.uniform(0.5, 2.0, n), random.uniform(1e4, 4e4, n - 1)
    none = np.zeros(n)
    return ReferredTrain(names, names[1:], np.ones(n), place, ends, ends, J, k, none, none[1:], none[1:])


def _rows(n: int, repeats: int) -> list[Row]:
    train = chain(n)
    found = train.modes()[0] ** 2
    asked = peers(train)
    for name, (peer, _) in asked.items():
        off_by = np.abs(np.sort(np.real(peer()[0])) - found).max() / found[-1]
        assert off_by < 1e-11, f"product and {name} differ by {off_by:g} of the highest ω²"
    times = seconds([train.modes, *(peer for peer, _ in asked.values())], repeats=repeats)
    product, timed = times[0], dict(zip(asked, times[1:], strict=True))
    best = min((name for name in asked if name.startswith("SciPy")), key=timed.__getitem__)
    made = []
    for name, (_, note) in asked.items():
        note = f"{n} discs in a chain, all frequencies and shapes; {note}"
        target = TARGET if name == best else None
        made.append(faster(f"modes of {n} discs", product, name, timed[name], target=target, note=note))
    return made


def peers(train: ReferredTrain) -> dict[str, tuple[Callable[[], Any], str]]:
    """The same by others, from arrays that are ready for them: ω² first."""
    K, J = train.stiffness_matrix, train.inertia
    scale = 1 / np.sqrt(J)
    diagonal, matrix = K.diagonal() * scale**2, scale[:, None] * K * scale
    off = -train.stiffness * scale[:-1] * scale[1:]
    M = np.diag(J)
    found: dict[str, tuple[Callable[[], Any], str]] = {
        "SciPy eigh_tridiagonal": (
            lambda: eigh_tridiagonal(diagonal, off),
            "the product puts the discs in order, SciPy is given them so",
        ),
        "SciPy eigh": (lambda: eigh(K, M), "of K and J"),
        "numpy.linalg.eigh": (lambda: np.linalg.eigh(matrix), "of J^(-1/2) K J^(-1/2)"),
    }
    if is_installed("opentorsion"):
        found["openTorsion"] = (assembled(train).undamped_modal_analysis, "of an assembly that is ready")
    return found


def assembled(train: ReferredTrain) -> Any:
    """The chain in openTorsion."""
    from opentorsion import Assembly, Disk, Shaft

    discs = [Disk(i, I=J) for i, J in enumerate(train.inertia.tolist())]
    shafts = [Shaft(i, i + 1, k=k) for i, k in enumerate(train.stiffness.tolist())]
    return Assembly(shafts, disk_elements=discs)
