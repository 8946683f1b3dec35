"""Manoeuvres of trains in machine files: engines, loads, motors, events, and messages about wrong ones."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from command_line import invoke

import linkwright as lw
from linkwright import ConvergenceError, InputError, Machine, MachineError, torsion_transient, waterfall
from linkwright.torsion import TrainTransient, excited_train, follow_train, responded
from linkwright.torsion.figures.transient import transient_figure, waterfall_figure
from linkwright.torsion.in_time.moving_train import combustion_weight, moving_train
from linkwright.torsion.in_time.peak_judgement import PeakJudgement
from linkwright.torsion.in_time.steady_start import balanced_start, mean_torques
from linkwright.torsion.page import torsion_html

V12 = Path(__file__).parents[2] / "machines" / "v_diesel.toml"

PLAIN = """
format = 1
name = "Generator set"
[train.discs]
engine = { inertia = "3 kg m^2" }
rotor = { inertia = "1.2 kg m^2" }
[train.shafts]
shaft = { between = ["engine", "rotor"], stiffness = "60 kN m/rad", damping = "20 N m s/rad" }
[train.loads]
rotor = { on = "rotor", torque = "500 N m", speed = "150 rad/s", exponent = 1 }
"""


def v12(entries: str = "") -> Machine:
    """The V-12 with a manoeuvre."""
    return lw.loads(V12.read_text(encoding="utf-8") + entries)


def event(kind: str, entries: str) -> str:
    return f'duration = 1\nevents = [{{ kind = "{kind}", {entries} }}]'


def motor(on: str, entries: str) -> str:
    return f'duration = 1\nmotors = {{ m = {{ on = "{on}", motor = {{ {entries} }} }} }}'


def manoeuvre(**entries: object) -> TrainTransient:
    return TrainTransient.model_validate(entries)


def test_engine_settles_to_its_forced_vibration() -> None:
    """With pistons and rods as good as weightless, every order is that of linear vibration."""
    text = V12.read_text(encoding="utf-8")
    for old, new in (
        ('mass = "5.2 kg"', 'mass = "2 mg"'),
        ('inertia = "0.075 kg m^2"', 'inertia = "3e-8 kg m^2"'),
        ('mass = "2.6 kg"', 'mass = "1 mg"'),
        ('inertia = "0.0236 kg m^2"', 'inertia = "1e-8 kg m^2"'),
        ('piston_mass = "3.3 kg"', 'piston_mass = "1 mg"'),
        ("\nloss_factor = 0.03", "\nloss_factor = 0"),
        ("loss_factor = 0.03 }", "damping = 60 }"),
        ("loss_factor = 0.16", "damping = 40"),
    ):
        assert old in text
        text = text.replace(old, new)
    light = lw.loads(text)
    assert light.train is not None
    speed = 150.0
    given = manoeuvre(duration=1.0, speed=speed, loads_follow=True)
    train = balanced_start(moving_train(light.train, given), light.train, given)[0]
    # A hundredth of all torques: swinging shifts them over the angle, which linear vibration does not know.
    small = replace(train, torques=tuple(replace(each, scale=0.01 * each.scale) for each in train.torques))
    two_turns = 4 * np.pi / speed
    moved = follow_train(
        small, duration=two_turns, speed=speed, loaded=True, settle=3.0, sample_time=two_turns / 4096
    )
    # The damping of the load is a hundredth as well; its mean follows the engine in any case.
    assert "1400 N m" in text
    same = lw.loads(text.replace("1400 N m", "14 N m"))
    forced = responded(excited_train(same, np.array([speed])))
    orders = forced.orders[:24]
    waves = 100 * np.fft.rfft(moved.torque[:, :-1])[:, 1:25] / 2048 * np.exp(-1j * orders * moved.angle[0, 0])
    wanted = forced.shaft_torques[:24, :, 0].T
    # The speed after 3 s is 1e-5 off; resonances of small damping turn that into 1e-3.
    assert np.abs(waves - wanted).max(axis=1) == pytest.approx(0.0, abs=2e-3 * np.abs(wanted).max())


def test_true_inertia_of_the_throws_is_near_its_mean() -> None:
    """The V-12 as it is: balanced, and its torques within some per cent of those of linear vibration."""
    machine = v12()
    moved = torsion_transient(machine, manoeuvre(duration=1.0, speed=157.0))
    assert abs(moved.energy_error) < 1e-9
    assert moved.speed.mean() == pytest.approx(157.0, rel=2e-3)
    assert moved.balance.startswith("combustion was scaled by 1.00")
    assert any("hysteresis" in note for note in moved.notes)
    forced = responded(excited_train(machine, np.array([157.0])))
    crank = [n for n, name in enumerate(moved.shafts) if name.startswith("crank") or name == "tail"]
    assert moved.torque_max[crank] == pytest.approx(forced.shaft_torque_max[crank, 0], rel=0.05)
    # Loss in shafts, by viscous damping in place of hysteresis, is of the size that hysteresis has.
    heat = sum(moved.loss[name] for name in moved.shafts)
    assert heat == pytest.approx(forced.shaft_heat[:, 0].sum(), rel=0.5)


def test_misfire_shakes_the_coupling() -> None:
    """One of twelve cylinders without combustion: half an order appears in the coupling."""
    event = {"kind": "misfire", "time": 0.0, "cylinders": [3]}
    sound, weak = (
        torsion_transient(v12(), manoeuvre(duration=2.0, speed=157.0, sample_time=1e-3, events=events))
        for events in ([], [event])
    )
    assert weak.work["combustion_3"] == 0.0
    assert weak.work["gas_3"] < 0
    c, f = weak.shafts.index("coupling"), weak.discs.index("flywheel")
    half = [
        waterfall(each.time, each.angle[f], each.torque[c], highest=6).order(0.5)[-1]
        for each in (sound, weak)
    ]
    assert half[1] > 50 * half[0]


def test_combustion_weights() -> None:
    given = manoeuvre(
        duration=9,
        fuel=0.0,
        events=[
            {"kind": "fuel_on", "time": 1, "over": 1},
            {"kind": "misfire", "time": 3, "until": 4, "cylinders": [2, 5], "factor": 0.25},
            {"kind": "fuel_off", "time": 6},
        ],
    )
    at = np.array([0.5, 1.5, 2.5, 3.5, 4.5, 6.5])
    for cylinder, misfires in ((1, 1.0), (5, 0.25)):
        weight = combustion_weight(given, cylinder)
        assert weight is not None
        assert np.interp(at, weight.x, weight.y) == pytest.approx([0, 0.5, 1, misfires, 1, 0])
    assert combustion_weight(manoeuvre(duration=1), 1) is None


def test_start_of_the_engine_by_a_motor() -> None:
    """From rest a starter turns the engine against its compressions; fuel takes over."""
    entries = """
