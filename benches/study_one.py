"""How long does the study of a machine take, with everything that its report shows?"""

from __future__ import annotations

import machines
from common import Row, seconds

import linkwright as lw


def rows(quick: bool) -> list[Row]:
    """The drive with two carts, when everything is warm."""
    machine = machines.two_carts()
    alone, within = lw.steady_state(machine, accuracy=1e-10), lw.study(machine).steady_state
    assert within is not None
    off = abs(within.speed_max / alone.speed_max - 1)
    assert off < 1e-9, f"the study differs by {off:g} from the analysis alone"
    time = seconds([lambda: lw.study(machine)], repeats=5 if quick else 15)[0]
    note = "reduction, steady motion, run-up, forces, linkage; warm"
    return [Row("study of two carts", "ms", 1e3 * time, target=10.0, aim="at most", note=note)]
