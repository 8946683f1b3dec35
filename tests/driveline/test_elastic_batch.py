"""Many elastic drivelines at once are those machines one by one."""

from __future__ import annotations

import numpy as np
import pytest
from elastic_drives import random_drive
from sizes import random_cases

import linkwright as lw
from linkwright.driveline.batch import elastic_motions

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


def test_variants_with_two_steady_motions_come_to_the_one_of_the_machine_alone() -> None:
    """Below a fold near 21.3 kN m/rad two motions are stable, above it one: each row is the machine alone."""
    machine = lw.replace(
        lw.read("elastic_coupling_of_carts"),
        {
            "drive.motor.torque_start": None,
            "drive.crankshaft.damping": 53.8,
            "mechanism.cranks.A2.phase": np.radians(88.4),
        },
    )
    entry = "drive.crankshaft.stiffness"
    stiffness = np.linspace(19e3, 23e3, 33)
    branches = lw.elastic_branches(machine, entry, stiffness[0], stiffness[-1]).branches
    known = [
        np.interp(20.5e3, branch.parameter[order], branch.torque_peak[-1, order])
        for branch in branches
        for stable in [np.flatnonzero(branch.is_stable)]
        for order in [stable[np.argsort(branch.parameter[stable])]]
    ]
    low, high = sorted(known)
    assert high > 1.25 * low
    # In any order, beside each other in lanes.
    order = np.random.default_rng(48).permutation(len(stiffness))
    found = elastic_motions(machine, {entry: stiffness[order]})
    peaks, multipliers = found.number("torque_peak", "crankshaft"), found.number("multiplier_max")
    for value, peak, multiplier in zip(stiffness[order], peaks, multipliers, strict=True):
        alone = lw.elastic_motion(lw.replace(machine, {entry: float(value)}), n=4)
        assert peak == pytest.approx(float(alone.torque_peak[-1]), rel=1e-6), value
        assert multiplier == pytest.approx(alone.multiplier_max, abs=1e-3), value
    assert (peaks[stiffness[order] < 21e3] < 1.1 * low).all()
    assert (peaks[stiffness[order] > 22e3] > 0.9 * high).all()


def test_an_unstable_motion_of_a_variant_is_that_of_the_machine_alone() -> None:
    """Where a pair of complex multipliers is beyond 1, a row has the numbers of the machine, and says so."""
    machine = lw.replace(
        lw.read("elastic_coupling_of_carts"),
        {
            "drive.motor.torque_start": None,
            "drive.crankshaft.damping": 45.9,
            "mechanism.cranks.A2.phase": 1.622,
        },
    )
    entry, values = "drive.crankshaft.stiffness", np.linspace(21.5e3, 22.5e3, 9)
    found = elastic_motions(machine, {entry: values})
    multipliers = found.number("multiplier_max")
    assert (multipliers > 1).any()
    for k in np.flatnonzero(multipliers > 1)[::3]:
        alone = lw.elastic_motion(lw.replace(machine, {entry: float(values[k])}), n=4)
        assert abs(alone.multipliers[0].imag) > 0
        assert multipliers[k] == pytest.approx(alone.multiplier_max, abs=1e-3)
        peak = found.number("torque_peak", "crankshaft")[k]
        assert peak == pytest.approx(float(alone.torque_peak[-1]), rel=1e-6)
