"""How long does the whole torsional study of an engine take?"""

from __future__ import annotations

import numpy as np
from common import ROOT, Row, seconds

import linkwright as lw
from linkwright.torsion.modes.free import free_vibration
from linkwright.torsion.response.forced import forced_vibration
from linkwright.torsion.response.stress import shaft_stress


def rows(quick: bool) -> list[Row]:
    """A V-12 with generator: free, forced over 200 speeds to order 24, sums in phase, stresses."""
    machine = lw.read(ROOT / "machines" / "v_diesel.toml")
    assert machine.train is not None
    assert machine.train.run is not None
    assert machine.train.run.points == 200
    found = forced_vibration(machine)
    heat = found.shaft_heat.sum(axis=0) + found.disc_heat.sum(axis=0)
    np.testing.assert_allclose(heat, found.power, rtol=1e-7)

    def study() -> None:
        free_vibration(machine)
        shaft_stress(machine, forced_vibration(machine))

    (time,) = seconds([study], repeats=3 if quick else 9)
    note = "from the machine file's numbers on: gas cycle, all torques, 48 half orders, sums, stresses"
    case = f"engine study: {len(found.discs)} discs, 200 speeds"
    return [Row(case, "ms", 1e3 * time, target=25.0, aim="at most", note=note)]
