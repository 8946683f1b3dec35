"""Flywheels: analysing the machine with one gives back the unevenness that was asked for."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.analysis.steady_state import steady_state
from linkwright.errors import InputError
from linkwright.files import read
from linkwright.files.library import library_path
from linkwright.machine import Machine, replace
from linkwright.sizing.fit import with_flywheel
from linkwright.sizing.flywheel import choose_flywheel, classical_flywheel


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


@pytest.mark.parametrize("wanted", [0.0, -1.0, 2.0, np.nan])
def test_an_impossible_wish(wanted: float) -> None:
    with pytest.raises(InputError, match="unevenness"):
        choose_flywheel(machine_of("one_cart"), wanted)