[train.transient]
duration = "3 s"
fuel = 0
sample_time = "1 ms"
[train.transient.motors.starter]
on = "flywheel"
motor = { kind = "dc", speed_no_load = "300 rpm", torque_stall = "4 kN m" }
[[train.transient.events]]
kind = "fuel_on"
time = "1.5 s"
over = "0.2 s"
[[train.transient.events]]
kind = "motor_off"
time = "2 s"
motor = "starter"
"""
    moved = torsion_transient(v12(entries))
    f = moved.discs.index("flywheel")
    assert moved.speed[:, 0].tolist() == [0.0] * len(moved.discs)
    cranked = moved.time < 1.5
    assert 0.6 * 31.4 < moved.speed[f, cranked][-1] < 31.4
    assert moved.speed[f, -1] > 60
    assert moved.work["starter"] > 0
    assert sum(moved.work[f"combustion_{n}"] for n in range(1, 13)) > moved.work["starter"]
    assert abs(moved.energy_error) < 1e-8


def test_load_step_of_a_plain_train() -> None:
    """Half of the load thrown off: the shaft swings about what speeds up the rotor; J ω̇ = M afterwards."""
    event = {"kind": "load_step", "time": 0.1, "load": "rotor", "factor": 0.5}
    moved = torsion_transient(lw.loads(PLAIN), manoeuvre(duration=1.1, speed=150.0, events=[event]))
    before = moved.time < 0.1
    assert moved.torque[0, before] == pytest.approx(np.full(before.sum(), 500.0), rel=1e-6)
    assert moved.balance == "engine is driven by a constant 500 N m, what the loads need at the start"
    # dω/dt = (500 − 250 ω/150)/4.2
    rate = 250 / 150 / 4.2
    wanted = 300 - 150 * np.exp(-rate * (moved.time[-1] - 0.1))
    mean = (3 * moved.speed[0, -1] + 1.2 * moved.speed[1, -1]) / 4.2
    # The load has the speed of the rotor, not the mean of both.
    assert mean == pytest.approx(wanted, rel=1e-5)


CONVEYOR = """
format = 1
name = "Motor, gear, conveyor"
[train]
driver = "motor"
[train.discs]
motor = { inertia = "2 kg m^2" }
pinion = { inertia = "0.1 kg m^2" }
wheel = { inertia = "1 kg m^2" }
drum = { inertia = "60 kg m^2" }
[train.gears]
stage = { between = ["pinion", "wheel"], ratio = 20 }
[train.shafts]
out = { between = ["wheel", "drum"], stiffness = "3 MN m/rad", damping = "2 kN m s/rad" }
[train.couplings.rubber]
between = ["motor", "pinion"]
stiffness = "15 kN m/rad"
damping = "30 N m s/rad"
torque_permitted = "PERMITTED N m"
[train.loads.conveyor]
on = "drum"
torque = "5 kN m"
speed = "72 rpm"
exponent = 0
[train.transient]
duration = "0.8 s"
speed = "1450 rpm"
BALANCE
events = [{ kind = "load_step", time = "0.1 s", load = "conveyor", factor = 1.5 }]
[train.transient.motors.m]
on = "motor"
[train.transient.motors.m.motor]
kind = "induction"
speed_synchronous = "1500 rpm"
torque_breakdown = "900 N m"
speed_breakdown = "1380 rpm"
"""


def conveyor(balance: str = "", permitted: str = "5000") -> Machine:
    return lw.loads(CONVEYOR.replace("BALANCE", balance).replace("PERMITTED", permitted))


def test_speed_settles_where_motor_and_load_meet() -> None:
    """The load is what the file says, to rounding, before and after its step."""
    moved = torsion_transient(conveyor())
    drum, before = moved.discs.index("drum"), moved.time < 0.1
    out = moved.torque[moved.shafts.index("out"), before]
    assert out == pytest.approx(np.full(len(out), 5000.0), rel=1e-6)
    # No swing before the step: the start is the steady state.
    assert np.ptp(moved.speed[drum, before]) < 1e-6 * moved.speed[drum, 0]
    assert "motor and loads balance, not at 1450 rpm" in moved.balance
    # The work of the load is its torque times the angle of its disc.
    step = int(before.sum())
    turned = moved.angle[drum, step] - moved.angle[drum, 0], moved.angle[drum, -1] - moved.angle[drum, step]
    assert moved.work["conveyor"] == pytest.approx(-5000 * turned[0] - 7500 * turned[1], rel=1e-3)


def test_start_as_given_without_balance() -> None:
    moved = torsion_transient(conveyor("balanced = false\nloaded = false"))
    assert moved.balance == ""
    assert moved.speed[0, 0] == pytest.approx(1450 * np.pi / 30, rel=1e-12)


def test_loads_are_scaled_where_that_is_asked_for() -> None:
    moved = torsion_transient(conveyor("loads_follow = true"))
    assert "loads were scaled by" in moved.balance
    assert moved.speed[0, 0] == pytest.approx(1450 * np.pi / 30, rel=1e-4)


def test_combustion_follows_the_load() -> None:
    """A governor gives what the loads ask for; a load step changes the loads of the file."""
    less = V12.read_text(encoding="utf-8").replace('torque = "1400 N m"', 'torque = "1000 N m"')
    machine = lw.loads(less)
    assert machine.train is not None
    given = manoeuvre(duration=1.0, speed=157.0)
    train, speed, told = balanced_start(moving_train(machine.train, given), machine.train, given)
    assert speed == 157.0
    assert told.startswith("combustion was scaled by 0.")
    load = {each.name: each.scale for each in train.torques}["generator"]
    assert load == -1000.0
    assert mean_torques(train, speed).sum() == pytest.approx(0.0, abs=1e-9 * 1000)


def test_limits_are_judged_in_the_manoeuvre(tmp_path: Path) -> None:
    """The step takes the coupling above what it bears; a stronger one is kept."""
    weak, strong = (torsion_transient(conveyor(permitted=size)) for size in ("300", "5000"))
    (of_weak,), (of_strong,) = weak.judgements, strong.judgements
    largest = float(np.abs(weak.torque[weak.shafts.index("rubber")]).max())
    assert of_weak.found >= largest * (1 - 1e-12)
    assert of_weak.found == pytest.approx(largest, rel=1e-3)
    assert (of_weak.is_kept, of_strong.is_kept) == (False, True)
    assert weak.findings == [f"{of_weak.words}."]
    assert strong.findings == []
    study = lw.torsion_study(conveyor(permitted="300"))
    assert weak.findings[0] in study.findings
    assert study.results()["transient"]["judgements"][0]["state"] == "exceeds"
    assert "Limits in the manoeuvre" in torsion_html(study, command="")
    assert "motor and loads balance" in study.balance
    path = tmp_path / "conveyor.toml"
    path.write_text(CONVEYOR.replace("BALANCE", "").replace("PERMITTED", "300"), encoding="utf-8")
    run = invoke("torsion", path)
    assert run.exit_code == 1
    assert "rubber: torque" in run.output
    # What counts other than given is said first.
    assert run.output.startswith("Manoeuvre: the start is at")


def test_stress_while_a_resonance_is_passed() -> None:
    """The stress amplitude within two revolutions, against what is permitted in transient passage."""
    text = PLAIN.replace('"20 N m s/rad" }', '"20 N m s/rad", limit = { diameter = 0.05, LIMIT } }')
    pulse = """
