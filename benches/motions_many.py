"""How many positions of a four-bar linkage, with velocities and accelerations, are written in a second?"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import machines
import numpy as np
from common import Row, is_installed, seconds
from peers import four_bar, kernels

import linkwright as lw

N_ANGLES = 384
MANY_ANGLES = 1_000_000

# Machines at once: results of 7 MB stay in a cache of the usual size, those of 70 MB go to memory.
BATCHES = (400, 4000)

Act = Callable[[], Any]


def rows(quick: bool) -> list[Row]:
    """Many machines at 384 angles, and one machine at many angles, results into the same array each time."""
    repeats = 5 if quick else 11
    many_angles = MANY_ANGLES // (10 if quick else 1)
    return [
        row for found in (*(many(n, repeats) for n in BATCHES), one(many_angles, repeats)) for row in found
    ]


def many(n: int, repeats: int) -> list[Row]:
    """Many machines."""
    coupler = np.linspace(0.35, 0.36, n)
    machine = lw.replace(machines.four_bar(), {"mechanism.rockers.R.coupler": coupler})
    phi = np.linspace(0, 2 * np.pi, N_ANGLES, endpoint=False)
    note = f"{n} machines × {N_ANGLES} angles, {48e-6 * n * N_ANGLES:.0f} MB written"
    by_hand = np.empty((n, 8, N_ANGLES))

    def reference() -> Any:
        return kernels.four_bars(coupler, np.cos(phi), np.sin(phi), by_hand)[:, :6]

    case = f"four-bar motions, {n} machines"
    return compared(case, machine, phi, coupler[:, None], reference, note, repeats, ratio=25.0)


def one(n_angles: int, repeats: int) -> list[Row]:
    """One machine."""
    phi = np.linspace(0, 2 * np.pi, n_angles)
    note = f"one machine × {n_angles} angles, {48e-6 * n_angles:.0f} MB written"
    by_hand = np.empty((8, n_angles))

    def reference() -> Any:
        return kernels.four_bar_over(phi, by_hand)[None, :6]

    return compared("four-bar motions, one machine", machines.four_bar(), phi, 0.35, reference, note, repeats)


def compared(
    case: str,
    machine: lw.Machine,
    phi: Any,
    coupler: Any,
    reference: Act,
    note: str,
    repeats: int,
    ratio: float | None = None,
) -> list[Row]:
    """Millions of positions a second of product, NumPy and the kernel by hand, once they agree."""
    n = np.size(coupler)
    ours, theirs = np.empty((n, 6, len(phi))), np.empty((n, 6, len(phi)))

    def product() -> Any:
        return lw.motions(machine, phi, points=["P"], out=ours)

    def peer() -> Any:
        return four_bar.motion(phi, coupler, theirs)

    def by_numba() -> Any:
        from peers import four_bar_numba

        return four_bar_numba.motion(phi, coupler, theirs)

    others: dict[str, tuple[Act, float | None]] = {"NumPy": (peer, ratio)}
    if n > 1 and is_installed("numba"):
        others["numba, all threads"] = (by_numba, None)
    if kernels.is_here():
        others["four-bar by hand, all threads"] = (reference, 0.8)
    for name, (act, _) in others.items():
        off = np.abs(product() - act()).max()
        assert off < 1e-12, f"product and {name} differ by {off:g}"
    times = seconds([product, *(act for act, _ in others.values())], repeats=repeats, shortest=0.05)
    rates = [n * len(phi) / time / 1e6 for time in times]
    words = f"{note}; position, velocity and acceleration; by hand two numbers more a position"
    return [
        Row(case, "M/s", rates[0], name, rate, rates[0] / rate, target, note=words)
        for (name, (_, target)), rate in zip(others.items(), rates[1:], strict=True)
    ]
