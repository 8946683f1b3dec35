"""Instant centres: closed forms of the crank-slider and of Cardan's circles; both centrodes roll together."""

from __future__ import annotations

import numpy as np
import pytest

import linkwright as lw
from linkwright import MachineError


def test_the_centre_of_a_rod_lies_on_the_crank_above_the_slider() -> None:
    machine, angles = lw.read("roller_one_cart"), np.array([0.1, 0.7, 2.0, 3.5, 5.9])
    found = lw.centrodes(machine, "cart1.rod", angles)
    slider = lw.kinematics(machine, angles).points["cart1"].position
    np.testing.assert_allclose(found.x, slider[:, 0], rtol=1e-12)
    np.testing.assert_allclose(found.y, slider[:, 0] * np.tan(angles), rtol=1e-12)


def test_cardans_circles() -> None:
    # Rod as long as the crank: a circle rolls within one of twice its radius.
    radius = 0.2
    machine = lw.replace(lw.read("roller_one_cart"), {"mechanism.sliders.cart1.rod": radius})
    found = lw.centrodes(machine, "cart1.rod", np.linspace(-1.4, 1.4, 57))
    # The rod is as steep as the crank; what the sines lose near the change point is below 1e-9.
    np.testing.assert_allclose(np.hypot(found.x, found.y), 2 * radius, rtol=1e-9)
    np.testing.assert_allclose(np.hypot(found.along, found.across), radius, rtol=1e-9)


@pytest.mark.parametrize(
    ("name", "link"), [("roller_one_cart", "cart1.rod"), ("four_bar_coupler_curve", "C.coupler")]
)
def test_the_moving_centrode_rolls_on_the_fixed(name: str, link: str) -> None:
    machine = lw.read(name)
    found = lw.centrodes(machine, link, np.linspace(0.3, 0.9, 20001))
    fixed = np.hypot(np.diff(found.x), np.diff(found.y))
    moving = np.hypot(np.diff(found.along), np.diff(found.across))
    # Chords differ from arcs by the square of the step over the radius of curvature.
    np.testing.assert_allclose(moving, fixed, rtol=1e-5)


def test_a_crank_turns_about_its_pivot() -> None:
    found = lw.centrodes(lw.read("roller_one_cart"), "A1", [0.2, 1.0])
    np.testing.assert_allclose([found.x, found.y], 0.0, atol=1e-15)


def test_a_link_that_translates_has_no_centre() -> None:
    # A parallelogram: the coupler keeps its direction.
    text = """
format = 1
name = "parallelogram"
[mechanism]
points.P = { x = "1 m", y = "0 m" }
cranks.A = { radius = "0.3 m" }
rockers.B = { crank = "A", pivot = "P", coupler = "1 m", rocker = "0.3 m" }
"""
    found = lw.centrodes(lw.loads(text), "B.coupler", [0.5, 1.0])
    assert np.isnan(found.x).all()
    assert np.isnan(found.across).all()


def test_an_unknown_link_is_told() -> None:
    with pytest.raises(MachineError, match='no link "rod"'):
        lw.centrodes(lw.read("roller_one_cart"), "rod")
