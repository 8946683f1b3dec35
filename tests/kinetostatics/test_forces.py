"""Forces in pairs: laws for every element and load, closed forms, and Lagrange's multipliers."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest
from zoo import ZOO, animal

import linkwright as lw
from linkwright import FindingError, Friction, InputError, MachineError, ShapeError, forces, mobility
from linkwright.cam import contacts, touch
from linkwright.kinetostatics.cam_contact import follower_at
from linkwright.kinetostatics.motion import motion_at
from linkwright.kinetostatics.places import Scene
from linkwright.kinetostatics.result import Forces
from linkwright.kinetostatics.wrench import masses
from linkwright.linkages.model.structure import FRAME, structure
from linkwright.machine import compile_machine

SPEED, ACCELERATION = 3.0, 1.5

# Slider-crank of which everything is known in closed form: mass in the slider alone.
SIMPLE = """
format = 1
name = "Slider-crank"
[mechanism.cranks.A]
radius = 0.1
[mechanism.sliders.S]
crank = "A"
rod = 0.25
[bodies]
S = { mass = 4 }
[loads]
work = { kind = "force", on = "S", force = -200 }
"""

LEVER = """
format = 1
name = "Lever at rest"
[mechanism.cranks.A]
radius = 0.5
[mechanism.rigid_points.K]
link = "A"
along = 0.3
[bodies]
A = { mass = 3, inertia = 0.1, along = 0.2 }
K = { mass = 2 }
[loads]
gravity = { kind = "gravity", acceleration = 10 }
pull = { kind = "force", on = "A", force = 7, direction = "90 deg" }
"""


@pytest.fixture(scope="module", params=ZOO)
def found(request: pytest.FixtureRequest) -> tuple[lw.Machine, Forces]:
    machine = animal(request.param)
    return machine, forces(machine, speed=SPEED, acceleration=ACCELERATION)


def size(values: np.ndarray) -> float:
    return float(np.abs(values).max())


# -- laws for all elements -----------------------------------------------------------------------------------


def test_powers_balance(found: tuple[lw.Machine, Forces]) -> None:
    _, result = found
    assert size(result.power_residual) <= 1e-10 * size(result.power_drive)


def test_driving_torque_is_that_of_the_reduction(found: tuple[lw.Machine, Forces]) -> None:
    """M_d = J ε + ½ J′ ω² + M_r, from the core, which knows nothing of reactions."""
    machine, result = found
    reduced, compiled = lw.reduction(machine), compile_machine(machine)
    needed = reduced.inertia_reduced * ACCELERATION + 0.5 * reduced.inertia_reduced_d1 * SPEED**2
    needed = needed + reduced.torque_load + reduced.viscous * SPEED + compiled.speed_load(SPEED)
    if compiled.has_laws:
        needed = needed + compiled.law_torques(reduced.crank_angle, SPEED)[0]
    np.testing.assert_allclose(result.torque_drive, needed, rtol=0, atol=1e-10 * size(needed))


def test_reduced_inertia_is_that_of_the_crankshaft(found: tuple[lw.Machine, Forces]) -> None:
    machine, result = found
    J = lw.reduction(machine).inertia_reduced
    at_rest = forces(machine, speed=SPEED, acceleration=0.0).torque_drive
    gained = (result.torque_drive - at_rest) / ACCELERATION
    np.testing.assert_allclose(gained, J, rtol=0, atol=1e-10 * size(result.torque_drive))


def test_every_member_is_in_equilibrium(found: tuple[lw.Machine, Forces]) -> None:
    """Σ F = m a of each member from the reported forces of its pairs, and the loads that are forces on it."""
    machine, result = found
    scene = Scene(machine, motion_at(machine, None, speed=SPEED, acceleration=ACCELERATION))
    total = {name: np.zeros((scene.n, 2)) for name in scene.structure.members}
    for pair in result.pairs.values():
        if pair.kind == "mesh" and not np.any(pair.force):
            continue
        for member, sign in ((pair.second, 1), (pair.first, -1)):
            if member != FRAME:
                total[member] += sign * pair.force
    for mass in masses(scene):
        total[mass.member] -= mass.mass * mass.acceleration(scene)
    external = _external(machine, scene)
    for name in total:
        np.testing.assert_allclose(
            total[name] + external[name],
            0,
            atol=1e-9 * max(map(size, [result.shaking_force, *_forces(result)])),
        )


def _forces(result: Forces) -> list[np.ndarray]:
    return [pair.force for pair in result.pairs.values()]


def _external(machine: lw.Machine, scene: Scene) -> dict[str, np.ndarray]:
    """Forces of loads and drivers on members, by the module that the loads are tested through elsewhere."""
    from linkwright.kinetostatics.applied import applied

    found = {name: np.zeros((scene.n, 2)) for name in scene.structure.members}
    for load in machine.all_loads.values():
        acts = applied(scene, load).wrenches
        for name in found:
            found[name] += acts.on_member(name)[:, :2]
    result = forces(machine, speed=SPEED, acceleration=ACCELERATION)
    for drive in scene.structure.drives:
        driver = scene.mechanism.linear_drivers.get(drive.name) or scene.mechanism.cranks.get(drive.name)
        if driver is not None and driver.follows() is not None:
            follower = follower_at(scene, drive.name)
            found[drive.member] += _pressed(scene, follower, drive.name, result.drives[drive.name])
        elif drive.guide is not None:
            push = result.drives[drive.name][:, None] * scene.direction(drive.guide)
            found[drive.member] += push
            if drive.guide.on is not None:
                found[drive.guide.on] -= push
    return found


def _pressed(scene: Scene, follower: Any, name: str, force: np.ndarray) -> np.ndarray:
    """Force of a cam on its follower, along the normal of the contact that carries."""
    points = scene.mechanism.fixed_points()
    at = [
        touch(follower.cam, contact, points, scene.motion.crank_angle).normal
        for contact in contacts(follower.cam, points, name)
    ]
    second = -at[1] if len(at) > 1 else at[0]
    return force[:, None] * np.where((force >= 0)[:, None], at[0], second)


def test_force_on_the_frame_is_the_change_of_momentum(found: tuple[lw.Machine, Forces]) -> None:
    """Σ m a = loads from outside − shaking force, without any reaction in it."""
    machine, result = found
    scene = Scene(machine, motion_at(machine, None, speed=SPEED, acceleration=ACCELERATION))
    from linkwright.kinetostatics.applied import applied

    outside, moment = np.zeros((scene.n, 2)), np.zeros(scene.n)
    for load in machine.all_loads.values():
        values = applied(scene, load).wrenches.values
        outside += values[:, :, :2].sum(axis=1)
        for name, i in scene.index.items():
            arm = scene.reference(name)
            moment += values[:, i, 2] + arm[:, 0] * values[:, i, 1] - arm[:, 1] * values[:, i, 0]
    for mass in masses(scene):
        a = mass.acceleration(scene)
        turning = scene.turning(mass.member, 2) * SPEED**2 + scene.turning(mass.member) * ACCELERATION
        outside -= mass.mass * a
        moment -= (
            mass.mass * (mass.centre[:, 0] * a[:, 1] - mass.centre[:, 1] * a[:, 0]) + mass.inertia * turning
        )
    np.testing.assert_allclose(result.shaking_force, outside, rtol=0, atol=1e-9 * size(outside))
    np.testing.assert_allclose(
        result.shaking_moment, moment, rtol=0, atol=1e-9 * max(size(moment), size(outside))
    )


def test_contributions_add_up(found: tuple[lw.Machine, Forces]) -> None:
    _, result = found
    shares = result.contributions.values()
    scale = max(size(each.reactions[name]) for each in shares for name in result.pairs)
    for name, pair in result.pairs.items():
        total = sum(each.reactions[name] for each in shares)
        np.testing.assert_allclose(total, pair.force, rtol=0, atol=1e-12 * scale)
    total = sum(each.torque_drive for each in shares)
    np.testing.assert_allclose(
        total, result.torque_drive, rtol=0, atol=1e-12 * size(result.torque_drive) + 1e-12
    )


def test_shares_of_loads_are_parts_of_the_result() -> None:
    machine = lw.read("press_with_flywheel")
    result = forces(machine, speed=5.0)
    assert list(result.contributions) == ["inertia", *(f"loads.{name}" for name in machine.all_loads)]
    copy = pickle.loads(pickle.dumps(result))
    assert copy == result
    with pytest.raises(ValueError, match="read-only"):
        result.contributions["inertia"].torque_drive[0] = 0.0


def test_mobility_is_one_less_one_for_each_redundant_bar(found: tuple[lw.Machine, Forces]) -> None:
    count = mobility(found[0].linkage)
    assert count.freedom == 1 - len(count.redundant)


def test_friction_takes_what_the_drive_gives_more(found: tuple[lw.Machine, Forces]) -> None:
    """With friction in every pin, guide and slot: powers balance, and friction never gives power."""
    machine, _ = found
    pairs = structure(machine.linkage).pairs
    friction = {
        name: Friction(0.05, radius=0.01 * (pair.kind == "pin"), viscous=0.1)
        for name, pair in pairs.items()
        if pair.kind in ("pin", "guide", "slot")
    }
    result = forces(machine, speed=SPEED, acceleration=ACCELERATION, friction=friction)
    known = np.isfinite(result.torque_drive)
    assert known.all() or result.findings
    assert size(result.power_residual[known]) <= 1e-10 * size(result.power_drive[known])
    assert result.power_friction[known].max() <= 1e-10 * size(result.power_drive[known])
    assert result.power_friction[known].min() < 0
    shares = result.contributions.values()
    for name, pair in result.pairs.items():
        total = sum(each.reactions[name] for each in shares)
        scale = size(pair.force[known]) + 1e-3
        np.testing.assert_allclose(total[known], pair.force[known], rtol=0, atol=1e-11 * scale)
        if pair.kind == "pin":
            # μ r R and c ω; no pin turns faster than 20 rad/s.
            assert (np.abs(pair.friction[known]) <= 0.05 * 0.01 * pair.size[known] + 0.1 * 20).all()


# -- closed forms --------------------------------------------------------------------------------------------


def rod_angle(phi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """β of the rod to the guide, and the slider's acceleration at ω = 20 rad/s."""
    r, rod = 0.1, 0.25
    beta = np.arcsin(r * np.sin(phi) / rod)
    root = np.sqrt(rod**2 - (r * np.sin(phi)) ** 2)
    s2 = -r * np.cos(phi) - (r**2 * np.cos(2 * phi)) / root - (r**2 * np.sin(2 * phi)) ** 2 / (4 * root**3)
    return beta, s2 * 400.0


