"""Multipliers of motions that pass corners of the motor's curve; motions held by a jump of a load."""

from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import linkwright as lw
from linkwright import SteadyStateError
from linkwright.machine import Status

J = 2.0  # kg m²

# A crank of constant inertia; a motor of two straight lines.
FILE = """format = 1
name = "Crank"
mechanism.cranks.A.radius = "1 m"
bodies.A = {{ on = "A", inertia = {inertia} }}
[drive]
motor = {{ kind = "table", speed = {speeds}, torque = [100, 80, {last}], inertia = 0 }}
gearbox = {{ ratio = 1, efficiency = 1 }}
[loads.L]
kind = "formula"
on = "A"
torque = "-(60 + {amplitude}*cos(phi){more})"
"""


def corners(amplitude: float, corner: float) -> lw.Machine:
    text = FILE.format(inertia=J, speeds=[0, corner, 14], last=-20, amplitude=amplitude, more="")
    return lw.loads(text)


def growth(amplitude: float, corner: float, omega: float) -> float:
    """d u(2π)/d u(0) by SciPy's variational equation, stopped where the speed passes the corner."""
    is_above, phi, state = omega > corner, 0.0, np.array([0.5 * omega**2, 0.0])

    def slope(phi: float, state: np.ndarray) -> list[float]:
        omega = np.sqrt(2.0 * state[0])
        falls = 100.0 / (14.0 - corner) if is_above else 20.0 / corner
        motor = 80.0 - falls * (omega - corner)
        return [(motor - 60.0 - amplitude * np.cos(phi)) / J, -falls / (J * omega)]

    def passes(phi: float, state: np.ndarray) -> float:
        return float(state[0] - 0.5 * corner**2)

    passes.terminal = True  # type: ignore[attr-defined]
    while phi < 2 * np.pi:
        piece = solve_ivp(
            slope, (phi, 2 * np.pi), state, "DOP853", rtol=1e-12, atol=1e-12, events=passes, max_step=0.1
        )
        phi, state = float(piece.t[-1]), piece.y[:, -1]
        if piece.status == 1:
            # Off the corner, whose sides have the same torque: 1e-9 rad change what grows by as much.
            is_above = not is_above
            rate = slope(phi, state)
            phi, state = phi + 1e-9, state + 1e-9 * np.array(rate)
    return float(np.exp(state[1]))


@pytest.mark.parametrize(("amplitude", "corner"), [(80, 10.5), (60, 10), (40, 8), (60, 9.5)])
def test_multiplier_counts_each_side_of_a_corner(amplitude: float, corner: float) -> None:
    """On which side of the corner rounding puts the end of a step changes nothing; in batches neither."""
    machine = corners(amplitude, corner)
    motion = lw.steady_state(machine)
    expected = growth(amplitude, corner, float(motion.speed[0]))
    assert motion.multiplier == pytest.approx(expected, rel=1e-7)
    rows = lw.steady_states(machine, {"bodies.A.inertia": [J, 1.001 * J]})
    assert rows.multiplier[0] == pytest.approx(expected, rel=1e-6)


def jumps(amplitude: float, at: str = "12", by: float = 8.0, inertia: float = 5.0) -> lw.Machine:
    more = f" + where(omega > {at}, {by}, 0)"
    text = FILE.format(inertia=inertia, speeds=[0, 10, 20], last=0, amplitude=amplitude, more=more)
    return lw.loads(text)


# The motor's torque at 12 rad/s is 64 N m: above the load of 60 below the jump, below that of 68 above it.
@pytest.mark.parametrize("amplitude", [0.0, 2.0, 3.9])
def test_motion_on_a_jump_is_told(amplitude: float) -> None:
    with pytest.raises(SteadyStateError, match=r"slides along a jump: the formula of L.* jumps at 12 rad/s"):
        lw.steady_state(jumps(amplitude))


@pytest.mark.parametrize(("amplitude", "begins"), [(5.0, "72.9"), (7.0, "110.6")])
def test_part_of_a_revolution_on_a_jump_is_told(amplitude: float, begins: str) -> None:
    """The angle is that at which the same motion with a slope 1e-4 rad/s wide comes to the jump, by SciPy."""
    with pytest.raises(SteadyStateError, match=rf"slides along a jump.*φ = {begins}"):
        lw.steady_state(jumps(amplitude))


def test_a_study_tells_of_one_jump_once() -> None:
    """Steady motion and run-up come to it at different angles."""
    told = [text for text in lw.study(jumps(5.0)).findings if "slides along a jump" in text]
    assert len(told) == 1


