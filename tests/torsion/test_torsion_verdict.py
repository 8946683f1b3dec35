"""Whether a train bears its vibration: every limit told with its numbers."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest

import linkwright as lw
from linkwright import forced_vibration
from linkwright.kernel.result import finite
from linkwright.torsion import excited_train, torsion_response
from linkwright.torsion.limits.criteria import Criterion, criteria
from linkwright.torsion.limits.verdict import Judgement, Verdict, verdict

TRAIN = """
format = 1
name = "Engine, coupling, gear, fan"
[train.discs]
engine = { inertia = 4 }
pinion = { inertia = 0.5 }
wheel = { inertia = 3 }
fan = { inertia = 20 }
[train.shafts.slow]
between = ["wheel", "fan"]
stiffness = 2e5
loss_factor = 0.02
[train.shafts.slow.limit]
diameter = 0.09
stress_permitted = "SHAFT"
stress_transient = "1 GPa"
stress_greatest = "GREATEST"
[train.couplings.rubber]
between = ["engine", "pinion"]
stiffness = 2e4
loss_factor = 0.2
torque_permitted = TORQUE
vibratory_torque_permitted = VIBRATORY
heat_permitted = HEAT
[train.dampers.ring]
on = "engine"
ring_inertia = 0.5
damping = 12
heat_permitted = RING
[train.gears]
stage = { between = ["pinion", "wheel"], ratio = 2.5 }
[train.loads.fan]
on = "fan"
torque = LOAD
speed = 80
[train.excitations.firing]
on = "engine"
harmonics = [{ order = 2, torque = 300 }, { order = 4, torque = 90 }]
[train.run]
speed_min = 30
speed_max = 200
points = 120
"""
SOUND = {
    "SHAFT": "500 MPa",
    "GREATEST": "900 MPa",
    "TORQUE": "1e6",
    "VIBRATORY": "1e6",
    "HEAT": "1e6",
    "RING": "1e6",
    "LOAD": "90000",
}


def machine(**changes: str) -> lw.Machine:
    text = TRAIN
    for key, value in (SOUND | changes).items():
        text = text.replace(key, value)
    return lw.loads(text)


def curves(subject: lw.Machine, speeds: np.ndarray | None = None) -> dict[tuple[str, str], Criterion]:
    at = excited_train(subject, speeds)
    return {(each.part, each.what): each for each in criteria(subject, at, torsion_response(at))}


def row(found: Verdict, part: str, what: str) -> Judgement:
    (one,) = [each for each in found.judgements if (each.part, each.what) == (part, what)]
    return one


def test_sound_train_keeps_all_its_limits() -> None:
    found = verdict(machine())
    assert found.state == "ok"
    assert found.barred == ()
    assert {(each.part, each.what) for each in found.judgements} == {
        ("slow", "vibratory stress"),
        ("slow", "maximum stress"),
        ("rubber", "torque"),
        ("rubber", "vibratory torque"),
        ("rubber", "heat"),
        ("ring", "heat"),
        ("stage", "drop of torque below its mean"),
    }
    assert all(each.state == "ok" and each.words.endswith("within limit") for each in found.judgements)


@pytest.mark.parametrize(
    ("key", "value", "part", "what"),
    [
        ("GREATEST", "300 MPa", "slow", "maximum stress"),
        ("TORQUE", "2000", "rubber", "torque"),
        ("VIBRATORY", "300", "rubber", "vibratory torque"),
        ("HEAT", "60", "rubber", "heat"),
        ("RING", "10", "ring", "heat"),
        ("LOAD", "500", "stage", "drop of torque below its mean"),
    ],
)
def test_one_limit_exceeded(key: str, value: str, part: str, what: str) -> None:
    found = verdict(machine(**{key: value}))
    assert found.state == "exceeds"
    over = [each for each in found.judgements if each.state != "ok"]
    assert [(each.part, each.what) for each in over] == [(part, what)]
    assert found.words[0] == over[0].words
    assert over[0].found > over[0].permitted


def test_numbers_are_those_of_the_curves_and_bounds_lie_on_the_limit() -> None:
    subject = machine(HEAT="60")
    one = row(verdict(subject), "rubber", "heat")
    curve = curves(subject, np.array([one.speed, *one.ranges[0]]))["rubber", "heat"].found
    assert one.found == pytest.approx(curve[0], rel=1e-12)
    # The range begins inside the run.
    assert curve[1] == pytest.approx(60, rel=1e-8)
    dense = curves(subject, np.linspace(30, 200, 20_001))["rubber", "heat"].found
    # A peak found to some 10⁻⁴ of the way between neighbours, flat on top.
    assert one.found == pytest.approx(dense.max(), rel=1e-5)


def test_heat_of_a_coupling_is_the_loss_of_its_cycles() -> None:
    """P = ½ ν Ω η k Δ² summed over orders, Δ from the torque T = k √(1 + η²) Δ."""
    subject = machine()
    forced = forced_vibration(subject)
    torque = np.abs(forced.shaft_torques[:, forced.shafts.index("rubber")])
    twist = torque / (2e4 * math.sqrt(1 + 0.2**2))
    wanted = 0.5 * forced.orders[:, None] * forced.speeds * 0.2 * 2e4 * twist**2
    found = curves(subject)["rubber", "heat"].found
    np.testing.assert_allclose(found, wanted.sum(axis=0), rtol=1e-12)


def test_shaft_above_its_continuous_limit_is_barred() -> None:
    found = verdict(machine(SHAFT="5 MPa"))
    one = row(found, "slow", "vibratory stress")
    assert found.state == one.state == "bar"
    assert len(found.barred) == len(one.ranges) >= 1
    assert one.ranges == tuple(each.barred for each in found.barred)
    assert one.words.endswith("pass quickly")


@pytest.mark.parametrize(
    ("transient", "reason"),
    [("", "no stress permitted"), ('stress_transient = "6 MPa"\n', "passage not permitted from")],
)
def test_shaft_that_cannot_be_barred_exceeds(transient: str, reason: str) -> None:
    text = TRAIN.replace('stress_transient = "1 GPa"\n', transient)
    for key, value in (SOUND | {"SHAFT": "5 MPa"}).items():
        text = text.replace(key, value)
    one = row(verdict(lw.loads(text)), "slow", "vibratory stress")
    assert one.state == "exceeds"
    assert reason in one.reason


def rule(strength: str, rated: float) -> Verdict:
    """The slow shaft as a propulsion shaft."""
    text = TRAIN
    start, end = text.index("[train.shafts.slow.limit]"), text.index("[train.couplings")
    limit = f'limit = {{ kind = "iacs_m68", tensile_strength = "{strength}", diameter = 0.09, '
    limit += "design_factor = 0.05 }\n"
    text = text[:start] + limit + text[end:]
    for key, value in SOUND.items():
        text = text.replace(key, value)
    return verdict(lw.loads(text + f"speed_rated = {rated}\n"))


def test_barred_speeds_near_service_are_told() -> None:
    one = row(rule("500 MPa", 45), "slow", "vibratory stress")
    assert one.state == "exceeds"
    assert "80%" in one.reason


def test_what_is_not_judged_is_told() -> None:
    found = rule("700 MPa", 100)
    assert any("no limit is given by IACS UR M68 above" in each for each in found.notes)
    assert any("as 600 MPa" in each for each in found.notes)


def test_a_limit_names_its_rule() -> None:
    by_rule = {each.part: each.rule for each in rule("700 MPa", 45).judgements}
    assert by_rule == {"slow": "IACS UR M68", "rubber": "given", "ring": "given", "stage": ""}


def test_loop_of_rigid_stages_is_told() -> None:
    text = """
