"""How a train may be operated: sentences, K_A with a misfire, synthesis at critical speeds, masses."""

from pathlib import Path

import numpy as np
import pytest

import linkwright as lw
from linkwright.torsion import TorsionStudy, study_tables, survey

SHIP = Path(__file__).parents[2] / "examples" / "twin_engine_ship" / "machine.toml"
RPM = np.pi / 30


@pytest.fixture(scope="module")
def ship() -> lw.Machine:
    coarse = {"train.run.points": 9, "train.run.orders_max": 2.0, "train.measured": {}}
    return lw.replace(lw.read(SHIP), coarse)


@pytest.fixture(scope="module")
def study(ship: lw.Machine) -> TorsionStudy:
    return lw.torsion_study(ship)


def test_application_factor_with_a_misfire(ship: lw.Machine, study: TorsionStudy) -> None:
    """The worst cylinder by itself in the file gives the same; no other cylinder is worse."""
    assert study.misfire is not None
    service = np.array([750 * RPM])
    by_cylinder = {}
    for engine in ("port", "starboard"):
        for n in range(6):
            out = lw.replace(ship, {f"train.engines.{engine}.factors": {str(n + 1): 0.0}})
            by_cylinder[f"{engine} {n + 1}"] = lw.mesh_torques(out, service).application_factor[:, 0]
    worst = np.max(list(by_cylinder.values()), axis=0)
    assert [gear.stage for gear in study.misfire.gears] == ["port_stage", "starboard_stage"]
    for stage, gear in enumerate(study.misfire.gears):
        # The service speed is among the speeds of the run; the mesh of the gas depends on what speeds are
        # computed together, to 1e-8.
        assert gear.application_factor == pytest.approx(worst[stage], rel=1e-7)
        assert by_cylinder[gear.cylinder][stage] == pytest.approx(worst[stage], rel=1e-7)
        assert gear.application_factor_max >= gear.application_factor > 1
        assert gear.application_factor == pytest.approx(1 + gear.vibratory / gear.mean, rel=1e-12)
    assert study.results()["misfire"]["gears"][0]["stage"] == "port_stage"


def test_orders_alone_and_together(ship: lw.Machine, study: TorsionStudy) -> None:
    """Where an order peaks, stress of one order and of all, from the torques over the section modulus.

    The shaft is the most used of those in which the order peaks: the speed is that of a shaft of one engine,
    whose twin may be used more there. Where it peaks in none, it is the most used of all.
    """
    seen = survey(ship)
    assert study.critical_responses
    assert study.campbell is not None
    assert len(study.critical_responses) == len(study.campbell.critical)
    for one in study.critical_responses:
        response = seen.carried_at(np.array([one.speed]))
        stress = lw.shaft_stress(ship, response)
        used = stress.vibratory[:, 0] / stress.continuous[:, 0]
        row = stress.shafts.index(one.shaft)
        assert one.is_peak or used[row] == pytest.approx(np.nanmax(used), rel=1e-12)
        s = response.shafts.index(one.shaft)
        order = int(np.abs(response.orders - one.order).argmin())
        amplitude = abs(response.shaft_torques[order, s, 0]) / stress.section_modulus[row]
        assert one.single == pytest.approx(amplitude, rel=1e-9)
        assert one.total == pytest.approx(stress.vibratory[row, 0], rel=1e-9)
        assert one.permitted == pytest.approx(stress.continuous[row, 0], rel=1e-9)


def test_sentences(study: TorsionStudy) -> None:
    assert study.operation.startswith("Continuous operation is permitted from 300 to 790 rpm without")
    assert "misfiring, avoid" in study.operation
    barred = lw.torsion_study(lw.read(SHIP.parents[1] / "propeller_shaft_line" / "machine.toml"))
    assert barred.verdict is not None
    (span,) = barred.verdict.barred
    low, high = (speed / RPM for speed in span.barred)
    assert f"but for the barred speed range {low:.5g} to {high:.5g} rpm" in barred.operation
    tight = {"train.couplings.rubber.vibratory_torque_permitted": 9000.0}
    exceeded = lw.torsion_study(lw.replace(barred.machine, tight))
    assert exceeded.verdict is not None
    (row,) = (row for row in exceeded.verdict.judgements if row.state == "exceeds")
    (low, high) = (speed / RPM for speed in row.ranges[0])
    words = f"Continuous operation is not permitted at {low:.5g} to {high:.5g} rpm: limits are exceeded"
    assert exceeded.operation.startswith(words)
    # The barred range stands beside, without a word that the other speeds are permitted.
    assert "is permitted" not in exceeded.operation
    assert "Barred speed range, to be passed quickly: " in exceeded.operation
    tables = {table.name: table for table in study_tables(barred)}
    assert tables["barred"].rows[0][0] == "line"
    assert tables["barred"].rows[0][-1] == "quick passage"


def test_masses_and_stiffnesses(study: TorsionStudy) -> None:
    """Behind a gear of 5 : 1 inertia and stiffness count a twenty-fifth."""
    tables = {table.name: table for table in study_tables(study)}
    propeller = next(row for row in tables["masses"].rows if "propeller" in row[0])
    assert propeller[2:] == ("14500 kg m²", "0.2", "580 kg m²")
    crank = next(row for row in tables["stiffnesses"].rows if row[0] == "port_crank_1")
    assert crank[2:5] == ("1 – 2", "shaft", "100 MN m/rad")
    assert crank[6:] == ("270 mm", f"{np.pi / 16 * 27**3:.4g} cm³")
    frequencies = tables["natural_frequencies"]
    nodes = frequencies.heads.index("nodes")
    assert study.free.nodes
    assert [row[nodes] for row in frequencies.rows] == [
        str(len(study.free.nodes[k])) if f > 0 else "–" for k, f in enumerate(study.free.natural_frequencies)
    ]
