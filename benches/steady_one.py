"""How fast is the steady state of one machine found, from Python, with all its curves and measures?"""

from __future__ import annotations

import machines
from common import Row, faster, is_installed, seconds

import linkwright as lw

# Relative: SciPy runs at rtol 1e-8; accelerations come from its dense output on a grid.
SPEEDS_AGREE, ACCELERATIONS_AGREE = 2e-7, 1e-5

# Crank speeds from which SciPy goes revolution by revolution [rad/s]: near the answer, and nearly at rest.
STARTS = {"SciPy from a good guess": 10.2, "SciPy from 0.1 rad/s": 0.1}


def rows(quick: bool) -> list[Row]:
    """One row for each way to go with SciPy."""
    machine = machines.two_carts()
    if not is_installed("scipy"):
        return [Row("steady state, one machine", "ms", 1e3 * alone(machine), "SciPy is not installed")]
    from peers import two_carts

    drive = two_carts.Drive()
    found = []
    for name, speed in STARTS.items():
        agree(lw.steady_state(machine), two_carts.steady(drive, speed))
        acts = (lambda: lw.steady_state(machine), lambda speed=speed: two_carts.steady(drive, speed))
        times = seconds(acts, repeats=5 if quick else 21)
        turns = two_carts.steady(drive, speed).turns
        note = f"product to 1e-9, SciPy DOP853 to 1e-8, {turns} revolutions"
        target = 250 if name == "SciPy from a good guess" else None
        found.append(faster("steady state, one machine", times[0], name, times[1], target=target, note=note))
    own = Row(
        "steady state, one machine", "ms", 1e3 * alone(machine), target=0.06, aim="at most", note="alone"
    )
    return [*found, own]


def alone(machine: lw.Machine) -> float:
    """The product's time without a peer [s]."""
    return seconds([lambda: lw.steady_state(machine)], repeats=21)[0]


def agree(ours: object, theirs: object) -> None:
    """Stop if the two answers differ by more than SciPy's accuracy."""
    steepest = max(abs(ours.acceleration_min), abs(ours.acceleration_max))  # type: ignore[attr-defined]
    for name in ("speed_min", "speed_max", "period"):
        a, b = getattr(ours, name), getattr(theirs, name)
        assert abs(a / b - 1) < SPEEDS_AGREE, f"{name}: {a} against {b}"
    b = theirs.acceleration_max  # type: ignore[attr-defined]
    assert abs(steepest / b - 1) < ACCELERATIONS_AGREE, f"acceleration: {steepest} against {b}"