def test_slider_crank_without_mass_in_the_rod() -> None:
    """Rod F/cos β, guide F tan β, torque F r sin(φ + β)/cos β (Norton, chapter 13, pin forces)."""
    result = forces(lw.loads(SIMPLE), speed=20.0)
    beta, a = rod_angle(result.crank_angle)
    F = 4 * a + 200
    np.testing.assert_allclose(result.pairs["A"].size, np.abs(F / np.cos(beta)), rtol=1e-11)
    np.testing.assert_allclose(result.pairs["S.guide"].normal, F * np.tan(beta), rtol=0, atol=1e-9)
    needed = -F * 0.1 * np.sin(result.crank_angle + beta) / np.cos(beta)
    np.testing.assert_allclose(result.torque_drive, needed, rtol=0, atol=1e-10)
    np.testing.assert_allclose(result.pairs["S.guide"].moment, 0, atol=1e-10)


def test_lever_at_rest() -> None:
    """Weights 30 and 20 N at 0.2 and 0.3 m, 7 N up at 0.5 m."""
    result = forces(lw.loads(LEVER), speed=0.0, angles=[0.0, np.pi / 3])
    np.testing.assert_allclose(
        result.torque_drive, np.array([1, 0.5]) * (30 * 0.2 + 20 * 0.3 - 7 * 0.5), rtol=1e-13
    )
    np.testing.assert_allclose(result.reactions["O"], [[0, 43], [0, 43]], atol=1e-12)


