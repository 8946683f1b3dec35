"""How many machines, and how many of their turns, does a batch of steady states go through in a second?"""

from __future__ import annotations

from typing import Any

import machines
import numpy as np
from common import Row, is_installed, seconds

import linkwright as lw

N, N_QUICK = 100_000, 20_000

# Machines that SciPy does, to extrapolate from.
N_PEER = 12

# What the lanes promise, relative.
LANES_AGREE = 1e-7

# Half widths: phase [rad], masses and forces as a share.
NARROW = (np.radians(3.0), 0.05)
WIDE = (np.radians(30.0), 0.2)


def rows(quick: bool) -> list[Row]:
    """Turns and machines a second while the speed stays above breakdown, and where many pass below it."""
    n = N_QUICK if quick else N
    machine = machines.two_carts()
    entries = variants(n, *NARROW)
    found = measured(machine, entries, "phase ±3°, masses and forces ±5 %", quick, target=2.0)
    found += measured(machine, variants(n // 10, *WIDE), "phase ±30°, the rest ±20 %", quick)
    return found


def variants(n: int, phase: float, share: float) -> dict[str, Any]:
    """Values of the entries that vary, drawn with a fixed seed."""
    draw = np.random.default_rng(20)
    return {
        "mechanism.cranks.A2.phase": draw.uniform(np.pi / 2 - phase, np.pi / 2 + phase, n),
        "bodies.cart1.mass": 1000 * draw.uniform(1 - share, 1 + share, n),
        "bodies.cart2.mass": 1000 * draw.uniform(1 - share, 1 + share, n),
        "loads.rolling1.force": (force := 3562 * draw.uniform(1 - share, 1 + share, n)),
        "loads.rolling2.force": force,
    }


def measured(
    machine: lw.Machine, entries: dict[str, Any], words: str, quick: bool, target: float | None = None
) -> list[Row]:
    """Turns a second, and machines a second against SciPy."""
    batch = lw.steady_states(machine, entries)
    solved = int((batch.status == 0).sum())
    assert solved == len(batch.status), f"{len(batch.status) - solved} machines without an answer"
    time = seconds([lambda: lw.steady_states(machine, entries)], repeats=3 if quick else 5)[0]
    n = len(batch.status)
    note = f"{n} machines, {batch.turns_swept / n:.1f} turns each; {words}"
    turns = batch.turns_swept / time
    case, unit = "steady states, batch", "M turns/s"
    rate = Row(case, unit, turns / 1e6, target=target, aim="at least", note=note)
    return [rate, against_scipy(entries, batch, n / time, note)]


def against_scipy(entries: dict[str, Any], batch: Any, rate: float, note: str) -> Row:
    """Machines a second, SciPy's from a few of them; their answers are compared."""
    case = "steady states, batch"
    if not is_installed("scipy"):
        return Row(case, "machines/s", rate, "SciPy is not installed", note=note)
    from peers import two_carts

    def drive(k: int) -> two_carts.Drive:
        phase, mass_1, mass_2, force, _ = (float(values[k]) for values in entries.values())
        return two_carts.Drive(mass_1, mass_2, force, phase)

    for k in range(N_PEER):
        # At the 1e-8 that is timed SciPy itself errs by up to 2e-6 where the speed passes breakdown.
        theirs = two_carts.steady(drive(k), 10.2, rtol=1e-11)
        for name in ("speed_min", "speed_max", "period"):
            off = getattr(batch, name)[k] / getattr(theirs, name) - 1
            assert abs(off) < LANES_AGREE, f"machine {k}, {name} differs by {off:g}"
    time = seconds([lambda: [two_carts.steady(drive(k), 10.2) for k in range(N_PEER)]], repeats=3)[0] / N_PEER
    return Row(case, "machines/s", rate, "SciPy, one process", 1 / time, rate * time, note=note)
