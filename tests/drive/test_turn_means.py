"""Means, work and extremes over a revolution: closed forms, and brute force where there are none."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import linkwright as lw
from linkwright import ConvergenceError, FindingError, Machine, loads, reduction, steady_state
from linkwright.kernel.numerics.turn_fit import turn_curve
from linkwright.machine import compile_machine

Function = Callable[[np.ndarray], np.ndarray]
TURN = np.array([0.0, 2 * np.pi])

# Function, its integral over the revolution, its largest value.
KNOWN: dict[str, tuple[Function, float, float]] = {
    "smooth": (lambda x: np.exp(np.cos(x)), 2 * np.pi * np.i0(1.0), np.e),
    "kinks": (lambda x: np.abs(np.sin(x - 0.3)), 4.0, 1.0),
    "jump": (lambda x: np.sign(x - 1.2345), 2 * np.pi - 2 * 1.2345, 1.0),
    "root": (lambda x: np.sqrt(np.abs(np.sin(x))), 4.792560938942367, 1.0),
    "peak": (
        lambda x: 1 / (1e-6 + (x - 2) ** 2),
        1e3 * (np.arctan(1e3 * (2 * np.pi - 2)) + np.arctan(2e3)),
        1e6,
    ),
    "bump": (lambda x: np.exp(-(((x - 1) / 1e-3) ** 2)), 1e-3 * np.sqrt(np.pi), 1.0),
    "nothing": (lambda x: 0 * x, 0.0, 0.0),
}


@pytest.mark.parametrize("name", KNOWN)
def test_integral_and_extreme_of_known_functions(name: str) -> None:
    of, integral, greatest = KNOWN[name]
    curve = turn_curve(lambda x: of(x)[None], TURN, name)
    off = abs(curve.integral()[0] - integral)
    # What is reported of the error holds, but for rounding of the sum itself; and it is small.
    assert off <= curve.error[0] + 1e-15 * curve.size[0]
    assert off <= 1e-11 * curve.size[0]
    assert curve.error[0] <= 1e-10 * curve.size[0]
    assert curve.extreme(+1)[0] == pytest.approx(greatest, rel=1e-11, abs=1e-300)


@pytest.mark.parametrize("apart", [1e-9, 1e-6, 1e-5, 1e-4, 3e-4, 1e-3, -1e-4])
@pytest.mark.parametrize("end", [1, 5 / 8, 0.5 + 1 / 2**7])
def test_a_kink_close_to_the_end_of_a_piece_is_seen(apart: float, end: float) -> None:
    """Between the last node and the end no value of a piece tells of it: peak and integral were too high."""
    at = 2 * np.pi * end - apart
    curve = turn_curve(lambda x: (x - np.maximum(40 * (x - at), 0))[None], TURN, "kink")
    end_slope = 40 * max(2 * np.pi - at, 0) ** 2 / 2
    assert curve.integral()[0] == pytest.approx(2 * np.pi**2 - end_slope, rel=1e-11)
    assert curve.extreme(+1)[0] == pytest.approx(min(at, 2 * np.pi), rel=1e-11)


def test_square_harmonics_and_work_of_a_known_function() -> None:
    curve = turn_curve(lambda x: np.stack([1 + np.sin(3 * x), np.cos(x)]), TURN, "torque")
    assert curve.rms() == pytest.approx([np.sqrt(1.5), np.sqrt(0.5)], rel=1e-13)
    found = curve.harmonics(np.array([0.0, 1.0, 3.0, 40.0]))
    # Means of f e^{−iνφ}: half the amplitude, −i for a sine.
    np.testing.assert_allclose(found, [[1, 0, -0.5j, 0], [0, 0.5, 0, 0]], atol=1e-13)
    # ∫cos = sin, which has no mean, and half of the first beside it.
    work = curve.excess(1, 0, 0.5)
    phi = np.linspace(0, 2 * np.pi, 1_000_001)
    brute = np.sin(phi) + 0.5 * np.sin(3 * phi) + 0.5
    assert work.extreme(+1)[0] == pytest.approx(brute.max(), abs=1e-10)
    assert work.extreme(-1)[0] == pytest.approx(brute.min(), abs=1e-10)


def test_a_function_without_smoothness_is_refused() -> None:
    with pytest.raises(ConvergenceError, match="varies without end"):
        turn_curve(lambda x: np.sin(1e7 * x)[None], TURN, "load")
    with pytest.raises(FindingError, match="no finite value"):
        turn_curve(lambda x: np.where(x < 1, np.nan, x)[None], TURN, "load")


def test_rounding_is_no_want_of_smoothness() -> None:
    """What is left of cancelled terms is noise; it must neither be refused nor cost much."""
    work = []

    def of(x: np.ndarray) -> np.ndarray:
        work.append(len(x))
        return (1e9 * np.sin(x) ** 2 + 1e9 * np.cos(x) ** 2 - 1e9)[None]

    curve = turn_curve(of, TURN, "load")
    # 1e9 is rounded to 1e-7.
    assert abs(curve.integral()[0]) < 1e-6
    assert sum(work) < 20_000


FOUR_BAR = """
format = 1
name = "four-bar"
[mechanism.points.B0]
x = 0.4
y = 0.1
[mechanism.cranks.A]
radius = 0.1
[mechanism.rockers.B]
crank = "A"
pivot = "B0"
coupler = 0.35
rocker = 0.25
[mechanism.rigid_points.P]
link = "B.coupler"
along = 0.3
across = 0.2
[bodies."B.rocker"]
mass = 30.0
[drive.motor]
kind = "constant_speed"
speed = 20.0
"""

# Springs near and through whose anchor the crank pin passes, one by a table, one that twists, weight, a force
# fixed in the frame.
CONSERVATIVE = {
    "near": '[mechanism.points.N]\nx = 0.101\ny = 0.0\n[loads.s]\nkind = "spring"\nbetween = ["A", "N"]\n'
    "stiffness = 1e5\nfree_length = 0.005",
    "through": '[mechanism.points.N]\nx = 0.1\ny = 0.0\n[loads.s]\nkind = "spring"\nbetween = ["A", "N"]\n'
    "stiffness = 1e5\nfree_length = 0.1",
    "table": '[loads.s]\nkind = "spring"\nbetween = ["P", "O"]\n'
    "length = [0.2, 0.31, 0.4]\nforce = [-20, 5, 90]",
    "torsion": '[loads.s]\nkind = "torsional_spring"\non = "B.rocker"\nstiffness = 70.0\nfree_angle = 1.0',
    "weight": '[loads.s]\nkind = "gravity"\nacceleration = 9.81\ndirection = "-70 deg"',
    "force": '[loads.s]\nkind = "force"\non = "P"\nforce = 100.0\ndirection = 0.5',
}


def machine(*parts: str) -> Machine:
    return loads("\n".join([FOUR_BAR, *parts]))


@pytest.mark.parametrize("name", CONSERVATIVE)
def test_a_load_with_a_potential_does_no_work(name: str) -> None:
    """Exactly none, however fast its torque varies; beside others, these alone count."""
    alone = reduction(machine(CONSERVATIVE[name]))
    assert np.abs(alone.torque_load).max() > 1.0
    assert alone.torque_load_mean == 0.0
    dry = '[loads.f]\nkind = "dry"\non = "B.rocker"\ntorque = 2.0'
    both, own = reduction(machine(CONSERVATIVE[name], dry)), reduction(machine(dry))
    assert both.torque_load_mean == pytest.approx(own.torque_load_mean, rel=1e-14)
    # The curve says the same, integrated as it is.
    compiled = compile_machine(machine(CONSERVATIVE[name]))
    curve = turn_curve(lambda phi: compiled.reductions(phi).load[None], compiled.kinks(), "load")
    assert abs(curve.integral()[0]) <= max(curve.error[0], 1e-13 * curve.size[0])
    assert steady_state(machine(CONSERVATIVE[name])).energy_load == pytest.approx(0, abs=1e-9 * curve.size[0])


# Resistances that a fixed rule over the revolution does not hold: a rocker near its change point, a coupler
# point near a cusp, formulas with narrow peaks and with a jump that no scan of the angle sees.
RESISTING = {
    "near change point": (
        {"mechanism.rockers.B.rocker": 0.162313},
        '[loads.f]\nkind = "viscous"\non = "B.rocker"\ndamping_torsional = 1.0',
    ),
    "peak": ({}, '[loads.f]\nkind = "formula"\non = "A"\ntorque = "10/(1 + 1e4*(1 - cos(phi - 1)))"'),
    "window": ({}, '[loads.f]\nkind = "formula"\non = "A"\ntorque = "where(cos(phi - 1) > 0.9999, 30, 0)"'),
    "friction": ({}, '[loads.f]\nkind = "dry"\non = "P"\nforce = 10.0'),
}


@pytest.mark.parametrize("name", RESISTING)
def test_means_against_brute_force(name: str) -> None:
    entries, load = RESISTING[name]
    made = lw.replace(machine(load), entries)
    found = reduction(made)
    # The rule of even samples: exact for what is smooth; beside kinks and jumps it errs by a sample.
    phi = (np.arange(1_000_000) + 0.5) * 2e-6 * np.pi
    at = compile_machine(made).reductions(phi)
    torque = at.load + at.dry
    jump = 1e-6 * np.abs(np.diff(torque)).sum()
    assert found.torque_load_mean == pytest.approx(torque.mean(), rel=1e-11, abs=jump)
    assert found.viscous_mean == pytest.approx(at.viscous.mean(), rel=1e-11)
    assert found.torque_load_max == pytest.approx(torque.max(), rel=1e-9)


def test_a_window_has_its_exact_mean() -> None:
    """30 N m over the angle at which cos φ > 0.9999, though no kink is reported."""
    found = reduction(machine(RESISTING["window"][1])).torque_load_mean
    assert found == pytest.approx(-30 * np.arccos(0.9999) / np.pi, rel=1e-12)


def test_a_constant_speed_reads_extremes_and_means_exactly() -> None:
    """The torque is known all round; its samples do not matter."""
    made = machine(CONSERVATIVE["near"], '[loads.f]\nkind = "dry"\non = "B.rocker"\ntorque = 2.0')
    coarse, fine = steady_state(made, n=8), steady_state(made, n=400_000)
    assert coarse.torque_motor_max == pytest.approx(fine.torque_motor.max(), rel=1e-8)
    assert coarse.torque_motor_max >= fine.torque_motor.max() * (1 - 1e-12)
    assert coarse.torque_motor_min == pytest.approx(fine.torque_motor.min(), rel=1e-8)
    square = np.trapezoid(fine.torque_motor**2, fine.crank_angle) / (2 * np.pi)
    assert coarse.torque_motor_rms == pytest.approx(np.sqrt(square), rel=1e-8)


def driven(torque: str) -> Machine:
    load = f'kind = "formula", on = "A", torque = "{torque}"'
    return loads(
        'format = 1\nname = "crank"\n[drive.motor]\nkind = "constant_speed"\nspeed = 12\n'
        f"[mechanism.cranks.A]\nradius = 0.1\n[bodies]\nA = {{ inertia = 1 }}\n[loads]\nl = {{ {load} }}\n"
    )


def test_cyclic_load_factor_of_a_known_torque() -> None:
    """Of a + b sin φ it is √(1 + (b/a)²/2), of an even torque 1; of a motor that brakes there is none."""
    swinging = steady_state(driven("-40 - 30*sin(phi)"), n=8)
    assert swinging.cyclic_load_factor == pytest.approx(np.sqrt(1 + 0.75**2 / 2), rel=1e-12)
    assert steady_state(driven("-40"), n=8).cyclic_load_factor == pytest.approx(1.0, rel=1e-12)
    assert steady_state(driven("40"), n=8).cyclic_load_factor is None


def test_cyclic_load_factor_is_one_over_time() -> None:
    """Of a motor that gives way: against the trapezoidal rule over time, good to the square of its steps."""
    found = steady_state(lw.read("machines/roller_two_carts.toml"), n=4000)
    mean = np.trapezoid(found.torque_motor, found.time) / found.period
    square = np.trapezoid(found.torque_motor**2, found.time) / found.period
    assert found.cyclic_load_factor == pytest.approx(np.sqrt(square) / mean, rel=1e-6)


@pytest.mark.parametrize("count", [4000, 5000])
def test_more_kinks_than_open_pieces(count: int) -> None:
    """A table of 0.1 deg and less: every interval is a piece to begin with."""
    kinks = np.linspace(0.0, 2 * np.pi, count + 1)
    found = turn_curve(lambda phi: np.abs(np.sin(phi * count / 2))[None], kinks, "arches")
    # Each arch has the mean 2/π.
    assert found.mean()[0] == pytest.approx(2 / np.pi, rel=1e-9)
