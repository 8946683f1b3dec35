"""Many elastic drivelines at once are those machines one by one."""

from __future__ import annotations

import numpy as np
import pytest
from elastic_drives import random_drive
from sizes import random_cases

import linkwright as lw

QUANTITIES = (
    "period",
    "multiplier_max",
    "torque_max.{shaft}",
    "torque_rms.{shaft}",
    "power_dissipated.{shaft}",
    "speed_min.{station}",
    "acceleration_max.{station}",
    "unevenness.{station}",
)


def test_variants_of_random_drives_are_those_of_single_machines() -> None:
    """Numbers of shafts and stations to 1e-6, whatever of mechanism, motor and driveline varies."""
    for number, rng in random_cases(4831, 3, 40):
        machine = random_drive(rng).machine
        motion = lw.elastic_motion(machine, n=4)
        names = {"shaft": motion.shafts[-1], "station": motion.stations[0]}
        responses = {f"r{k}": f"elastic_motion.{name.format(**names)}" for k, name in enumerate(QUANTITIES)}
        places = ["mechanism.cranks.A.radius", "bodies.S.mass", "drive.flywheel.inertia"]
        places += ["drive.gearbox.ratio"] if rng.random() < 0.5 else ["drive.motor.torque_stall"]
        variables = {
            f"x{k}": {"address": place, "range": [0.9 * lw.get(machine, place), 1.1 * lw.get(machine, place)]}
            for k, place in enumerate(places)
        }
        plan = lw.new_study(machine, {"variables": variables, "responses": responses})
        assert all(asked.is_batch for asked in plan.asked)
        values = plan.values(rng.random((12, len(places))))
        rows = lw.evaluate(plan, values)
        assert not rows.one_by_one
        for row in (0, 5, 11):
            entries = {place: float(values[f"x{k}"][row]) for k, place in enumerate(places)}
            alone = lw.elastic_motion(lw.replace(machine, entries), n=4)
            for name, response in responses.items():
                _, quantity, *part = response.split(".")
                expected = getattr(alone, quantity)
                if part:
                    of = alone.stations if part[0] in alone.stations else alone.shafts
                    expected = expected[of.index(part[0])]
                off = 1e-7 if quantity == "multiplier_max" else 0.0
                assert rows.columns[name][row] == pytest.approx(float(expected), rel=1e-6, abs=off), (
                    number,
                    response,
                )


def test_a_variant_that_stalls_says_so_beside_others_that_run() -> None:
    """Where many are computed at once, the reason is that of the machine alone."""
    machine = lw.read("elastic_coupling_of_carts")
    variable = {"address": "loads.rolling1.force", "range": ["3 kN", "300 kN"]}
    tables = {"variables": {"force": variable}, "responses": {"peak": "elastic_motion.torque_max.crankshaft"}}
    rows = lw.evaluate(lw.new_study(machine, tables), {"force": np.array([3.5e3, 300e3])})
    assert rows.status.tolist() == [0, 1]
    with pytest.raises(lw.SteadyStateError) as error:
        lw.elastic_motion(lw.replace(machine, {"loads.rolling1.force": 300e3}))
    assert rows.why(1) == " ".join(str(error.value).split())
    assert rows.columns["peak"][0] > 0
