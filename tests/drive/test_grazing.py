"""Motions that graze a jump of a load over speed: below it, held by it, or carried on by it."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import linkwright as lw
from linkwright import SteadyStateError

J = 0.3  # kg m²

# A crank of constant inertia; a motor of one straight line.
FILE = """format = 1
name = "Crank"
mechanism.cranks.A.radius = "1 m"
bodies.A = {{ on = "A", inertia = 0.3 }}
[drive]
motor = {{ kind = "table", speed = [0, 36], torque = [30, 0], inertia = 0 }}
gearbox = {{ ratio = 1, efficiency = 1 }}
[loads.L]
kind = "formula"
on = "A"
torque = "-(15 + 7*cos(phi) + {second}*sin(2*phi) + {jump}*where(omega > {level!r}, 1, 0))"
"""

# Shares of the speed by which the motion without a jump goes beyond its level, or stays below it.
BY = [1e-3, 1e-4, 1e-5, 3e-6, 1e-6, 1e-7]


def grazing(by: float, jump: float, second: float) -> lw.Machine:
    """The level lies below the maximum speed of the motion without the jump by a share of it."""
    without = lw.steady_state(lw.loads(FILE.format(second=second, jump=0, level=18.0)), accuracy=1e-12)
    return lw.loads(FILE.format(second=second, jump=jump, level=without.speed_max * (1 - by)))


@pytest.mark.parametrize("second", [0, 4])
@pytest.mark.parametrize("jump", [20.0, 0.2, -0.2])
@pytest.mark.parametrize("by", BY)
def test_a_motion_below_a_jump_does_not_know_of_it(by: float, jump: float, second: int) -> None:
    without = lw.steady_state(grazing(0.0, 0.0, second))
    motion = lw.steady_state(grazing(-by, jump, second))
    # A load that falls may carry a faster motion as well.
    motions = [motion.speed_max, *(other.speed_max for other in motion.others)]
    assert min(abs(speed / without.speed_max - 1) for speed in motions) < 1e-6
    if jump > 0:
        assert motion.speed == pytest.approx(without.speed, rel=1e-8)


@pytest.mark.parametrize("by", [1e-4, 1e-5])
def test_the_faster_of_two_motions_beside_each_other_is_the_answer(by: float) -> None:
    """Just above the motion that does not reach the level is one that is carried on."""
    motion = lw.steady_state(grazing(-by, -2.0, 0))
    assert motion.speed_max == pytest.approx(20.317, abs=1e-2)
    (slow,) = motion.others
    assert slow.speed_max == pytest.approx(19.26, abs=1e-3)


@pytest.mark.parametrize("second", [0, 4])
@pytest.mark.parametrize("jump", [20.0, 0.2])
@pytest.mark.parametrize("by", BY[2:])
def test_a_jump_that_holds_the_top_of_a_motion_is_told(by: float, jump: float, second: int) -> None:
    with pytest.raises(SteadyStateError, match="slides along a jump: the formula of L"):
        lw.steady_state(grazing(by, jump, second))


def gained(u: float, level: float, jump: float, second: int, longest: float = 0.02) -> float:
    """What u = ½ω² gains over a revolution by SciPy, stopped where the speed passes the level.

    Between the ends of steps of at most `longest` it looks for no passage.
    """
    is_above, phi, start = bool(2 * u > level**2), 0.0, u

    def slope(phi: float, u: np.ndarray) -> list[float]:
        load = 15.0 + 7.0 * np.cos(phi) + second * np.sin(2 * phi) + (jump if is_above else 0.0)
        return [(30.0 * (1.0 - np.sqrt(2.0 * u[0]) / 36.0) - load) / J]

    def passes(phi: float, u: np.ndarray) -> float:
        return float(u[0] - 0.5 * level**2)

    passes.terminal = True  # type: ignore[attr-defined]
    while phi < 2 * np.pi:
        passes.direction = -1.0 if is_above else 1.0  # type: ignore[attr-defined]
        piece = solve_ivp(
            slope, (phi, 2 * np.pi), [u], "DOP853", rtol=1e-12, atol=1e-12, events=passes, max_step=longest
        )
        phi, u = float(piece.t[-1]), float(piece.y[0, -1])
        is_above ^= piece.status == 1
    return u - start


@pytest.mark.parametrize("second", [0, 4])
@pytest.mark.parametrize("jump", [-0.05, -0.1, -2.0])
@pytest.mark.parametrize("by", BY)
def test_a_load_that_falls_carries_a_motion_on(by: float, jump: float, second: int) -> None:
    """What is answered repeats by SciPy too, however near the level the motion without the jump is."""
    machine = grazing(by, jump, second)
    level = float(machine.loads["L"].text.split("omega > ")[1].split(",")[0])
    motion = lw.steady_state(machine)
    u = 0.5 * float(motion.speed[0]) ** 2
    assert motion.speed_max > level * (1 + by)
    assert gained(u, level, jump, second) == pytest.approx(0.0, abs=1e-7 * u)


@pytest.mark.parametrize("second", [0, 4])
@pytest.mark.parametrize("jump", [-16.0, -18.0, -25.0])
@pytest.mark.parametrize("by", [-0.3, -0.1, -1e-2, -1e-4])
def test_starts_that_run_away_are_told(by: float, jump: float, second: int) -> None:
    """Beyond the level the load drives more than the motor brakes: by SciPy it gains speed from above."""
    machine = grazing(by, jump, second)
    level = float(machine.loads["L"].text.split("omega > ")[1].split(",")[0])
    motion = lw.steady_state(machine)
    (limit,) = motion.start_limits
    assert (limit.outcome, limit.side) == ("runs away", "above")
    for share, sign in ((1e-4, 1), (-1e-5, -1)):
        u = 0.5 * (limit.speed * (1 + share)) ** 2
        assert limit.speed * (1 + share) > motion.speed[0]
        assert np.sign(gained(u, level, jump, second)) == sign
    assert motion.to_dict()["start_limits"] == [limit._asdict()]
    (warning,) = [text for text in lw.study(machine).warnings if "runs away" in text]
    assert f"above {limit.speed:.4g} rad/s at φ = 0°" in warning
    rows = lw.steady_states(machine, {"bodies.A.inertia": np.array([J, 1.01 * J])})
    assert rows.fast_starts.tolist() == [1, 1]
    assert rows.speed_max[0] == pytest.approx(motion.speed_max, rel=1e-8)


@pytest.mark.parametrize("jump", [-10.0, -2.0, 20.0])
def test_starts_that_settle_need_no_word(jump: float) -> None:
    assert lw.steady_state(grazing(-0.1, jump, 0)).start_limits == ()
    rows = lw.steady_states(grazing(-0.1, jump, 0), {"bodies.A.inertia": np.array([J, 1.01 * J])})
    assert rows.fast_starts.tolist() == [0, 0]


@pytest.mark.parametrize("second", [0, 4])
@pytest.mark.parametrize("jump", [-0.1, -2.0])
@pytest.mark.parametrize("by", [1e-4, 1e-6, 3e-7])
def test_a_motion_in_time_meets_a_jump_that_it_touches(by: float, jump: float, second: int) -> None:
    """The motion without the jump goes beyond its level inside a step, and would come back."""
    machine, without = grazing(by, jump, second), lw.steady_state(grazing(0.0, 0.0, second))
    level = float(machine.loads["L"].text.split("omega > ")[1].split(",")[0])
    motion = lw.transient(machine, speed=without.speed[0], duration=10.0, turns=1.0, accuracy=1e-10)
    u = 0.5 * float(without.speed[0]) ** 2
    expected = u + gained(u, level, jump, second, 1e-3)
    # By how much the motion goes beyond the level tells when it passes it: 1e-11 of 3e-7.
    assert 0.5 * motion.speed[-1] ** 2 == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("second", [0, 4])
@pytest.mark.parametrize("jump", [20.0, 0.2])
@pytest.mark.parametrize("by", [1e-4, 1e-6, 1e-7, 3e-8])
def test_a_motion_in_time_does_not_pass_a_jump_that_holds_it(by: float, jump: float, second: int) -> None:
    """It is refused, or stays on the jump to the accuracy asked for, however little it would go beyond."""
    machine, without = grazing(by, jump, second), lw.steady_state(grazing(0.0, 0.0, second))
    level = float(machine.loads["L"].text.split("omega > ")[1].split(",")[0])
    try:
        motion = lw.transient(machine, speed=without.speed[0], duration=10.0, turns=1.0, accuracy=1e-9)
    except SteadyStateError as error:
        if "slides along a jump: the formula of L" not in str(error):
            raise
        return
    # Only the smaller jump may be followed, in steps that are as short as the accuracy asks.
    assert jump < 1
    between = (motion.time[:-1, None] + np.diff(motion.time)[:, None] * np.linspace(0.0, 1.0, 32)).ravel()
    assert motion.at(between)[1].max() < level * (1 + 2e-9)


# What the acceleration of a steep drive behind a jump is made of: a motor of one straight line.
STALL, TOP, JUMP = 3e7, 36.0, -5e2


@pytest.mark.parametrize("accuracy", [1e-6, 1e-8, 1e-10, 1e-12])
def test_the_peak_behind_a_jump_of_a_steep_drive_is_that_of_its_level(accuracy: float) -> None:
    """Right behind the jump the drive has its torque at the level, and the load its new one at that angle."""
    level = TOP * (1.0 - 4.5e3 / STALL)
    motion = lw.steady_state(steep(level), accuracy=accuracy)
    load = 5e3 + 1e3 * np.cos(motion.acceleration_max_angle)
    expected = (STALL * (1.0 - level / TOP) - load - JUMP) / J
    # Rounding of u = 648, 1e-16 of it, makes 5e-9 of an acceleration of 1667 under a drive of 8e4 per radian.
    assert motion.acceleration_max == pytest.approx(expected, rel=1e-9)


def steep(level: float) -> lw.Machine:
    """The crank under a steep motor and a load that falls where the speed passes the level upward."""
    text = FILE.replace("torque = [30, 0]", f"torque = [{STALL}, 0]")
    text = text.replace("15 + 7*cos(phi) + {second}*sin(2*phi) + {jump}", "5e3 + 1e3*cos(phi) + {jump}")
    return lw.loads(text.format(jump=JUMP, level=level))
