"""Steady motion of elastic drivelines, against integrations in time and against the rigid machine."""

from __future__ import annotations

import numpy as np
import pytest
from elastic_drives import cycle, random_drive
from sizes import random_cases

import linkwright as lw

# Two carts of paper 1 with Kloss's formula at all speeds, and a coupling at the crank: independent DOP853 and
# Newton's method, extremes read from samples. Period; speed of the crank, of the motor side there, torque of
# the coupling, acceleration of the crank, minimum and maximum each.
PUBLISHED = {
    (2e4, 50.0): (
        0.6112296942,
        (8.46542209, 12.50144951),
        (9.45222149, 10.80997366),
        (-606.5951, 2575.5910),
        (-69.08779, 57.44724),
    ),
    (5e3, 30.0): (
        0.6136248681,
        (7.25686247, 13.34180400),
        (9.42359413, 10.83521987),
        (-587.9499, 2134.5646),
        (-74.46476, 58.78672),
    ),
}


def two_carts(stiffness: float, damping: float, *, kloss: bool = True) -> lw.Machine:
    entries = {"drive.crankshaft": {"stiffness": stiffness, "damping": damping}}
    if kloss:
        entries["drive.motor.torque_start"] = None
    machine = lw.read("roller_two_carts")
    return lw.replace(machine, entries)


@pytest.mark.parametrize("coupling", PUBLISHED)
def test_two_carts_with_a_coupling_move_as_an_independent_integration_found(
    coupling: tuple[float, float],
) -> None:
    """Period to ten digits, extremes to the error of its samples, which lie inside of them."""
    motion = lw.elastic_motion(two_carts(*coupling))
    period, *extremes = PUBLISHED[coupling]
    assert motion.period == pytest.approx(period, rel=1e-9)
    crank, gearbox = motion.stations.index("crank"), motion.stations.index("gearbox")
    found = (
        (motion.speed_min[crank], motion.speed_max[crank]),
        (motion.speed_min[gearbox], motion.speed_max[gearbox]),
        (motion.torque_min[0], motion.torque_max[0]),
        (motion.acceleration_min[crank], motion.acceleration_max[crank]),
    )
    for (low, high), (least, greatest) in zip(found, extremes, strict=True):
        # A parabola's top between samples: a few millionths of the range.
        near = 1e-6 * (greatest - least)
        assert least - near <= low <= least + 1e-7 * abs(least)
        assert greatest - 1e-7 * abs(greatest) <= high <= greatest + near


def test_multipliers_of_two_carts_are_those_of_the_independent_integration() -> None:
    """A coupling of 2·10⁴ N m/rad leaves −0.1303 and −0.0009 of a disturbance, and nothing of the third."""
    multipliers = lw.elastic_motion(two_carts(2e4, 50.0)).multipliers
    assert multipliers == pytest.approx([-0.1303, -0.0009, 0.0], abs=5e-5)


