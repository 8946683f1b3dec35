"""What does generality cost? A six-bar linkage from a file against a four-bar kernel by hand."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from common import Row, seconds
from peers import kernels

import linkwright as lw

HERE = Path(__file__).parent

# Angles in a call: the core does so many in one thread, so that both have one.
N_ANGLES = 8192

# A Stephenson III chain has two dyads and a coupler point between them.
DYADS = 2


def rows(quick: bool) -> list[Row]:
    """Rates per dyad on one thread."""
    case, peer = "six-bar from a file, rate per dyad", "four-bar by hand, one thread"
    if not kernels.is_here():
        return [Row(case, "ns", None, peer, None, None, 7.0, "at most", note="rustc is not installed")]
    phi = np.linspace(0, 2 * np.pi, N_ANGLES, endpoint=False)
    ours, theirs = np.empty((1, 6, N_ANGLES)), np.empty((8, N_ANGLES))
    machine = lw.read(HERE / "six_bar.toml")

    def product() -> object:
        return lw.motions(machine, phi, points=["S"], out=ours)

    def by_hand() -> object:
        return kernels.four_bar_over(phi, theirs, threads=1)

    off = np.abs(lw.motions(machine, phi, points=["P"])[0] - by_hand()[:6]).max()
    assert off < 1e-12, f"product and kernel differ by {off:g}"
    times = seconds([product, by_hand], repeats=7 if quick else 21)
    per_dyad, per_position = times[0] / N_ANGLES / DYADS, times[1] / N_ANGLES
    note = (
        f"{N_ANGLES} angles a call, one thread, joint with two derivatives; the call from Python is included"
    )
    ratio = per_position / per_dyad
    return [Row(case, "ns", 1e9 * per_dyad, peer, 1e9 * per_position, ratio, 7.0, "at most", note)]
