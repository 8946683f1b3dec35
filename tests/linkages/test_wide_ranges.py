"""Ranges of closure that are wider than a revolution, and those of a law that has no value elsewhere."""

from pathlib import Path

import numpy as np
import pytest

import linkwright as lw
from linkwright import AssemblyError

FOUND = Path(__file__).parents[1] / "found"

# Ends of the range of the boundary-driven six-bar [deg]: by its own search, to 1e-6.
LOW, HIGH = 157.954246, 540.287754


@pytest.mark.parametrize("drawn", [158.0, 200.0, 360.0, 400.0, 539.5, 540.2])
def test_a_range_wider_than_a_revolution_is_found_from_wherever_it_is_drawn(drawn: float) -> None:
    machine = lw.read(FOUND / "boundary_branch.toml")
    phi = np.radians(drawn)
    pose = lw.kinematics(machine, [phi])
    places = {
        f"mechanism.joints.{name}.{axis}": float(pose.points[name].position[0, k])
        for name in "CDE"
        for k, axis in enumerate("xy")
    }
    closed = lw.closure(lw.replace(machine, {**places, "mechanism.assembled_at": float(phi)}))
    assert np.degrees(closed.ranges) == pytest.approx(np.array([[LOW, HIGH]]), abs=1e-5)
    assert closed.change_point is None


def test_forces_propose_angles_within_a_wide_range() -> None:
    machine = lw.read(FOUND / "boundary_branch.toml")
    with pytest.raises(AssemblyError, match=r'--angles="158\.1 deg, 540\.1 deg"'):
        lw.forces(machine, speed=1.0)
    inside = np.radians([159.0, 350.0, 539.0])
    assert np.isfinite(lw.forces(machine, speed=1.0, angles=inside).torque_drive).all()


def test_a_law_without_value_elsewhere_does_not_forbid_a_pose() -> None:
    machine = lw.read(FOUND / "boom_by_law.toml")
    pose = lw.pose(machine, 0.3, speed=2.0)
    # The cylinder has the length 5 + φ, by the law of cosines.
    assert pose.slides["cyl"].position == pytest.approx(5.3)
    assert pose.slides["cyl"].velocity == pytest.approx(2.0)
    # The argument of acos is within ±1 for lengths from 1 to 7.
    assert lw.closure(machine).ranges[0] == pytest.approx((-4.0, 2.0), abs=1e-9)


def test_a_pose_where_the_law_has_no_value_is_refused_with_the_range() -> None:
    machine = lw.read(FOUND / "boom_by_law.toml")
    with pytest.raises(AssemblyError, match=r"-229\.18° to 114\.59°: the law of C.*has no usable value"):
        lw.pose(machine, 3.0)
    with pytest.raises(AssemblyError, match="has no usable value"):
        lw.reduction(machine)


def test_a_motion_under_a_law_of_time_stays_where_the_crank_has_a_law() -> None:
    machine = lw.read(FOUND / "boom_by_law.toml")
    times = np.linspace(0, 1, 11)
    moved = lw.motion(machine, lambda t: 1.0 * t, times)
    assert moved.slides["cyl"].position == pytest.approx(5 + times)


def test_a_law_of_a_crank_alone_limits_its_own_motion() -> None:
    text = 'format = 1\nname = "crank"\n[mechanism.cranks.A]\nradius = 1\nlaw = "sqrt(cos(phi) - 0.5)"\n'
    closed = lw.closure(lw.loads(text))
    assert closed.element == "A"
    # cos φ ≥ ½ within 60° about zero; there the slope of the root is infinite.
    assert np.degrees(closed.ranges[0]) == pytest.approx((300.0, 420.0), abs=1e-4)


def test_change_points_are_listed_in_every_revolution_of_the_cycle() -> None:
    dead = lw.linkage(lw.read(FOUND / "kite.toml")).dead_points
    passed = [np.degrees(point.angle) for point in dead if point.kind == "change point passed"]
    assert passed == pytest.approx([90.0, 450.0])
