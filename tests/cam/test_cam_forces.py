"""Forces of cam and follower against free bodies, balances of work and power, and closed forms."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from cam_laws import CYCLOIDAL, PARABOLIC, POLYNOMIAL_345, POLYNOMIAL_4567, SKEW, UNIFORM, turn
from scipy.optimize import brentq, minimize_scalar

from linkwright import (
    ArmPivot,
    FindingError,
    FollowerLoad,
    InputError,
    ShapeError,
    StemGuide,
    cam_course,
    contact_force,
    least_preload,
    lift_off,
)
from linkwright.cam import MotionLaw
from linkwright.cam.dynamics.contact_force import ContactForce
from linkwright.cam.dynamics.follower_load import CamCourse, force_along

BASE, ROLLER = 0.04, 0.012
LIFT = turn(POLYNOMIAL_345, 0.015)
FOLLOWER = FollowerLoad(0.9, 8e3, 120.0)
GUIDE = StemGuide(0.05, 0.045, 0.12, 0.016)
MU = 0.08


def course(lift: MotionLaw = LIFT, n: int = 720, speed: float = 30.0, acceleration: float = 0.0) -> CamCourse:
    """A translating roller follower in line, radius of the prime circle BASE + ROLLER."""
    phi = lift.start + (np.arange(n + 1)) * lift.length / n
    s, d1, d2 = (lift.at(phi, k) for k in range(3))
    gamma = np.arctan2(d1, BASE + ROLLER + s)
    # Velocity of the cam's surface along the tangent, less that of the follower's end.
    sliding = np.hypot(d1, BASE + ROLLER + s) - ROLLER
    return cam_course(
        phi, (s, d1, d2), speed, pressure_angle=gamma, sliding=sliding, acceleration=acceleration
    )


def free_body(
    at: CamCourse, follower: FollowerLoad, guide: StemGuide, k: int, mu: float, side: float
) -> np.ndarray:
    """N, R₁, R₂ of one row by three equations of a stem, all forces at their points, directions by iteration.

    Coordinates: x across, to where the cam's surface runs; y along the way; origin at the roller's centre.
    """
    gamma, way = at.pressure_angle[k], np.sign(at.lift_d1[k])
    need = float(force_along(at, follower)[k])
    normal = side * np.array([np.sin(gamma), np.cos(gamma)])
    tangent = np.array([np.cos(gamma), -np.sin(gamma)]) * np.sign(at.sliding[k])
    near = guide.overhang - at.lift[k]
    sense = np.array([1.0, 1.0])
    for _ in range(9):
        rows = np.zeros((3, 3))
        contact = normal + mu * tangent
        # Force on the stem's axis below: the roller's centre is on it, so the contact has no moment about it
        # but by an offset.
        rows[:, 0] = [contact[0], contact[1], -at.offset[k] * contact[1]]
        for j, y in enumerate((near, near + guide.length)):
            # The wall that pushes is on the side that the push comes from.
            x = -sense[j] * guide.diameter / 2
            pull = -guide.coefficient * way * sense[j]
            rows[:, 1 + j] = [1.0, pull, y - x * pull]
        found = np.linalg.solve(rows, [0.0, need, 0.0])
        if (np.sign(found[1:]) == sense).all():
            return found
        sense = np.sign(found[1:])
    raise AssertionError("directions of the reactions did not settle")


@pytest.mark.parametrize("offset", [0.0, 0.004])
@pytest.mark.parametrize("closure", ["force", "form"])
def test_a_follower_in_its_guide_is_in_equilibrium(closure: str, offset: float) -> None:
    at = replace(course(speed=30.0 if closure == "force" else 200.0), offset=np.full(721, offset))
    found = contact_force(at, FOLLOWER, GUIDE, friction=MU, closure=closure)
    assert not found.jammed.any()
    moving = np.flatnonzero(np.abs(at.lift_d1) > 1e-6)
    for k in moving[::7]:
        force, near, far = free_body(at, FOLLOWER, GUIDE, int(k), MU, found.side[k])
        assert force == pytest.approx(found.normal[k] * found.side[k], rel=1e-11)
        assert [near, far] == pytest.approx([found.near[k], found.far[k]], rel=1e-9, abs=1e-9)
        assert force > 0
    if closure == "form":
        assert {-1.0, 1.0} == set(found.side[moving])
        assert (np.sign(found.normal) == found.side).all()


def test_formula_of_the_handbooks() -> None:
    """N = F/(cos γ − μ(2A/B + 1) sin γ), rising, without diameter and friction of the contact."""
    at = course()
    guide = StemGuide(0.05, 0.045, 0.12)
    found = contact_force(at, FOLLOWER, guide)
    up = at.lift_d1 > 1e-9
    a = (0.045 - at.lift[up]) / 0.05
    gamma = at.pressure_angle[up]
    expected = force_along(at, FOLLOWER)[up] / (np.cos(gamma) - 0.12 * (2 * a + 1) * np.sin(gamma))
    np.testing.assert_allclose(found.normal[up], expected, rtol=1e-13)


def test_jam_begins_at_the_angle_of_the_handbooks() -> None:
    """tan γ = B/(μ(2A + B)); the finding names it and where the follower is beyond it."""
    gamma = np.linspace(0.0, 1.2, 121)
    at = cam_course(np.linspace(0, 1, 121), (0.0, np.ones(121), 0.0), 1.0, pressure_angle=gamma)
    found = contact_force(at, FOLLOWER, StemGuide(0.05, 0.06, 0.2))
    limit = np.arctan(0.05 / (0.2 * 0.17))
    # A thousand times the force counts as jammed already.
    np.testing.assert_array_equal(found.jammed, gamma > limit - 1e-3)
    assert np.isnan(found.normal[found.jammed]).all()
    assert np.isfinite(found.normal[~found.jammed]).all()
    assert f"friction allows {np.degrees(limit):.4g}°" in found.findings[0]
    assert np.isnan(found.torque_mean)
    assert np.isfinite(found.normal_max)


def test_power_in_is_power_out() -> None:
    """dE/dt + load + damper + friction, with angular acceleration."""
    follower = FollowerLoad(0.9, 8e3, 120.0, 15.0, 40.0)
    at = course(acceleration=50.0)
    found = contact_force(at, follower, GUIDE, friction=MU)
    out = (0.9 * at.lift_ddot + 8e3 * at.lift + 120.0 + 15.0 * at.velocity + 40.0) * at.velocity
    np.testing.assert_allclose(found.power, out - found.power_friction, rtol=1e-12, atol=1e-10)
    assert (found.power_friction <= 0).all()
    # Friction by its own places: contact, and both ends of the guide.
    size = np.abs(found.normal)
    lost = MU * size * np.abs(at.sliding) * at.speed
    lost += 0.12 * (np.abs(found.near) + np.abs(found.far)) * np.abs(at.velocity)
    lost[at.lift_d1 == 0] = (MU * size * np.abs(at.sliding) * at.speed)[at.lift_d1 == 0]
    np.testing.assert_allclose(-found.power_friction, lost, rtol=1e-9, atol=1e-9)


def test_torque_is_the_moment_of_the_contact_about_the_cam() -> None:
    """Statics of the cam: normal and friction at the point of contact, found from the roller's centre."""
    at = course()
    found = contact_force(at, FOLLOWER, GUIDE, friction=MU)
    gamma = at.pressure_angle
    # On the follower along the normal and the tangent; x to where the surface runs, which for a cam that
    # turns forward is to the left of the way: a moment −(y F_x − x F_y) of the reaction drives backward.
    normal = np.stack([np.sin(gamma), np.cos(gamma)])
    tangent = np.stack([np.cos(gamma), -np.sin(gamma)])
    point = np.stack([np.zeros_like(gamma), BASE + ROLLER + at.lift]) - ROLLER * normal
    force = found.normal * normal + MU * np.abs(found.normal) * tangent
    np.testing.assert_allclose(
        found.torque, point[1] * force[0] - point[0] * force[1], rtol=1e-10, atol=1e-10
    )


