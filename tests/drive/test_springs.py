"""Springs, dampers, following forces: virtual work on a four-bar, balance of work."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

import linkwright as lw
from linkwright import FindingError

Array = NDArray[np.float64]

FOUR_BAR = """
format = 1
name = "four-bar with a coupler point"
[drive.motor]
kind = "dc"
speed_no_load = 40
torque_stall = 60
inertia = 0.4
[mechanism.points]
D = { x = 0.4, y = 0.05 }
F = { x = 0.1, y = 0.5 }
[mechanism.cranks.A]
radius = 0.1
phase = 0.3
[mechanism.rockers.B]
crank = "A"
pivot = "D"
coupler = 0.38
rocker = 0.28
[mechanism.rigid_points.K]
link = "B.coupler"
along = 0.2
across = 0.15
[bodies]
"B.rocker" = { mass = 3 }
"B.coupler" = { mass = 2 }
A = { inertia = 2.0 }
[loads]
"""

PHI = np.linspace(0, 2 * np.pi, 49)


def machine(*loads: str) -> lw.Machine:
    return lw.loads(FOUR_BAR + "\n".join(f"l{n} = {load}" for n, load in enumerate(loads)))


def point(phi: Array) -> tuple[Array, Array, Array]:
    """Coupler point, and angles of coupler and rocker, by intersection of two circles."""
    pin = 0.1 * np.stack([np.cos(phi + 0.3), np.sin(phi + 0.3)], axis=-1)
    u = np.array([0.4, 0.05]) - pin
    distance = np.linalg.norm(u, axis=-1)
    corner = np.arccos((0.38**2 + distance**2 - 0.28**2) / (2 * 0.38 * distance))
    coupler = np.arctan2(u[:, 1], u[:, 0]) + corner
    e = np.stack([np.cos(coupler), np.sin(coupler)], axis=-1)
    joint = pin + 0.38 * e
    rocker = np.arctan2(joint[:, 1] - 0.05, joint[:, 0] - 0.4)
    return pin + 0.2 * e + 0.15 * np.stack([-e[:, 1], e[:, 0]], axis=-1), coupler, rocker


def slope(f: Callable[[Array], Array]) -> Array:
    """Derivative by φ: central difference of order 6, good to about 1e-10 of the function."""
    h = 1e-2
    weights = {1: 45, 2: -9, 3: 1}
    return sum(w * (f(PHI + k * h) - f(PHI - k * h)) for k, w in weights.items()) / (60 * h)


def length(phi: Array) -> Array:
    return np.linalg.norm(point(phi)[0] - np.array([0.1, 0.5]), axis=-1)


def gas_energy(phi: Array) -> Array:
    """−∫ F dL of F = 300 (h/(h − (0.45 − L)))^1.3, through 300·1.4 N at 0.1 m."""
    root = 1.4 ** (1 / 1.3)
    h = 0.35 * root / (root - 1)
    left = h - (0.45 - length(phi))
    return 300 * h**1.3 * left ** (-0.3) / 0.3


def table_energy(phi: Array) -> Array:
    """∫ F dL of F = 100·(L − 0.1)."""
    return 50 * (length(phi) - 0.1) ** 2


ENERGIES: dict[str, Callable[[Array], Array]] = {
    '{ kind = "spring", between = ["F", "K"], stiffness = 800, free_length = 0.2, '
    "preload = 25 }": lambda phi: 400 * (length(phi) - 0.2) ** 2 + 25 * length(phi),
    '{ kind = "spring", between = ["K", "F"], length = [0.05, 0.6], force = [-5, 50] }': table_energy,
    '{ kind = "gas_spring", between = ["F", "K"], force_extended = 300, length_extended = 0.45, '
    "length_compressed = 0.1, progression = 1.4, exponent = 1.3 }": gas_energy,
    '{ kind = "torsional_spring", on = "B.rocker", stiffness = 30, free_angle = "100 deg" }': lambda phi: (
        15 * (point(phi)[2] - np.radians(100)) ** 2
    ),
    '{ kind = "torsional_spring", on = "B.rocker", against = "B.coupler", stiffness = 30, '
    'free_angle = "60 deg" }': lambda phi: 15 * (point(phi)[2] - point(phi)[1] - np.radians(60)) ** 2,
}


SPRINGS = list(ENERGIES)


@pytest.mark.parametrize("load", ENERGIES)
def test_torque_is_the_slope_of_the_energy(load: str) -> None:
    found = lw.reduction(machine(load), n=48).torque_load
    # The differences limit the comparison, at 1e-10 of some tens of J.
    np.testing.assert_allclose(found, slope(ENERGIES[load]), rtol=1e-8, atol=1e-7)


@pytest.mark.parametrize("load", ENERGIES)
def test_springs_give_back_what_they_take(load: str) -> None:
    drag = '{ kind = "viscous", on = "K", damping = 150 }'
    found = lw.steady_state(machine(load, drag), accuracy=1e-12)
    assert found.energy_drive == pytest.approx(found.energy_load, rel=1e-9)
    # All work is the damper's: the spring does none over a revolution. Trapezoids on 360 intervals of a
    # smooth periodic function.
    viscous = lw.reduction(machine(drag)).viscous
    work = np.trapezoid(viscous * found.speed, found.crank_angle)
    assert found.energy_load == pytest.approx(work, rel=1e-9)


def test_damper_between_points() -> None:
    reduced = lw.reduction(machine('{ kind = "damper", between = ["F", "K"], damping = 400 }'), n=48)
    np.testing.assert_allclose(reduced.viscous, 400 * slope(length) ** 2, rtol=1e-8, atol=1e-8)


def test_torsional_damper_between_links() -> None:
    load = '{ kind = "torsional_damper", on = "B.rocker", against = "B.coupler", damping_torsional = 3 }'
    reduced = lw.reduction(machine(load), n=48)
    angle = slope(lambda phi: point(phi)[2] - point(phi)[1])
    np.testing.assert_allclose(reduced.viscous, 3 * angle**2, rtol=1e-8, atol=1e-8)


def test_torsional_damper_against_the_frame_is_viscous_friction() -> None:
    one = lw.steady_state(machine('{ kind = "torsional_damper", on = "B.rocker", damping_torsional = 3 }'))
    other = lw.steady_state(machine('{ kind = "viscous", on = "B.rocker", damping_torsional = 3 }'))
    assert one.speed_min == pytest.approx(other.speed_min, rel=1e-13)


def test_damper_by_a_straight_curve_is_the_linear_one() -> None:
    curve = '{ kind = "damper", between = ["F", "K"], velocity = [-9, 0, 9], force = [-3600, 0, 3600] }'
    one = lw.steady_state(machine(curve), accuracy=1e-11)
    other = lw.steady_state(
        machine('{ kind = "damper", between = ["F", "K"], damping = 400 }'), accuracy=1e-11
    )
    for name in ("speed_min", "speed_max", "period", "energy_load"):
        assert getattr(one, name) == pytest.approx(getattr(other, name), rel=1e-10)


def test_damper_by_a_bent_curve_balances_its_work() -> None:
    curve = (
        '{ kind = "damper", between = ["F", "K"], velocity = [-2, -0.3, 0, 0.2, 2], '
        "force = [-300, -200, 0, 50, 90] }"
    )
    found = lw.steady_state(machine(curve), accuracy=1e-11)
    assert found.energy_drive == pytest.approx(found.energy_load, rel=1e-9)
    speed = np.interp(PHI, found.crank_angle, found.speed) * slope(length)
    assert abs(speed).max() > 0.3
    work = np.trapezoid(np.interp(speed, [-2, -0.3, 0, 0.2, 2], [-300, -200, 0, 50, 90]) * slope(length), PHI)
    # 48 trapezoids over a revolution with kinks.
    assert found.energy_load == pytest.approx(work, rel=1e-2)


def test_following_force_turns_with_its_link() -> None:
    load = '{ kind = "force", on = "K", force = 70, direction = "20 deg", along = "B.rocker" }'
    found = lw.reduction(machine(load), n=48).torque_load
    way = point(PHI)[2] + np.radians(20)
    d1 = np.stack([slope(lambda phi: point(phi)[0][:, 0]), slope(lambda phi: point(phi)[0][:, 1])], axis=-1)
    np.testing.assert_allclose(found, -70 * (d1[:, 0] * np.cos(way) + d1[:, 1] * np.sin(way)), atol=1e-7)


def test_numbers_of_springs_vary_in_a_batch() -> None:
    drag = '{ kind = "viscous", on = "K", damping = 150 }'
    for load, entry, values in (
        (SPRINGS[2], "progression", np.linspace(1.2, 1.6, 5)),
        (SPRINGS[4], "free_angle", np.linspace(0.5, 1.5, 5)),
        (SPRINGS[0], "preload", np.linspace(0, 50, 5)),
    ):
        base = machine(load, drag)
        found = lw.steady_states(base, {f"loads.l0.{entry}": values})
        for nth, value in enumerate(values):
            one = lw.steady_state(lw.replace(base, {f"loads.l0.{entry}": float(value)}))
            assert found.speed_min[nth] == pytest.approx(one.speed_min, rel=2e-7)


THROUGH_ANCHOR = """
format = 1
name = "spring through its anchor"
[drive.motor]
kind = "dc"
speed_no_load = 30
torque_stall = 40
inertia = 1.5
[mechanism.points]
M = { x = 0.5, y = 0 }
[mechanism.cranks.A]
radius = 0.1
[mechanism.sliders.S]
crank = "A"
rod = 0.5
[loads]
drag = { kind = "viscous", on = "S", damping = 300 }
spring = { kind = "spring", between = ["M", "S"], stiffness = 900, free_length = 0.08 }
"""


def test_spring_through_its_own_anchor() -> None:
    """At the anchor the force turns round: the torque is finite there, and work is balanced."""
    anchored = lw.loads(THROUGH_ANCHOR)
    # Where s = 0.1 cos φ + √(0.25 − 0.01 sin² φ) = 0.5: cos φ = 0.1/(2·0.5).
    at = float(np.arccos(0.1))
    assert lw.kinematics(anchored, [at]).slides["S"].position[0] == pytest.approx(0.5, abs=1e-15)
    reduced = lw.reduction(anchored)
    assert np.isfinite(reduced.torque_load).all()
    found = lw.steady_state(anchored, accuracy=1e-11)
    assert found.energy_drive == pytest.approx(found.energy_load, rel=1e-9)
    from linkwright.machine import compile_machine

    kinks = compile_machine(anchored).kinks()
    assert np.abs(kinks - at).min() < 1e-9


def test_knots_of_forward_and_return_are_watched_once() -> None:
    from linkwright.machine import compile_machine

    load = (
        '{ kind = "force_position", on = "S", position = [0.45, 0.5, 0.55], forward = [0, 9, 0], '
        "return = [0, 5, 0] }"
    )
    text = THROUGH_ANCHOR.split("spring = ")[0] + f"work = {load}\nmore = {load}"
    kinks = compile_machine(lw.loads(text)).kinks()
    # Start and end, where one dead centre is; the other one, and three knots passed twice.
    assert len(kinks) == 2 + 1 + 6
    assert np.diff(kinks).min() > 1e-3


def test_torsional_spring_on_a_link_that_turns_round() -> None:
    with pytest.raises(FindingError, match="torsional spring l0 is twisted by more than 180"):
        lw.steady_state(machine('{ kind = "torsional_spring", on = "A", stiffness = 3 }'))


def test_gas_spring_pressed_in_too_far() -> None:
    load = (
        '{ kind = "gas_spring", between = ["F", "K"], force_extended = 300, length_extended = 0.42, '
        "length_compressed = 0.41, progression = 1.5 }"
    )
    with pytest.raises(FindingError, match="gas spring l0 is compressed beyond its gas volume"):
        lw.steady_state(machine(load))
