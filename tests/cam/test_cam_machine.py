"""Cams in a machine: motion of followers, reduction, forces, elements that hang on followers, batches."""

from __future__ import annotations

import numpy as np
import pytest
from cam_cases import RISE, SWING, TURN, machine

import linkwright as lw
from linkwright import MachineError, ShapeError, cam_profile

PHI = np.linspace(0.0, TURN, 361)[:-1] + 0.003

LINE = """
base_radius = "40 mm"
roller_radius = "10 mm"
direction = "70 deg"
offset = "12 mm"
phase = "25 deg"
"""

ARM = """
follower = "oscillating"
arm_pivot = "P"
arm_length = "80 mm"
base_radius = "40 mm"
roller_radius = "10 mm"
phase = "25 deg"
pivot = "C"
"""
POINTS = """
[mechanism.points]
C = { x = 0.02, y = -0.01 }
P = { x = 0.08, y = 0.07 }
"""


def by_hand(phi: np.ndarray, order: int, h: float = 0.02) -> np.ndarray:
    """Cycloidal rise over 110° and modified-sine return over 120°, from their formulas in the textbook."""
    out = np.zeros_like(phi)
    at = np.mod(phi, TURN)
    beta, back = np.radians(110), np.radians(120)
    rise = at < beta
    z = at / beta
    out += np.where(rise, h / beta**order * _cycloidal(z, order), 0.0)
    out += np.where((at >= beta) & (at < np.radians(160)), h if order == 0 else 0.0, 0.0)
    falls = (at >= np.radians(160)) & (at < np.radians(280))
    z = (at - np.radians(160)) / back
    fall = -h / back**order * _modified_sine(z, order) + (h if order == 0 else 0.0)
    return out + np.where(falls, fall, 0.0)


def _cycloidal(z: np.ndarray, order: int) -> np.ndarray:
    w = TURN
    return (
        z - np.sin(w * z) / w,
        1 - np.cos(w * z),
        w * np.sin(w * z),
        w * w * np.cos(w * z),
    )[order]


def _modified_sine(z: np.ndarray, order: int) -> np.ndarray:
    """Norton, Cam Design and Manufacturing Handbook, 2nd ed., section 3.4: C_v = 1.7596, C_a = 5.5280."""
    c, pi = 4 + np.pi, np.pi
    quick, slow = 4 * pi * z, 4 * pi * z / 3
    first = (
        pi * z / c - np.sin(quick) / (4 * c),
        pi / c * (1 - np.cos(quick)),
        4 * pi**2 / c * np.sin(quick),
        16 * pi**3 / c * np.cos(quick),
    )[order]
    phase = slow + pi / 3
    middle = (
        2 / c + pi * z / c - 9 * np.sin(phase) / (4 * c),
        pi / c * (1 - 3 * np.cos(phase)),
        4 * pi**2 / c * np.sin(phase),
        16 * pi**3 / (3 * c) * np.cos(phase),
    )[order]
    last = (
        4 / c + pi * z / c - np.sin(quick) / (4 * c),
        pi / c * (1 - np.cos(quick)),
        4 * pi**2 / c * np.sin(quick),
        16 * pi**3 / c * np.cos(quick),
    )[order]
    return np.where(z < 1 / 8, first, np.where(z < 7 / 8, middle, last))


# -- motion --------------------------------------------------------------------------------------------------


