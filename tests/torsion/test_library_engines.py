"""The engines of the library: torque of their indicated pressure, and limits that they keep."""

from __future__ import annotations

import math

import numpy as np
import pytest

from linkwright import read, torsion_study
from linkwright.kernel.files.library import library_path
from linkwright.torsion import Combustion, dead_centres, running_gears


@pytest.mark.parametrize("name", ["v_diesel", "v8_diesel"])
def test_engine(name: str) -> None:
    machine = read(library_path(name))
    assert machine.train is not None
    engine, run = machine.train.engine, machine.train.run
    assert engine is not None
    assert run is not None
    study = torsion_study(machine)
    assert study.findings == []
    found = study.forced
    assert found is not None
    strokes = [each.stroke for each in dead_centres(engine.radius, running_gears(engine))]
    swept = math.pi / 4 * engine.bore**2 * math.fsum(strokes) * len(engine.throws)
    # A cycle of two revolutions does the work p_i V_h.
    assert isinstance(engine.gas, Combustion)
    assert engine.gas.mean_effective_pressure is not None
    pressure = engine.gas.mean_effective_pressure
    torque = pressure * swept / (4 * math.pi)
    loads = machine.train.loads
    at = int(np.argmin(np.abs(found.speeds - run.service)))
    resistance = {key: load.resistance(float(found.speeds[at])) for key, load in loads.items()}
    share = resistance["generator"] / math.fsum(resistance.values())
    tail = found.mean_torques[found.shafts.index("tail"), at]
    # Harmonics of the gas are sums over a mesh of crank angles, with the mean to some 1e-4.
    assert tail == pytest.approx(torque * share, rel=1e-3)
