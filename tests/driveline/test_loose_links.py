"""Drives whose links have backlash or curves, against integrations with events."""

from __future__ import annotations

import numpy as np
import pytest
from elastic_drives import Drive
from loose_drives import Law, LooseDrive, loose_cycle, parting, random_loose_drive
from sizes import generator, random_cases

import linkwright as lw
from linkwright.driveline.parametric import parametric_zones
from linkwright.driveline.solving import multipliers_of, ready, solved


def test_random_drives_with_backlash_and_curves_repeat_by_equations_written_down_here() -> None:
    """Start, multipliers, period, losses and extremes of drives with up to three links."""
    chaotic, unknown = [], []
    for number, rng in random_cases(4802, 1, 200, also=(9,)):
        loose = random_loose_drive(rng)
        try:
            motion = lw.elastic_motion(loose.machine, angles=np.zeros(1))
        except lw.SteadyStateError:
            chaotic.append(number)
            continue
        except lw.ConvergenceError:
            unknown.append(number)
            continue
        lead, masses = loose.drive.ratio, _masses(motion)
        speed = motion.speed[masses, 0] / motion.ratio[masses]
        start = np.concatenate([motion.twist[:, 0] / lead, speed])
        scale = np.concatenate([np.maximum(abs(motion.twist_max), abs(motion.twist_min)) / lead, speed])
        found = loose_cycle(loose, start, motion.turns)
        correction = np.linalg.solve(np.eye(len(start)) - found.slopes, found.end - start)
        assert np.abs(correction / scale).max() < 1e-7, number
        largest = np.sort(np.abs(np.linalg.eigvals(found.slopes)))[::-1]
        scale_of_multipliers = max(1.0, largest[0])
        assert np.abs(np.abs(motion.multipliers) - largest).max() < 1e-5 * scale_of_multipliers, number
        assert abs(motion.period / found.period - 1) < 1e-8, number
        lost = motion.power_dissipated * motion.period
        assert np.abs(lost - found.loss).max() <= 1e-6 * max(found.loss.max(), 1e-9), number
        own = motion.ratio[masses]
        for low, high, values, factor in (
            (motion.speed_min[masses], motion.speed_max[masses], found.speed, own),
            (motion.acceleration_min[masses], motion.acceleration_max[masses], found.acceleration, own),
            (motion.torque_min, motion.torque_max, found.torque, 1 / lead),
        ):
            expected = values * factor[:, None]
            size = np.abs(expected).max(axis=1)
            assert np.abs((low - expected[:, 0]) / size).max() <= 1e-6, number
            assert np.abs((high - expected[:, 1]) / size).max() <= 1e-6, number
    assert len(unknown) <= 1
    for case in chaotic:
        # Seen in time: neighbouring motions part, and no cycle of up to 24 revolutions repeats.
        factor, near = parting(random_loose_drive(generator(4802, case)))
        assert factor > 1.05, case
        assert near > 1e-5, case
    for case in unknown:
        # They meet: what is not found is none of those that are called chaotic.
        assert parting(random_loose_drive(generator(4802, case)))[0] < 1.05, case


def _masses(motion: lw.ElasticMotion) -> list[int]:
    """The first station of each mass, from the motor on: stations of one mass have one speed at the crank."""
    referred = motion.speed[:, 0] / motion.ratio
    apart = np.abs(np.diff(referred)) > 1e-13 * referred[1:]
    return [0, *(np.flatnonzero(apart) + 1)]