def test_a_cam_without_friction_gives_back_what_it_takes() -> None:
    found = contact_force(course(n=3600), FOLLOWER)
    # The trapezoidal rule over a whole revolution, with jumps of the third derivative.
    assert abs(found.torque_mean) < 1e-6 * found.torque_max
    load = np.where(course(n=3600).lift_d1 > 0, 200.0, 0.0)
    worked = contact_force(course(n=3600), replace(FOLLOWER, load=load))
    assert worked.torque_mean * 2 * np.pi == pytest.approx(200.0 * 0.015, rel=1e-5)


def test_oscillating_follower() -> None:
    """Arm and inertia: N l cos γ = J ψ̈ + …; friction of the journal against the motion."""
    at = course()
    pivot = ArmPivot(0.08, 0.1, 0.01)
    follower = FollowerLoad(2e-3, 30.0, 4.0)
    easy = contact_force(at, follower, ArmPivot(0.08))
    np.testing.assert_allclose(
        easy.normal * 0.08 * np.cos(at.pressure_angle), force_along(at, follower), rtol=1e-13
    )
    found = contact_force(at, follower, pivot)
    up, down = at.lift_d1 > 1e-9, at.lift_d1 < -1e-9
    assert (found.normal[up] > easy.normal[up]).all()
    assert (found.normal[down] < easy.normal[down]).all()
    lost = 0.1 * 0.01 * np.abs(found.near) * np.abs(at.velocity)
    np.testing.assert_allclose(-found.power_friction, lost, atol=1e-12)
    same = contact_force(at, follower, ArmPivot(np.full(721, 0.08), 0.1, 0.01))
    np.testing.assert_array_equal(same.normal, found.normal)