def test_a_jump_that_is_passed_is_none_to_slide_on() -> None:
    assert lw.steady_state(jumps(40.0)).multiplier > 0.0
    # A load that falls with the speed drives the motion away from its jump.
    assert lw.steady_state(jumps(2.0, by=-8.0)).speed_min > 12.0


def gained(u: float, amplitude: float, by: float) -> float:
    """What u gains over a revolution by SciPy, stopped where the speed passes the jump."""
    is_above, phi, start = u > 72.0, 0.0, u

    def slope(phi: float, u: np.ndarray) -> list[float]:
        load = 60.0 + amplitude * np.cos(phi) + (by if is_above else 0.0)
        return [(160.0 - 8.0 * np.sqrt(2.0 * u[0]) - load) / 5.0]

    def passes(phi: float, u: np.ndarray) -> float:
        return float(u[0] - 72.0)

    passes.terminal = True  # type: ignore[attr-defined]
    while phi < 2 * np.pi:
        piece = solve_ivp(
            slope, (phi, 2 * np.pi), [u], "DOP853", rtol=1e-12, atol=1e-12, events=passes, max_step=0.1
        )
        phi, u = float(piece.t[-1]), float(piece.y[0, -1])
        if piece.status == 1:
            is_above = not is_above
            phi, u = phi + 1e-10, u + 1e-10 * slope(phi, np.array([u]))[0]
    return u - start


@pytest.mark.parametrize("by", [8.0, 4.0])
@pytest.mark.parametrize("amplitude", [20.0, 15.0, 10.0, 9.0, 8.5])
def test_a_jump_that_is_passed_at_a_flat_angle_is_passed(amplitude: float, by: float) -> None:
    """The motion repeats, and its multiplier is the slope of SciPy's map of revolutions."""
    motion = lw.steady_state(jumps(amplitude, by=by))
    u = 0.5 * float(motion.speed[0]) ** 2
    assert gained(u, amplitude, by) == pytest.approx(0.0, abs=1e-7 * u)
    apart = 1e-5 * u
    slope = 1.0 + (gained(u + apart, amplitude, by) - gained(u - apart, amplitude, by)) / (2.0 * apart)
    assert motion.multiplier == pytest.approx(slope, abs=1e-5)


def test_a_level_that_moves_with_the_angle_holds_too() -> None:
    with pytest.raises(SteadyStateError, match="slides along a jump"):
        lw.steady_state(jumps(0.0, at="12 + 0.01*sin(phi)"))


def test_a_row_on_a_jump_has_a_status() -> None:
    rows = lw.steady_states(jumps(2.0), {"bodies.A.inertia": [5.0, 6.0]})
    assert (rows.status == int(Status.SLIDES)).all()


@pytest.mark.parametrize("accuracy", [1e-5, 1e-8])
def test_motion_in_time_tells_what_holds_it(accuracy: float) -> None:
    """Not only where its steps across the jump become too many."""
    with pytest.raises(SteadyStateError, match="slides along a jump: the formula of L"):
        lw.transient(jumps(2.0), speed=11.9, turns=5.0, accuracy=accuracy)


@pytest.mark.parametrize("accuracy", [1e-5, 1e-8])
def test_motion_in_time_tells_what_holds_it_clockwise(accuracy: float) -> None:
    """The motor drives the crank clockwise up to the same speed, where the same load jumps."""
    text = FILE.format(inertia=5.0, speeds=[0, 10, 20], last=0, amplitude=2.0, more="")
    text = text.replace("-(60 + 2.0*cos(phi))", "60 + 2.0*cos(phi) + where(omega < -12, 8, 0)")
    with pytest.raises(SteadyStateError, match="slides along a jump: the formula of L"):
        lw.transient(lw.loads(text), speed=-11.9, turns=5.0, accuracy=accuracy, clockwise=True)


def test_a_jump_right_behind_the_start_of_an_implicit_step_counts() -> None:
    """Steps whose stages all lay behind a jump did not see it."""
    text = FILE.format(inertia=5.0, speeds=[0, 10, 20], last=0, amplitude=0, more="")
    for level in np.linspace(0.01, 2.0, 200).tolist():
        # A drag of 1e7 N m s/rad below 1e-6 rad/s makes the first steps implicit.
        load = f"-(10*min(1e6*omega, 1) + where(omega > {level!r}, -40, 0))"
        machine = lw.loads(text.replace("-(60 + 0*cos(phi))", load))
        motion = lw.transient(machine, duration=0.2, accuracy=1e-9)
        # Some dozens of steps, each good for 1e-9.
        assert motion.speed[-1] == pytest.approx(_behind(level, 0.2), rel=1e-7)


