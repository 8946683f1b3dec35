"""Flywheels: analysing the machine with one gives back the speed fluctuation that was asked for."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright import InputError, Machine, choose_flywheel, loads, read, replace, steady_state
from linkwright.kernel.files.library import library_path
from linkwright.machine import compile_machine
from linkwright.sizing.flywheel import classical_flywheel, constant_inertia
from linkwright.sizing.motor_change import with_flywheel


def machine_of(name: str) -> Machine:
    return read(library_path(f"roller_{name}"))


@pytest.mark.parametrize("name", ["one_cart", "two_carts", "three_carts"])
@pytest.mark.parametrize("wanted", [0.07, 0.03, 0.01, 0.002])
def test_analysis_gives_back_what_was_asked(name: str, wanted: float) -> None:
    machine = machine_of(name)
    found = choose_flywheel(machine, wanted)
    again = steady_state(with_flywheel(machine, found.inertia), accuracy=1e-12)
    assert again.unevenness == pytest.approx(wanted, rel=1e-6)
    assert found.unevenness == pytest.approx(wanted, rel=1e-6)
    # A little less is not enough.
    less = steady_state(with_flywheel(machine, 0.999 * found.inertia), accuracy=1e-12)
    assert less.unevenness > wanted


def test_none_is_needed() -> None:
    found = choose_flywheel(machine_of("four_carts"), 0.05)
    assert found.inertia == 0
    assert found.unevenness == found.unevenness_without
    assert not found.warnings


def test_a_flywheel_of_the_file_is_replaced() -> None:
    machine = machine_of("two_carts")
    plain = choose_flywheel(machine, 0.03)
    again = choose_flywheel(with_flywheel(machine, 55.0), 0.03)
    assert again.inertia == pytest.approx(plain.inertia, rel=1e-9)
    assert again.unevenness_without == plain.unevenness_without == pytest.approx(0.0850, abs=5e-5)


def test_the_run_up_pays_for_it() -> None:
    found = choose_flywheel(machine_of("two_carts"), 0.02)
    assert found.run_up_time is not None
    assert found.run_up_time_without is not None
    assert found.run_up_time > 3 * found.run_up_time_without
    assert "lengthens the run-up" in found.warnings[0]


@pytest.mark.parametrize(("wanted", "words"), [(0.02, "with the flywheel of"), (0.5, "the machine does not")])
def test_a_run_up_that_fails_is_told_with_its_reason(wanted: float, words: str) -> None:
    """With a flywheel, and where none is needed."""
    found = choose_flywheel(replace(machine_of("two_carts"), {"run_up.turns_max": 0.5}), wanted)
    assert found.run_up is None
    assert words in found.warnings[0]
    assert "has not settled" in found.warnings[0]


def test_the_estimate_is_met_where_the_motor_does_not_answer() -> None:
    """With a motor of constant torque and a great flywheel Mertsalov's method is exact in the limit.

    A weak viscous load takes what is left, so that there is a steady motion near the design speed.
    """
    machine = read(
        library_path("roller_two_carts"),
        {
            "drive.motor": {"kind": "constant_torque", "torque": 1000.0 / (9.8 * 0.9), "inertia": 0.138},
            "loads.oil": {"kind": "viscous", "on": "A1", "damping_torsional": 8.85},
        },
    )
    found = choose_flywheel(machine, 0.001)
    speed = found.steady.speed_mean_time
    estimate, _ = classical_flywheel(replace(machine, {"drive.speed": speed}), 0.001)
    assert found.inertia == pytest.approx(estimate, rel=5e-3)


def test_work_of_the_search_is_small() -> None:
    assert choose_flywheel(machine_of("one_cart"), 0.01).iterations <= 12


YOKE = """
format = 1
name = "yoke"
[mechanism.cranks.A]
radius = 0.1
[mechanism.yokes.S]
pin = "A"
[bodies.S]
mass = {mass}
{more}
[drive]
speed = 20.0
[drive.motor]
kind = "dc"
speed_no_load = 21.0
torque_stall = 500.0
inertia = 0.5
[drive.gearbox]
ratio = 1.0
"""


def yoke(mass: float, more: str = "") -> Machine:
    return loads(YOKE.format(mass=mass, more=more))


def test_excess_work_of_a_yoke_in_closed_form() -> None:
    """A yoke on a pin of radius r: J = m r² sin²φ alone, F r |sin φ| alone, a step of torque alone."""
    assert classical_flywheel(yoke(40.0), 0.01)[1] == pytest.approx(0.5 * 40 * 0.1**2 * 20**2, rel=1e-12)
    # The mean of |sin| is 2/π, met where sin φ = 2/π.
    rubbing = yoke(1e-9, '[loads.f]\nkind = "dry"\non = "S"\nforce = 300.0')
    met = np.arcsin(2 / np.pi)
    exact = 300 * 0.1 * (2 * np.cos(met) - (2 / np.pi) * (np.pi - 2 * met))
    assert classical_flywheel(rubbing, 0.01)[1] == pytest.approx(exact, rel=1e-9)
    # 90 N m over a third of the revolution: the mean of 30 N m is exceeded by 60 all through it.
    press = yoke(1e-9, '[loads.p]\nkind = "formula"\non = "A"\ntorque = "where(cos(phi - 1) > 0.5, -90, 0)"')
    assert classical_flywheel(press, 0.01)[1] == pytest.approx(60 * 2 * np.pi / 3, rel=1e-9)


@pytest.mark.parametrize("name", ["one_cart", "two_carts", "three_carts"])
def test_excess_work_against_fine_samples(name: str) -> None:
    """Even samples fall short of the extremes by their distance squared; the rule of even means is exact."""
    machine = machine_of(name)
    _, work = classical_flywheel(machine, 0.02)
    compiled, omega = compile_machine(machine), 10.5
    n = 200_000
    phi = np.linspace(0, 2 * np.pi, n + 1)
    at = compiled.reductions(phi)
    torque = at.load + at.dry + at.viscous * omega
    rising = np.cumsum(0.5 * (torque[1:] + torque[:-1])) * 2 * np.pi / n
    stored = np.r_[0, rising] - rising[-1] * phi / (2 * np.pi) + 0.5 * at.inertia * omega**2
    assert machine.drive is not None
    assert machine.drive.speed == omega
    assert work == pytest.approx(np.ptp(stored), rel=1e-8)


def test_what_turns_with_the_crank_already_is_taken_off() -> None:
    """Drive, and a disc on the crank; not what oscillates."""
    plain = yoke(40.0)
    estimate, work = classical_flywheel(plain, 0.01)
    assert estimate == pytest.approx(work / (0.01 * 20**2) - 0.5, rel=1e-14)
    disc = yoke(40.0, "[bodies.A]\nmass = 3.0\ninertia = 2.25\nalong = 0.05")
    found, same = classical_flywheel(disc, 0.01)
    assert same == pytest.approx(work, rel=1e-12)
    assert found == pytest.approx(estimate - 2.25 - 3.0 * 0.05**2, rel=1e-12)
    # Only how it is said differs: on the crank, or as a flywheel of that inertia.
    assert constant_inertia(disc) == pytest.approx(constant_inertia(with_flywheel(plain, 2.2575)), rel=1e-12)


@pytest.mark.parametrize("wanted", [0.0, -1.0, 2.0, np.nan])
def test_an_impossible_wish(wanted: float) -> None:
    with pytest.raises(InputError, match="unevenness"):
        choose_flywheel(machine_of("one_cart"), wanted)