def test_where_a_spring_is_too_weak_is_told() -> None:
    found = contact_force(course(speed=200.0), FOLLOWER)
    np.testing.assert_array_equal(found.lost, found.force_along < 0)
    assert found.lost.any()
    assert "leaves the cam from" in found.findings[0]
    assert found.normal_min < 0


def sides(lift: MotionLaw, clearance: float, n: int = 7200) -> ContactForce:
    return contact_force(course(lift, n), FollowerLoad(0.9), closure="form", clearance=clearance)


def test_flank_changes_where_the_acceleration_does() -> None:
    found = sides(turn(CYCLOIDAL, 0.015), 0.0).side_changes
    # In the middle of rise and return, and from the return to the rise across the dwells.
    expected = [(1.0, -1), (2.8 + 0.85, 1)]
    listed = [(each.cam_angle, each.side) for each in found]
    for angle, side in expected:
        assert any(abs(a - angle) < 1e-3 and s == side for a, s in listed)
    assert all(each.impact_speed == 0 for each in found)


def test_landing_speed_of_a_smooth_change() -> None:
    """v = ½ (Ḟ/m)^{1/3}(6j)^{2/3}, in the limit of a small clearance, where F is straight."""
    j = 1e-9
    change = next(
        each for each in sides(turn(CYCLOIDAL, 0.015), j).side_changes if abs(each.cam_angle - 1) < 1e-3
    )
    rate = abs(turn(CYCLOIDAL, 0.015).at(1.0, 3)) * 30.0**3
    assert change.impact_speed == pytest.approx(0.5 * np.cbrt(rate * (6 * j) ** 2), rel=1e-3)
    assert change.force_rate == pytest.approx(-0.9 * rate, rel=1e-4)


def test_landing_speed_of_a_jump() -> None:
    """A constant acceleration a from the jump on: v = √(2aj). The jump lies between two rows."""
    j = 1e-4
    law = turn(PARABOLIC, 0.015)
    change = next(each for each in sides(law, j, 72000).side_changes if abs(each.cam_angle - 1) < 1e-3)
    a = abs(law.at(1.1, 2)) * 30.0**2
    assert change.impact_speed == pytest.approx(np.sqrt(2 * a * j), rel=2e-3)


@pytest.mark.parametrize("law", [CYCLOIDAL, POLYNOMIAL_345, POLYNOMIAL_4567, PARABOLIC, SKEW])
def test_lift_off_against_a_search(law: MotionLaw) -> None:
    lift = turn(law, 0.015)
    found = lift_off(lift, FOLLOWER)
    phi = np.linspace(lift.start, lift.end, 400_001)[:-1]
    s, d2 = lift.at(phi), lift.at(phi, 2)
    falling = d2 < 0
    speeds = np.sqrt((8e3 * s[falling] + 120) / (-0.9 * d2[falling]))
    # The scan misses a smooth minimum by the square of its step, one at a jump by the step.
    assert found.speed == pytest.approx(speeds.min(), rel=5e-5)
    assert found.speed <= speeds.min() * (1 + 1e-12)
    assert np.interp(found.cam_angle, phi[falling], speeds) == pytest.approx(found.speed, rel=1e-3)
    assert 0.9 * found.lift_d2 * found.speed**2 + found.force_spring == pytest.approx(0, abs=1e-9)


