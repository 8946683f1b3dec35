"""Kinks and jumps of torques at some speed: motion, curves, Floquet multiplier, derivatives."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from found_machines import found_machine
from scipy.integrate import solve_ivp

import linkwright as lw

J = 5.0  # kg m²

# A motor of two straight lines with a corner at 10 rad/s, on a crank of constant inertia.
FILE = """format = 1
name = "Crank with a motor of two lines"
[mechanism.cranks.A]
radius = "1 m"
[bodies.A]
on = "A"
inertia = {inertia}
[drive.motor]
kind = "table"
speed = [0, 10, 20]
torque = [100, 80, 0]
inertia = 0
[drive.gearbox]
ratio = 1
efficiency = 1
[loads.L]
kind = "formula"
on = "A"
torque = "-({base} + 40*cos(phi) + where({switch} > {level}, {jump}, 0))"
"""

# Mean load [N m], what is compared with what, the jump [N m].
CASES = {
    "corner of the motor": (80, "phi", "10", 0),
    "less load above 11.5 rad/s": (60, "omega", "11.5", -4),
    "more load above 11.7 rad/s": (60, "omega", "11.7", 2),
    "much more load above 11.5 rad/s": (60, "omega", "11.5", 8),
    "found by marching": (60, "omega", "12", 8),
    "a level that moves with the angle": (60, "omega", "11.7 + sin(2*phi)", 8),
}


def text(case: str, inertia: float = J) -> str:
    base, switch, level, jump = CASES[case]
    return FILE.format(inertia=inertia, base=base, switch=switch, level=level, jump=jump)


@pytest.fixture(params=CASES)
def case(request: pytest.FixtureRequest) -> str:
    return str(request.param)


def solved(case: str, folder: Path, inertia: float = J) -> tuple:
    file = folder / "machine.toml"
    file.write_text(text(case, inertia), encoding="utf-8")
    machine = lw.read(file)
    return machine, lw.steady_state(machine, n=721)


def events_of(case: str) -> list[Callable[[float, float], float]]:
    """What is zero where the motion passes the motor's corner and the load's switch, of angle and speed."""
    _, switch, level, _ = CASES[case]
    corner = [lambda phi, omega: omega - 10.0]
    if switch == "phi":
        return corner
    moves = 1.0 if "sin" in level else 0.0
    at = float(level.split()[0])
    return [*corner, lambda phi, omega: omega - at - moves * np.sin(2.0 * phi)]


def revolution(case: str, u: float) -> tuple[float, list[np.ndarray]]:
    """u at the end of the revolution by SciPy, stopped at every zero, and samples of (φ, u)."""
    base, _, _, jump = CASES[case]
    events = events_of(case)
    above = [event(0.0, np.sqrt(2.0 * u)) > 0.0 for event in events]
    phi, samples = 0.0, []

    def slope(phi: float, u: np.ndarray) -> np.ndarray:
        omega = np.sqrt(2.0 * u)
        motor = 160.0 - 8.0 * omega if above[0] else 100.0 - 2.0 * omega
        load = base + 40.0 * np.cos(phi) + (jump if len(above) > 1 and above[1] else 0.0)
        return (motor - load) / J

    stops = []
    for event in events:

        def stop(phi: float, u: np.ndarray, event: Callable[[float, float], float] = event) -> float:
            return event(phi, float(np.sqrt(2.0 * u[0])))

        stop.terminal = True  # type: ignore[attr-defined]
        stops.append(stop)
    while phi < 2.0 * np.pi - 1e-12:
        piece = solve_ivp(
            slope,
            (phi, 2.0 * np.pi),
            [u],
            method="DOP853",
            rtol=1e-12,
            atol=1e-12,
            events=stops,
            max_step=0.1,
        )
        samples.append(np.array([piece.t, piece.y[0]]))
        phi, u = float(piece.t[-1]), float(piece.y[0, -1])
        for number, found in enumerate(piece.t_events or []):
            if piece.status == 1 and len(found):
                above[number] = not above[number]
                # Off the zero by 1e-10 rad: the slope there errs by as much.
                u += 1e-10 * float(slope(phi, np.array([u]))[0])
                phi += 1e-10
    return u, samples


def test_motion_repeats_and_its_curve_is_that_of_scipy(case: str, tmp_path: Path) -> None:
    """1e-9 is promised; SciPy steps off each jump by 1e-10 rad."""
    _, motion = solved(case, tmp_path)
    u = 0.5 * float(motion.speed[0]) ** 2
    end, samples = revolution(case, u)
    assert end == pytest.approx(u, rel=3e-9)
    speed = np.sqrt(
        2.0 * np.interp(np.concatenate([s[0] for s in samples]), motion.crank_angle, 0.5 * motion.speed**2)
    )
    assert np.isfinite(motion.acceleration).all()
    # Straight lines over half degrees: ½ ε′ (π/720)².
    assert np.max(np.abs(speed / np.sqrt(2.0 * np.concatenate([s[1] for s in samples])) - 1.0)) < 3e-5
    assert motion.acceleration_max >= motion.acceleration.max() - 1e-9
    assert motion.acceleration_min <= motion.acceleration.min() + 1e-9


def test_multiplier_is_the_slope_of_the_map_of_revolutions(case: str, tmp_path: Path) -> None:
    """Central differences of SciPy's map: 1e-5 of u apart their own error is about 1e-8."""
    _, motion = solved(case, tmp_path)
    u = 0.5 * float(motion.speed[0]) ** 2
    apart = 1e-5 * u
    slope = (revolution(case, u + apart)[0] - revolution(case, u - apart)[0]) / (2.0 * apart)
    assert motion.multiplier == pytest.approx(slope, rel=3e-7)