def test_journal_alone() -> None:
    """A disc of weight mg that turns in a journal: torque μ r m g, whatever the angle."""
    text = LEVER.replace("along = 0.2 }", "along = 0 }").replace("K = { mass = 2 }\n", "").split("pull")[0]
    friction = {"O": Friction(0.1, radius=0.03, viscous=0.2)}
    result = forces(lw.loads(text), speed=5.0, friction=friction)
    np.testing.assert_allclose(result.torque_drive, 0.1 * 0.03 * 30 + 0.2 * 5, rtol=1e-12)
    np.testing.assert_allclose(result.pairs["O"].friction, -0.1 * 0.03 * 30 - 0.2 * 5, rtol=1e-12)


def wedge(mu: float, speed: float = 1.0, load: float = -100.0, radius: float = 0.24) -> Forces:
    """The slider-crank, without mass, whose guide has friction and whose load resists on one way."""
    text = (
        SIMPLE.replace("radius = 0.1", f"radius = {radius}")
        .replace("mass = 4", "mass = 0")
        .replace("-200", f"{load}")
    )
    return forces(lw.loads(text), speed=speed, friction={"S.guide": Friction(mu)})


def test_guide_with_friction_is_a_wedge() -> None:
    """S cos β = F + μ S sin β while the rod pushes against F: S = F/(cos β − μ sin β)."""
    result = wedge(0.2)
    phi = result.crank_angle
    beta = np.abs(np.arcsin(0.24 * np.sin(phi) / 0.25))
    outward = (phi > np.pi + 0.01) & (phi < 2 * np.pi - 0.01)
    expected = 100 / (np.cos(beta) - 0.2 * np.sin(beta))
    np.testing.assert_allclose(result.pairs["A"].size[outward], expected[outward], rtol=1e-10)
    back = (phi > 0.01) & (phi < np.pi - 0.01)
    expected = 100 / (np.cos(beta) + 0.2 * np.sin(beta))
    np.testing.assert_allclose(result.pairs["A"].size[back], expected[back], rtol=1e-10)