format = 1
name = "Two ways round"
[train.discs]
a = { inertia = 1 }
b = { inertia = 1 }
c = { inertia = 1 }
[train.gears]
ab = { between = ["a", "b"], ratio = 2, kind = "internal" }
bc = { between = ["b", "c"], ratio = 2, kind = "internal" }
ac = { between = ["a", "c"], ratio = 4, kind = "internal" }
[train.excitations.pulse]
on = "a"
harmonics = [{ order = 1, torque = 100 }]
[train.run]
speed_min = 10
speed_max = 20
"""
    found = verdict(lw.loads(text))
    assert found.judgements == ()
    assert sum("statically indeterminate" in each for each in found.notes) == 1
    assert found.notes[0].startswith("ab, bc, ac: ")


def test_goes_to_json() -> None:
    told = verdict(machine(SHAFT="5 MPa", HEAT="60")).to_dict()
    again = json.loads(json.dumps(finite(told), allow_nan=False))
    assert again["state"] == "exceeds"
    assert {each["unit"] for each in again["judgements"]} == {"Pa", "N m", "W"}
    assert again["barred"][0]["shaft"] == "slow"


def test_resonance_without_damping_has_no_bound() -> None:
    # ω² = 2k/J = 256² is met by the second order at 128 rad/s, to the last digit.
    subject = lw.loads("""
format = 1
name = "Undamped"
[train.discs]
a = { inertia = 1 }
b = { inertia = 1 }
[train.shafts.s]
between = ["a", "b"]
stiffness = 32768
limit = { torque_permitted = 100 }
[train.excitations.e]
on = "a"
harmonics = [{ order = 2, torque = 10 }]
[train.run]
speed_min = 64
speed_max = 192
points = 3
""")
    found = verdict(subject)
    (one,) = found.judgements
    assert (one.state, one.found, one.speed) == ("exceeds", math.inf, 128.0)
    assert "torque unbounded" in one.words
    json.dumps(finite(found.to_dict()), allow_nan=False)
