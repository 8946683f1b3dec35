"""How many positions of a four-bar linkage, with velocities and accelerations, are written in a second?"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import machines
import numpy as np
from common import Row, seconds
from peers import four_bar

import linkwright as lw

N_ANGLES = 384
MANY_ANGLES = 1_000_000

# Machines at once: results of 7 MB stay in a cache of the usual size, those of 70 MB go to memory.
BATCHES = (400, 4000)


def rows(quick: bool) -> list[Row]:
    """Many machines at 384 angles, and one machine at many angles, results into the same array each time."""
    repeats = 5 if quick else 11
    return [*(many(n, repeats) for n in BATCHES), one(MANY_ANGLES // (10 if quick else 1), repeats)]


def many(n: int, repeats: int) -> Row:
    """Many machines."""
    coupler = np.linspace(0.35, 0.36, n)
    machine = lw.replace(machines.four_bar(), {"mechanism.rockers.R.coupler": coupler})
    phi = np.linspace(0, 2 * np.pi, N_ANGLES, endpoint=False)
    note = f"{n} machines × {N_ANGLES} angles, {48e-6 * n * N_ANGLES:.0f} MB written"
    return row("four-bar motions, many machines", machine, phi, coupler[:, None], note, repeats)


def one(n_angles: int, repeats: int) -> Row:
    """One machine."""
    phi = np.linspace(0, 2 * np.pi, n_angles)
    note = f"one machine × {n_angles} angles, {48e-6 * n_angles:.0f} MB written"
    return row("four-bar motions, one machine", machines.four_bar(), phi, 0.35, note, repeats)


def row(case: str, machine: lw.Machine, phi: Any, coupler: Any, note: str, repeats: int) -> Row:
    """Millions of positions a second of product and NumPy, after a comparison of what they write."""
    n = np.size(coupler)
    ours, theirs = np.empty((n, 6, len(phi))), np.empty((n, 6, len(phi)))

    def product() -> Any:
        return lw.motions(machine, phi, points=["P"], out=ours)

    def peer() -> Any:
        return four_bar.motion(phi, coupler, theirs)

    off = np.abs(product() - peer()).max()
    assert off < 1e-12, f"product and NumPy differ by {off:g}"
    rates = [n * len(phi) / time / 1e6 for time in timed(product, peer, repeats)]
    words = f"{note}; position, velocity and acceleration; the ratio should be 20 or more"
    return Row(case, "M/s", rates[0], "NumPy", rates[1], rates[0] / rates[1], 300, "at least", words)


def timed(product: Callable[[], Any], peer: Callable[[], Any], repeats: int) -> list[float]:
    """Median times of both."""
    return seconds([product, peer], repeats=repeats, shortest=0.05)