def test_random_drives_repeat_by_equations_written_down_here() -> None:
    """Start, multipliers, extremes, mean torques and losses of drives with up to three springs."""
    for number, rng in random_cases(4801, 8, 200):
        drive = random_drive(rng)
        motion = lw.elastic_motion(drive.machine, angles=np.zeros(1))
        masses = _masses(motion, len(drive.inertia))
        speed = motion.speed[masses, 0] / motion.ratio[masses]
        start = np.concatenate([motion.twist[:, 0] / drive.ratio, speed])
        scale = np.concatenate([np.abs(motion.twist_max / drive.ratio), speed])
        found = cycle(drive, start, 1e-4 * scale)
        # The start that repeats differs from the given one by what Newton's method takes off.
        off = found.end - start
        # The angle of the crank is the variable: the third of motions and states is one less.
        correction = np.linalg.solve(np.eye(len(start)) - found.slopes, off)
        assert np.abs(correction / scale).max() < 1e-7, number
        largest = np.sort(np.abs(np.linalg.eigvals(found.slopes)))[::-1]
        assert np.abs(motion.multipliers) == pytest.approx(largest, abs=1e-5), number
        assert motion.period == pytest.approx(found.period, rel=1e-8), number
        own, lead = motion.ratio[masses], drive.ratio
        for low, high, values, factor in (
            (motion.speed_min[masses], motion.speed_max[masses], found.speed, own),
            (motion.acceleration_min[masses], motion.acceleration_max[masses], found.acceleration, own),
            (motion.torque_min, motion.torque_max, found.torque, 1 / lead),
        ):
            expected = values * factor[:, None]
            size = np.abs(expected).max(axis=1)
            assert np.abs(low - expected[:, 0]).max() <= 1e-6 * size.max(), number
            assert np.abs((low - expected[:, 0]) / size).max() <= 1e-6, number
            assert np.abs((high - expected[:, 1]) / size).max() <= 1e-6, number
        assert motion.torque_mean * lead == pytest.approx(found.torque_mean, rel=1e-7), number
        assert motion.power_dissipated * motion.period == pytest.approx(found.loss, rel=1e-6), number


def _masses(motion: lw.ElasticMotion, count: int) -> list[int]:
    """The first station of each mass, from the motor on: stations of one mass have one speed at the crank."""
    referred = motion.speed[:, 0] / motion.ratio
    last = len(motion.stations) - 1
    first = [0] + [n for n in range(1, last + 1) if abs(referred[n] - referred[n - 1]) > 1e-13 * referred[n]]
    assert len(first) == count
    return first


def test_a_stiff_coupling_approaches_the_rigid_machine_by_one_over_its_stiffness() -> None:
    """Ten times the stiffness leaves a tenth of the difference in the period; speeds are the rigid ones."""
    rigid = lw.steady_state(lw.replace(lw.read("roller_two_carts"), {"drive.motor.torque_start": None}))
    motions = [lw.elastic_motion(two_carts(k, 50.0)) for k in (1e6, 1e7, 1e8)]
    off = [motion.period - rigid.period for motion in motions]
    # What is left of higher powers of 1/k is a tenth of what it was.
    assert off[1] / off[0] == pytest.approx(0.1, rel=0.05)
    assert off[2] / off[1] == pytest.approx(0.1, rel=0.005)
    speeds = motions[2].speed_min[-1], motions[2].speed_max[-1]
    assert speeds == pytest.approx((rigid.speed_min, rigid.speed_max), rel=1e-5)


def test_work_of_the_motor_is_that_of_loads_and_damping() -> None:
    """Energy of a cycle balances to the accuracy of the solution."""
    motion = lw.elastic_motion(two_carts(2e4, 50.0, kloss=False))
    lost = motion.power_dissipated.sum() * motion.period
    assert motion.energy_drive == pytest.approx(motion.energy_load + lost, rel=1e-9)


SLIDER_CRANK = """
format = 1
name = "slider-crank on an elastic drive"
[drive.motor]
{motor}
inertia = 0.1
[drive.gearbox]
ratio = 5
inertia = 0.02
[drive.flywheel]
inertia = 1
[drive.crankshaft]
stiffness = {stiffness}
damping = {damping}
[mechanism.cranks.A]
radius = 0.2
[mechanism.sliders.S]
crank = "A"
rod = 0.7
[bodies]
S = {{ mass = 60 }}
[loads]
oil = {{ kind = "viscous", on = "S", damping = 30 }}
"""

HELD = 'kind = "constant_speed"\nspeed = 50'


def dc_motor(stall: float) -> str:
    return f'kind = "dc"\nspeed_no_load = 50\ntorque_stall = {stall}'


def slider_crank(motor: str, stiffness: float, damping: float) -> lw.Machine:
    return lw.loads(SLIDER_CRANK.format(motor=motor, stiffness=stiffness, damping=damping))


