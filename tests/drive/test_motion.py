"""Run-up, run-down, motion in time, the step method and batches, from Python."""

from __future__ import annotations

from math import cos, sin, sqrt
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import linkwright as lw
from linkwright import AssemblyError, InputError, MachineError, ShapeError, StartError, SteadyStateError
from linkwright.kernel.arrays import Floats
from linkwright.machine import CompiledMachine, NoSteadyMotion, SteadyMotion, compile_machine

MACHINES = Path(__file__).parents[2] / "machines"


@pytest.fixture(scope="module")
def two_carts() -> lw.Machine:
    return lw.read(MACHINES / "roller_two_carts.toml")


def test_transient_against_scipy() -> None:
    """Slider-crank under constant torque and dry resistance, two seconds, against DOP853 of SciPy."""
    r, rod, m, q, J0, M, F = 0.2, 0.8, 1000.0, 64.0, 48.4, 500.0, 3562.0
    text = f"""
    format = 1
    name = "slider-crank"
    [drive.motor]
    kind = "constant_torque"
    torque = {M}
    [drive.flywheel]
    inertia = {J0}
    [mechanism.cranks.A]
    radius = {r}
    [mechanism.sliders.S]
    crank = "A"
    rod = {rod}
    [bodies]
    S = {{ mass = {m} }}
    "S.rod" = {{ mass = {q} }}
    [loads]
    dry = {{ kind = "dry", on = "S", force = {F} }}
    """

    def J_and_slope(phi: float) -> tuple[float, float, float]:
        lam = r / rod
        s, c = sin(phi), cos(phi)
        D = sqrt(1 - lam**2 * s**2)
        x1 = -r * s * (1 + lam * c / D)
        x2 = -r * c - r * lam * ((c * c - s * s) / D + lam**2 * s * s * c * c / D**3)
        y1, y2 = 0.5 * r * c, -0.5 * r * s
        g1, g2 = 0.5 * (x1 - r * s), 0.5 * (x2 - r * c)
        b1 = -lam * c / D
        b2 = lam * s / D - lam**3 * s * c * c / D**3
        J = J0 + m * x1**2 + q * (g1**2 + y1**2) + q * rod**2 / 12 * b1**2
        J1 = 2 * (m * x1 * x2 + q * (g1 * g2 + y1 * y2) + q * rod**2 / 12 * b1 * b2)
        return J, J1, x1

    def rhs(t: float, y: np.ndarray) -> list[float]:
        J, J1, x1 = J_and_slope(y[0])
        return [y[1], (M - F * abs(x1) - 0.5 * J1 * y[1] ** 2) / J]

    # The last is the end; between the ends of the steps the motion is as at them.
    at = np.append(np.linspace(0.1, 1.9, 50), 2.0)
    reference = solve_ivp(
        rhs, (0, 2), [0.0, 8.0], method="DOP853", rtol=1e-12, atol=1e-12, t_eval=at, max_step=1e-3
    )
    path = lw.transient(lw.loads(text), speed=8.0, duration=2.0, accuracy=1e-10)
    # SciPy steps over the kinks of |x′| with steps of 1 ms: an error of order h² times the kink.
    assert path.speed[-1] == pytest.approx(reference.y[1, -1], rel=1e-8)
    assert path.crank_angle[-1] == pytest.approx(reference.y[0, -1], rel=1e-8)
    np.testing.assert_allclose(path.at(at[:-1])[1], reference.y[1, :-1], rtol=1e-8)
    np.testing.assert_allclose(path.at(at[:-1])[0], reference.y[0, :-1], rtol=1e-8)


def test_run_up_settles_into_steady_motion(two_carts: lw.Machine) -> None:
    result = lw.run_up(two_carts)
    # When it settles does not depend on the angles at which its steady motion is known.
    for known in ({"n": 8}, {"n": 360}, {"n": 5760}, {"angles": np.array([3.0, 1.0])}):
        again = lw.run_up(two_carts, steady=lw.steady_state(two_carts, **known))
        assert (again.turns, again.time) == pytest.approx((result.turns, result.time), rel=1e-12)
    steady = lw.steady_state(two_carts)
    angle, speed = result.motion.at(np.array([result.time]))
    there = np.interp(angle % (2 * np.pi), steady.crank_angle, steady.speed)
    # At that time the speed is just on the edge of the band; the curves are good to 1e-4.
    assert abs(speed[0] - there[0]) / steady.speed_mean_time == pytest.approx(0.01, abs=2e-4)
    assert result.turns == pytest.approx(angle[0] / (2 * np.pi))


