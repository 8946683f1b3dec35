"""How long do 360 positions of a four-bar with velocities and accelerations take, at first and later?"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import machines
import numpy as np
from common import Row, faster, is_installed, seconds

import linkwright as lw

HERE = Path(__file__).parent
N = 360
POINTS = ("A", "R", "P")

# One process a measurement: what is compiled or loaded at the first call counts.
_OURS = """
import sys; sys.path.append(sys.path.pop(0))
import time, numpy as np
start = time.perf_counter()
import machines, linkwright as lw
machine, phi = machines.four_bar(), np.arange(1, 361) * 2 * np.pi / 360
lw.motions(machine, phi, points=("A", "R", "P"))
print(time.perf_counter() - start)
"""
_THEIRS = """
import sys; sys.path.append(sys.path.pop(0))
import time, numpy as np
start = time.perf_counter()
from peers import pylinkage_four_bar as peer
made = peer.linkage(0.35)
peer.motion(made)
print(time.perf_counter() - start)
"""


def rows(quick: bool) -> list[Row]:
    """The call when everything is warm, and the first one of a process."""
    machine, phi = machines.four_bar(), np.arange(1, N + 1) * 2 * np.pi / N

    def array() -> object:
        return lw.motions(machine, phi, points=POINTS)

    def named() -> object:
        found = lw.kinematics(machine, phi)
        return found.points["P"].d2, found.links["R.rocker"].angle

    repeats = 7 if quick else 21
    if not (is_installed("pylinkage") and is_installed("numba")):
        ours, by_name = seconds([array, named], repeats=repeats)
        note = "pylinkage with numba is not installed: pip install linkwright[bench]"
        return [
            Row("360 positions, motions", "ms", 1e3 * ours, "pylinkage", target=10, note=note),
            Row("360 positions, kinematics", "ms", 1e3 * by_name, target=0.05, aim="at most", note=note),
            Row("360 positions, first result", "ms", 1e3 * first(_OURS), "pylinkage", note=note),
        ]
    return compared(array, named, repeats)


def compared(array: object, named: object, repeats: int) -> list[Row]:
    """All rows beside pylinkage's compiled solver."""
    from peers import pylinkage_four_bar as peer

    made = peer.linkage(0.35)
    theirs = peer.motion(made)
    ours = lw.kinematics(machines.four_bar(), np.arange(1, N + 1) * 2 * np.pi / N)
    for name, index in (("A", 2), ("R", 3), ("P", 4)):
        each = ours.points[name]
        for mine, other in zip((each.position, each.d1, each.d2), theirs, strict=True):
            off = np.abs(mine - other[:, index]).max()
            assert off < 1e-12, f"product and pylinkage differ by {off:g} in {name}"

    fast, by_name, slow = seconds([array, named, lambda: peer.motion(made)], repeats=repeats)  # type: ignore[list-item]
    what = "pylinkage step_fast_with_kinematics, numba"
    note = "three joints, position, velocity, acceleration; pylinkage's turn of its own compiled solver"
    begin = "a new process, from its imports, NumPy's not counted; the peer loads what numba has cached"
    return [
        faster("360 positions, motions", fast, what, slow, target=10, note=note),
        Row(
            "360 positions, kinematics",
            "ms",
            1e3 * by_name,
            what,
            1e3 * slow,
            slow / by_name,
            0.05,
            "at most",
            f"{note}; all points and links by name, one of each looked at",
        ),
        faster("360 positions, first result", first(_OURS), what, first(_THEIRS), note=begin),
    ]


def first(program: str) -> float:
    """Seconds that a program prints."""
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=HERE, capture_output=True, text=True, check=True
    )
    return float(done.stdout)
