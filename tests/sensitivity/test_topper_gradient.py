"""Derivatives of toppers: knives in pieces, closed forms, ties, what has none."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from random_toppers import CAM, topper_table
from sizes import generator

import linkwright as lw
from linkwright import FindingError
from linkwright.cam import MotionLaw
from linkwright.kernel.numerics.tangent import Tangent
from linkwright.machine import exchanged
from linkwright.sensitivity.sources import source
from linkwright.topping import Knife, edges_of, require_topper
from linkwright.topping.knife_along import knife_along, refused_of_law

# What differences are good for, as a share of the largest derivative of a response, or of the response.
_TOLERANCE = 1e-7


def test_what_has_no_derivative_says_why() -> None:
    machine = lw.read("topper")
    found = source(machine, "topper", ["topper.knife_speed"])
    assert "fixed sample phases" in found.missing["topper.best_phase"]
    assert found.missing["topper.uncut_phase"] == "no head has an uncut share"
    assert "other end of the stroke" in found.ties["topper.worst_offset"]
    with pytest.raises(FindingError, match="one of fixed sample phases"):
        lw.gradient(machine, ["topper.best_phase"])
    fast = lw.replace(machine, {"topper.knife_speed": 4.0})
    missing = source(fast, "topper", ["topper.knife_speed"]).missing
    assert "runs backwards at times" in missing["topper.length_exact"]
    still = lw.replace(machine, {"topper.knife_speed": 0.0})
    assert source(still, "topper", ["topper.knife_speed"]).missing["topper.time_across"] == "it is inf"


_SLIDER = ("mechanism.cranks.crank.radius", "mechanism.sliders.knife.rod", "mechanism.sliders.knife.offset")


def _knife_numbers(law: MotionLaw) -> list[Any]:
    extremes = [extreme.value for order in (0, 1, 2) for extreme in law.extremes(order)]
    return extremes + [law.value(angle, 0, "after") for angle in (0.3, 2.9)]


def test_a_knife_in_pieces_follows_its_mechanism() -> None:
    """A cam beside a slider makes its motion one in pieces; entries that move their ends are refused."""
    described: dict[str, Any] = {"format": 1, "name": "Topper", "drive": {"speed": 22.0}}
    described["mechanism"] = {
        "cranks": {"crank": {"radius": 0.03}},
        "sliders": {"knife": {"crank": "crank", "rod": 0.16, "offset": 0.01}},
        "cams": {"beside": CAM},
    }
    described["topper"] = topper_table(generator(5), "slider")
    machine = lw.Machine.model_validate(described)

    def knife(machine: lw.Machine) -> Knife:
        return edges_of(machine, require_topper(machine))[0].knife

    refused = refused_of_law(machine, [*_SLIDER, "mechanism.cams.beside.phase"], knife(machine))
    assert list(refused) == ["mechanism.cams.beside.phase"]
    units = zip(_SLIDER, np.eye(len(_SLIDER)), strict=True)
    along = exchanged(machine, {name: Tangent(lw.get(machine, name), unit) for name, unit in units})
    numbers = _knife_numbers(knife_along(machine, along, _SLIDER, knife(machine)).law)
    for nth, address in enumerate(_SLIDER):
        size = lw.get(machine, address)
        h = 1e-3 * size
        near = {
            n: np.array(_knife_numbers(knife(exchanged(machine, {address: size + n * h})).law))
            for n in (-4, -2, -1, 1, 2, 4)
        }
        once, twice, four = ((near[n] - near[-n]) / (2 * n * h) for n in (1, 2, 4))
        exact = np.array([number.d[nth] for number in numbers])
        error = np.abs((64 * once - 20 * twice + four) / 45 - exact) * size
        assert (error <= _TOLERANCE * np.abs([number.value for number in numbers])).all(), address


def test_an_edge_across_the_row_leans_to_either_side() -> None:
    """At no angle the paper's lengths grow to both sides."""
    machine = lw.replace(lw.read("topper"), {"topper.edge_angle": 0.0})
    found = lw.gradient(machine, ["topper.length_published", "topper.length_exact"], ["topper.edge_angle"])
    assert "one-sided derivatives" in found.ties["topper.length_published"]
    assert np.isnan(found.derivatives[0, 0])
    # S + d + 2Δ over cos α.
    assert found.derivatives[1, 0] == pytest.approx(0.0, abs=1e-12)


def test_the_mean_draw_cut_ratio_is_exact() -> None:
    """Of a sine the mean of |a + b cos ψ| is (2/π)(a arcsin(a/b) + √(b² − a²))."""
    machine = lw.read("topper")
    v, v_h, alpha = 1.9, 0.55, np.radians(20)
    a, b = v * np.sin(alpha), 0.5 * np.pi * v_h * np.cos(alpha)
    along = 2 / np.pi * (a * np.arcsin(a / b) + np.sqrt(b**2 - a**2))
    assert lw.topper(machine, charts=False).slicing_ratio_mean == pytest.approx(
        along / (v * np.cos(alpha)), rel=1e-12
    )


def test_ties_of_a_knife_that_moves_alike_both_ways() -> None:
    """What a symmetric stroke reaches twice has only one-sided derivatives, and says so."""
    machine = lw.read("topper_cam")
    start, length = "mechanism.cams.knife.sections.1.law.start", "topper.edge_length"
    names = ["drive_torque_max", "drive_torque_min", "uncut_share"]
    found = lw.gradient(machine, [f"topper.{name}" for name in names], [start, length])
    assert set(found.ties) == {f"topper.{name}" for name in names}
    assert np.isnan(found.derivatives[:, 0]).all()
    # The edge is as long for both: its derivative is that of either side.
    assert np.isfinite(found.derivatives[:, 1]).all()
    value, step = lw.get(machine, start), 1e-5
    below, at, above = (
        lw.topper(lw.replace(machine, {start: value + change})) for change in (-step, 0.0, step)
    )
    for name in names:
        left, right = (getattr(at, name) - getattr(below, name), getattr(above, name) - getattr(at, name))
        assert abs(left - right) > 0.5 * max(abs(left), abs(right))


def test_entries_that_a_knife_does_not_know() -> None:
    for name, entry in (("topper", "run_up.settled"), ("topper_field", "run_up.angle_start")):
        found = lw.gradient(lw.read(name), ["topper.travel_along"], [entry])
        assert found.derivatives.tolist() == [[0.0]]
