"""How many rod strings are predicted, and how many measured cards diagnosed, in a second?"""

from __future__ import annotations

import numpy as np
from common import Row, seconds
from peers import rods

import linkwright as lw

N, N_QUICK, N_PEER = 10_000, 2000, 3

# Difference of peak loads over their range that is allowed to either side.
AGREE = 0.02

WELL = """format = 1
name = "well"
[rod_string]
specific_gravity = 0.9
stroke = "54 in"
speed = "16 rpm"
[[rod_string.sections]]
rod = "3/4"
length = "5000 ft"
grade = "D"
[rod_string.pump]
plunger = "1.5 in"
fluid_level = "4500 ft"
bulk_modulus = "1e15 Pa"
"""


def rows(quick: bool) -> list[Row]:
    """Predictions a second beside a march in time, and cards of a day."""
    n = N_QUICK if quick else N
    machine = lw.loads(WELL)
    draw = np.random.default_rng(49)
    entries = {
        "rod_string.stroke": draw.uniform(1.2, 1.6, n),
        "rod_string.speed": draw.uniform(0.8, 1.7, n),
        "rod_string.damping_factor": draw.uniform(0.08, 0.2, n),
        "rod_string.pump.plunger": draw.uniform(0.030, 0.045, n),
    }
    return [predictions(machine, entries, quick), cards(machine, n)]


def predictions(machine: lw.Machine, entries: dict[str, np.ndarray], quick: bool) -> Row:
    """Strings a second; their peak loads are compared."""
    found = lw.rod_strings(machine, entries)
    n = len(found.load_max)
    assert np.isfinite(found.load_max).all()
    time = seconds([lambda: lw.rod_strings(machine, entries)], repeats=2 if quick else 3)[0]

    def theirs(k: int) -> tuple[float, float]:
        one = lw.replace(machine, {name: float(column[k]) for name, column in entries.items()}).rod_string
        section = one.sections[0]
        return rods.peak_loads(
            section.length,
            section.modulus * section.area,
            section.mass,
            one.damping_rate,
            one.fluid_load,
            one.stroke,
            2 * np.pi / one.speed,
        )

    for k in range(N_PEER):
        reach = found.load_max[k] - found.load_min[k]
        own = np.array([found.load_max[k], found.load_min[k]]) - found.weight_fluid[k]
        off = np.abs(own - theirs(k)).max() / reach
        assert off < AGREE, f"string {k}: peak loads differ by {off:g} of their range"
    peer = seconds([lambda: [theirs(k) for k in range(N_PEER)]], repeats=1)[0] / N_PEER
    return Row(
        "rod strings, batch",
        "strings/s",
        n / time,
        "march in time with NumPy",
        1 / peer,
        n / time * peer,
        target=5000.0,
        aim="at least",
        note=f"{n} strings of one section, peak loads within {100 * AGREE:.0f} % of their range",
    )


def cards(machine: lw.Machine, n: int) -> Row:
    """Measured cards a second, with 100 N of noise, the damping fitted to some of them."""
    from linkwright.rods.card import SurfaceCard

    motion = lw.rod_string(machine)
    at = np.arange(200) / 200
    own = np.arange(len(motion.time)) / len(motion.time)
    position, load = (np.interp(at, own, x, period=1) for x in (motion.rod_position, motion.rod_load))
    noise = np.random.default_rng(50).normal(size=(n, 200)) * 100
    day = [SurfaceCard(position, load + row, motion.period) for row in noise]
    time = seconds([lambda: lw.diagnose_cards(machine, day)], repeats=1)[0]
    note = f"{n} cards of 200 samples of one well"
    return Row("measured cards, batch", "cards/s", n / time, target=2000.0, aim="at least", note=note)
