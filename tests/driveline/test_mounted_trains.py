"""Steady motion of trains with several motors and mechanisms, against integrations in time and limits."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mounted_trains import DISCS, SHAFTS, cycle, random_train
from scipy.interpolate import CubicSpline
from sizes import random_cases

import linkwright as lw
from linkwright.machine.write import dumps
from linkwright.torsion.model.train_mechanism import TrainMechanism


def test_random_trains_repeat_by_equations_written_down_here() -> None:
    """Start, multipliers and extremes of trains with two motors and two cranks at ratios of 1, 2 and ½."""
    for n, (number, rng) in enumerate(random_cases(4810, 4, 100)):
        train = random_train(rng, (1.0, 2.0, 0.5)[n % 3])
        motion = lw.elastic_motion(train.machine, angles=np.zeros(1))
        discs = [motion.stations.index(name) for name in DISCS]
        shafts = [motion.shafts.index(name) for name in SHAFTS]
        assert motion.turns == train.turns, number
        start = np.concatenate([motion.twist[shafts, 0], motion.speed[discs, 0]])
        scale = np.concatenate([np.abs(motion.twist_max[shafts]), motion.speed[discs, 0]])
        found = cycle(train, start, 1e-4 * scale)
        correction = np.linalg.solve(np.eye(len(start)) - found.slopes, found.end - start)
        assert np.abs(correction / scale).max() < 1e-7, number
        largest = np.sort(np.abs(np.linalg.eigvals(found.slopes)))[::-1]
        assert np.abs(np.abs(motion.multipliers) - largest).max() < 1e-5, number
        assert abs(motion.period / found.period - 1) < 1e-8, number
        for low, high, expected in (
            (motion.speed_min[discs], motion.speed_max[discs], found.speed),
            (motion.acceleration_min[discs], motion.acceleration_max[discs], found.acceleration),
            (motion.torque_min[shafts], motion.torque_max[shafts], found.torque),
        ):
            size = np.abs(expected).max(axis=1)
            assert np.abs((low - expected[:, 0]) / size).max() <= 1e-6, number
            assert np.abs((high - expected[:, 1]) / size).max() <= 1e-6, number
        lost = motion.power_dissipated.sum() * motion.period
        work = motion.energy_drive * motion.turns
        assert abs(motion.energy_load * motion.turns + lost - work) <= 1e-10 * work, number


PRESS = """
format = 1
name = "press"
[mechanism.cranks.A]
radius = 0.2
[mechanism.sliders.S]
crank = "A"
rod = 0.7
[bodies]
S = { mass = 60 }
[loads]
oil = { kind = "viscous", on = "S", damping = 300 }
"""

# Both presses on one crankshaft, the second one radian ahead.
BOTH = (
    PRESS.replace(
        "[mechanism.sliders.S]", "[mechanism.cranks.B]\nradius = 0.2\nphase = 1.0\n[mechanism.sliders.S]"
    ).replace("[bodies]", '[mechanism.sliders.T]\ncrank = "B"\nrod = 0.7\n[bodies]\nT = { mass = 60 }')
    + 'oil2 = { kind = "viscous", on = "T", damping = 300 }\n'
)

LINE_SHAFT = """
format = 1
name = "line shaft"
[train.discs]
hub = {{ inertia = 3.0 }}
c1 = {{ inertia = 1.5 }}
c2 = {{ inertia = 1.2 }}
[train.shafts]
left = {{ between = ["hub", "c1"], stiffness = {stiffness}, damping = {damping} }}
right = {{ between = ["hub", "c2"], stiffness = {stiffness}, damping = {damping} }}
[train.motors.motor]
on = "hub"
motor = {{ kind = "dc", speed_no_load = 30, torque_stall = {motor} }}
[train.mechanisms.press1]
on = "c1"
machine = "press1.toml"
[train.mechanisms.press2]
on = "c2"
machine = "press2.toml"
phase = {phase}
"""


def line_shaft(
    folder: Path, *, stiffness: float = 4e3, damping: float = 12.0, phase: float = 1.0, motor: float = 2e3
) -> lw.Machine:
    """Two presses on one motor, with files in a folder."""
    for name in ("press1", "press2"):
        (folder / f"{name}.toml").write_text(PRESS)
    file = folder / "line.toml"
    file.write_text(LINE_SHAFT.format(stiffness=stiffness, damping=damping, phase=phase, motor=motor))
    return lw.read(file)


def test_stiff_shafts_approach_the_rigid_machine_with_both_presses_by_one_over_the_stiffness(
    tmp_path: Path,
) -> None:
    """Rigid: one crankshaft with both cranks, the motor and the three discs as a flywheel."""
    rigid = lw.steady_state(
        lw.loads(
            BOTH + '[drive.motor]\nkind = "dc"\nspeed_no_load = 30\ntorque_stall = 2000\n'
            "[drive.flywheel]\ninertia = 5.7\n"
        )
    )
    off = []
    for stiffness in (1e6, 1e7, 1e8):
        motion = lw.elastic_motion(line_shaft(tmp_path, stiffness=stiffness, damping=50.0))
        off.append(motion.speed_max[1] - rigid.speed_max)
    # What is left of higher powers of 1/k is a tenth of what it was.
    assert off[1] / off[0] == pytest.approx(0.1, rel=0.05)
    assert off[2] / off[1] == pytest.approx(0.1, rel=0.005)
    assert abs(off[2]) < 1e-5 * rigid.speed_max


def test_equal_presses_half_a_revolution_apart_have_equal_torques(tmp_path: Path) -> None:
    """With equal discs, the one press does what the other did half a period before."""
    machine = lw.replace(line_shaft(tmp_path, phase=np.pi), {"train.discs.c2.inertia": 1.5})
    motion = lw.elastic_motion(machine, n=1440)
    assert motion.torque_max[0] == pytest.approx(motion.torque_max[1], rel=1e-8)
    assert motion.torque_min[0] == pytest.approx(motion.torque_min[1], rel=1e-8)
    assert motion.speed_max[1] == pytest.approx(motion.speed_max[2], rel=1e-8)
    curves = np.vstack([motion.torque, motion.speed[:1]])
    curves[:, -1] = curves[:, 0]
    later = CubicSpline(motion.time, curves, axis=1, bc_type="periodic")(motion.time + motion.period / 2)
    assert np.abs(later[0] - curves[1]).max() < 1e-6 * motion.torque_peak[0]
    # What both do together repeats twice in a period.
    assert np.abs(later[2] - curves[2]).max() < 1e-6 * motion.speed_max[0]


def one_press(*, as_train: bool, more: str = "") -> lw.Machine:
    """Motor, elastic coupling and press as [drive] or as [train]."""
    if not as_train:
        return lw.loads(
            PRESS + '[drive.motor]\nkind = "dc"\nspeed_no_load = 30\ntorque_stall = 2000\ninertia = 3\n'
            "[drive.flywheel]\ninertia = 1.5\n[drive.crankshaft]\nstiffness = 4000\ndamping = 12\n" + more
        )
    return lw.loads(
        PRESS + "[train.discs]\nmotor = { inertia = 3 }\ncrank = { inertia = 1.5 }\n"
        '[train.shafts]\ncrankshaft = { between = ["motor", "crank"], stiffness = 4000, damping = 12 }\n'
        '[train.motors.motor]\non = "motor"\n'
        'motor = { kind = "dc", speed_no_load = 30, torque_stall = 2000 }\n'
        '[train.mechanisms.press]\non = "crank"\n' + more
    )


def test_a_driveline_is_the_same_as_drive_and_as_train() -> None:
    """Motor, elastic coupling, crank: period, extremes and multipliers agree to rounding."""
    one, other = (lw.elastic_motion(one_press(as_train=is_train)) for is_train in (False, True))
    assert other.period == pytest.approx(one.period, rel=1e-9)
    assert other.torque_max == pytest.approx(one.torque_max, rel=1e-8)
    assert other.torque_min == pytest.approx(one.torque_min, rel=1e-8)
    assert other.speed_max[-1] == pytest.approx(one.speed_max[-1], rel=1e-9)
    assert np.sort(np.abs(other.multipliers)) == pytest.approx(np.sort(np.abs(one.multipliers)), abs=1e-9)
    assert other.torque_motor_mean == pytest.approx(one.torque_motor_mean, rel=1e-9)


def test_two_presses_on_one_disc_are_one_machine_with_two_cranks() -> None:
    """A press by duals on the crank itself, one radian ahead, does what a second crank does."""
    both = one_press(as_train=True)
    press = lw.loads(PRESS)
    assert both.train is not None
    mounted = {
        name: TrainMechanism(on="crank", machine=press, phase=phase)
        for name, phase in (("first", 0.0), ("second", 1.0))
    }
    one = lw.elastic_motion(both.with_entries({"train": both.train.with_entries({"mechanisms": mounted})}))
    whole = {"both": TrainMechanism(on="crank", machine=lw.loads(BOTH))}
    two = lw.elastic_motion(both.with_entries({"train": both.train.with_entries({"mechanisms": whole})}))
    assert one.period == pytest.approx(two.period, rel=1e-10)
    assert one.torque_max == pytest.approx(two.torque_max, rel=1e-9)
    assert one.acceleration_min == pytest.approx(two.acceleration_min, rel=1e-9)
    assert np.abs(one.multipliers) == pytest.approx(np.abs(two.multipliers), abs=1e-7)


def test_linear_vibration_of_a_press_is_the_same_as_drive_and_as_train() -> None:
    """Natural frequencies with the mean inertia; torques under its harmonics over the speeds of a run."""
    drive = one_press(as_train=False)
    forced = lw.forced_vibration(drive)
    speeds = f"[train.run]\nspeed_min = {forced.speeds[0]}\nspeed_max = {forced.speeds[-1]}\n"
    train = one_press(as_train=True, more=speeds + f"points = {len(forced.speeds)}\n")
    f = [lw.free_vibration(machine).natural_frequencies for machine in (drive, train)]
    assert f[1] == pytest.approx(f[0], rel=1e-12)
    other = lw.forced_vibration(train)
    assert other.shaft_torque_vibratory[0] == pytest.approx(forced.shaft_torque_vibratory[-1], rel=1e-6)


def test_a_motor_that_keeps_its_speed_holds_its_disc(tmp_path: Path) -> None:
    """The hub turns at one speed, and the torque of the motor is what both shafts take from it."""
    motor = {"kind": "constant_speed", "speed": 20.0}
    machine = lw.replace(line_shaft(tmp_path), {"train.motors.motor.motor": motor})
    motion = lw.elastic_motion(machine)
    assert (motion.speed_min[0], motion.speed_max[0]) == pytest.approx((20, 20), rel=1e-12)
    assert motion.torque_motor[0] == pytest.approx(
        motion.torque.sum(axis=0), abs=1e-8 * motion.torque_peak.max()
    )
    lost = motion.power_dissipated.sum() * motion.period
    assert motion.energy_drive == pytest.approx(motion.energy_load + lost, rel=1e-10)


def test_damping_of_discs_acts_on_their_vibration_alone(tmp_path: Path) -> None:
    """It lowers vibratory torques and multipliers; its power counts as that of a load."""
    machine = line_shaft(tmp_path)
    free = lw.elastic_motion(machine)
    damped = lw.elastic_motion(
        lw.replace(machine, {f"train.discs.{name}.damping": 20.0 for name in ("hub", "c1", "c2")})
    )
    assert damped.torque_vibratory.max() < free.torque_vibratory.max()
    lost = damped.power_dissipated.sum() * damped.period
    assert damped.energy_drive == pytest.approx(damped.energy_load + lost, rel=1e-10)
    assert damped.multiplier_max < free.multiplier_max


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        ({"train.mechanisms.press1.on": "c3"}, '"c3"\n.*the name of a disc\n.*"hub", "c1", "c2"'),
        ({"drive.motor": {"kind": "constant_speed", "speed": 1.0}}, "give it as .train.motors."),
        ({"train.mechanisms.press1.machine": "none.toml"}, "no such file"),
        ({"train.mechanisms.press1.machine": "../press1.toml"}, "a file in the folder of the machine file"),
        ({"train.mechanisms.press1.machine": "line.toml"}, "without .train."),
        ({"train.motors.motor.on": "c4"}, "expected: the name of a disc"),
    ],
)
def test_what_is_wrong_with_a_mechanism_is_said(
    tmp_path: Path, change: dict[str, Any], expected: str
) -> None:
    """Unknown discs, missing files and motors in two places are named with their entries."""
    line_shaft(tmp_path)
    with pytest.raises(lw.MachineFileError, match=expected):
        lw.read(tmp_path / "line.toml", change)


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        ({"train.shafts.left.joint_angle": 0.1}, "a joint"),
        ({"train.motors": {}}, "needs a motor"),
        (
            {"train.excitations": {"e": {"on": "hub", "harmonics": [{"order": 1, "torque": 1.0}]}}},
            "a pulsating torque",
        ),
        ({"train.modal_damping": {"others": 0.1}}, "ratios of modes"),
    ],
)
def test_what_steady_motion_does_not_carry_is_refused(
    tmp_path: Path, change: dict[str, Any], expected: str
) -> None:
    """Each part is named, with the analysis that has it."""
    with pytest.raises(lw.InputError, match=expected):
        lw.elastic_motion(lw.replace(line_shaft(tmp_path), change))


def test_presses_that_never_repeat_together_are_refused(tmp_path: Path) -> None:
    """A ratio of 100 to 123 takes a hundred revolutions."""
    machine = line_shaft(tmp_path)
    text = dumps(machine) + '\n[train.gears]\npair = { between = ["c2", "x"], teeth = [123, 100] }\n'
    text += '[train.discs.x]\ninertia = "1 kg m^2"\n'
    machine = lw.loads(text, {"train.mechanisms.press2.on": "x"})
    with pytest.raises(lw.InputError, match="do not repeat together within 24 revolutions"):
        lw.elastic_motion(machine)


def test_motors_too_weak_for_the_presses_are_named_with_numbers(tmp_path: Path) -> None:
    """Constant friction of 4 r F = 4 kJ a revolution, 637 N m, is more than a motor of 100 N m gives."""
    text = dumps(line_shaft(tmp_path, motor=100.0))
    dry = '[train.mechanisms.press1.machine.loads.dry]\nkind = "dry"\non = "S"\nforce = "5000 N"\n'
    machine = lw.loads(text + dry)
    with pytest.raises(lw.SteadyStateError, match="exceeds that of the motors"):
        lw.elastic_motion(machine)


def test_a_press_that_does_not_turn_is_named(tmp_path: Path) -> None:
    """A rod shorter than the crank closes over part of the revolution only."""
    machine = lw.replace(
        line_shaft(tmp_path), {"train.mechanisms.press2.machine.mechanism.sliders.S.rod": 0.15}
    )
    with pytest.raises(lw.AssemblyError, match=r"train\.mechanisms\.press2: .* closes only"):
        lw.elastic_motion(machine)


def test_permitted_torque_of_a_coupling_is_judged(tmp_path: Path) -> None:
    """A limit below the peak is a finding with both numbers, and ends a study with one."""
    machine = line_shaft(tmp_path)
    machine = lw.replace(machine, {"train.shafts.left.limit": {"torque_permitted": 50.0}})
    motion = lw.elastic_motion(machine)
    assert [one.part for one in motion.judgements] == ["left"]
    assert motion.findings[0].startswith("left: torque ")
    assert lw.study(machine).findings[0][1:] == motion.findings[0][1:]


def test_a_written_train_reads_back_as_the_same(tmp_path: Path) -> None:
    """The machines of its files stand in the text, so that it needs no files."""
    machine = line_shaft(tmp_path)
    again = lw.loads(dumps(machine))
    assert lw.elastic_motion(again).period == lw.elastic_motion(machine).period


def test_motors_of_the_train_move_it_in_time() -> None:
    """The same motor in [train.motors] and in [train.transient.motors] gives the same motion."""
    text = (
        'format = 1\nname = "start"\n[train.discs]\na = { inertia = 1 }\nb = { inertia = 2 }\n'
        '[train.shafts]\ns = { between = ["a", "b"], stiffness = 1000, damping = 1 }\n'
        "[train.transient]\nduration = 0.5\n[train.PLACE.m]\n"
        'on = "a"\nmotor = { kind = "dc", speed_no_load = 30, torque_stall = 200 }\n'
    )
    one, other = (
        lw.torsion_transient(lw.loads(text.replace("PLACE", place)))
        for place in ("motors", "transient.motors")
    )
    assert np.array_equal(one.torque, other.torque)
    assert one.speed[0, -1] > 1.0
    dc = '"dc", speed_no_load = 30, torque_stall = 200'
    held = text.replace("PLACE", "motors").replace(dc, '"constant_speed", speed = 9')
    with pytest.raises(lw.MachineError, match=r"train\.motors\.m\.motor\.kind(.|\n)*to move in time"):
        lw.torsion_transient(lw.loads(held))


# Loads of angle, speed and position, with kinks in each.
LOADS = """
drag = { kind = "formula", on = "S", force = "-20 * v * abs(v)" }
twist = { kind = "formula", on = "A", torque = "-30 * sin(phi)^2 - 2 * omega" }
spring = { kind = "spring", between = ["A", "S"], stiffness = 2000, free_length = 0.6 }
rub = { kind = "dry", on = "S", force = 100 }
fan = { kind = "torque_speed", speed = [0, 20, 25, 60], torque = [0, 20, 50, 60] }
"""


@pytest.mark.parametrize("ratio", [1.0, 2.0])
def test_the_order_of_the_presses_changes_nothing(tmp_path: Path, ratio: float) -> None:
    """Either crank counts the motion; the other has inertia and loads by duals, where the twists put it."""
    line_shaft(tmp_path)
    (tmp_path / "press2.toml").write_text(PRESS + LOADS)
    text = (tmp_path / "line.toml").read_text().replace('"hub", "c2"', '"wheel", "c2"')
    gears = f"""
[train.discs.wheel]
inertia = 0.5
[train.gears]
pair = {{ between = ["hub", "wheel"], ratio = {ratio} }}
"""
    (tmp_path / "line.toml").write_text(text + gears)
    machine = lw.read(tmp_path / "line.toml")
    assert machine.train is not None
    swapped = dict(reversed(machine.train.mechanisms.items()))
    other = machine.with_entries({"train": machine.train.with_entries({"mechanisms": swapped})})
    one, two = lw.elastic_motion(machine), lw.elastic_motion(other)
    # Cycles of one and two revolutions last as long.
    assert two.period == pytest.approx(one.period, rel=1e-10)
    for name in (
        "torque_min",
        "torque_max",
        "acceleration_min",
        "acceleration_max",
        "speed_min",
        "speed_max",
    ):
        assert getattr(two, name) == pytest.approx(getattr(one, name), rel=1e-8), name
    assert np.sort(np.abs(two.multipliers)) == pytest.approx(np.sort(np.abs(one.multipliers)), abs=3e-6)