def test_a_motor_of_constant_speed_is_the_limit_of_steep_ones() -> None:
    """Ten times the stall torque leaves a tenth of the difference; the motor's own speed does not change."""
    held = lw.elastic_motion(slider_crank(HELD, 500, 30))
    assert held.stations == ("motor", "crank")
    assert (held.speed_min[0], held.speed_max[0]) == pytest.approx((50, 50), rel=1e-12)
    off = []
    for stall in (1e4, 1e5, 1e6):
        steep = lw.elastic_motion(slider_crank(dc_motor(stall), 500, 30))
        off.append(steep.speed_max[-1] - held.speed_max[-1])
        assert steep.torque_max == pytest.approx(held.torque_max, rel=200 / stall)
    # What is left of higher powers is a tenth of what it was.
    assert off[1] / off[0] == pytest.approx(0.1, rel=0.06)
    assert off[2] / off[1] == pytest.approx(0.1, rel=0.01)


def test_a_motion_near_resonance_is_found_although_the_start_stalls() -> None:
    """From the speed without load the crank comes to rest; added damping, less and less, leads there."""
    motion = lw.elastic_motion(slider_crank(dc_motor(1e4), 2000, 5))
    crank = motion.stations.index("crank")
    assert 0 < motion.speed_min[crank] < 0.05 * motion.speed_max[crank]
    lost = motion.power_dissipated.sum() * motion.period
    assert motion.energy_drive == pytest.approx(motion.energy_load + lost, rel=1e-8)


def test_an_unstable_motion_is_said_to_be_one() -> None:
    """A driving torque that grows with the speed: a disturbance grows every revolution."""
    text = SLIDER_CRANK.format(motor=HELD, stiffness=500, damping=0) + (
        'push = { kind = "formula", on = "A", torque = "2 * omega" }\n'
    )
    machine = lw.loads(text.replace("damping = 30", "damping = 1"))
    motion = lw.elastic_motion(machine)
    assert motion.multiplier_max > 1
    study = lw.study(machine)
    assert any("unstable" in text for text in study.warnings)


def test_torques_beyond_what_is_permitted_are_findings() -> None:
    """Both limits of the coupling are judged, with numbers; a study ends with findings."""
    limits = {"torque_permitted": 2000.0, "vibratory_torque_permitted": 2000.0}
    machine = lw.replace(two_carts(2e4, 50.0, kloss=False), {"drive.crankshaft.limit": limits})
    motion = lw.elastic_motion(machine)
    assert [judgement.is_kept for judgement in motion.judgements] == [False, True]
    assert motion.findings[0].startswith("crankshaft: torque 2575 N m in steady motion, permitted 2000 N m")
    assert any("limit exceeded" in text for text in lw.study(machine).findings)


def test_a_nearly_rigid_coupling_without_damping_is_answered_or_refused_with_a_remedy() -> None:
    """10¹⁰ N m/rad: speeds of the rigid machine, a torque that finer steps keep; 10¹²: too many steps."""
    rigid = lw.steady_state(two_carts(1e10, 0.0))
    coarse, fine = (lw.elastic_motion(two_carts(1e10, 0.0), accuracy=error, n=8) for error in (1e-9, 1e-10))
    assert fine.speed_max[-1] == pytest.approx(rigid.speed_max, rel=1e-6)
    assert coarse.torque_max == pytest.approx(fine.torque_max, rel=1e-8)
    with pytest.raises(lw.ConvergenceError, match="leave out a stiffness that is rigid at this speed"):
        lw.elastic_motion(two_carts(1e12, 0.0))


def test_a_machine_that_cannot_move_says_why() -> None:
    """A rigid driveline, no motor, and a motor too weak for the load are refused with the reason."""
    with pytest.raises(lw.InputError, match="the driveline is rigid"):
        lw.elastic_motion(lw.read("roller_two_carts"))
    weak = lw.replace(two_carts(2e4, 50.0), {"drive.motor.torque_breakdown": 90.0})
    with pytest.raises(lw.SteadyStateError, match="comes to rest or turns back after"):
        lw.elastic_motion(weak)