def test_derivatives_agree_with_differences(case: str, tmp_path: Path) -> None:
    """Along the inertia, by differences of the same analysis a thousandth of it apart, extrapolated."""
    machine, _ = solved(case, tmp_path)
    names = [
        "steady_state.multiplier",
        "steady_state.speed_max",
        "steady_state.speed_min",
        "steady_state.period",
    ]
    gradient = lw.gradient(machine, names, ["bodies.A.inertia"])

    def difference(name: str, apart: float) -> float:
        ends = [getattr(solved(case, tmp_path, J + sign * apart)[1], name) for sign in (1.0, -1.0)]
        return float(ends[0] - ends[1]) / (2.0 * apart)

    for row, full in enumerate(names):
        name = full.split(".")[1]
        coarse, fine = difference(name, 4e-3), difference(name, 2e-3)
        value = float(gradient.derivatives[row, 0])
        assert value == pytest.approx((4.0 * fine - coarse) / 3.0, rel=1e-5, abs=1e-9), name


@pytest.mark.parametrize("inertia", [4.998, 5.0, 5.003])
@pytest.mark.parametrize("accuracy", [1e-9, 1e-11])
def test_two_jumps_at_one_speed_are_one(inertia: float, accuracy: float) -> None:
    """Written as two jumps of 3 N m that rounding alone keeps apart, a jump of 6 N m has the same motion,
    Floquet multiplier and derivatives; the motor has its corner there too.
    """
    text = FILE.replace("where({switch} > {level}, {jump}, 0)", "{more}")

    def motion(more: str) -> tuple:
        machine = lw.loads(text.format(inertia=inertia, base=72, more=more))
        names = ["steady_state.multiplier", "steady_state.period"]
        found = lw.gradient(machine, names, ["bodies.A.inertia"])
        return lw.steady_state(machine, accuracy=accuracy), found.derivatives[:, 0]

    two, derivatives = motion("where(omega > 10, 3, 0) + where(omega*omega > 100, 3, 0)")
    one, expected = motion("where(omega > 10, 6, 0)")
    assert two.multiplier == pytest.approx(one.multiplier, rel=1e-8)
    assert two.speed_min == pytest.approx(one.speed_min, rel=1e-9)
    assert derivatives == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("accuracy", [1e-9, 1e-11])
def test_speed_does_not_leap_at_a_jump(accuracy: float) -> None:
    """Between two angles u changes by no more than the largest acceleration makes of it.

    SciPy's LSODA, stopped at the jumps, follows the same curve with this period.
    """
    motion = lw.steady_state(found_machine("load_that_falls_at_a_flat_angle"), accuracy=accuracy, n=3600)
    most = max(motion.acceleration_max, -motion.acceleration_min) * 2 * np.pi / 3600
    assert np.abs(np.diff(0.5 * motion.speed**2)).max() <= most * (1 + 1e-9)
    assert motion.period == pytest.approx(0.566666719083, rel=1e-8)


# The motor drives faster around one speed alone, by a formula.
HUMP = """format = 1
name = "Crank"
mechanism.cranks.A.radius = "0.2 m"
mechanism.sliders.S = {{ crank = "A", rod = 0.6 }}
bodies.A = {{ inertia = 2, mass = 3 }}
bodies.S = {{ mass = 0.05 }}
drive.motor = {{ kind = "table", speed = [0, 5, 9, 40], torque = [50, 20, 0, -20] }}
[loads.f]
kind = "formula"
on = "A"
torque = "-(10 - 60*max(0, 1 - abs(omega - {speed})/{width}))"
"""


@pytest.mark.parametrize(
    ("speed", "width"), [(12.0, 0.01), (15.0, 0.1), (20.0, 1.0), (20.0, 0.01), (23.0, 0.03)]
)
def test_a_motion_far_above_the_working_speed_is_found(speed: float, width: float) -> None:
    """Some three to five times the speed from which motions are looked for. Motor and load balance on either
    side of the hump; the inertia is all but constant, so starts part at the lower one and meet at the upper.
    """
    machine = lw.loads(HUMP.format(speed=speed, width=width))
    motion = lw.steady_state(machine)
    assert speed < motion.speed_min
    assert motion.speed_max < speed + width
    # The unstable motion between is found where starts part slowly enough to close in on it.
    away = [other for other in motion.others if not other.is_stable]
    assert len(away) == (width == 1.0)
    assert all(speed - width < other.speed_min and other.speed_max < speed for other in away)
    (slow,) = [other for other in motion.others if other.is_stable]
    assert slow.speed_max == pytest.approx(7.0, rel=1e-3)
    rows = lw.steady_states(machine, {"bodies.A.inertia": [2.0, 2.1]})
    assert rows.speed_mean_time[0] == pytest.approx(motion.speed_mean_time, rel=1e-9)
    assert rows.speed_min[1] > speed
