"""How long do the natural frequencies and mode shapes of a train take?"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from common import Row, faster, seconds
from scipy.linalg import eigh, eigh_tridiagonal

from linkwright.engine.train import ReferredTrain


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
    K, J = train.stiffness_matrix, train.inertia
    scale = 1 / np.sqrt(J)
    off = -train.stiffness * scale[:-1] * scale[1:]
    peers: dict[str, Callable[[], Any]] = {
        "SciPy eigh_tridiagonal": lambda: eigh_tridiagonal(K.diagonal() * scale**2, off),
        "SciPy eigh": lambda: eigh(K, np.diag(J)),
        "numpy.linalg.eigh": lambda: np.linalg.eigh(scale[:, None] * K * scale),
    }
    found = train.modes()[0] ** 2
    for name, peer in peers.items():
        off_by = np.abs(peer()[0] - found).max() / found[-1]
        assert off_by < 1e-12, f"product and {name} differ by {off_by:g} of the highest ω²"
    acts = [train.modes, *peers.values()]
    times = seconds(acts, repeats=repeats)
    best = min(range(1, len(acts)), key=times.__getitem__)
    note = f"{n} discs in a chain, all frequencies and shapes; product with the ordering of the train"
    made = []
    for nth, name in enumerate(peers, start=1):
        target = 3.0 if nth == best else None
        made.append(faster(f"modes of {n} discs", times[0], name, times[nth], target=target, note=note))
    return made