def test_translating_follower_moves_as_its_sections_say() -> None:
    found = lw.kinematics(machine(RISE + LINE), PHI, third=True)
    slide, point = found.slides["F"], found.points["F"]
    at = PHI - np.radians(25)
    start = np.sqrt(0.05**2 - 0.012**2)
    way = np.array([np.cos(np.radians(70)), np.sin(np.radians(70))])
    np.testing.assert_allclose(slide.position, start + by_hand(at, 0), rtol=1e-14)
    for order, name in enumerate(("d1", "d2", "d3"), start=1):
        wanted = by_hand(at, order)
        scale = np.abs(wanted).max()
        np.testing.assert_allclose(getattr(slide, name), wanted, atol=1e-13 * scale)
        np.testing.assert_allclose(getattr(point, name), wanted[:, None] * way, atol=1e-13 * scale)
    # To the left of the direction lies the offset.
    left = np.array([-way[1], way[0]])
    np.testing.assert_allclose(point.position @ left, 0.012, rtol=1e-13)


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("rotation", ["same", "opposite"])
def test_oscillating_follower_swings_away_from_the_cam(side: str, rotation: str) -> None:
    lines = SWING + ARM + f'side = "{side}"\nrotation = "{rotation}"\n'
    found = lw.kinematics(machine(lines, POINTS), PHI, third=True)
    C, P = np.array([0.02, -0.01]), np.array([0.08, 0.07])
    a, at = np.linalg.norm(P - C), PHI - np.radians(25)
    psi = np.arccos((a**2 + 0.08**2 - 0.05**2) / (2 * a * 0.08)) + by_hand(at, 0, 0.3)
    # Law of cosines for the distance of the roller from the cam's centre.
    far = np.linalg.norm(found.points["F"].position - C, axis=1)
    np.testing.assert_allclose(far, np.sqrt(a**2 + 0.08**2 - 2 * a * 0.08 * np.cos(psi)), rtol=1e-13)
    np.testing.assert_allclose(np.linalg.norm(found.points["F"].position - P, axis=1), 0.08, rtol=1e-14)
    # On the left of the way from C to P the arm is where the cross product is positive.
    to, arm = P - C, found.points["F"].position - P
    across = to[0] * arm[:, 1] - to[1] * arm[:, 0]
    assert (across > 0).all() == (side == "left")
    assert (across < 0).all() == (side == "right")
    sign = -1.0 if side == "left" else 1.0
    link = found.links["F"]
    for order, name in enumerate(("d1", "d2", "d3"), start=1):
        wanted = sign * by_hand(at, order, 0.3)
        np.testing.assert_allclose(getattr(link, name), wanted, atol=1e-13 * np.abs(wanted).max())


def test_joints_give_the_value_after_them() -> None:
    """The jerk of the cycloidal law jumps to its largest value where the rise begins."""
    found = lw.kinematics(machine(RISE + 'base_radius = "40 mm"\nroller_radius = "10 mm"'), [0.0], third=True)
    beta = np.radians(110)
    assert found.slides["F"].d3[0] == pytest.approx(0.02 * TURN**2 / beta**3, rel=1e-14)
    # 110° is no float: the joint lies within rounding of it, so that either side may count.
    near = lw.kinematics(
        machine(RISE + 'base_radius = "40 mm"\nroller_radius = "10 mm"'),
        [beta - 1e-12, beta + 1e-12],
        third=True,
    )
    d3 = near.slides["F"].d3
    assert d3[0] == pytest.approx(0.02 * TURN**2 / beta**3, rel=1e-10)
    assert d3[1] == 0.0


def test_turns_go_on_and_on() -> None:
    m = machine(RISE + LINE)
    one, many = lw.kinematics(m, PHI), lw.kinematics(m, PHI + 20 * TURN)
    # 20 revolutions are 126 rad: an angle loses 1.4e-14 of a radian.
    np.testing.assert_allclose(one.slides["F"].position, many.slides["F"].position, atol=1e-14)
    backwards = lw.kinematics(m, PHI - 3 * TURN)
    np.testing.assert_allclose(one.slides["F"].position, backwards.slides["F"].position, atol=1e-14)


def test_motion_in_time() -> None:
    """x″ = s″ω² + s′ε and the jerk s‴ω³ + 3 s″ωε of an accelerating shaft."""
    t = np.linspace(0.05, 1.0, 40)
    m = machine(RISE + LINE)
    found = lw.motion(m, lambda t: 2 * t + 0.75 * t**2, t)
    omega, at = 2 + 1.5 * t, 2 * t + 0.75 * t**2 - np.radians(25)
    way = np.array([np.cos(np.radians(70)), np.sin(np.radians(70))])
    s1, s2 = by_hand(at, 1), by_hand(at, 2)
    point = found.points["F"]
    np.testing.assert_allclose(point.velocity @ way, s1 * omega, atol=1e-15)
    np.testing.assert_allclose(point.acceleration @ way, s2 * omega**2 + s1 * 1.5, atol=1e-14)
    jerk = by_hand(at, 3) * omega**3 + 3 * s2 * omega * 1.5
    np.testing.assert_allclose(point.jerk @ way, jerk, atol=1e-13)