def test_friction_that_locks_is_found() -> None:
    """Beyond tan β = 1/μ nothing moves the slider outward."""
    result = wedge(0.5)
    phi = result.crank_angle
    steep = np.tan(np.abs(np.arcsin(0.24 * np.sin(phi) / 0.25))) > 1 / 0.5
    outward = phi > np.pi
    assert (np.isnan(result.torque_drive) == (steep & outward)).all()
    assert steep.any()
    assert "locks" in result.findings[0]
    assert np.isfinite(result.torque_drive_max)


def test_long_guide_shares_the_moment() -> None:
    """A yoke driven off its guide: N₁,₂ = ±M/ℓ at its ends, friction μ (|N₁| + |N₂|)."""
    text = """
    format = 1
    name = "Scotch yoke"
    [mechanism.cranks.A]
    radius = 0.1
    [mechanism.yokes.Y]
    pin = "A"
    [loads]
    work = { kind = "dry", on = "Y", force = 50 }
    """
    mu, length = 0.15, 0.4
    result = forces(lw.loads(text), speed=1.0, friction={"Y.guide": Friction(mu, length=length)})
    phi = result.crank_angle
    # The pin's force P is along the guide at the height r sin φ: P = F + μ·2|P r sin φ|/ℓ.
    expected = 50 / (1 - 2 * mu * np.abs(0.1 * np.sin(phi)) / length)
    moving = np.abs(np.sin(phi)) > 1e-6
    np.testing.assert_allclose(np.abs(result.pairs["Y.slot"].normal[moving]), expected[moving], rtol=1e-10)