[train.excitations.e]
on = "engine"
harmonics = [{ order = 2, torque = 90 }]
[train.transient]
duration = "2 s"
speed = "60 rad/s"
balanced = false
events = [{ kind = "speed_course", on = "engine", times = [0, 2], speed = [60, 180], gain = 400 }]
"""

    def moved(transient: str, greatest: str) -> tuple[PeakJudgement, ...]:
        limit = f"stress_permitted = 1e5, stress_transient = {transient}, stress_max = {greatest}"
        return torsion_transient(lw.loads(text.replace("LIMIT", limit) + pulse)).judgements

    greatest, passing = moved("1e6", "1e6")
    W = np.pi / 16 * 0.05**3
    assert (greatest.what, passing.what) == ("maximum stress", "vibratory stress in transient passage")
    assert not greatest.is_kept
    assert not passing.is_kept
    assert passing.found < greatest.found
    # At the peak the shaft swings by several times the 90 N m · 1.2/4.2 that it would carry at rest.
    assert passing.found > 2 * 90 * 1.2 / 4.2 / W
    assert all(each.is_kept for each in moved("1e9", "1e9"))


def test_harmonics_of_loads_and_excitations() -> None:
    """Orders that repeat together share a table; others stand alone; both give the same torque."""
    pulsating = (
        PLAIN
        + """
