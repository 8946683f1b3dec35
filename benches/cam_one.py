"""How long does the synthesis of a cam take, with all its checks?"""

from __future__ import annotations

from itertools import count
from typing import Any

import machines
from common import Row, seconds
from peers import cam as peer

import linkwright as lw
from linkwright.cam.profile.faults import cam_faults
from linkwright.cam.profile.profile import cam_profile

N = 3600
H, ROLLER, OFFSET = 0.02, 0.01, 0.005


def rows(quick: bool) -> list[Row]:
    """One cam at 3600 angles, another base radius each time."""
    machine = machines.roller_cam()
    nth = count()

    def base() -> float:
        return 0.04 + 1e-6 * next(nth)

    def product(radius: float | None = None) -> Any:
        entry = {"mechanism.cams.cam.base_radius": radius or base()}
        profile = cam_profile(lw.replace(machine, entry), n=N)
        return profile, cam_faults(profile)

    def theirs(radius: float | None = None) -> Any:
        return peer.synthesis(N, H, radius or base(), ROLLER, OFFSET)

    found, expected = product(0.04)[0], theirs(0.04)
    off = abs(found.pressure_angle_max - expected[3])
    assert off < 1e-5, f"product and NumPy differ by {off:g} rad, more than samples 0.1° apart explain"
    times = seconds([product, theirs], repeats=5 if quick else 11)
    words = (
        f"{N} angles: contact, profile, pressure angle, curvature; product: extremes and undercut located "
        "exactly, self-crossing looked for; NumPy: extremes at the samples"
    )
    ratio = times[1] / times[0]
    return [Row("cam synthesis", "ms", 1e3 * times[0], "NumPy", 1e3 * times[1], ratio, 0.3, "at most", words)]
