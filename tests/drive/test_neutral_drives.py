"""Drives that do not tell speeds apart: the machine keeps any speed of a range, which is said."""

import re

import numpy as np
import pytest

import linkwright as lw
from linkwright import SteadyStateError
from linkwright.machine import Status

FILE = """format = 1
name = "Crank and slider"
mechanism.cranks.A.radius = "0.2 m"
mechanism.sliders.S = {{ crank = "A", rod = 0.6 }}
bodies.A = {{ inertia = 2, mass = 3 }}
bodies.S = {{ mass = 5 }}
[drive]
motor = {motor}
gearbox = {{ ratio = 1, efficiency = {efficiency} }}
[loads]
{loads}
"""

# Torque over speed: none between two speeds, 10 N m between two, none from a speed on.
BAND = '{ kind = "table", speed = [0, 5, 20, 30], torque = [50, 0, 0, -50] }'
LEVEL = '{ kind = "table", speed = [0, 5, 20, 30], torque = [50, 10, 10, -50] }'
END = '{ kind = "table", speed = [0, 20], torque = [50, 0] }'
NONE = '{ kind = "constant_torque", torque = 0 }'
TEN = '{ kind = "constant_torque", torque = 10 }'
DRY = 'd = { kind = "dry", on = "A", torque = "10 N m" }'
GRAVITY = 'g = { kind = "gravity" }'


def machine(motor: str, loads: str = "", efficiency: float = 1.0) -> lw.Machine:
    return lw.loads(FILE.format(motor=motor, loads=loads, efficiency=efficiency))


def told(of: lw.Machine) -> tuple[float, float]:
    with pytest.raises(SteadyStateError, match="no unique steady motion") as error:
        lw.steady_state(of)
    text = str(error.value)
    if "at any speed" in text:
        return 0.0, np.inf
    if found := re.search(r"from ([\d.]+) rad/s up", text):
        return float(found[1]), np.inf
    found = re.search(r"from ([\d.]+) to ([\d.]+) rad/s at φ = 0", text)
    assert found, text
    return float(found[1]), float(found[2])


def at_start(of: lw.Machine, speed: float, *, fastest: bool) -> float:
    """Speed at φ = 0 of the motion of constant energy whose fastest, or slowest, speed is given."""
    J = lw.reduction(of, n=7200).inertia_reduced
    return float(speed * np.sqrt((J.min() if fastest else J.max()) / J[0]))


@pytest.mark.parametrize(
    ("motor", "loads", "efficiency"),
    [(BAND, "", 1.0), (LEVEL, DRY, 1.0), (LEVEL, DRY.replace("10 N", "8 N"), 0.8)],
)
def test_range_is_that_of_constant_energy(motor: str, loads: str, efficiency: float) -> None:
    """Motions between 5 and 20 rad/s all round have the energy that they start with: J ω² is constant.

    The message gives five digits; stages of steps may lie a little beside the extremes.
    """
    of = machine(motor, loads, efficiency)
    expected = at_start(of, 5.0, fastest=False), at_start(of, 20.0, fastest=True)
    assert told(of) == pytest.approx(expected, rel=1e-4)


def test_range_that_ends_at_the_drive_only_below() -> None:
    of = machine(END)
    assert told(of) == pytest.approx((at_start(of, 20.0, fastest=False), np.inf), rel=1e-4)


def test_machine_without_torques_keeps_any_speed() -> None:
    assert told(machine(NONE)) == (0.0, np.inf)
    assert told(machine(TEN, DRY)) == (0.0, np.inf)


@pytest.mark.parametrize(("motor", "loads"), [(NONE, GRAVITY), (TEN, f"{GRAVITY}\n{DRY}")])
def test_slowest_speed_lifts_the_weights(motor: str, loads: str) -> None:
    """What is slower at φ = 0 comes to rest on the way up, by the balance of energy; a dry load of the
    motor's torque takes nothing away. The message gives five digits.
    """
    of = machine(motor, loads)
    J, phi = lw.reduction(of, n=7200).inertia_reduced, np.linspace(0.0, 2 * np.pi, 7201)
    # The centre of mass is that of a straight crank.
    height = 3 * 0.1 * np.sin(phi)
    needed = 9.81 * (height - height[0]).max()
    slowest, fastest = told(of)
    assert slowest == pytest.approx(np.sqrt(2 * needed / J[0]), rel=3e-5)
    assert fastest == np.inf


def test_rows_have_a_status() -> None:
    for of in (machine(BAND, GRAVITY), machine(NONE), machine(LEVEL, DRY), machine(END)):
        rows = lw.steady_states(of, {"bodies.A.inertia": [2.0, 2.5]})
        assert (rows.status == int(Status.NEUTRAL)).all()


def test_range_below_a_faster_motion_is_told() -> None:
    """Between 5 and 8 rad/s the motor gives just what the dry load takes; its curve rises and falls again."""
    motor = '{ kind = "table", speed = [0, 5, 8, 12, 20], torque = [50, 10, 10, 40, 0] }'
    of = machine(motor, DRY)
    motion = lw.steady_state(of)
    assert motion.speed_mean_time == pytest.approx(18.0, rel=0.02)
    ends = [other for other in motion.others if other.multiplier == 1.0]
    assert ends[0].speed_max == pytest.approx(8.0, rel=1e-4)
    assert ends[1].speed_min == pytest.approx(5.0, rel=1e-4)
    assert any("bounds a range of periodic motions" in text for text in lw.study(of).warnings)


def test_range_above_a_steady_motion_is_told() -> None:
    """From 36 rad/s up nothing drives and nothing loads; above 25 rad/s the load falls to nothing."""
    motor = '{ kind = "table", speed = [0, 36], torque = [30, 0] }'
    load = (
        'L = {{ kind = "formula", on = "A", torque = "-(15 + 7*cos(phi) - where(omega > {level}, 15, 0))" }}'
    )
    of = machine(motor, load.format(level=25))
    motion = lw.steady_state(of)
    # The motion does not reach the level, so it is that without the jump.
    assert motion.speed == pytest.approx(
        lw.steady_state(machine(motor, load.format(level=1e6))).speed, rel=1e-9
    )
    (end,) = [other for other in motion.others if other.multiplier == 1.0]
    assert end.speed_min == pytest.approx(36.0, rel=1e-4)
    (limit,) = motion.start_limits
    assert (limit.outcome, limit.side) == ("runs away", "above")
    assert motion.speed_max < limit.speed < end.speed_max
    assert any("accelerates into the range of periodic motions" in text for text in lw.study(of).warnings)


def test_a_slight_slope_is_none_of_these() -> None:
    """A damping of the path of the pin that takes a millionth of the torque decides the speed."""
    of = machine(TEN, f'{DRY}\nv = {{ kind = "viscous", on = "A", damping = 1e-6 }}')
    with pytest.raises(SteadyStateError, match="comes to rest"):
        lw.steady_state(of)
    more = TEN.replace("10", "10.00001")
    motion = lw.steady_state(machine(more, f'{DRY}\nv = {{ kind = "viscous", on = "A", damping = 1e-6 }}'))
    assert motion.speed_mean_time == pytest.approx(1e-5 / (1e-6 * 0.2**2), rel=1e-3)