def _behind(level: float, duration: float) -> float:
    """Speed after a time by 5 dω/dt = 100 − 2ω − drag, 40 N m more above the level; the drag first grows."""
    slow = 1e-6
    grows = -np.log1p(-slow * 10000002.0 / 100.0) * 5.0 / 10000002.0
    below = 2.5 * np.log((45.0 - slow) / (45.0 - level))
    return float(65.0 - (65.0 - level) * np.exp(-(duration - grows - below) / 2.5))


def steep(amplitude: float, width: float) -> Callable[[float, np.ndarray], list[float]]:

    def slope(phi: float, u: np.ndarray) -> list[float]:
        omega = np.sqrt(2.0 * u[0])
        load = 60.0 + amplitude * np.cos(phi) + 8.0 * np.clip((omega - 12.0) / width + 0.5, 0.0, 1.0)
        return [(160.0 - 8.0 * omega - load) / 5.0]

    return slope


@pytest.mark.parametrize(("amplitude", "begins"), [(5.0, 73.0), (7.0, 110.6)])
def test_a_slope_in_place_of_the_jump_keeps_its_speed(amplitude: float, begins: float) -> None:
    """The motion comes to the jump at the angle that is reported, and stays on the slope for some time."""
    width = 1e-3
    u = np.array([72.0])
    for _ in range(4):
        last = solve_ivp(
            steep(amplitude, width), (0, 2 * np.pi), u, "LSODA", rtol=1e-8, atol=1e-8, max_step=0.02
        )
        u = last.y[:, -1]
    speed, at = np.sqrt(2 * last.y[0]), np.degrees(last.t)
    on = np.abs(speed - 12.0) < width
    assert on[(at > begins + 1) & (at < 113)].all()
    assert not on[(at > begins - 30) & (at < begins - 2)].any()


def test_motions_between_two_corners_of_a_table_are_told() -> None:
    """A motor whose curve steps down twice holds a load on either step, and between them unstably."""
    file = """format = 1
name = "Two steps"
mechanism.cranks.A.radius = "1 m"
bodies.A = { on = "A", inertia = 2 }
loads.L = { kind = "dry", on = "A", torque = "10 N m" }
[drive]
motor.kind = "table"
motor.inertia = 0
motor.speed = [0, 15.2, 15.3, 15.5, 15.9, 25]
motor.torque = [20, 20, 9, 9, 14, 0]
gearbox = { ratio = 1, efficiency = 1 }
"""
    motion = lw.steady_state(lw.loads(file))
    # Straight lines through the load of 10 N m: the last piece, and the two pieces around the lower step.
    top, middle, low = 15.9 + 9.1 * 4 / 14, 15.5 + 0.4 / 5, 15.2 + 0.1 * 10 / 11
    assert motion.speed_max == pytest.approx(top, rel=1e-9)
    assert [other.speed_max for other in motion.others] == pytest.approx([middle, low], rel=1e-6)
    assert [other.multiplier < 1 for other in motion.others] == [False, True]


def beside_a_jump(window: float, amplitude: float, *, is_steep: bool) -> lw.Machine:
    """A load that falls by 40 N m at 12 rad/s and holds the motor a little below 12 and below 17 rad/s."""
    base = 160.0 - 8.0 * (12.0 - window)
    ripple = f"{amplitude}*cos(phi)"
    more, tables = f"{ripple} + {base} - where(omega > 12, 40, 0)", ""
    if is_steep:
        more, torques = ripple, [base, base, base - 40.0, base - 40.0]
        tables = f'\n[loads.T]\nkind = "torque_speed"\nspeed = [0, 12, 12.001, 20]\ntorque = {torques}\n'
    text = FILE.format(inertia=5.0, speeds=[0, 10, 20], last=0, amplitude=0, more="")
    return lw.loads(text.replace("60 + 0*cos(phi)", more) + tables)


@pytest.mark.parametrize("is_steep", [False, True])
@pytest.mark.parametrize("window", [0.3, 0.02, 0.0003])
@pytest.mark.parametrize("share", [0.0, 1.2])
def test_a_motion_right_below_a_jump_is_told(is_steep: bool, window: float, share: float) -> None:
    """Both motions have the mean speed at which motor and mean load balance, to the square of the ripple."""
    motion = lw.steady_state(beside_a_jump(window, share * window, is_steep=is_steep))
    assert motion.speed_mean_time == pytest.approx(17.0 - window, rel=1e-4 * share * window + 1e-9)
    assert [other.is_stable for other in motion.others] == [True]
    assert motion.others[0].speed_mean_time == pytest.approx(12.0 - window, rel=1e-4 * share * window + 1e-7)