# -- what hangs on a follower --------------------------------------------------------------------------------


def test_rod_and_slider_on_a_follower() -> None:
    """The follower rises along y; a rod of 0.2 m from it moves a slider along x: x² + y² = l²."""
    m = machine(
        RISE + 'base_radius = "40 mm"\nroller_radius = "10 mm"\ndirection = "90 deg"',
        '[mechanism.sliders.S]\ncrank = "F"\nrod = 0.2\nthrough = "O"\n',
    )
    found = lw.kinematics(m, PHI, third=True)
    y, y1, y2 = 0.05 + by_hand(PHI, 0), by_hand(PHI, 1), by_hand(PHI, 2)
    x = np.sqrt(0.04 - y * y)
    x1 = -y * y1 / x
    x2 = -(y1 * y1 + y * y2 + x1 * x1) / x
    slide = found.slides["S"]
    np.testing.assert_allclose(slide.position, x, rtol=1e-14)
    np.testing.assert_allclose(slide.d1, x1, atol=1e-16)
    np.testing.assert_allclose(slide.d2, x2, atol=1e-15)
    h = 1e-4
    inside = np.abs(np.mod(PHI - np.radians([[0, 110, 160, 175, 265, 280, 360]]).T, TURN) - np.pi) < np.pi - h
    smooth = inside.all(axis=0)
    ends = [lw.kinematics(m, PHI + k * h).slides["S"].d2 for k in (-1, 1)]
    # Differences of order 2 at h = 1e-4: rounding 1e-15/1e-4 and truncation h² of a fifth derivative.
    third = (ends[1] - ends[0]) / (2 * h)
    np.testing.assert_allclose(slide.d3[smooth], third[smooth], atol=1e-7)


def test_lever_gear_and_plate_on_an_arm() -> None:
    """An arm is a link: points on it, gears that mesh with it, a rocker driven from its end."""
    m = machine(
        SWING + ARM,
        POINTS
        + """
Q = { x = 0.35, y = 0.05 }
[mechanism.rigid_points.K]
link = "F"
along = 0.05
across = 0.03
[mechanism.rockers.R]
crank = "K"
pivot = "Q"
coupler = 0.25
rocker = 0.12
[mechanism.gears.G]
pivot = "Q"
meshes = "F"
size = 20
size_other = 60
""",
    )
    found = lw.kinematics(m, PHI)
    link, P = found.links["F"], np.array([0.08, 0.07])
    e = np.stack((np.cos(link.angle), np.sin(link.angle)), axis=1)
    n = np.stack((-e[:, 1], e[:, 0]), axis=1)
    K = found.points["K"]
    np.testing.assert_allclose(K.position, P + 0.05 * e + 0.03 * n, atol=1e-16)
    np.testing.assert_allclose(K.d1, link.d1[:, None] * (0.05 * n - 0.03 * e), atol=1e-16)
    R = found.points["R"].position
    np.testing.assert_allclose(np.linalg.norm(R - K.position, axis=1), 0.25, rtol=1e-13)
    np.testing.assert_allclose(found.links["G"].d1, -3 * link.d1, atol=1e-15)


def test_several_cams_in_one_machine() -> None:
    m = machine(
        RISE + LINE,
        "[mechanism.cams.B]\n"
        + SWING
        + ARM.replace("25 deg", "100 deg")
        + POINTS
        + "[mechanism.cams.T]\n"
        + RISE
        + LINE.replace("25 deg", "205 deg"),
    )
    both = lw.kinematics(m, PHI)
    alone = lw.kinematics(machine(RISE + LINE), PHI)
    np.testing.assert_array_equal(both.slides["F"].position, alone.slides["F"].position)
    later = lw.kinematics(machine(RISE + LINE), PHI - np.pi)
    np.testing.assert_allclose(both.slides["T"].position, later.slides["F"].position, atol=1e-15)
    assert set(lw.study(m).results()) >= {"cam.F", "cam.B", "cam.T"}
    assert cam_profile(m, "B").stroke == pytest.approx(0.3)