@pytest.mark.parametrize("name", ["roller_one_cart", "roller_two_carts"])
def test_a_run_up_does_not_depend_on_what_was_computed_before(name: str) -> None:
    known = lw.steady_state(lw.read(MACHINES / f"{name}.toml"))
    found = []
    for accuracy in (None, 1e-2, 1e-9, 1e-12):
        machine = lw.read(MACHINES / f"{name}.toml")
        if accuracy is not None:
            lw.steady_state(machine, accuracy=accuracy)
        run_up = lw.run_up(machine, steady=known)
        found.append((run_up.time, run_up.turns, run_up.speed_peak))
    assert found == [found[0]] * 4


def test_a_study_solves_its_steady_motion_once(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[float] = []

    def solve(self: CompiledMachine, phi: Floats, accuracy: float) -> SteadyMotion | NoSteadyMotion:
        asked.append(accuracy)
        return steady(self, phi, accuracy)

    steady = CompiledMachine.steady
    monkeypatch.setattr(CompiledMachine, "steady", solve)
    assert lw.study(lw.read(MACHINES / "roller_two_carts.toml")).run_up is not None
    assert len(asked) == 1


def test_too_weak_a_start_names_angle_and_torques(two_carts: lw.Machine) -> None:
    weak = lw.replace(two_carts, {"drive.motor.torque_start": 39.8})
    with pytest.raises(
        StartError, match=r"does not start: at 0\.0° the motor gives 351 N m .* needs 775 N m"
    ):
        lw.run_up(weak)


def test_stall_on_the_way_is_told(two_carts: lw.Machine) -> None:
    heavy = lw.replace(two_carts, {"loads.rolling1.force": 12000.0})
    with pytest.raises(StartError, match="stalls after"):
        lw.run_up(heavy)


def test_a_rod_too_short_is_told_with_angles(two_carts: lw.Machine) -> None:
    """sin φ = l/r bounds the ranges in which a rod shorter than the crank closes."""
    short = lw.replace(two_carts, {"mechanism.sliders.cart1.rod": 0.15})
    edge = np.degrees(np.arcsin(0.15 / 0.2))
    found = lw.closure(short)
    assert not found.turns_fully
    np.testing.assert_allclose(np.degrees(found.ranges[0]), [180 - edge, 180 + edge], atol=1e-6)
    np.testing.assert_allclose(np.degrees(found.ranges[1]), [360 - edge, 360 + edge], atol=1e-6)
    for analysis in (lw.reduction, lw.steady_state, lw.run_up, lw.constant_energy, lw.kinematics):
        with pytest.raises(AssemblyError, match="cart1"):
            analysis(short)


def test_run_down_against_its_energy(two_carts: lw.Machine) -> None:
    """Without a brake the kinetic energy is used up by the loads."""
    steady = lw.steady_state(two_carts)
    result = lw.run_down(two_carts)
    reduced = lw.reduction(two_carts, n=7200)
    phi = reduced.crank_angle
    upto = phi <= result.angle_end
    whole, rest = int(result.turns), phi[upto]
    work = whole * 2 * np.pi * reduced.torque_load_mean + np.trapezoid(reduced.torque_load[upto], rest)
    energy = 0.5 * reduced.inertia_reduced[0] * steady.speed[0] ** 2
    # The last part of a trapezium of 0.05° is left out: a torque of 1000 N m over 1e-3 rad.
    assert work == pytest.approx(energy, abs=1.5)


def test_step_method_approaches_the_solution(two_carts: lw.Machine) -> None:
    """It is of order 1: a third of the step leaves about a third of the error."""
    exact = lw.steady_state(two_carts).unevenness
    errors = [lw.step_method(two_carts, step=np.radians(d)).unevenness - exact for d in (3, 1)]
    assert errors[0] / errors[1] == pytest.approx(3, rel=0.2)


def test_step_must_divide_the_turn(two_carts: lw.Machine) -> None:
    with pytest.raises(InputError, match="does not divide the revolution"):
        lw.step_method(two_carts, step=np.radians(7))


def test_constant_speed_needs_the_inertia_torque() -> None:
    machine = lw.read(MACHINES / "roller_two_carts.toml")
    text = {"kind": "constant_speed", "speed": 100.0, "inertia": 0.138}
    data = machine.model_dump(by_alias=True, exclude_unset=True)
    data["drive"]["motor"] = text
    fixed = lw.Machine.model_validate(data)
    motion = lw.steady_state(fixed)
    omega = 100.0 / 9.8
    reduced = lw.reduction(fixed)
    need = reduced.torque_load + 0.5 * reduced.inertia_reduced_d1 * omega**2
    np.testing.assert_allclose(motion.torque_drive, need, rtol=1e-12)
    assert motion.unevenness == 0.0
    with pytest.raises(InputError, match="constant-speed motor"):
        lw.transient(fixed, duration=1.0)


def test_no_load_no_limit_is_told() -> None:
    """A constant torque without a load that grows with speed has no steady motion."""
    text = """
    format = 1
    name = "runs away"
    [drive.motor]
    kind = "constant_torque"
    torque = 10
    [drive.flywheel]
    inertia = 1
    [mechanism.cranks.A]
    radius = 0.1
    [loads]
    drag = { kind = "dry", on = "A", torque = 4 }
    """
    with pytest.raises(SteadyStateError, match="accelerates without limit"):
        lw.steady_state(lw.loads(text))
    with pytest.raises(SteadyStateError, match="needs"):
        lw.steady_state(lw.replace(lw.loads(text), {"loads.drag.torque": 40.0}))


def test_batch_is_the_single_machine(two_carts: lw.Machine) -> None:
    phases = np.radians(np.linspace(40, 140, 57))
    masses = np.linspace(700, 1300, 57)
    entries = {"mechanism.cranks.A2.phase": phases, "bodies.cart1.mass": masses}
    many = lw.steady_states(two_carts, entries)
    assert (many.status == 0).all()
    for row in range(0, 57, 8):
        one = lw.steady_state(lw.replace(two_carts, {k: float(v[row]) for k, v in entries.items()}))
        # Lanes work on a fixed mesh: speeds to 1e-7, accelerations to 1e-6.
        assert many.unevenness[row] == pytest.approx(one.unevenness, rel=1e-6)
        assert many.dynamism[row] == pytest.approx(one.dynamism, rel=3e-6)
        assert many.torque_motor_rms[row] == pytest.approx(one.torque_motor_rms, rel=1e-6)
    assert list(many.to_frame()["bodies.cart1.mass"]) == list(masses)


def test_a_bad_row_stays_alone(two_carts: lw.Machine) -> None:
    rods = np.array([0.8, 0.15, 0.7])
    many = lw.steady_states(two_carts, {"mechanism.sliders.cart1.rod": rods})
    assert list(many.status) == [0, 1, 0]
    assert np.isnan(many.unevenness[1])
    assert np.isfinite(many.unevenness[[0, 2]]).all()


@pytest.mark.parametrize(
    ("entries", "error"),
    [
        ({"bodies.cart1.mass": [1.0, -1.0]}, MachineError),
        ({"bodies.cart1.mass": [1.0, np.nan]}, MachineError),
        ({"bodies.cart9.mass": [1.0, 2.0]}, MachineError),
        ({"bodies.cart1.mass": [1.0, 2.0], "bodies.cart2.mass": [1.0, 2.0, 3.0]}, ShapeError),
        ({"bodies.cart1.mass": [[1.0, 2.0]]}, ShapeError),
        ({}, ShapeError),
    ],
)
def test_impossible_batches_are_refused(two_carts: lw.Machine, entries: dict, error: type) -> None:
    with pytest.raises(error):
        lw.steady_states(two_carts, entries)


def test_out_is_checked(two_carts: lw.Machine) -> None:
    angles = np.linspace(0, 1, 10)
    out = np.empty((1, 6, 10))
    assert lw.motions(two_carts, angles, points=["cart1"], out=out) is out
    for bad in (np.empty((1, 6, 9)), np.empty((1, 6, 20))[..., ::2], np.empty((1, 6, 10), dtype=np.float32)):
        with pytest.raises(ShapeError):
            lw.motions(two_carts, angles, points=["cart1"], out=bad)
    with pytest.raises(MachineError, match="cart1"):
        lw.motions(two_carts, angles, points=["cart7"])


def test_a_batch_is_translated_once(two_carts: lw.Machine) -> None:
    """A batch is translated anew if another came between, or if its entries were changed in place."""
    batch = lw.replace(two_carts, {"mechanism.sliders.cart1.rod": np.array([0.81, 0.82])})
    before = compile_machine(batch)
    assert compile_machine(batch) is before
    lengths = batch.linkage.sliders["cart1"].rod
    assert isinstance(lengths, np.ndarray)
    lengths.flags.writeable = True
    lengths[1] = 0.83
    after = compile_machine(batch)
    assert after is not before
    assert 0.83 in after.values
    assert 0.83 not in before.values
    compile_machine(lw.replace(two_carts, {"mechanism.sliders.cart1.rod": np.array([0.81, 0.84])}))
    assert compile_machine(batch) is not after


def test_a_change_point_is_passed(two_carts: lw.Machine) -> None:
    """A rod as long as the crank stands across the guide at 90°: the slider goes on through the pivot.

    Its law is 2 r cos φ; in the series near the change points and outside them all three orders are exact to
    the rounding that the direct root leaves 0.03 rad away, 1e-16/0.03³ and less.
    """
    folds = lw.replace(two_carts, {"mechanism.sliders.cart1.rod": 0.2})
    near = np.pi / 2 + np.array([-0.031, -0.029, -1e-4, -1e-9, 0.0, 1e-12, 1e-6, 0.0299, 0.0301])
    for angles in (near, np.linspace(0, 4 * np.pi, 500)):
        slide = lw.kinematics(folds, angles).slides["cart1"]
        np.testing.assert_allclose(slide.position, 0.4 * np.cos(angles), atol=1e-14)
        np.testing.assert_allclose(slide.d1, -0.4 * np.sin(angles), atol=1e-12)
        np.testing.assert_allclose(slide.d2, -0.4 * np.cos(angles), atol=1e-11)
    assert np.isfinite(lw.reduction(folds).inertia_reduced).all()
    assert lw.steady_state(folds).speed_min > 0


def test_arrays_ask_for_a_batch(two_carts: lw.Machine) -> None:
    many = lw.replace(two_carts, {"bodies.cart1.mass": np.array([500.0, 1000.0])})
    for analysis in (lw.reduction, lw.steady_state, lw.run_up):
        with pytest.raises(ShapeError, match="one machine"):
            analysis(many)
    assert lw.kinematics(many, [0.0, 1.0]).points["cart1"].position.shape == (2, 2, 2)


def test_arrays_changed_afterwards_do_not_count(two_carts: lw.Machine) -> None:
    radii = np.array([0.1, 0.2])
    many = lw.replace(two_carts, {"mechanism.cranks.A1.radius": radii})
    before = lw.motions(many, [0.0], points=["A1"])[:, 0, 0]
    radii *= 0.5
    after = lw.motions(many, [0.0], points=["A1"])[:, 0, 0]
    np.testing.assert_array_equal(after, before)
    with pytest.raises(ValueError, match="read-only"):
        lw.get(many, "mechanism.cranks.A1.radius")[0] = 1.0


def test_masses_of_links_vary_in_a_batch() -> None:
    text = (MACHINES / "roller_one_cart.toml").read_text(encoding="utf-8")
    machine = lw.loads(text.replace('mass_per_length = "80 kg/m"', "mass = 64"))
    masses = np.array([32.0, 64.0, 96.0])
    many = lw.steady_states(machine, {"bodies.cart1.rod.mass": masses})
    one = lw.steady_state(lw.replace(machine, {"bodies.cart1.rod.mass": 96.0}))
    assert many.speed_max[2] == pytest.approx(one.speed_max, rel=1e-7)


def test_entries_that_belong_together_vary_together(two_carts: lw.Machine) -> None:
    """Breakdown and starting torque raised together are possible; a start above breakdown is not."""
    both = {"drive.motor.torque_breakdown": [215.4, 500.0], "drive.motor.torque_start": [129.0, 300.0]}
    assert (lw.steady_states(two_carts, both).status == 0).all()
    with pytest.raises(MachineError, match="torque_start"):
        lw.steady_states(
            two_carts,
            {"drive.motor.torque_breakdown": [215.4, 140.0], "drive.motor.torque_start": [129.0, 200.0]},
        )


def test_extremes_do_not_depend_on_the_curves(two_carts: lw.Machine) -> None:
    coarse, fine = lw.steady_state(two_carts, n=7), lw.steady_state(two_carts, n=3600)
    for name in ("speed_max", "torque_motor_max", "torque_motor_min", "power_motor_max", "acceleration_min"):
        assert getattr(coarse, name) == pytest.approx(getattr(fine, name), rel=1e-12), name
    assert lw.reduction(two_carts, n=7).torque_load_max == pytest.approx(
        lw.reduction(two_carts, n=7200).torque_load.max(), rel=1e-6
    )


def test_no_inertia_is_told() -> None:
    text = """
    format = 1
    name = "weightless"
    [drive.motor]
    kind = "dc"
    speed_no_load = 10
    torque_stall = 1
    [mechanism.cranks.A]
    radius = 0.1
    """
    machine = lw.loads(text)
    for analysis in (lw.steady_state, lw.constant_energy, lambda m: lw.transient(m, speed=1.0, duration=1.0)):
        with pytest.raises(SteadyStateError, match=r"inertia (is|falls to) zero"):
            analysis(machine)


@pytest.mark.parametrize("n", [0, -1])
def test_a_turn_needs_an_interval(two_carts: lw.Machine, n: int) -> None:
    for analysis in (lw.steady_state, lw.reduction):
        with pytest.raises(InputError, match="at least 1"):
            analysis(two_carts, n=n)


@pytest.mark.parametrize("share", [1e-5, 3e-5, 1e-4, 3e-4])
@pytest.mark.parametrize("start", range(0, 360, 45))
def test_a_kink_over_speed_that_is_passed_and_passed_back(share: float, start: int) -> None:
    """A flywheel swings by a torque −B cos φ; a brake bites from just below its largest speed on."""
    J, B, speed = 1.0, 20.0, 10.0
    phi = np.radians(start)
    energy = 0.5 * J * speed**2 + B * np.sin(phi)
    bites = np.sqrt(2 * (energy + B) / J) * (1 - share)
    text = f"""
    format = 1
    name = "flywheel with a brake"
    [drive]
    motor = {{ kind = "constant_torque", torque = 1e-9 }}
    flywheel = {{ inertia = {J} }}
    [mechanism.cranks.A]
    radius = 0.1
    [loads.swing]
    kind = "formula"
    on = "A"
    torque = "-{B}*cos(phi)"
    [loads.brake]
    kind = "torque_speed"
    speed = [0.0, {bites}, {bites + 1.0}]
    torque = [0.0, 0.0, 1000.0]
    """

    def rhs(_: float, y: np.ndarray, brake: float) -> list[float]:
        return [y[1], (1e-9 - B * cos(y[0]) - brake * (y[1] - bites)) / J]

    def kink(_: float, y: np.ndarray, brake: float) -> float:
        return float(y[1] - bites)

    # SciPy goes from kink to kink, where the brake begins or ends. It sees them since its steps are short
    # against the time above the kink.
    kink.terminal = True  # type: ignore[attr-defined]
    time, y, brake, kinks = 0.0, [phi, speed], 1000.0 * (speed > bites), 0
    while time < 1.4:
        kink.direction = -1.0 if brake else 1.0  # type: ignore[attr-defined]
        part = solve_ivp(
            rhs, (time, 1.4), y, "DOP853", rtol=1e-13, atol=1e-13, max_step=1e-3, events=kink, args=(brake,)
        )
        time, y, brake = float(part.t[-1]), part.y[:, -1], 1000.0 - brake
        kinks += part.status
    path = lw.transient(lw.loads(text), angle=phi, speed=speed, duration=1.4, accuracy=1e-10)
    assert kinks >= 2
    assert path.speed[-1] == pytest.approx(y[1], rel=1e-8)
    assert path.crank_angle[-1] == pytest.approx(y[0], rel=1e-8)