def test_lift_off_is_where_the_least_force_is_zero() -> None:
    lift = turn(SKEW, 0.015)
    follower = FollowerLoad(0.9, 8e3, 120.0, 25.0, 10.0)
    load = turn(CYCLOIDAL, 50.0)
    found = lift_off(lift, follower, load)

    def least(omega: float) -> float:
        # Largest lack of force by a bounded search around the worst of a scan.
        def force(x: float) -> float:
            s, d1, d2 = (float(lift.at(x, k)) for k in range(3))
            return 0.9 * d2 * omega**2 + 25 * d1 * omega + 8e3 * s + 130.0 + float(load.at(x))

        scan = np.linspace(0, 2 * np.pi, 2001)[:-1]
        x = scan[np.argmin([force(each) for each in scan])]
        return min(
            force(x),
            float(
                minimize_scalar(
                    force, bounds=(x - 4e-3, x + 4e-3), method="bounded", options={"xatol": 1e-10}
                ).fun
            ),
        )

    assert found.speed == pytest.approx(brentq(least, 0.5 * found.speed, 1.5 * found.speed), rel=1e-6)


def test_least_preload_is_the_other_side_of_lift_off() -> None:
    lift = turn(CYCLOIDAL, 0.015)
    # At low speed the spring holds at the top, and in the dwell at the foot nothing is asked for.
    assert least_preload(lift, FOLLOWER, 20.0).preload == pytest.approx(0, abs=1e-12)
    for speed in (120.0, 200.0):
        need = least_preload(lift, FOLLOWER, speed)
        again = lift_off(lift, replace(FOLLOWER, preload=need.preload))
        assert again.speed == pytest.approx(speed, rel=1e-9)
    more = least_preload(lift, FOLLOWER, 77.0, contact=30.0)
    assert more.preload == pytest.approx(least_preload(lift, FOLLOWER, 77.0).preload + 30)


def test_what_cannot_be_held_is_told() -> None:
    with pytest.raises(FindingError, match=r"at rest .* increase the preload"):
        lift_off(LIFT, FollowerLoad(1.0, 1e3, -5.0))
    with pytest.raises(FindingError, match="at any speed"):
        lift_off(turn(UNIFORM, 0.01), FOLLOWER)
    with pytest.raises(FindingError, match="no preload"):
        least_preload(turn(UNIFORM, 0.01), FOLLOWER, 10.0)
    with pytest.raises(InputError, match="mass: found 0"):
        lift_off(LIFT, FollowerLoad(0.0, 1.0, 1.0))
    with pytest.raises(InputError, match="found an array"):
        lift_off(LIFT, FollowerLoad(1.0, 1.0, 1.0, load=np.zeros(5)))


def test_inputs_without_sense_are_told() -> None:
    at = course()
    with pytest.raises(InputError, match="sliding"):
        contact_force(replace(at, sliding=np.zeros(721)), FOLLOWER, friction=0.1)
    with pytest.raises(ShapeError, match="one length"):
        contact_force(at, FollowerLoad(1.0, load=np.zeros(7)))
    with pytest.raises(FindingError, match=r"into its guide, 0\.01 m away"):
        contact_force(at, FOLLOWER, StemGuide(0.05, 0.01))
    with pytest.raises(InputError, match=r"cam_angle: found 1 rad after 2 rad"):
        cam_course([0.0, 2.0, 1.0], (0.0, 0.0, 0.0), 1.0)
    with pytest.raises(InputError, match=r"less than 90°"):
        cam_course([0.0, 1.0], (0.0, 0.0, 0.0), 1.0, pressure_angle=2.0)
    with pytest.raises(InputError, match="speed"):
        cam_course([0.0, 1.0], (0.0, 0.0, 0.0), -1.0)


def test_the_mean_torque_is_exact_or_its_error_is_told() -> None:
    """Inertia, spring and preload take nothing over a revolution; what a damper takes has its error."""
    idle = contact_force(course(n=90), FollowerLoad(0.9, 8e3, 120.0))
    # Trapezia of 4° leave 2e-4 of the maximum; what is left here is the rounding of a sum of 90 torques.
    assert abs(idle.torque_mean) < 1e-14 * idle.torque_max
    damped = FollowerLoad(0.9, 8e3, 120.0, damping=50.0)
    exact = 50.0 * 30.0 * sum(_square_of_slope(LIFT)) / (2 * np.pi)
    for n in (90, 360):
        found = contact_force(course(n=n), damped)
        assert abs(found.torque_mean - exact) < found.torque_mean_error + 1e-14 * found.torque_max
        assert found.torque_mean_error < 1e-3 * exact


def _square_of_slope(lift: MotionLaw) -> Iterator[float]:
    """∫ s′² dφ, section by section."""
    for a, b in pairwise(lift.breaks):
        x, w = np.polynomial.legendre.leggauss(16)
        yield float(w @ lift.at(0.5 * (a + b) + 0.5 * (b - a) * x, 1) ** 2 * 0.5 * (b - a))