[train.excitations.e]
on = "engine"
speed = "100 rad/s"
exponent = 2
harmonics = [{ order = 0.5, torque = 30, phase = 0.3 }]
[train.excitations.g]
on = "engine"
harmonics = [{ order = 1, torque = 8 }, { order = 2.7182818, torque = 5, phase = "40 deg" }]
"""
    )
    pulsating = pulsating.replace(
        "exponent = 1 }", "exponent = 1, harmonics = [{ order = 4, share = 0.1, phase = 0.2 }] }"
    )
    machine = lw.loads(pulsating)
    assert machine.train is not None
    train = moving_train(machine.train, manoeuvre(duration=1.0, speed=120.0, balanced=False))
    phi = np.linspace(0.0, 25.0, 101)
    torque = train.net_torques(0.0, np.column_stack([phi, phi]), np.full(2, 120.0)).torque
    engine = (
        1.44 * 30 * np.cos(0.5 * phi + 0.3) + 8 * np.cos(phi) + 5 * np.cos(2.7182818 * phi + np.radians(40))
    )
    load = -500 * 0.8 * (1 + 0.1 * np.cos(4 * phi + 0.2))
    assert torque == pytest.approx(np.column_stack([engine, load]), abs=1e-8)
    assert [each.name for each in train.torques] == ["rotor", "e", "g", "g"]
    assert mean_torques(train, 120.0)[1] == pytest.approx(-400.0, rel=1e-9)


def test_coupling_of_a_curve_and_a_damper() -> None:
    """The curve of the file is that of the motion, and the ring of a damper is a disc."""
    text = PLAIN.replace('stiffness = "60 kN m/rad", damping = "20 N m s/rad"', 'stiffness = "600 kN m/rad"')
    text = text.replace('between = ["engine", "rotor"]', 'between = ["engine", "hub"]')
    text = (
        text.replace("[train.shafts]", 'hub = { inertia = "0.3 kg m^2" }\n[train.shafts]')
        + """
