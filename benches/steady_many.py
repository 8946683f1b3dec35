"""How many machines, and revolutions of them, does a batch of steady states go through in a second?"""

from __future__ import annotations

from typing import Any

import machines
import numpy as np
from common import Row, is_installed, seconds
from peers import kernels

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
    found = measured(machine, entries, "phase ±3°, masses and forces ±5 %", quick, target=700.0)
    found += measured(machine, variants(n // 10, *WIDE), "phase ±30°, the rest ±20 %", quick, target=200.0)
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
    assert solved == len(batch.status), f"{len(batch.status) - solved} machines without a result"
    time = seconds([lambda: lw.steady_states(machine, entries)], repeats=3 if quick else 5)[0]
    n = len(batch.status)
    note = f"{n} machines, {batch.turns_swept / n:.1f} revolutions each; {words}"
    case = "steady states, batch"
    rate = Row(case, "k machines/s", 1e-3 * n / time, target=target, aim="at least", note=note)
    return [rate, *by_hand(batch.turns_swept / time), against_scipy(entries, batch, n / time, note)]


def by_hand(turns: float) -> list[Row]:
    """Revolutions per second beside those of a kernel that knows one slider-crank."""
    if not kernels.is_here():
        return []
    one = np.array([3.0, 8.0, 0.12, 20.0, 0.12, 0.45, 0.35, 260.0 / 15**2, 0.15, 1.0, 2500.0 / 15**2])
    numbers = np.ascontiguousarray(np.multiply.outer(one, np.linspace(0.99, 1.01, 4096)))
    steps, revolutions = 100, 20
    fine = kernels.drives(numbers[:, :64].copy(), 4 * steps, revolutions)
    off = np.abs(kernels.drives(numbers, steps, revolutions)[:64] / fine - 1).max()
    assert off < 1e-6, f"the kernel by hand differs by {off:g} from itself with shorter steps"
    time = seconds([lambda: kernels.drives(numbers, steps, revolutions)], repeats=3)[0]
    theirs = numbers.shape[1] * revolutions / time
    note = f"sweeps of the product over a revolution; by hand {steps} steps of order 4, each {off:.0e} exact"
    return [
        Row(
            "steady states, revolutions of a batch",
            "M revolutions/s",
            turns / 1e6,
            "slider-crank by hand, all threads",
            theirs / 1e6,
            turns / theirs,
            note=note,
        )
    ]


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