def test_opposite_rotation_mirrors_the_cam_and_leaves_the_motion() -> None:
    same, other = (
        machine(RISE + LINE.replace("12 mm", "0 mm") + f'rotation = "{r}"\n') for r in ("same", "opposite")
    )
    one, two = (lw.kinematics(m, PHI).slides["F"] for m in (same, other))
    np.testing.assert_array_equal(one.position, two.position)
    a, b = (cam_profile(m).flanks[0].curve().points(PHI) for m in (same, other))
    np.testing.assert_allclose(a, b * [1, -1], atol=1e-17)


# -- reduction and forces ------------------------------------------------------------------------------------

LOADED = """
[bodies]
F = { mass = 3 }
[loads]
gravity = { kind = "gravity", acceleration = 10 }
dry = { kind = "dry", on = "F", force = 40 }
air = { kind = "viscous", on = "F", damping = 25 }
spring = { kind = "spring", between = ["F", "Q"], stiffness = 5000, free_length = 0.1 }
[mechanism.points]
Q = { x = 0, y = 0 }
"""


def test_reduction_of_a_translating_follower() -> None:
    """J = m s′², J′ = 2 m s′ s″, and torques of loads as forces times s′."""
    lines = RISE + LINE.replace("12 mm", "0 mm")
    m = machine(lines, LOADED)
    found = lw.reduction(m, n=360)
    phi = found.crank_angle - np.radians(25)
    s, s1, s2 = (by_hand(phi, order) for order in range(3))
    np.testing.assert_allclose(found.inertia_reduced, 3 * s1**2, atol=1e-17)
    np.testing.assert_allclose(found.inertia_reduced_d1, 6 * s1 * s2, atol=1e-16)
    np.testing.assert_allclose(found.viscous, 25 * s1**2, atol=1e-16)
    weight = 30 * np.sin(np.radians(70))
    wanted = (weight + 5000 * (0.05 + s - 0.1)) * s1 + 40 * np.abs(s1)
    np.testing.assert_allclose(found.torque_load, wanted, atol=1e-13)


def test_reduction_of_an_oscillating_follower() -> None:
    """J = J_P ψ′², with J_P by Steiner from the centre of mass."""
    body = "[bodies]\nF = { mass = 2, inertia = 0.004, along = 0.03, across = 0.01 }\n"
    m = machine(SWING + ARM, POINTS + body)
    found = lw.reduction(m, n=360)
    psi1, psi2 = (by_hand(found.crank_angle - np.radians(25), order, 0.3) for order in (1, 2))
    J = 0.004 + 2 * (0.03**2 + 0.01**2)
    np.testing.assert_allclose(found.inertia_reduced, J * psi1**2, rtol=1e-12, atol=1e-18)
    np.testing.assert_allclose(found.inertia_reduced_d1, 2 * J * psi1 * psi2, atol=1e-16)


@pytest.mark.parametrize("rotation", ["same", "opposite"])
@pytest.mark.parametrize("offset", ["0 mm", "12 mm"])
def test_normal_force_of_a_translating_follower(rotation: str, offset: str) -> None:
    """N cos γ is what the follower needs along its line, and its guide bears N sin γ across."""
    lines = RISE + LINE.replace("12 mm", offset) + f'rotation = "{rotation}"\n'
    m = machine(lines, '[bodies]\nF = { mass = 3 }\n[loads]\ng = { kind = "gravity", acceleration = 10 }\n')
    found = lw.forces(m, speed=8.0, acceleration=5.0)
    at = found.crank_angle - np.radians(25)
    s1, s2 = by_hand(at, 1), by_hand(at, 2)
    along = 3 * (s2 * 64 + s1 * 5) + 30 * np.sin(np.radians(70))
    across = 30 * np.cos(np.radians(70))
    sign = 1.0 if rotation == "same" else -1.0
    e = float(offset.split()[0]) * 1e-3
    gamma = np.arctan((sign * s1 + e) / (np.sqrt(0.05**2 - e**2) + by_hand(at, 0)))
    np.testing.assert_allclose(found.drives["F"] * np.cos(gamma), along, rtol=1e-11)
    guide = found.pairs["F.guide"]
    left = np.array([-np.sin(np.radians(70)), np.cos(np.radians(70))])
    np.testing.assert_allclose(guide.force @ left, across - along * np.tan(gamma), atol=1e-11)
    np.testing.assert_allclose(found.torque_drive, along * s1, atol=1e-12)
    assert np.abs(found.power_residual).max() < 1e-10 * np.abs(found.power_drive).max()