def test_teeth_press_along_the_line_of_action() -> None:
    """Tangential force M/r, radial force F tan α that parts the gears."""
    text = """
    format = 1
    name = "Two gears"
    [mechanism.points]
    P = { x = 0.3 }
    [mechanism.cranks.A]
    radius = 0.05
    [mechanism.gears]
    G = { pivot = "P", meshes = "A", size = 40, size_other = 20 }
    [loads]
    work = { kind = "torque", on = "G", torque = SIGN }
    """
    for sign in (8, -8):
        result = forces(lw.loads(text.replace("SIGN", str(sign))), speed=2.0, pressure_angle=np.radians(20))
        teeth = result.pairs["G.mesh"].force
        np.testing.assert_allclose(teeth[:, 1] * -0.2 + sign, 0, atol=1e-12)
        # On the gear to the right the teeth press to the right.
        np.testing.assert_allclose(teeth[:, 0], 40 * np.tan(np.radians(20)), rtol=1e-12)
        np.testing.assert_allclose(result.torque_drive, 0.5 * sign, rtol=1e-12)


def test_internal_teeth_push_the_pinion_inward() -> None:
    """A planet of 20 teeth in a ring of 60 at rest."""
    machine = animal("planetary train with a crank on the planet")
    result = forces(machine, speed=2.0)
    phi = result.crank_angle + 0.3
    outward = np.stack((np.cos(phi), np.sin(phi)), axis=-1)
    teeth = result.pairs["G.mesh"]
    radial = (teeth.force * outward).sum(axis=1)
    assert (radial < 0).all()
    np.testing.assert_allclose(radial, -np.abs(teeth.normal) * np.tan(np.radians(20)), rtol=1e-10)


def test_weight_on_a_cable_is_its_tension() -> None:
    machine = lw.replace(animal("cable on an arc"), {"loads.dry.force": 0.0})
    result = forces(machine, speed=1e-9)
    np.testing.assert_allclose(result.pairs["H.cable"].normal, 30 * 9.81, rtol=1e-9)
    fast = forces(machine, speed=20.0)
    assert "slack" in fast.findings[0]
    assert fast.pairs["H.cable"].normal.min() < 0


# -- an independent solution ---------------------------------------------------------------------------------


def test_four_bar_against_lagrange_multipliers() -> None:
    """Three free bodies in coordinates of their centres, eight constraints: multipliers are the reactions."""
    r, a, b, d = 0.1, 0.35, 0.25, np.array([0.4, 0.05])
    lengths, mass = (r, a, b), (2.0, 1.0, 1.5)
    text = f"""
    format = 1
    name = "four-bar"
    [mechanism.points]
    D = {{ x = {d[0]}, y = {d[1]} }}
    [mechanism.cranks.A]
    radius = {r}
    [mechanism.rockers.R]
    crank = "A"
    pivot = "D"
    coupler = {a}
    rocker = {b}
    [bodies]
    A = {{ mass = {mass[0]} }}
    "R.coupler" = {{ mass = {mass[1]} }}
    "R.rocker" = {{ mass = {mass[2]} }}
    [loads]
    gravity = {{ kind = "gravity" }}
    work = {{ kind = "torque", on = "R.rocker", torque = -5 }}
    """
    phi = np.array([0.4, 2.0, 4.5])
    omega, epsilon = 7.0, -2.0
    result = forces(lw.loads(text), speed=omega, acceleration=epsilon, angles=phi)
    for k, angle in enumerate(phi):
        q = _four_bar_position(angle, r, a, b, d)
        J, gamma_of = _four_bar_jacobian(q, lengths), _four_bar_gamma
        v = np.linalg.solve(J, np.array([0] * 8 + [omega]))
        acceleration = np.linalg.solve(J, gamma_of(q, v, lengths) + np.array([0] * 8 + [epsilon]))
        M = np.diag([x for m, rod in zip(mass, lengths, strict=True) for x in (m, m, m * rod**2 / 12)])
        Q = np.zeros(9)
        Q[[1, 4, 7]] = -9.81 * np.array(mass)
        Q[8] = -5
        multipliers = np.linalg.solve(J.T, M @ acceleration - Q)
        for row, name, sign in ((0, "O", 1), (2, "A", 1), (4, "R", 1), (6, "D", 1)):
            np.testing.assert_allclose(
                result.reactions[name][k], sign * multipliers[row : row + 2], rtol=1e-9
            )
        assert result.torque_drive[k] == pytest.approx(multipliers[8], rel=1e-9)


