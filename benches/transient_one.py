"""How fast is a motion of two seconds followed to 1e-5 of the speed?

Each program runs with the loosest setting from which on all tighter ones keep the accuracy, so that none
wins by luck; among SciPy's methods the fastest such is taken. Asked for are the speed at the end, and the
whole curve at 201 instants.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import machines
import numpy as np
from common import Row, faster, is_installed, seconds

import linkwright as lw

WANTED = 1e-5

# Settings from loose to tight.
ACCURACIES = [10.0**-k for k in range(2, 13)]
STEPS = [1000 * k for k in range(1, 9)]

# Velocity below which exudyn's friction is proportional to it [m/s]: smaller ones change nothing any more.
ZONE = 3e-4

Solve = Callable[[float, Any], Any]


def rows(quick: bool) -> list[Row]:
    """The speed at the end, and the curve; against SciPy and against exudyn."""
    machine = machines.slider_crank()
    if not is_installed("scipy"):
        return [Row("transient of 2 s", "ms", None, "SciPy is not installed", note="no reference solution")]
    found = []
    for case, times in (("speed after 2 s", np.array([0.0, 2.0])), ("201 instants", np.linspace(0, 2, 201))):
        found += compared(f"transient of 2 s, {case}", machine, times, repeats=5 if quick else 15)
    return found


def compared(case: str, machine: lw.Machine, times: Any, repeats: int) -> list[Row]:
    """Rows of one question."""
    exact = reference(times)
    ours, accuracy = loosest(partial(by_linkwright, machine), ACCURACIES, times, exact)
    peers = [("SciPy " + name, *each) for name, each in scipy_settings(times, exact).items()]
    peers += [("exudyn", *each) for each in exudyn_setting(times, exact)]
    spent = seconds([ours, *(act for _, act, _ in peers)], repeats=repeats)
    timed = [(time, name, setting) for time, (name, _, setting) in zip(spent[1:], peers, strict=True)]
    best = min(each for each in timed if each[1] != "exudyn")
    chosen = [best, *(each for each in timed if each[1] == "exudyn")]
    found = []
    for time, name, setting in chosen:
        note = f"loosest settings that keep {WANTED:g}: product {accuracy:g}, peer {setting:g}"
        target = 80 if name != "exudyn" else None
        found.append(faster(case, spent[0], name, time, target=target, note=note))
    if len(chosen) == 1:
        found.append(Row(case, "ms", 1e3 * spent[0], "exudyn is not installed or misses the accuracy"))
    return found


def reference(times: Any) -> Any:
    """Speeds to 1e-12: SciPy from dead centre to dead centre, confirmed by the product."""
    from peers.slider_crank import speeds_by_pieces

    exact = speeds_by_pieces("DOP853", 1e-13, times)
    ours = by_linkwright(machines.slider_crank(), 1e-13, times[[0, -1]])
    off = abs(ours[-1] / exact[-1] - 1)
    assert off < 1e-10, f"the two references differ by {off:g}"
    return exact


def by_linkwright(machine: lw.Machine, accuracy: float, times: Any) -> Any:
    """Speeds [rad/s] at given times."""
    motion = lw.transient(machine, speed=8.0, duration=2.0, accuracy=accuracy)
    if len(times) == 2:
        return motion.speed[[0, -1]]
    return motion.at(times)[1]


def scipy_settings(times: Any, exact: Any) -> dict[str, tuple[Callable[[], Any], float]]:
    """For each method that reaches the accuracy: the act and its setting."""
    from peers.slider_crank import speeds, speeds_by_pieces

    ways: dict[str, Solve] = {name: partial(speeds, name) for name in ("RK45", "DOP853", "LSODA", "BDF")}
    for name in ("RK45", "DOP853", "LSODA"):
        ways[f"{name} by dead centres"] = partial(speeds_by_pieces, name)
    found = {}
    for name, solve in ways.items():
        try:
            found[name] = loosest(solve, ACCURACIES[:9], times, exact)
        except ValueError:
            continue
    return found


def exudyn_setting(times: Any, exact: Any) -> list[tuple[Callable[[], Any], float]]:
    """The act and its number of steps; nothing if exudyn is missing or misses the accuracy."""
    if not is_installed("exudyn"):
        return []
    from peers.exudyn_slider_crank import speeds

    def solve(steps: float, times: Any) -> Any:
        return speeds(int(steps), ZONE, times)

    try:
        return [loosest(solve, STEPS, times, exact)]
    except ValueError:
        return []


def loosest(
    solve: Solve, settings: Sequence[float], times: Any, exact: Any
) -> tuple[Callable[[], Any], float]:
    """The act with the loosest setting from which on all tighter ones keep the accuracy, and the setting."""
    off = [float(np.abs(solve(setting, times) / exact - 1).max()) for setting in settings]
    good = [setting for k, setting in enumerate(settings) if max(off[k:]) <= WANTED]
    if not good:
        raise ValueError("no setting keeps the accuracy")
    return partial(solve, good[0], times), good[0]