@pytest.mark.parametrize("side", ["left", "right"])
def test_normal_force_of_an_oscillating_follower(side: str) -> None:
    """N l cos γ = J ε_ψ with all mass in the arm's inertia."""
    m = machine(
        SWING + ARM + f'side = "{side}"\n',
        POINTS + "[bodies]\nF = { mass = 0, inertia = 0.01 }\n".replace("mass = 0, ", ""),
    )
    found = lw.forces(m, speed=8.0, acceleration=0.0)
    at = found.crank_angle - np.radians(25)
    gamma = cam_profile(m).flanks[0].contact.kernel.rows(np.mod(at, TURN))["pressure_angle"]
    needed = 0.01 * by_hand(at, 2, 0.3) * 64
    np.testing.assert_allclose(found.drives["F"] * 0.08 * np.cos(gamma), needed, atol=1e-10)
    np.testing.assert_allclose(found.torque_drive, needed * by_hand(at, 1, 0.3), atol=1e-11)


def test_second_contact_takes_over_where_the_first_would_pull() -> None:
    """In a conjugate pair the driving torque is that of virtual work, whichever roller carries."""
    lines = RISE + 'base_radius = "40 mm"\nroller_radius = "10 mm"\noffset = "8 mm"\n'
    pair = lines + 'closure = "conjugate"\nsecond = { distance = "130 mm" }\n'
    m = machine(pair, "[bodies]\nF = { mass = 3 }\n")
    found = lw.forces(m, speed=8.0, acceleration=0.0)
    s1, s2 = by_hand(found.crank_angle, 1), by_hand(found.crank_angle, 2)
    force, second = found.drives["F"], cam_profile(m).flanks[1]
    gamma = [
        flank.contact.kernel.rows(found.crank_angle)["pressure_angle"] for flank in cam_profile(m).flanks
    ]
    needed = 3 * s2 * 64
    assert second.contact.turned == np.pi
    assert (force < -1).any()
    carried = np.where(force >= 0, force * np.cos(gamma[0]), force * np.cos(gamma[1]))
    np.testing.assert_allclose(carried, needed, atol=1e-11)
    np.testing.assert_allclose(found.torque_drive, needed * s1, atol=1e-12)


# -- batches -------------------------------------------------------------------------------------------------

DRIVEN = """
[drive.motor]
kind = "constant_torque"
torque = 20
[drive.flywheel]
inertia = 0.02
[bodies]
F = { mass = 3 }
"S.rod" = { mass = 1 }
S = { mass = 5 }
[mechanism.sliders.S]
crank = "F"
rod = 0.2
through = "O"
[loads]
air = { kind = "viscous", on = "S", damping = 3000 }
"""


def test_base_radius_varies_in_a_batch() -> None:
    lines = RISE + 'roller_radius = "10 mm"\ndirection = "90 deg"\nbase_radius = '
    m = machine(f"{lines}0.04", DRIVEN)
    base = np.array([0.035, 0.04, 0.05, 0.06, 0.07])
    found = lw.steady_states(m, {"mechanism.cams.F.base_radius": base})
    assert not found.status.any()
    assert np.ptp(found.speed_mean_time) > 0.01 * found.speed_mean_time.max()
    for i, radius in enumerate(base):
        one = lw.steady_state(machine(f"{lines}{radius}", DRIVEN))
        # The batch promises 1e-7.
        assert found.speed_max[i] == pytest.approx(one.speed_max, rel=1e-7)
        assert found.period[i] == pytest.approx(one.period, rel=1e-7)