def _four_bar_position(phi: float, r: float, a: float, b: float, d: np.ndarray) -> np.ndarray:
    A = r * np.array([np.cos(phi), np.sin(phi)])
    u = d - A
    c = np.hypot(*u)
    alpha = np.arctan2(u[1], u[0]) + np.arccos((a * a + c * c - b * b) / (2 * a * c))
    joint = A + a * np.array([np.cos(alpha), np.sin(alpha)])
    beta = np.arctan2(*(joint - d)[::-1])
    return np.array([*(A / 2), phi, *((A + joint) / 2), alpha, *((d + joint) / 2), beta])


def _four_bar_jacobian(q: np.ndarray, lengths: tuple[float, ...]) -> np.ndarray:
    """Of: start of the crank, both joints, start of the rocker, angle of the crank."""

    def end(body: int, sign: int) -> np.ndarray:
        J = np.zeros((2, 9))
        half, angle = sign * lengths[body] / 2, q[3 * body + 2]
        J[:, 3 * body : 3 * body + 2] = np.eye(2)
        J[:, 3 * body + 2] = half * np.array([-np.sin(angle), np.cos(angle)])
        return J

    driver = np.zeros((1, 9))
    driver[0, 2] = 1
    return np.vstack([end(0, -1), end(1, -1) - end(0, 1), end(2, 1) - end(1, 1), end(2, -1), driver])


def _four_bar_gamma(q: np.ndarray, v: np.ndarray, lengths: tuple[float, ...]) -> np.ndarray:
    """−J̇ q̇ of the same."""

    def end(body: int, sign: int) -> np.ndarray:
        half, angle = sign * lengths[body] / 2, q[3 * body + 2]
        return half * v[3 * body + 2] ** 2 * np.array([np.cos(angle), np.sin(angle)])

    return np.concatenate([end(0, -1), end(1, -1) - end(0, 1), end(2, 1) - end(1, 1), end(2, -1), [0.0]])


# -- motions, findings, input --------------------------------------------------------------------------------


def test_along_steady_motion_the_motor_gives_the_torque() -> None:
    machine = lw.read("machines/roller_two_carts.toml")
    steady = lw.steady_state(machine)
    result = forces(machine, steady)
    np.testing.assert_allclose(
        result.torque_drive, steady.torque_drive, rtol=0, atol=1e-7 * size(steady.torque_drive)
    )
    assert forces(machine).torque_drive_max == pytest.approx(result.torque_drive_max, rel=1e-12)


def test_along_a_transient() -> None:
    machine = lw.read("machines/roller_two_carts.toml")
    path = lw.transient(machine, speed=5.0, duration=0.5)
    result = forces(machine, path)
    assert size(result.power_residual) <= 1e-10 * size(result.power_drive)