RATTLING = """
format = 1
name = "crank drive with backlash"
[drive.motor]
kind = "constant_speed"
speed = 50
[drive.gearbox]
ratio = 5
inertia = 0.02
[drive.flywheel]
inertia = 1
[drive.crankshaft]
stiffness = {stiffness}
damping = {damping}
backlash = {backlash}
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


def rattling(stiffness: float = 1e4, damping: float = 30.0, backlash: float = 0.02) -> lw.Machine:
    return lw.loads(RATTLING.format(stiffness=stiffness, damping=damping, backlash=backlash))


def written(stiffness: float, damping: float, backlash: float) -> LooseDrive:
    """The same drive by its equations, at the crank: a motor of any inertia keeps its speed."""
    drive = Drive(
        machine=None,
        inertia=np.array([1e30, 1.0]),
        stiffness=np.array([stiffness]),
        damping=np.array([damping]),
        ratio=np.array([1.0]),
        motor=np.zeros_like,
        radius=0.2,
        rod=0.7,
        mass=60.0,
        dry=0.0,
        viscous=30.0,
        drag=0.0,
    )
    return LooseDrive(drive.machine, drive, [Law(stiffness, damping, backlash / 2, None)])


def test_between_the_flanks_a_shaft_carries_exactly_nothing_and_never_pulls() -> None:
    """T = 0 within the backlash; in contact it has the sign of the twist, whatever the damper does."""
    motion = lw.elastic_motion(rattling(), n=3600)
    free = np.abs(motion.twist[0]) <= 0.01
    assert 0.1 < free.mean() < 0.9
    assert (motion.torque[0][free] == 0).all()
    assert (motion.torque[0] * motion.twist[0] >= 0).all()
    lost = motion.power_dissipated.sum() * motion.period
    assert motion.turns * motion.energy_drive == pytest.approx(
        motion.turns * motion.energy_load + lost, rel=1e-7
    )


def test_a_vanishing_backlash_still_holds_the_damper_back_where_the_torque_changes_its_sign() -> None:
    """b = 2·10⁻⁸: the motion repeats by an independent integration, and is linear where little is damped."""
    motion = lw.elastic_motion(rattling(backlash=2e-8), angles=np.zeros(1))
    linear = lw.elastic_motion(rattling(backlash=0.0))
    assert abs(motion.torque_max[0] - linear.torque_max[0]) > 1.0
    start = np.array([motion.twist[0, 0], 10.0, motion.speed[-1, 0]])
    found = loose_cycle(written(1e4, 30.0, 2e-8), start)
    assert found.end == pytest.approx(start, rel=1e-7, abs=1e-9)
    assert motion.torque_max[0] == pytest.approx(found.torque[0, 1], rel=1e-6)
    for damping in (0.3, 0.1):
        loose, straight = (
            lw.elastic_motion(rattling(damping=damping, backlash=backlash)) for backlash in (2e-8, 0.0)
        )
        assert loose.torque_max == pytest.approx(straight.torque_max, rel=2e-5)


def test_a_motion_that_alternates_about_another_repeats_after_one_cycle() -> None:
    """Multiplier −0.56: it is near itself after two cycles first, and the shortest cycle is given."""
    motion = lw.elastic_motion(rattling(damping=3.0, backlash=2e-8), angles=np.zeros(1))
    assert motion.turns == 1
    start = np.array([motion.twist[0, 0], 10.0, motion.speed[-1, 0]])
    found = loose_cycle(written(1e4, 3.0, 2e-8), start)
    assert found.end == pytest.approx(start, rel=1e-7, abs=1e-8)


def test_without_backlash_the_law_is_that_of_a_spring() -> None:
    """A curve through points of a straight line gives the linear motion."""
    linear = lw.elastic_motion(rattling(backlash=0.0))
    straight = {"drive.crankshaft.stiffness": None, "drive.crankshaft.twist": [0, 0.01, 0.04]}
    straight["drive.crankshaft.torque"] = [0, 100, 400]
    curved = lw.elastic_motion(lw.replace(rattling(backlash=0.0), straight))
    assert curved.torque_max == pytest.approx(linear.torque_max, rel=1e-8)


def test_a_branch_turns_where_a_multiplier_of_an_independent_integration_is_one() -> None:
    """Fold over the stiffness: the start repeats, and one multiplier of the motion there is 1."""
    family = lw.elastic_branches(rattling(15e3, 20.0), "drive.crankshaft.stiffness", 9e3, 15.4e3)
    (branch, *_) = family.branches
    folds = [point.parameter for point in branch.special if point.kind == "fold"]
    assert folds
    for fold in folds:
        at = int(np.argmin(np.abs(branch.parameter - fold)))
        twist, rate, speed = branch.start[at]
        start = np.array([twist, speed + rate, speed])
        found = loose_cycle(written(float(branch.parameter[at]), 20.0, 0.02), start)
        assert found.end == pytest.approx(start, rel=1e-6, abs=1e-8)
        # The speed of the motor stays.
        slopes = np.delete(np.delete(found.slopes, 1, axis=0), 1, axis=1)
        assert np.abs(np.linalg.eigvals(slopes) - 1).min() < 1e-4


@pytest.mark.parametrize(
    ("line", "by", "message"),
    [
        ("damping = 30.0", "damping = 30.0\ntwist = [0, 0.01]", "one of stiffness, sections, or twist and"),
        ("backlash = 0.02", "backlash = -1", "backlash"),
        ("inertia = 0.02", "inertia = 0.02\nbacklash = 0.01", "none with rigid teeth"),
    ],
)
def test_entries_that_do_not_fit_are_refused(line: str, by: str, message: str) -> None:
    """A curve beside a stiffness, a negative backlash, and backlash of rigid teeth are faults."""
    text = RATTLING.format(stiffness=1e4, damping=30.0, backlash=0.02)
    with pytest.raises(lw.InputError, match=message):
        lw.loads(text.replace(line, by))


def test_growth_in_a_zone_of_parametric_resonance_is_that_of_the_multipliers() -> None:
    """Speed at a natural frequency, J(φ) of order 2: first-order growth to a tenth where J changes little."""
    for number, rng in random_cases(4803, 6, 200):
        mass, c = rng.uniform(5.0, 15.0), rng.uniform(0.0, 0.3)
        J = 3.0 + 0.5 * mass * 0.2**2
        k = J * (10.0 * (1 + rng.uniform(-0.2, 0.2) * mass * 0.04 / 4 / J)) ** 2
        text = RATTLING.format(stiffness=k, damping=c, backlash=0).replace("mass = 60", f"mass = {mass}")
        text = text.replace("inertia = 1\n", "inertia = 3\n").replace("damping = 30", "damping = 0.1")
        machine = lw.loads(text.replace("rod = 0.7", "rod = 10.0"))
        # The motion about which disturbances grow, not the one to which they lead.
        driven = ready(machine)
        motion, _ = solved(driven, 1e-9)
        zones = [zone for zone in parametric_zones(machine, 2 * np.pi / motion.period) if zone.order == 2]
        exponent = np.log(abs(multipliers_of(motion, driven.chain)[0])) / motion.period
        rate = 0.25 * 0.5 * mass * 0.04 / J * 10.0
        assert zones, number
        assert zones[0].growth == pytest.approx(exponent, abs=0.1 * rate), number
