"""Counts of any size: computed, or refused with the name of what was asked for; never a panic."""

from __future__ import annotations

import numpy as np
import pytest

import linkwright as lw
from linkwright import InputError, InternalError, _core
from linkwright.machine import compile_machine


@pytest.mark.parametrize("rows", [1, 2])
def test_motions_of_more_numbers_than_a_task_writes(rows: int) -> None:
    machine = lw.read("machines/roller_one_cart.toml")
    radius = lw.get(machine, "mechanism.cranks.A1.radius")
    machine = lw.replace(machine, {"mechanism.cranks.A1.radius": np.full(rows, radius)})
    angles = np.linspace(0.0, 6.0, 5)
    # Six numbers a point: more than the 8 192 of a task.
    many = lw.motions(machine, angles, points=["A1"] * 1400)
    one = lw.motions(machine, angles, points=["A1"])
    np.testing.assert_array_equal(many, np.tile(one, (1, 1400, 1)))


@pytest.mark.parametrize("count", [2**31, 2**40, 2**62, 2**63, 2**64, 2**5000])
def test_counts_without_end_are_refused_by_name(count: int) -> None:
    with pytest.raises(InputError, match=r"^fine: "):
        lw.topper_field(lw.read("machines/topper.toml"), fine=count)
    with pytest.raises(InputError, match=r"^per_turn: "):
        lw.search_cams(lw.read("machines/roller_cam.toml"), entries={"base_radius": [0.3]}, per_turn=count)
    cart = lw.read("machines/roller_one_cart.toml")
    for analysis in (lw.steady_state, lw.reduction, lw.forces):
        with pytest.raises(InputError, match=r"^n: "):
            analysis(cart, n=count)


def test_the_core_refuses_tables_beyond_memory() -> None:
    kernel = lw.cam_profile(lw.read("machines/roller_cam.toml"), n=90).flanks[0].contact.kernel
    for per_turn in (2**40, 2**62):
        with pytest.raises(InputError, match="do not fit into memory"):
            kernel.search(kernel.sizes, 1.0, per_turn)


def test_a_panic_is_an_error_that_names_the_analysis(capfd: pytest.CaptureFixture[str]) -> None:
    # A parameter that varies without any values: nothing in the package asks for that.
    compiled = compile_machine(lw.read("machines/roller_one_cart.toml"))
    slots, values = np.zeros(1, dtype=np.int32), np.empty((0, 5))
    words = r"^steady motion of many machines: internal error, range .*(batch|rows)\.rs:\d+"
    with pytest.raises(InternalError, match=words):
        _core.steady_rows(compiled.plan, compiled.parameters, slots, values, 1e-8)
    assert capfd.readouterr() == ("", "")
