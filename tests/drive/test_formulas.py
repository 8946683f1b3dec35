"""Loads by formulas: equal to the built-in loads in every analysis, and to what the formula says."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import linkwright as lw
from linkwright import FindingError, SteadyStateError
from linkwright.kernel.description.formula import parse, program, terms
from linkwright.machine import dumps

MACHINE = """
format = 1
name = "slider-crank with a tip on the rod"
[drive.motor]
kind = "dc"
speed_no_load = 150
torque_stall = 120
inertia = 0.2
[drive.gearbox]
ratio = 10
efficiency = 0.9
[mechanism.points.P]
x = 0.3
y = -0.2
[mechanism.cranks.A]
radius = 0.15
phase = 0.2
[mechanism.sliders.S]
crank = "A"
rod = 0.55
offset = 0.06
angle = 0.4
[mechanism.rigid_points.T]
link = "S.rod"
along = 0.3
across = 0.1
[bodies]
S = { mass = 8.0 }
A = { mass = 2.0, inertia = 0.5, along = 0.05, across = 0.02 }
[loads]
"""


def machine(*loads: str) -> lw.Machine:
    return lw.loads(MACHINE + "\n".join(f"l{n} = {load}" for n, load in enumerate(loads)))


FORMULA = '{{ kind = "formula", on = "{}", {} }}'

# Pull over length of a spring from P.
SPRING = "(-900 + (900*0.2 - 30)/sqrt((x - 0.3)^2 + (y + 0.2)^2))"

# Built-in loads, and the same by formulas.
SAME = {
    "dry": (
        ['{ kind = "dry", on = "S", force = 300 }'],
        FORMULA.format("S", 'force = "-300*sign(v)"'),
    ),
    "dry on a link": (
        ['{ kind = "dry", on = "S.rod", torque = 9 }'],
        FORMULA.format("S.rod", 'torque = "-9*sign(psi_dot)"'),
    ),
    "viscous": (
        ['{ kind = "viscous", on = "S", damping = 200 }'],
        FORMULA.format("S", 'force = "-c*v", constants = { c = "200 N s/m" }'),
    ),
    "both": (
        ['{ kind = "dry", on = "S", force = 300 }', '{ kind = "viscous", on = "S", damping = 200 }'],
        FORMULA.format("S", 'force = "-200*v - 300*sign(v)"'),
    ),
    "spring": (
        ['{ kind = "spring", between = ["P", "S"], stiffness = 900, free_length = 0.2, preload = 30 }'],
        FORMULA.format("S", f'force = "{SPRING}*(x - 0.3)", direction = 0'),
        FORMULA.format("S", f'force = "{SPRING}*(y + 0.2)", direction = "90 deg"'),
    ),
    "force": (
        ['{ kind = "force", on = "T", force = 50, direction = "30 deg" }'],
        FORMULA.format("T", 'force = "50", direction = "30 deg"'),
    ),
    "following force": (
        ['{ kind = "force", on = "T", force = 50, direction = "30 deg", along = "S.rod" }'],
        FORMULA.format("T", 'force = "100/2", direction = "30 deg", along = "S.rod"'),
    ),
    "torque": (['{ kind = "torque", on = "A", torque = 7 }'], FORMULA.format("A", 'torque = "7"')),
    "torque over angle": (
        ['{ kind = "torque_angle", angle = [1, 2, 3], torque = [0, 30, 0] }'],
        FORMULA.format("A", 'torque = "-30*max(0, 1 - abs(phi - 2))"'),
    ),
    "force over position": (
        ['{ kind = "force_position", on = "S", position = [0.5, 0.6], forward = [0, 800] }'],
        FORMULA.format("S", 'force = "where(v > 0, -800*min(1, max(0, (s - 0.5)/0.1)), 0)"'),
    ),
    "fan": (
        ['{ kind = "formula", on = "A", torque = "-0.2*omega^2" }'],
        FORMULA.format("A", 'torque = "-0.2*psi_dot*abs(omega)"'),
    ),
}

MEASURES = ("speed_min", "speed_max", "acceleration_min", "acceleration_max", "period", "energy_load")


@pytest.mark.parametrize("what", SAME)
def test_formula_moves_the_machine_as_the_built_in_load(what: str) -> None:
    built_in, by_formula = machine(*SAME[what][0]), machine(*SAME[what][1:])
    one, other = lw.reduction(built_in), lw.reduction(by_formula)
    # Sums of a few terms, in another order.
    np.testing.assert_allclose(other.torque_load, one.torque_load, rtol=1e-12, atol=1e-11)
    np.testing.assert_allclose(other.viscous, one.viscous, rtol=1e-12, atol=1e-12)
    steady = [lw.steady_state(each, accuracy=1e-11) for each in (built_in, by_formula)]
    for name in MEASURES:
        # A load of fixed direction does no work in a revolution: a joule is the measure then.
        scale = max(abs(getattr(steady[0], name)), steady[0].acceleration_max if "acc" in name else 1.0)
        # Extremes are read on the meshes of both, which agree to the accuracy times 100.
        difference = getattr(steady[1], name) - getattr(steady[0], name)
        assert difference == pytest.approx(0, abs=1e-8 * scale), name
    ways = [lw.transient(each, duration=0.6, accuracy=1e-10) for each in (built_in, by_formula)]
    # A thousand steps of 1e-10 at most.
    assert ways[1].speed[-1] == pytest.approx(ways[0].speed[-1], rel=1e-7)
    assert ways[1].crank_angle[-1] == pytest.approx(ways[0].crank_angle[-1], rel=1e-7)


@pytest.mark.parametrize("what", SAME)
def test_work_over_a_turn_is_balanced(what: str) -> None:
    found = lw.steady_state(machine(*SAME[what][1:]), accuracy=1e-11)
    scale = max(abs(found.energy_load), 1.0)
    assert found.energy_drive - found.energy_load == pytest.approx(0, abs=1e-9 * scale)


@pytest.mark.parametrize("force", ["-200*v - 300*sign(v)", "(-200*v - 300*sign(v))*1"])
def test_constants_vary_in_a_batch(force: str) -> None:
    """Both as summands in the reduction, and as a law of its own."""
    by_formula = machine(
        FORMULA.format("S", f'force = "{force.replace("300", "f")}", constants = {{ f = 300 }}')
    )
    built_in = machine(*SAME["both"][0])
    sizes = np.linspace(100, 400, 11)
    found = lw.steady_states(by_formula, {"loads.l0.constants.f": sizes})
    exact = lw.steady_states(built_in, {"loads.l0.force": sizes})
    assert (found.status == 0).all()
    # Lanes are promised to 1e-7.
    np.testing.assert_allclose(found.speed_min, exact.speed_min, rtol=2e-7)
    np.testing.assert_allclose(found.unevenness, exact.unevenness, rtol=1e-5)


def test_quadratic_drag_against_scipy() -> None:
    """A flywheel under constant motor torque and a drag of the square of the speed, in time."""
    text = """
    format = 1
    name = "fan"
    [drive.motor]
    kind = "constant_torque"
    torque = 12
    inertia = 0.8
    [mechanism.cranks.A]
    radius = 0.1
    [loads]
    fan = { kind = "formula", on = "A", torque = "-0.03*omega^2 - 2*sin(3*t)" }
    """
    fan = lw.loads(text)
    found = lw.transient(fan, duration=3.0, accuracy=1e-11)
    exact = solve_ivp(
        lambda t, y: [y[1], (12 - 0.03 * y[1] ** 2 - 2 * math.sin(3 * t)) / 0.8],
        (0, 3),
        [0, 0],
        method="DOP853",
        rtol=1e-12,
        atol=1e-12,
    )
    assert found.speed[-1] == pytest.approx(exact.y[1, -1], rel=1e-9)
    assert found.crank_angle[-1] == pytest.approx(exact.y[0, -1], rel=1e-9)


def test_fan_runs_where_its_torque_meets_the_motor() -> None:
    """On the crank alone: 8·0.5·60 (1 − 8ω/200) = 0.9 ω², ω by the quadratic."""
    text = """
    format = 1
    name = "fan"
    [drive.motor]
    kind = "dc"
    speed_no_load = 200
    torque_stall = 60
    inertia = 0.1
    [drive.gearbox]
    ratio = 8
    efficiency = 0.5
    [mechanism.cranks.A]
    radius = 0.1
    [loads]
    fan = { kind = "formula", on = "A", torque = "-c*omega*abs(omega)", constants = { c = 0.9 } }
    """
    slope = 240 * 8 / 200
    omega = (-slope + math.sqrt(slope**2 + 4 * 0.9 * 240)) / 1.8
    found = lw.steady_state(lw.loads(text))
    assert found.speed_max == pytest.approx(omega, rel=1e-12)
    assert found.unevenness == pytest.approx(0, abs=1e-12)
    assert found.energy_load == pytest.approx(2 * math.pi * 0.9 * omega**2, rel=1e-12)


def test_moving_kinks_are_met() -> None:
    """Where a valve opens depends on the speed: the accuracy asked for is kept all the same."""
    loaded = machine(FORMULA.format("S", 'force = "-400*max(0, abs(v) - 1.2)"'))
    exact = lw.steady_state(loaded, accuracy=1e-12)
    for accuracy in (1e-6, 1e-8, 1e-10):
        found = lw.steady_state(loaded, accuracy=accuracy)
        assert found.speed_min == pytest.approx(exact.speed_min, rel=accuracy)
    assert found.energy_drive == pytest.approx(found.energy_load, rel=1e-9)
    rows = lw.steady_states(loaded, {"bodies.S.mass": [8.0, 9.0]}, accuracy=1e-10)
    assert rows.speed_min[0] == pytest.approx(exact.speed_min, rel=1e-9)


def test_formula_friction_holds_at_rest() -> None:
    """A machine whose friction exceeds the drive does not start, whichever way the friction is written."""
    for load in (
        '{ kind = "dry", on = "A", torque = 5000 }',
        FORMULA.format("A", 'torque = "-5000*sign(omega)"'),
    ):
        assert lw.transient(machine(load), duration=1.0).end.name == "DOES_NOT_START"


def test_constant_speed_takes_the_formula_at_that_speed() -> None:
    text = """
    format = 1
    name = "fan at constant speed"
    [drive.motor]
    kind = "constant_speed"
    speed = 12
    [mechanism.cranks.A]
    radius = 0.1
    [bodies]
    A = { inertia = 1 }
    [loads]
    fan = { kind = "formula", on = "A", torque = "-0.5*omega^2" }
    """
    found = lw.steady_state(lw.loads(text))
    assert found.torque_motor_mean == pytest.approx(72, rel=1e-12)


def test_time_has_no_steady_motion() -> None:
    with pytest.raises(SteadyStateError, match=r"formula of l0, .* depends on time t"):
        lw.steady_state(machine(FORMULA.format("S", 'force = "-100*sin(t)"')))
    # Its reduction would have no value.
    with pytest.raises(SteadyStateError, match=r"formula of l0, .* depends on time t"):
        lw.reduction(machine(FORMULA.format("S", 'force = "-100*sin(t)"')))


def test_formula_without_value_is_named() -> None:
    with pytest.raises(FindingError, match=r"formula of l1, .* no finite value at crank angle"):
        lw.steady_state(machine(SAME["dry"][0][0], FORMULA.format("S", 'force = "-sqrt(s - 0.5)"')))


VALUES = {
    "2 + 3*4^2": 50.0,
    "-2^2": -4.0,
    "2^-1": 0.5,
    "2^3^2": 512.0,
    "2**0.5": math.sqrt(2),
    "8/4/2": 1.0,
    "10 - 4 - 3": 3.0,
    "1 - -2": 3.0,
    "max(1, 5, 3) + min(4, 2)": 7.0,
    "where(1 < 2, 3, 4) + where(1 >= 2, 30, 40)": 43.0,
    "where(2 <= 2, 1, 0) + where(2 > 2, 10, 20)": 21.0,
    "atan2(1, -1)": math.atan2(1, -1),
    "pow(9, 0.5)*step(0) + step(-1)": 3.0,
    "sign(-3)*abs(-2)": -2.0,
    "exp(log(5))": 5.0,
    "asin(0.5) + acos(0.5) + atan(1) + tan(0.3) + tanh(0.7)": (
        math.pi / 2 + math.pi / 4 + math.tan(0.3) + math.tanh(0.7)
    ),
    "g/9.81 + pi": 1 + math.pi,
    "1.5e1 + .5": 15.5,
}


@pytest.mark.parametrize("text", VALUES)
def test_values_of_texts(text: str) -> None:
    """Torque on the crank, whose transfer function is one."""
    found = lw.reduction(machine(FORMULA.format("A", f'torque = "{text}"')), n=4).torque_load
    np.testing.assert_allclose(found, -VALUES[text], rtol=1e-14)


def test_variables_of_a_point() -> None:
    """Each variable against the kinematics."""
    phi = lw.reduction(machine(), n=24).crank_angle
    moved = lw.kinematics(machine(), phi)
    T, rod, S = moved.points["T"], moved.links["S.rod"], moved.slides["S"]
    cases: list[tuple[str, str, Any]] = [
        ("S", 'force = "s"', S.position * S.d1),
        ("T", 'force = "x + 2*y", direction = 0', (T.position @ [1, 2]) * T.d1[:, 0]),
        ("T", 'force = "vx/vy", direction = 1.5707963267948966', T.d1[:, 0]),
        ("T", 'force = "v/omega", direction = 0', np.hypot(*T.d1.T) * T.d1[:, 0]),
        ("S.rod", 'torque = "sin(psi)"', np.sin(rod.angle) * rod.d1),
        ("S.rod", 'torque = "psi_dot/omega"', rod.d1**2),
        ("T", 'force = "cos(psi)", along = "S.rod"', np.cos(rod.angle) * _along(T.d1, rod.angle)),
    ]
    for on, entries, exact in cases:
        found = lw.reduction(machine(FORMULA.format(on, entries)), n=24).torque_load
        np.testing.assert_allclose(found, -exact, rtol=1e-11, atol=1e-12, err_msg=entries)


def _along(d1: Any, angle: Any) -> Any:
    return d1[:, 0] * np.cos(angle) + d1[:, 1] * np.sin(angle)


def test_summands_by_speed_stand_alone() -> None:
    parts = terms(parse("1 - (x - v) + sign(v)*2 - phi"))
    asked = [{operand for op, operand in program(each) if op == "name"} for each in parts]
    assert asked == [{"v"}, {"v"}, {"x", "phi"}]


def test_round_trip() -> None:
    loaded = machine(FORMULA.format("S", 'force = "-c*v", constants = { c = "0.2 kN s/m" }'))
    assert lw.loads(dumps(loaded)) == loaded
    assert lw.get(loaded, "loads.l0.constants.c") == 200.0