def test_change_point_is_a_finding() -> None:
    """A parallelogram in line: the rocker may turn either way, and no force decides."""
    text = """
    format = 1
    name = "parallelogram"
    [mechanism.points]
    D = { x = 0.4 }
    [mechanism.cranks.A]
    radius = 0.1
    [mechanism.rockers.R]
    crank = "A"
    pivot = "D"
    coupler = 0.4
    rocker = 0.1
    assembly = "ASSEMBLY"
    [bodies]
    "R.coupler" = { mass = 3 }
    [loads]
    work = { kind = "torque", on = "R.rocker", torque = -3 }
    """
    result = forces(lw.loads(text.replace("ASSEMBLY", "left")), speed=1.0, n=8)
    line = np.abs(np.sin(result.crank_angle)) < 1e-9
    assert (np.isnan(result.torque_drive) == line).all()
    assert "change point" in result.findings[0]
    with pytest.raises(FindingError, match="unbounded"):
        forces(lw.loads(text.replace("ASSEMBLY", "left")), speed=1.0, angles=[0.0])


def test_wrong_input_is_named() -> None:
    machine = lw.loads(SIMPLE)
    with pytest.raises(InputError, match="neither a motor"):
        forces(machine)
    with pytest.raises(MachineError, match=r"friction\.B(.|\n)*pin, guide or slot"):
        forces(machine, speed=1.0, friction={"B": Friction(0.1)})
    with pytest.raises(MachineError, match=r"friction\.A\.radius"):
        forces(machine, speed=1.0, friction={"A": Friction(0.1)})
    with pytest.raises(InputError, match=r"friction\.S\.guide\.coefficient"):
        forces(machine, speed=1.0, friction={"S.guide": Friction(-0.1)})
    with pytest.raises(ShapeError, match="one machine"):
        forces(lw.replace(machine, {"mechanism.cranks.A.radius": np.array([0.1, 0.2])}), speed=1.0)
    for angles in ("abc", [], [[0.0, 1.0]]):
        with pytest.raises(ShapeError, match="angles"):
            forces(machine, speed=1.0, angles=angles)
    with pytest.raises(InputError, match="nothing that moves"):
        forces(lw.loads('format = 1\nname = "x"\n[mechanism.points]\nD = { x = 1 }'), speed=1.0)
    with pytest.raises(InputError, match="both"):
        forces(machine, motion_at(machine, None, speed=1.0), speed=2.0)


def test_several_links_on_one_pin_are_named_by_link() -> None:
    pairs = structure(animal("two cranks, one pin with two rods").linkage).pairs
    assert {"A:S.rod", "A:T.rod", "B", "O", "P", "S", "T", "U"} <= set(pairs)
    assert pairs["A:T.rod"].first == "A"


def test_study_has_the_forces_along_its_steady_motion() -> None:
    found = lw.study(lw.read("machines/roller_two_carts.toml"))
    assert found.forces is not None
    alone = forces(found.machine, found.steady_state)
    # The study looks at every fourth angle.
    assert found.forces.torque_drive == pytest.approx(alone.torque_drive[::4], rel=1e-12)
    written = found.to_dict()["results"]["forces"]
    assert written["reaction_max"]["A1"] == pytest.approx(alone.reaction_max["A1"], rel=1e-4)
    assert {"torque_drive_max", "shaking_force_max"} <= written.keys()


def test_every_kind_of_load_and_element_is_among_the_machines() -> None:
    """A new kind of load or element must come here, where its laws are tested."""
    from linkwright.kinetostatics.model.loads import AnyLoad
    from linkwright.linkages.model.topology import KINDS

    kinds = {each.model_fields["kind"].annotation for each in AnyLoad.__args__[0].__args__}
    machines = [animal(name) for name in ZOO]
    there = {type(load).model_fields["kind"].annotation for m in machines for load in m.loads.values()}
    assert there == kinds
    # Cams have become drivers in the whole mechanism.
    tables = {kind.table for kind in KINDS}
    there = {
        table
        for m in machines
        for part in (m.mechanism, m.linkage)
        for table in tables
        if getattr(part, table)
    }
    assert there == tables