@pytest.mark.parametrize("entry", ["offset", "phase", "direction", "roller_radius"])
def test_other_sizes_vary_in_motions(entry: str) -> None:
    values = {
        "offset": [0.0, 0.01],
        "phase": [0.0, 1.0],
        "direction": [1.0, 1.5],
        "roller_radius": [0.01, 0.02],
    }
    m = machine(RISE + LINE)
    both = lw.motions(
        lw.replace(m, {f"mechanism.cams.F.{entry}": np.array(values[entry])}), PHI, points=["F"]
    )
    for row, value in enumerate(values[entry]):
        one = lw.kinematics(lw.replace(m, {f"mechanism.cams.F.{entry}": value}), PHI).points["F"]
        np.testing.assert_allclose(both[row][:2].T, one.position, atol=1e-15)
        np.testing.assert_allclose(both[row][4:].T, one.d2, atol=1e-14)


@pytest.mark.parametrize("entry", ["arm_length", "base_radius"])
def test_sizes_of_an_arm_vary_in_motions(entry: str) -> None:
    m = machine(SWING + ARM, POINTS)
    values = np.array([0.05, 0.07])
    both = lw.motions(lw.replace(m, {f"mechanism.cams.F.{entry}": values}), PHI, points=["F"])
    for row, value in enumerate(values):
        one = lw.kinematics(lw.replace(m, {f"mechanism.cams.F.{entry}": float(value)}), PHI).points["F"]
        np.testing.assert_allclose(both[row][:2].T, one.position, atol=1e-15)


def test_pivots_vary_in_motions() -> None:
    m = machine(SWING + ARM, POINTS)
    both = lw.motions(lw.replace(m, {"mechanism.points.P.x": np.array([0.08, 0.09])}), PHI, points=["F"])
    one = lw.kinematics(lw.replace(m, {"mechanism.points.P.x": 0.09}), PHI).points["F"]
    np.testing.assert_allclose(both[1][:2].T, one.position, atol=1e-15)


def test_a_row_without_place_is_nan_alone() -> None:
    m = machine(RISE + LINE)
    both = lw.motions(
        lw.replace(m, {"mechanism.cams.F.offset": np.array([0.0, 0.06, 0.01])}), PHI[:3], points=["F"]
    )
    assert np.isnan(both).any(axis=(1, 2)).tolist() == [False, True, False]


def test_sections_cannot_vary_in_a_batch() -> None:
    m = machine(RISE + 'base_radius = "40 mm"\nroller_radius = "10 mm"\ndirection = "90 deg"\n', DRIVEN)
    lifts = np.array([0.02, 0.03])
    entries = {"mechanism.cams.F.sections.0.lift": lifts, "mechanism.cams.F.sections.2.lift": -lifts}
    with pytest.raises(ShapeError, match="sections of a cam cannot vary"):
        lw.steady_states(m, entries)
    with pytest.raises(MachineError, match="add to 0"):
        lw.steady_states(m, {"mechanism.cams.F.sections.0.lift": lifts})
    with pytest.raises(ShapeError, match="profile of cam F"):
        cam_profile(lw.replace(m, {"mechanism.cams.F.base_radius": lifts}))


def test_sections_are_exchanged_one_by_one() -> None:
    m = machine(RISE + 'base_radius = "40 mm"\nroller_radius = "10 mm"\n')
    other = lw.replace(
        m, {"mechanism.cams.F.sections.0.lift": 0.03, "mechanism.cams.F.sections.2.lift": -0.03}
    )
    assert cam_profile(other).stroke == pytest.approx(0.03)
    np.testing.assert_allclose(
        lw.kinematics(other, PHI).slides["F"].position - 0.05,
        by_hand(PHI, 0, 0.03),
        atol=1e-15,
    )
    assert cam_profile(m).stroke == pytest.approx(0.02), "the first machine is as it was"
