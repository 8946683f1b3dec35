"""How many cams are looked at in a second, in a search over base radius, offset and law?"""

from __future__ import annotations

from typing import Any

import machines
import numpy as np
from common import Row, seconds
from peers import cam as peer

from linkwright.cam.search import search_cams

N_ANGLES = 360
LAWS = ("cycloidal", "modified_sine", "polynomial_3_4_5", "harmonic")
H, ROLLER = 0.02, 0.01

# Cams of the NumPy program, which is that much slower; its rate does not depend on the number.
THEIRS = 20_000


def rows(quick: bool) -> list[Row]:
    """A million cams at 360 angles."""
    n = 100_000 if quick else 1_000_000
    machine = machines.roller_cam()
    rng = np.random.default_rng(1)
    base, offset = rng.uniform(0.02, 0.08, n // len(LAWS)), rng.uniform(-0.01, 0.01, n // len(LAWS))
    phi = np.linspace(0, 2 * np.pi, N_ANGLES, endpoint=False)

    def product() -> Any:
        return search_cams(
            machine, entries={"base_radius": base, "offset": offset}, laws=LAWS, per_turn=N_ANGLES
        )

    def theirs() -> Any:
        return peer.search(peer.cycloidal_cam(phi, H), base[:THEIRS], ROLLER, offset[:THEIRS])

    ours, expected = product(), theirs()
    k = min(THEIRS, len(base))
    off = np.abs(np.tan(ours.pressure_angle_max[:k]) - expected[:, 0]).max()
    assert off < 1e-3, f"product and NumPy differ by {off:g}, more than other angles explain"
    times = seconds([product, theirs], repeats=3 if quick else 5)
    rates = [n / times[0] / 1e6, k / times[1] / 1e6]
    words = f"{n} cams of {len(LAWS)} laws at {N_ANGLES} angles: pressure angle, curvature, undercut"
    ratio = rates[0] / rates[1]
    return [Row("search over cams", "M cams/s", rates[0], "NumPy", rates[1], ratio, 6.0, "at least", words)]
