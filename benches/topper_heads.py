"""How many heads of roots does a knife cover in a second: what each needs, and what is left of it?"""

from __future__ import annotations

from typing import Any

import numpy as np
from common import Row, seconds
from peers import topper as peer

from linkwright.kernel.files.library import library_path
from linkwright.machine.read import read
from linkwright.topping.coverage import COARSE, coverage
from linkwright.topping.edge import Edge
from linkwright.topping.knife import knives

# Stations of the NumPy program: as many as the product has at its coarse setting in this field.
STATIONS = 24

# Heads of the NumPy program; its rate does not depend on the number.
THEIRS = 100_000


def rows(quick: bool) -> list[Row]:
    """A million heads under the library's topper, with an edge that cuts all of them, and a short one."""
    n = 100_000 if quick else 1_000_000
    machine = read(library_path("topper"))
    described = machine.topper
    assert described is not None, "a topper"
    (knife,) = knives(machine, described)
    edge = Edge(knife, described.edge_angle, described.forward_speed)
    rng = np.random.default_rng(1)
    diameter = rng.normal(0.098, 0.012, n).clip(0.03)
    offset, phase = rng.uniform(-0.02, 0.02, n), rng.uniform(0, 2 * np.pi, n)
    heads = slice(0, THEIRS)

    def product(length: float) -> Any:
        return coverage(edge, diameter, offset, phase, length=length, fine=COARSE)

    def theirs(length: float) -> Any:
        return peer.cover(
            0.5 * diameter[heads],
            offset[heads],
            phase[heads],
            angle=edge.angle,
            forward=edge.forward_speed,
            half_stroke=0.5 * knife.stroke,
            rate=knife.rate,
            length=length,
            stations=STATIONS,
        )

    return [_row(product, theirs, length, n, quick) for length in (0.28, 0.15)]


def _row(product: Any, theirs: Any, length: float, n: int, quick: bool) -> Row:
    """One length of the edge."""
    ours, (need, area) = product(length), theirs(length)
    k = min(THEIRS, n)
    off = np.abs(ours.length_needed[:k] - need[:k]).max()
    left = abs(ours.uncut[:k].sum() - area[:k].sum())
    # Their stations miss a top by up to the height of an arc of one step, (π/24)²/8 of some 0.2 m.
    assert off < 1e-3, f"product and NumPy differ by {off:g} m, more than their stations explain"
    assert left < 1e-3 * area[:k].sum() + 1e-6, f"product and NumPy leave areas that differ by {left:g} m²"
    times = seconds([lambda: product(length), lambda: theirs(length)], repeats=3 if quick else 5)
    rates = [n / times[0] / 1e6, k / times[1] / 1e6]
    short = 100 * float((ours.length_needed > length).mean())
    words = (
        f"{n} heads in all phases, edge of {length} m, too short for {short:.3g} % of them: length needed to "
        f"1e-6 m, place, area left; NumPy with {STATIONS} stations errs by up to {off:.1g} m"
    )
    case = f"coverage of heads, L = {length} m"
    # Where the edge is long enough there are no areas to find.
    aim = 5.0 if short > 50 else 12.0
    return Row(case, "M heads/s", rates[0], "NumPy", rates[1], rates[0] / rates[1], aim, "at least", words)
