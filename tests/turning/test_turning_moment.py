"""Turning-moment diagrams: closed forms, laws of energy, an independent integration, what is refused."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from sizes import cases

import linkwright as lw
from linkwright import FindingError, InputError, MachineError
from linkwright.kernel.numerics.turn_curve import TurnCurve
from linkwright.kernel.numerics.turn_fit import turn_curve
from linkwright.kernel.page.table import curves_csv
from linkwright.turning import diagram


def machine(**diagram: Any) -> lw.Machine:
    return lw.Machine.model_validate({"format": 1, "name": "shaft", "turning_moment": diagram})


def formula(text: str) -> dict[str, Any]:
    return {"kind": "formula", "torque": text}


def test_two_harmonics_have_their_closed_form() -> None:
    """T − M = a sin 2φ + b cos 2φ: E changes by √(a² + b²), crossing where tan 2φ = −b/a."""
    a, b, mean = 9500.0, -5700.0, 20000.0
    found = lw.turning_moment(
        machine(speed="180 rpm", driver=formula(f"{mean} + {a}*sin(2*phi) + {b}*cos(2*phi)"), unevenness=0.01)
    )
    omega = 6 * math.pi
    size = math.hypot(a, b)
    assert found.energy_fluctuation == pytest.approx(size, rel=1e-13)
    assert found.torque_mean == pytest.approx(mean, rel=1e-13)
    assert found.power_mean == pytest.approx(mean * omega, rel=1e-13)
    assert found.energy_coefficient == pytest.approx(size / (2 * math.pi * mean), rel=1e-13)
    assert found.inertia == pytest.approx(size / (0.01 * omega**2), rel=1e-13)
    assert found.acceleration_max == pytest.approx(size / found.inertia, rel=1e-13)
    starts = sorted(math.remainder(area["start"], math.pi / 2) for area in found.areas)
    assert starts == pytest.approx([0.5 * math.atan2(-b, a)] * 4, abs=1e-12)
    assert found.accuracy < 1e-12


def test_the_load_of_a_punch_leaves_the_motor_its_mean() -> None:
    """A punch takes its torque over 60° only; a motor of constant torque gives all of it evenly."""
    load = {"kind": "table", "between": "steps", "angle": "0, 60 deg", "torque": [6000.0, 0.0]}
    found = lw.turning_moment(machine(speed="30 rad/s", load=load, inertia=100.0))
    assert found.torque_mean == pytest.approx(1000.0, rel=1e-13)
    assert found.energy_fluctuation == pytest.approx(5000 * math.pi / 3, rel=1e-12)
    assert found.speed_min_angle == pytest.approx(math.pi / 3, abs=1e-12)
    assert found.unevenness == pytest.approx(5000 * math.pi / 3 / (100 * 900), rel=1e-12)


def test_one_step_a_quarter_has_areas_of_its_own() -> None:
    steps = {
        "kind": "table",
        "between": "steps",
        "angle": "0, 90, 180, 270 deg",
        "torque": [10, -10, 20, -20],
    }
    found = lw.turning_moment(machine(speed=10, driver=steps))
    quarter = math.pi / 2
    assert [area["energy"] for area in found.areas] == pytest.approx(
        [10 * quarter, -10 * quarter, 20 * quarter, -20 * quarter], rel=1e-12
    )
    assert found.energy_fluctuation == pytest.approx(20 * quarter, rel=1e-12)
    assert found.inertia is None
    assert found.unevenness is None


_TORQUES = st.lists(st.floats(-100, 200), min_size=3, max_size=9)


@settings(max_examples=cases(40, 1000))
@given(_TORQUES, st.floats(0.01, 0.3), st.sampled_from([1, 2]))
def test_speed_and_energy_agree_with_an_integration(torques: list[float], delta: float, turns: int) -> None:
    """½ J ω² by the curves of the result, against the equation of motion by DOP853 from corner to corner."""
    cycle = 2 * math.pi * turns
    angle = np.linspace(0, cycle, len(torques), endpoint=False)
    torque = np.asarray(torques)
    if np.ptp(torque) < 1.0:
        return
    driver = {"kind": "table", "angle": angle.tolist(), "torque": torques}
    found = lw.turning_moment(machine(speed=20.0, cycle=cycle, driver=driver, unevenness=delta), n=720)
    J = found.inertia
    assert J is not None
    assert found.speed_max is not None
    assert found.speed_min is not None
    mean = found.torque_mean
    # Kinetic energy is conserved: what the torques do is what the shaft gains.
    gained = 0.5 * J * (found.speed**2 - found.speed[0] ** 2)
    assert gained == pytest.approx(found.energy, abs=1e-10 * found.energy_fluctuation)
    assert found.speed.max() <= found.speed_max * (1 + 1e-12)
    assert found.speed.min() >= found.speed_min * (1 - 1e-12)
    assert (found.speed_max - found.speed_min) / found.speed_mean == pytest.approx(delta, rel=1e-12)
    assert sum(area["energy"] or 0.0 for area in found.areas) == pytest.approx(
        0, abs=1e-9 * found.energy_fluctuation
    )

    omega = float(found.speed[0])
    corners = zip(angle, np.append(angle[1:], cycle), torque, np.roll(torque, -1), strict=True)
    for low, high, first, last in corners:
        inside = found.crank_angle[(found.crank_angle > low) & (found.crank_angle < high)]
        steep = float((last - first) / (high - low))
        start = float(first) - mean - float(low) * steep

        def slope(phi: float, omega: np.ndarray, start: float = start, steep: float = steep) -> list[float]:
            return [(start + steep * phi) / (J * float(omega[0]))]

        at = np.append(inside, high)
        run = solve_ivp(slope, (low, high), [omega], method="DOP853", rtol=1e-11, atol=1e-12, t_eval=at)
        ours = found.speed[np.isin(found.crank_angle, at)]
        # Ten times the tolerance of the integration, summed over a few hundred steps.
        assert run.y[0, np.isin(at, found.crank_angle)] == pytest.approx(ours, rel=1e-8)
        omega = float(run.y[0, -1])


def test_inertia_that_is_there_spares_flywheel() -> None:
    drive = formula("100 + 50*sin(phi)")
    alone = lw.turning_moment(machine(speed=10, driver=drive, unevenness=0.05, radius_of_gyration=0.5))
    beside = lw.turning_moment(machine(speed=10, driver=drive, unevenness=0.05, inertia=5.0))
    heavy = lw.turning_moment(machine(speed=10, driver=drive, unevenness=0.05, inertia=500.0))
    assert alone.flywheel_inertia == pytest.approx(100 / (0.05 * 100), rel=1e-12)
    assert alone.flywheel_mass == pytest.approx(alone.flywheel_inertia / 0.25, rel=1e-13)
    assert beside.flywheel_inertia == pytest.approx(alone.flywheel_inertia - 5.0, rel=1e-12)
    assert heavy.flywheel_inertia == 0.0
    assert heavy.unevenness == pytest.approx(100 / (500 * 100), rel=1e-12)


@pytest.mark.parametrize(
    ("diagram", "word"),
    [
        ({"driver": formula("100 + sin(phi)"), "load": formula("101 + sin(phi)")}, "does not repeat"),
        ({"driver": formula("100 + 50*sin(phi)"), "inertia": 0.1}, "cannot keep the shaft turning"),
        ({"driver": formula("1/sin(phi)")}, "integral"),
        ({"areas": [10, -20, 5]}, "-5 J"),
    ],
)
def test_what_a_shaft_cannot_do_is_a_finding(diagram: dict[str, Any], word: str) -> None:
    with pytest.raises(FindingError, match=word):
        lw.turning_moment(machine(speed=10, **diagram))
    found = lw.study(machine(speed=10, **diagram))
    assert word in found.findings[0]


@pytest.mark.parametrize(
    ("diagram", "key"),
    [
        ({}, "turning_moment.driver"),
        ({"driver": formula("omega")}, "turning_moment.driver.torque"),
        ({"driver": {"kind": "table", "angle": [0, 7], "torque": [1, 2]}}, "turning_moment.driver.angle"),
        ({"driver": {"kind": "table", "angle": [0, 1], "torque": [1]}}, "turning_moment.driver.torque"),
        ({"driver": {"kind": "table", "angle": "0, 90, 360 deg", "torque": [1, 2, 3]}}, "driver.torque"),
        ({"areas": [1, -1], "driver": formula("1")}, "turning_moment.driver"),
        ({"areas": [1]}, "turning_moment.areas"),
        ({"areas": [1, 0, -1]}, "turning_moment.areas.1"),
        ({"areas": [1, -1], "cycle": "0 deg"}, "turning_moment.cycle"),
        ({"areas": [1, -1], "radius_of_gyration": 1.0}, "turning_moment.radius_of_gyration"),
    ],
)
def test_what_contradicts_itself_is_told_with_its_key(diagram: dict[str, Any], key: str) -> None:
    with pytest.raises(MachineError) as caught:
        machine(speed=10, **diagram)
    assert any(key in problem.key for problem in caught.value.problems), caught.value


def test_a_machine_without_the_table_is_refused() -> None:
    with pytest.raises(InputError, match="turning_moment"):
        lw.turning_moment(lw.read("machines/roller_one_cart.toml"))


def test_a_shaft_without_inertia_has_no_curve_of_speed() -> None:
    found = lw.turning_moment(machine(speed=10, driver=formula("100 + 50*sin(2*phi)")))
    assert found.inertia is None
    assert not len(found.speed)
    assert list(found.curves()) == ["crank_angle", "torque_driver", "torque_load", "energy"]
    assert "nan" not in curves_csv(found).lower()
    assert ",," not in curves_csv(found)


def test_one_torque_is_fitted_once(monkeypatch: pytest.MonkeyPatch) -> None:
    calls = []

    def counted(*given: Any) -> TurnCurve:
        calls.append(given)
        return turn_curve(*given)

    monkeypatch.setattr(diagram, "turn_curve", counted)
    wave = "100 + 50*sin(2*phi)"
    alone = lw.turning_moment(machine(speed=10, load=formula(wave), inertia=20.0))
    assert len(calls) == 1
    # Against a driver of the same mean, given as such, fitted beside it.
    both = lw.turning_moment(machine(speed=10, load=formula(wave), driver=formula("100"), inertia=20.0))
    assert alone.energy_fluctuation == pytest.approx(both.energy_fluctuation, rel=1e-13)
    assert alone.speed == pytest.approx(both.speed, rel=1e-13)


def test_rim_of_a_flywheel() -> None:
    """σ = ρ v² both ways; the ring of that cross-section has the mass and the inertia that it is for."""
    given = {"speed": "40 rad/s", "areas": [3000, -3000], "unevenness": 0.02}
    rim = {"density": 7200.0, "stress": "4.5 MPa", "inertia_share": 0.9, "width_ratio": 1.5}
    found = lw.turning_moment(machine(**given, rim=rim))
    R, J = found.rim_radius, found.flywheel_inertia
    R, J = 25 / 40, 3000 / (0.02 * 1600)
    assert found.rim_radius == pytest.approx(R, rel=1e-14)
    assert (found.rim_speed, found.rim_stress) == pytest.approx((25.0, 4.5e6), rel=1e-14)
    volume = 2 * math.pi * R * found.rim_width * found.rim_thickness
    assert found.rim_mass == pytest.approx(7200 * volume, rel=1e-13)
    assert found.rim_mass * R**2 == pytest.approx(0.9 * J, rel=1e-13)
    assert found.rim_width / found.rim_thickness == pytest.approx(1.5, rel=1e-13)
    again = lw.turning_moment(machine(**given, rim={"density": 7200.0, "radius": R}))
    assert again.rim_stress == pytest.approx(4.5e6, rel=1e-13)
    assert again.rim_width is None


def test_rim_without_flywheel_has_its_stress_alone() -> None:
    found = lw.turning_moment(machine(speed=10, areas=[5, -5], rim={"density": 7850.0, "radius": 0.5}))
    assert found.rim_stress == pytest.approx(7850 * 25.0, rel=1e-14)
    assert found.rim_mass is None


@pytest.mark.parametrize(
    ("rim", "words"),
    [
        ({"density": 7200.0}, "radius, or stress"),
        ({"density": 7200.0, "radius": 1.0, "stress": 1e6}, "nothing beside radius"),
        ({"radius": 1.0}, "density"),
    ],
)
def test_wrong_rims_are_refused(rim: dict[str, float], words: str) -> None:
    with pytest.raises(MachineError, match=words):
        machine(speed=10, areas=[5, -5], rim=rim)


def areas_of(areas: list[float]) -> lw.Machine:
    head = 'format = 1\nname = "shaft"\n[turning_moment]\nspeed = 60\nunevenness = 0.02\n'
    return lw.loads(f"{head}areas = {areas}\narea_scale = 71.4\n")


def test_areas_that_balance_leave_nothing() -> None:
    """Rounding of their sum is no energy."""
    diagram = lw.turning_moment(areas_of([-30, 410, -280, 320, -330, 250, -360, 280, -260]))
    assert diagram.areas[-1]["energy_after"] == 0
    assert diagram.accuracy == 0


def test_areas_that_do_not_balance_are_told_with_their_limit() -> None:
    with pytest.raises(FindingError, match=r"2142 J, 1\.2 % of the sum"):
        lw.turning_moment(areas_of([-30, 410, -280, 320, -330, 250, -360, 280, -230]))


def test_angles_that_fall_are_named_as_they_are_written() -> None:
    """A text of several angles has one unit for all: the message has it too, not radians."""
    load = {"kind": "table", "angle": "0, 200, 140 deg", "torque": "60, 4000, 60 N m"}
    with pytest.raises(MachineError, match="140 deg"):
        lw.Machine.model_validate(
            {"format": 1, "name": "press", "turning_moment": {"speed": 12.0, "unevenness": 0.1, "load": load}}
        )
