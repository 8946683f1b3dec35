"""The worst single misfire: each case against the file that says so, the worst against all of them."""

import numpy as np
import pytest

import linkwright as lw
from linkwright import shaft_stress
from linkwright.torsion import excited_train, survey, torsion_response
from linkwright.torsion.limits.misfire import misfire_verdict, misfires


def engine() -> lw.Machine:
    return lw.replace(lw.read("v8_diesel"), {"train.run.points": 6, "train.run.orders_max": 3.0})


def test_cases_are_those_of_the_file_and_the_worst_is_found() -> None:
    machine = engine()
    seen = survey(machine)
    found = misfire_verdict(machine, seen)
    assert found is not None
    stresses = []
    cases = list(misfires(machine, seen.at))
    assert [case.cylinder for case in cases] == [str(n + 1) for n in range(8)]
    for n, case in enumerate(cases):
        told = excited_train(lw.replace(machine, {"train.engine.factors": {str(n + 1): 0.0}}))
        np.testing.assert_allclose(case.at.torques.harmonics, told.torques.harmonics, rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(case.at.torques.mean, told.torques.mean, rtol=1e-9, atol=1e-9)
        stresses.append(shaft_stress(machine, torsion_response(told)).vibratory[0].max())
    row = found.judgements[0]
    assert (row.part, row.what) == ("crank_1", "vibratory stress")
    # The survey has the speeds of the run, and more.
    assert row.found >= max(stresses) * (1 - 1e-9)
    assert row.is_kept
    # A dead cylinder excites half orders far more than sound ones, which fire evenly.
    sound = shaft_stress(machine, seen.found).vibratory[0].max()
    assert row.found > sound


def test_what_is_exceeded_restricts_the_operation() -> None:
    limit = {
        "train.engine.limit.stress_permitted": 1.2e7,
        "train.couplings.coupling.vibratory_torque_permitted": 300.0,
    }
    study = lw.torsion_study(lw.replace(engine(), limit))
    assert study.misfire is not None
    rows = {(row.part, row.what): row for row in study.misfire.judgements}
    over = rows["coupling", "vibratory torque"]
    assert over.above is not None
    assert over.above[0] <= over.speed <= over.above[1]
    assert any(
        f"Cylinder {over.cylinder} misfiring" in note and "restrict" in note for note in study.warnings
    )
    assert not any("misfiring" in finding for finding in study.findings)


@pytest.mark.parametrize("factors", [{"3": 0.0}])
def test_no_second_misfire_is_looked_at(factors: dict[str, float]) -> None:
    machine = lw.replace(engine(), {"train.engine.factors": factors})
    assert misfire_verdict(machine, survey(machine)) is None