[train.couplings.soft]
between = ["hub", "rotor"]
twist = [0, 0.1, 0.2]
torque = [0, 400, 1500]
damping = 5
[train.dampers.ring]
on = "engine"
ring_inertia = "0.4 kg m^2"
damping = "30 N m s/rad"
"""
    )
    machine = lw.loads(text)
    moved = torsion_transient(machine, manoeuvre(duration=0.2, speed=150.0))
    assert (moved.discs, moved.shafts) == (("engine", "rotor", "hub", "ring"), ("shaft", "soft", "ring"))
    # 500 N m lie between the points of the curve: the twist is that of the smooth curve through them.
    assert moved.torque[1] == pytest.approx(np.full(len(moved.time), 500.0), rel=1e-6)
    twist = moved.angle[2, 0] - moved.angle[1, 0]
    assert machine.train is not None
    x, y, s = machine.train.couplings["soft"].curve()
    z = (twist - x[1]) / 0.1
    value = y[1] + z * (0.1 * s[1] + z * (3300 - 0.2 * s[1] - 0.1 * s[2] + z * (0.1 * (s[1] + s[2]) - 2200)))
    assert value == pytest.approx(500.0, rel=1e-6)
    assert moved.loss["ring"] < 1e-6


def test_speed_course_leads_the_train() -> None:
    course = {
        "kind": "speed_course",
        "on": "engine",
        "times": [0.0, 1.0],
        "speed": [100.0, 180.0],
        "gain": 400.0,
    }
    moved = torsion_transient(lw.loads(PLAIN), manoeuvre(duration=1.0, speed=100.0, events=[course]))
    # The lag: what speeds up 4.2 kg m² by 80 rad/s², and what the load needs more than at the start, over
    # the gain.
    lag = (4.2 * 80 + 500 * 80 / 150) / 400
    assert 180 - moved.speed[0, -1] == pytest.approx(lag, rel=0.02)


def test_short_circuit_and_torques() -> None:
    shorted = {"torque": 500, "speed": 157.0, "pole_pairs": 2, "reactance": 0.15, "decay": 0.05, "phases": 2}
    events = [
        {"kind": "short_circuit", "time": 0.1, "until": 0.3, "on": "rotor", **shorted},
        {"kind": "torque", "time": 0.5, "until": 0.6, "on": "rotor", "torque": "-100 N m"},
        {"kind": "torque_course", "on": "engine", "times": [0.7, 0.8, 0.9], "torque": [0, 300, 0]},
    ]
    moved = torsion_transient(lw.loads(PLAIN), manoeuvre(duration=1.0, speed=150.0, events=events))
    assert set(moved.work) == {"rotor", "driver", "short_circuit_1", "torque_2", "torque_course_3"}
    assert 0.1 < moved.torque_max_time[0] < 0.2
    assert moved.torque_max[0] > 1500
    turned = np.interp([0.5, 0.6], moved.time, moved.angle[1])
    assert moved.work["torque_2"] == pytest.approx(-100 * (turned[1] - turned[0]), rel=1e-4)
    assert moved.work["torque_course_3"] > 0
    assert abs(moved.energy_error) < 1e-8


WRONG = [
    ("duration = 0", "duration", "a time greater than 0"),
    ("duration = 1\nsample_time = 1e-7", "sample_time", "200000 samples"),
    ('duration = 1\nbalanced = "x"', "balanced", "true or false"),
    ("duration = 1\nsettle = -1", "settle", "a time of 0 or more"),
    (event("torque", 'time = 2, on = "rotor", torque = 1'), "events.0.time", "less than"),
    (
        event("torque", 'time = 0.5, until = 0.4, on = "rotor", torque = 1'),
        "events.0.until",
        "more than time",
    ),
    (event("load_step", 'time = 0, load = "rotr", factor = 0'), "events.0.load", "the name of a load"),
    (event("motor_off", 'time = 0, motor = "m"'), "events.0.motor", "the name of a motor"),
    (event("torque", 'time = 0, on = "x", torque = 1'), "events.0.on", "the name of a disc"),
    (event("fuel_off", "time = 0"), "events.0.kind", "an event of a train with an engine"),
    (
        event("torque_course", 'on = "rotor", times = [0, 0], torque = [1, 2]'),
        "events.0.times.1",
        "more than 0",
    ),
    (motor("x", 'kind = "constant_torque", torque = 1'), "motors.m.on", "the name of a disc"),
    (motor("rotor", 'kind = "constant_speed", speed = 1'), "motors.m.motor.kind", '"induction"'),
]


@pytest.mark.parametrize(("entries", "key", "expected"), WRONG, ids=[each[1] for each in WRONG])
def test_wrong_manoeuvres_are_told(entries: str, key: str, expected: str) -> None:
    with pytest.raises(MachineError) as caught:
        lw.loads(f"{PLAIN}\n[train.transient]\n{entries}\n")
    (problem,) = caught.value.problems
    assert problem.key == f"train.transient.{key}"
    assert expected in problem.expected


def test_cylinders_that_are_not_there() -> None:
    events = (
        '[train.transient]\nduration = 1\nevents = [{ kind = "misfire", time = 0, cylinders = [3, 13] }]\n'
    )
    with pytest.raises(
        MachineError, match=r"events\.0\.cylinders\.1(.|\n)*the number of a cylinder, 1 to 12"
    ):
        v12(events)


def test_what_cannot_be_followed_is_told() -> None:
    with pytest.raises(InputError, match=r"has no manoeuvre: give \[train.transient\]"):
        torsion_transient(lw.loads(PLAIN))
    with pytest.raises(InputError, match=r"has no \[train\]"):
        torsion_transient(lw.read(V12.parent / "roller_two_carts.toml"), manoeuvre(duration=1))
    with pytest.raises(InputError, match=r"loss_mode: found 20, expected a mode of vibration, 1 to 8"):
        torsion_transient(v12(), manoeuvre(duration=1, speed=150, loss_mode=20))
    text = V12.read_text(encoding="utf-8").split("[train.run]")[0]
    with pytest.raises(InputError, match=r"gas_speed: found nothing"):
        torsion_transient(lw.loads(text), manoeuvre(duration=1))
    falling = lw.loads(PLAIN.replace("exponent = 1", "exponent = -1"))
    with pytest.raises(
        InputError, match=r"loads.rotor.exponent: found -1, expected 0 or more in a motion from rest"
    ):
        torsion_transient(falling, manoeuvre(duration=1))
    with pytest.raises(ConvergenceError, match="after 10 steps: that is the maximum"):
        torsion_transient(lw.loads(PLAIN), manoeuvre(duration=1, speed=150, steps_max=10))


def test_results_are_plain() -> None:
    moved = torsion_transient(lw.loads(PLAIN), manoeuvre(duration=0.1, speed=150.0))
    plain = moved.to_dict()
    assert plain["discs"] == ["engine", "rotor"]
    assert plain["method"] == "explicit"
    assert set(moved.curves()) == {"time", "kinetic_energy", "potential_energy"}


def test_figures() -> None:
    """Panels, words, marks; a band where samples are many."""
    event = {"kind": "load_step", "time": 1.0, "load": "rotor", "factor": 0.0}
    moved = torsion_transient(lw.loads(PLAIN), manoeuvre(duration=4.0, speed=150.0, events=[event]))
    figure = transient_figure(moved)
    speeds, shaft = figure.axes
    assert [text.get_text() for text in speeds.get_legend().get_texts()] == ["engine", "rotor"]
    assert shaft.get_ylabel().startswith("shaft")
    assert len(shaft.collections) == 1
    found = waterfall(moved.time, moved.angle[0], moved.torque[0], highest=4)
    figure = waterfall_figure(found, quantity="torque [N m]")
    assert figure.axes[1].get_ylabel() == "torque [N m]"
