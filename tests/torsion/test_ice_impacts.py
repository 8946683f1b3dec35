"""Ice at a propeller in time: closed form of a half-sine pulse, SciPy, the rules' figures, gear stages."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import linkwright as lw
from linkwright import InputError, MachineFileError
from linkwright.torsion import TorsionTransient
from linkwright.torsion.in_time.ice_impacts import _SAMPLES, pulses
from linkwright.torsion.model.ice_impacts import IceImpacts, IcePropeller

RPM = np.pi / 30
SPEED = 120 * RPM
ONE = {"kind": "ice_impacts", "on": "propeller", "blades": 4, "impacts": 1, "amplitude": 1.0, "ramp": 0.0}


def met(*ice: dict[str, Any], speed: float = SPEED, motor: float = 1e12, **more: Any) -> TorsionTransient:
    text = f"""
        format = 1
        name = "Line"
        [train.discs]
        motor = {{ inertia = {motor} }}
        propeller = {{ inertia = 6000 }}
        [train.shafts]
        line = {{ between = ["motor", "propeller"], stiffness = 8e6 }}
        [train.transient]
        duration = 0.8
        speed = {speed}
        settle = 0
        accuracy = 1e-11
        sample_time = 1e-4
        """
    machine = lw.loads(text)
    manoeuvre = machine.train.transient.model_validate(
        machine.train.transient.model_dump() | {"events": ice} | more
    )
    return lw.torsion_transient(machine, manoeuvre)


def test_pulse_of_a_half_sine_by_the_closed_form() -> None:
    # So small a torque hardly turns the propeller out of its even rotation: the pulse is one of time, and
    # x = T/k (sin pt − (p/ω) sin ωt)/(1 − p²/ω²) while it lasts, free vibration thereafter.
    torque, k, J, alpha = 1.0, 8e6, 6000.0, math.radians(90)
    moved = met(ONE | {"time": 0.1, "torque": torque, "duration": alpha})
    omega, p = math.sqrt(k / J), math.pi * SPEED / alpha
    lasts = math.pi / p
    t = moved.time - 0.1

    def during(s: Any) -> Any:
        return torque / (1 - (p / omega) ** 2) * (np.sin(p * s) - p / omega * np.sin(omega * s))

    def rate(s: float) -> float:
        factor = torque / (1 - (p / omega) ** 2)
        return factor * p * (math.cos(p * s) - math.cos(omega * s))

    after = during(lasts) * np.cos(omega * (t - lasts)) + rate(lasts) / omega * np.sin(omega * (t - lasts))
    wanted = np.where(t < 0, 0.0, np.where(t < lasts, during(t), after))
    # Corners of the table, a quarter of a degree wide, are worth 1e-5 of the pulse.
    np.testing.assert_allclose(moved.torque[0], wanted, atol=3e-5)
    # The shaft drives the propeller against the ice.
    assert moved.torque_max[0] == pytest.approx(wanted.max(), rel=1e-4)
    (ice,) = moved.ice
    assert ice.end == pytest.approx(0.1 + lasts, abs=2e-4)


def test_large_pulses_by_scipy() -> None:
    # The propeller slows down, and the pulses with it.
    torque, alpha, ramp, count = 4e5, math.radians(90), 1.5 * math.pi, 5
    event = {"time": 0.05, "torque": torque, "duration": alpha, "impacts": count, "ramp": ramp}
    moved = met(ONE | event)
    length = (count - 1) * math.pi / 2 + alpha

    def rates(t: float, y: Any) -> Any:
        phi = y[1] - SPEED * 0.05
        ice = 0.0
        if 0 < phi < length:
            ice = torque * abs(math.sin(math.pi * phi / alpha)) * min(phi / ramp, (length - phi) / ramp, 1.0)
        twist = 8e6 * (y[0] - y[1])
        return [y[2], y[3], -twist / 1e12, (twist - ice) / 6000]

    # Steps so short that the corners do not matter.
    start = [0.0, 0.0, SPEED, SPEED]
    options = {"t_eval": moved.time, "max_step": 2e-4, "rtol": 1e-10, "atol": 1e-12}
    found = solve_ivp(rates, (0, 0.8), start, method="DOP853", **options)
    np.testing.assert_allclose(moved.torque[0], 8e6 * (found.y[0] - found.y[1]), atol=2e-5 * torque)
    (ice,) = moved.ice
    assert ice.speed_min == pytest.approx(found.y[3][moved.time <= ice.end].min(), rel=5e-6)
    assert abs(moved.energy_error) < 1e-9


def test_begins_at_its_time_from_rest_and_twice() -> None:
    course = {"kind": "torque", "time": 0.0, "on": "propeller", "torque": 2e5}
    ice = ONE | {"torque": 100.0, "duration": 0.3}
    moved = met(course, ice | {"time": 0.3}, ice | {"time": 0.5, "impacts": 2}, speed=0.0, motor=50.0)
    work = moved.work
    # The work of the ice: of a pulse over the angle, T α 2/π.
    assert work["ice_impacts_2"] == pytest.approx(-100 * 0.3 * 2 / math.pi, rel=1e-4)
    assert work["ice_impacts_3"] == pytest.approx(-200 * 0.3 * 2 / math.pi, rel=1e-4)
    assert [one.start for one in moved.ice] == [0.3, 0.5]


def test_ice_does_not_come_again() -> None:
    # The propeller speeds up to many times its speed: the table is made longer.
    course = {"kind": "torque", "time": 0.3, "on": "propeller", "torque": 1e6}
    ice = ONE | {"time": 0.1, "torque": 1000.0, "duration": 0.5}
    moved = met(ice, course, speed=1.0, motor=50.0)
    assert moved.work["ice_impacts_1"] == pytest.approx(-1000 * 0.5 * 2 / math.pi, rel=1e-3)


def test_a_propeller_that_stops_is_said() -> None:
    moved = met(ONE | {"time": 0.1, "torque": 2e7, "duration": 2.0}, accuracy=1e-7)
    assert any("the ice stops propeller" in note for note in moved.notes)
    assert moved.ice[0].speed_min < 0


def test_sequence_of_pulses() -> None:
    event = IceImpacts.model_validate(
        {"kind": "ice_impacts", "time": 0, "on": "p", "blades": 4, "torque": 1, "case": 3, "impacts": 8}
    )
    assert len(event.begins) == 16
    assert np.diff(event.begins) == pytest.approx(math.pi / 4)
    angle = np.linspace(-1, event.length + 1, 200_001)
    found = pulses(event, angle)
    # Beyond the ramps two blocks for 45° of four blades are a rectified sine of order 8.
    inside = (angle > event.ramp) & (angle < event.length - event.ramp)
    np.testing.assert_allclose(found[inside], np.abs(np.sin(4 * angle[inside])), atol=1e-9)
    assert found[(angle < 0) | (angle > event.length)].max() == 0.0
    half = found[(angle > 0) & (angle < math.pi / 4)]
    assert half.max() < 1 / 6


def test_ice_torque_by_hand() -> None:
    given = {"diameter": 3.0, "hub_diameter": 0.9, "pitch": 2.4, "speed": 4 * math.pi}
    # 14.7 (1 − 0.3) 0.8^0.16 (2·3)^0.17 3³ kN m, D below 1.8·2 m.
    found = IcePropeller.model_validate(given | {"ice_class": "PC5"}).torque
    assert found == pytest.approx(1e3 * 14.7 * 0.7 * 0.964928 * 1.356081 * 27, rel=1e-5)
    # 1.9·10.9·0.7·0.8^0.16·6^0.17·1.2^1.1·3^1.9 kN m, above 1.8·1.2 m.
    found = IcePropeller.model_validate(given | {"ice_class": "IB"}).torque
    assert found == pytest.approx(
        1e3 * 1.9 * 10.9 * 0.7 * 0.964928 * 1.356081 * 1.222078 * 8.063626, rel=1e-5
    )
    for ducted in (False, True):
        near = [
            IcePropeller.model_validate(
                given | {"ice_class": "PC7", "ice_thickness": 3.0 / 1.8 * (1 + by), "ducted": ducted}
            ).torque
            for by in (-1e-9, 1e-9)
        ]
        # 1.9 stands for 1.8^1.1 = 1.909.
        assert near[0] == pytest.approx(near[1], rel=0.005)


GEARED = """
format = 1
name = "Geared"
[train]
driver = "motor"
[train.discs]
motor = {{ inertia = 600 }}
pinion = {{ inertia = 40, damping = 30 }}
wheel = {{ inertia = 1500 }}
pump = {{ inertia = 90 }}
propeller = {{ inertia = 6000 }}
[train.shafts]
input = {{ between = ["motor", "pinion"], stiffness = 1e6, damping = 2e3 }}
line = {{ between = ["wheel", "propeller"], stiffness = 8e6, damping = 1e4 }}
[train.gears]
stage = {{ between = ["pinion", "wheel"], ratio = 5 {mesh} }}
take_off = {{ between = ["pump", "wheel"], ratio = 3, kind = "belt" {mesh} }}
{modal}
[train.loads.water]
on = "propeller"
torque = 2e5
speed = 12
[train.loads.oil]
on = "pump"
torque = 300
speed = 36
harmonics = [{{ order = 3, share = 0.4 }}]
[train.transient]
duration = 0.5
speed = 60
settle = 0
sample_time = 1e-4
accuracy = 1e-9
[[train.transient.events]]
kind = "ice_impacts"
time = 0.05
on = "propeller"
blades = 4
case = 1
impacts = 4
ramp = 0
torque = 3e5
"""


@pytest.mark.parametrize("modal", ["", "[train.modal_damping]\nothers = 0.03\n"])
def test_rigid_stages_carry_what_stiff_meshes_do(modal: str) -> None:
    rigid, stiff = (
        lw.torsion_transient(lw.loads(GEARED.format(mesh=mesh, modal=modal)))
        for mesh in ("", ", stiffness = 3e9, damping = 2e5")
    )
    assert rigid.stages == ("stage", "take_off")
    for one, other in zip(rigid.stage_torque, stiff.stage_torque, strict=True):
        # The stiff mesh swings at some kHz for the first ms, and gives way by 1e-4 elsewhere.
        later = rigid.time > 0.02
        np.testing.assert_allclose(one[later], other[later], atol=3e-3 * np.abs(other).max())


def test_stage_with_a_permitted_torque_is_judged() -> None:
    text = GEARED.format(mesh="", modal="").replace("ratio = 5 ", "ratio = 5, torque_permitted = 5e4")
    moved = lw.torsion_transient(lw.loads(text))
    (judged,) = moved.judgements
    assert judged.part == "stage"
    assert judged.found == np.abs(moved.stage_torque[0]).max()
    assert judged.is_kept == (judged.found <= 5e4)
    loose = lw.torsion_transient(lw.loads(text.replace("5e4", "1e7")))
    assert loose.findings == []


def test_limit_of_a_stage_in_a_loop_is_said_not_to_be_judged() -> None:
    text = Path("examples/ice_impacts/machine.toml").read_text(encoding="utf-8")
    second = '[train.gears.second]\nbetween = ["pinion", "wheel"]\nratio = 5\n'
    machine = lw.loads(text.replace("[train.shafts.line]", f"{second}[train.shafts.line]"))
    moved = lw.torsion_transient(machine)
    assert np.isnan(moved.stage_torque).all()
    (note,) = moved.notes
    assert note.startswith("stage: torque_permitted is not checked")
    assert moved.to_dict()["stages"]["stage"] == {"torque_max": None, "torque_min": None}


def test_shortest_pulse_keeps_its_impulse() -> None:
    """α_i C_q 2/π from the samples of the table, wherever between them a pulse begins."""
    ice = {"time": 0.0, "torque": 1.0, "duration": math.radians(5), "blades": 7, "impacts": 7}
    event = IceImpacts.model_validate(ONE | ice)
    angle = np.arange(_SAMPLES) * (2 * np.pi / _SAMPLES)
    sampled = pulses(event, angle).sum() * 2 * np.pi / _SAMPLES
    # Trapezoids of a half sine: (π/20)²/12 of it at most, one step before the ends and behind them.
    assert sampled == pytest.approx(7 * 2 / math.pi * math.radians(5), rel=(math.pi / 20) ** 2 / 6)


RULES: list[tuple[dict[str, Any], str]] = [
    ({"case": 1, "torque": None}, "either torque or propeller"),
    ({}, "either case, or amplitude and duration"),
    ({"case": 1, "amplitude": 0.5}, "none beside case"),
    ({"case": 1, "blades": 7}, "3 to 6"),
    ({"case": 1, "impacts": None}, "their number"),
    ({"amplitude": 1, "duration": 7.0}, "5 deg to a revolution"),
    ({"amplitude": 1, "duration": math.radians(4.9)}, "5 deg to a revolution"),
    ({"case": 1, "on": "hub"}, "the name of a disc"),
    ({"case": 1, "time": 0.9}, "less than the duration"),
]


@pytest.mark.parametrize(("change", "words"), RULES)
def test_what_makes_no_sense(change: dict[str, Any], words: str) -> None:
    event = {"time": 0.1, "on": "propeller", "blades": 4, "impacts": 3, "torque": 100.0} | change
    rows = "\n".join(
        f"{key} = {value!r}".replace("'", '"') for key, value in event.items() if value is not None
    )
    text = GEARED.format(mesh="", modal="")
    text = (
        text[: text.index("[[train.transient")] + '[[train.transient.events]]\nkind = "ice_impacts"\n' + rows
    )
    with pytest.raises(MachineFileError, match=words):
        lw.loads(text)


def test_a_propeller_at_rest_is_said() -> None:
    moved = met(ONE | {"time": 0.1, "torque": 10.0, "duration": 0.5}, speed=0.0)
    assert any("does not rotate ahead" in note for note in moved.notes)
    assert not any("stops" in note for note in moved.notes)


def test_tables_of_pulses_have_an_end() -> None:
    # 0.8 s at 100 000 rad/s are 12 700 revolutions.
    with pytest.raises(InputError, match=r"may make 1\d{4} revolutions, .* computed for 1000"):
        met(ONE | {"time": 0.1, "torque": 10.0, "duration": 0.5}, speed=1e5)


@pytest.mark.parametrize(("blades", "turns", "count"), [(3, 1.5, 5), (5, 1.5, 8), (5, 0.5, 3), (4, 0.5, 2)])
def test_half_an_impact_counts_as_one(blades: int, turns: float, count: int) -> None:
    """Round half up, whether the whole number below is even (4.5, 2.5) or odd (7.5)."""
    # H_ice/m = turns / 2: 2 H_ice/m revolutions.
    propeller = {"ice_class": "PC7", "diameter": 4.0, "hub_diameter": 1.0, "pitch": 3.0, "speed": SPEED}
    event = {"kind": "ice_impacts", "on": "p", "time": 0.0, "blades": blades, "case": 1}
    made = IceImpacts.model_validate(event | {"propeller": propeller | {"ice_thickness": turns / 2}})
    assert made.propeller is not None
    assert made.propeller.revolutions == pytest.approx(turns)
    assert made.count == count
