"""Straight lines: exact ones are straight, approximate ones deviate as their closed forms say."""

from __future__ import annotations

import numpy as np
import pytest

import linkwright as lw
from linkwright import InputError, SynthesisError, loads
from linkwright.machine import dumps
from linkwright.synthesis.line_kinds import KINDS
from linkwright.synthesis.straight_line import narrowest_strip


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_has_the_wanted_length(kind: str) -> None:
    found = lw.straight_line(kind, 0.25)
    assert found.length == pytest.approx(0.25, rel=1e-12)
    assert loads(dumps(found.machine)) == found.machine
    # The machine is scaled, not its result: analysed again it draws the same line.
    p = lw.motions(found.machine, found.crank_angles, points=["P"])[0]
    along = p[0] * np.cos(found.direction) + p[1] * np.sin(found.direction)
    across = p[1] * np.cos(found.direction) - p[0] * np.sin(found.direction)
    assert np.ptp(along) == pytest.approx(0.25, rel=1e-12)
    assert np.ptp(across) == pytest.approx(2 * found.deviation, abs=1e-15)


@pytest.mark.parametrize("kind", [key for key, each in KINDS.items() if each.exact])
def test_exact_lines_are_straight(kind: str) -> None:
    found = lw.straight_line(kind, 1.0)
    # Rounding of coordinates that are a few times the length.
    assert found.deviation < 1e-14


@pytest.mark.parametrize("kind", [key for key, each in KINDS.items() if not each.exact])
def test_approximate_lines_are_nearly_straight(kind: str) -> None:
    found = lw.straight_line(kind, 1.0)
    assert 1e-5 < found.straightness < 0.01


def test_hoeken_against_its_closed_form() -> None:
    """Crank 1, frame 2, coupler = rocker = 2.5, P at 5, over half a revolution.

    Coupler and rocker are equal, so P, A and B₀ make a right angle at B₀: P is perpendicular to B₀A, at
    distance √(25 − d²) with d² = 5 − 4 cos φ.
    """
    found = lw.straight_line("hoeken", 4.0)
    mechanism = found.machine.mechanism
    assert mechanism.cranks["A"].radius == pytest.approx(1.0, rel=1e-12)
    sizes = (mechanism.points["B0"].x, mechanism.rockers["B"].coupler, mechanism.rigid_points["P"].along)
    assert sizes == pytest.approx((2.0, 2.5, 5.0), rel=1e-12)
    phi = np.linspace(np.pi / 2, 3 * np.pi / 2, 100_001)
    pin = np.exp(1j * phi)
    d = np.abs(pin - 2)
    P = 2 - 1j * (pin - 2) / d * np.sqrt(25 - d * d)
    assert P[50_000] == pytest.approx(2 + 4j)
    # Both ends are at height 4 and 4 apart: x = 4 and 0.
    assert P[[0, -1]] == pytest.approx([4 + 4j, 0 + 4j])
    assert 2 * found.deviation == pytest.approx(np.ptp(P.imag), rel=1e-5)
    assert found.turns_fully


def test_chebyshev_passes_its_three_places() -> None:
    """Frame 4, arms 5, coupler 2: P is 4 above the frame over both pivots and in the middle (3-4-5)."""
    found = lw.straight_line("chebyshev", 1.0)
    scale = found.machine.mechanism.points["B0"].x / 4
    middle = lw.motions(found.machine, [0.0], points=["P"])[0]
    assert middle[:2, 0] / scale == pytest.approx([2, 4], rel=1e-12)
    # Over A₀ the crank stands upright: 90° less the 53.13° of the middle.
    left = lw.motions(found.machine, [np.pi / 2 - np.arctan2(4, 3)], points=["P"])[0]
    assert left[:2, 0] / scale == pytest.approx([0, 4], abs=1e-12)


@pytest.mark.parametrize(
    ("kind", "pivot", "end", "share"), [("peaucellier", "B", "C", 1.0), ("hart", "C", "R", 0.25)]
)
def test_inversors_invert(kind: str, pivot: str, end: str, share: float) -> None:
    found = lw.straight_line(kind, 1.0)
    rocker = found.machine.mechanism.rockers[pivot]
    p = lw.motions(found.machine, found.crank_angles, points=[end, "P"])[0]
    product = np.hypot(p[0], p[1]) * np.hypot(p[6], p[7])
    np.testing.assert_allclose(product, share * (rocker.rocker**2 - rocker.coupler**2), rtol=1e-12)


def test_proportions_and_range() -> None:
    usual = lw.straight_line("hoeken", 1.0)
    longer = lw.straight_line("hoeken", 1.0, crank_range=(-2.0, 2.0))
    assert longer.straightness > 2 * usual.straightness
    other = lw.straight_line("hoeken", 1.0, proportions={"crank": 1.0, "frame": 2.1, "arm": 2.6})
    assert other.deviation != pytest.approx(usual.deviation, rel=0.01)
    same = lw.straight_line("hoeken", 1.0, proportions={"crank": 10, "frame": 20, "arm": 25})
    assert same.deviation == pytest.approx(usual.deviation, rel=1e-9)


def test_narrowest_strip_of_a_turned_rectangle() -> None:
    turn = np.exp(0.7j)
    corners = np.array([0, 3, 3 + 0.2j, 0.2j, 1 + 0.1j]) * turn
    width, direction = narrowest_strip(corners.real, corners.imag)
    assert (width, direction) == pytest.approx((0.2, 0.7), rel=1e-12)


def test_what_is_wrong_is_told() -> None:
    with pytest.raises(InputError, match='did you mean "hoeken"'):
        lw.straight_line("hoekn", 1.0)
    with pytest.raises(InputError, match="no length cranck"):
        lw.straight_line("hoeken", 1.0, proportions={"cranck": 1})
    with pytest.raises(InputError, match="length: found -1"):
        lw.straight_line("hoeken", -1.0)
    with pytest.raises(SynthesisError, match="does not close"):
        lw.straight_line("watt", 1.0, crank_range=(-1.5, 1.5))
    with pytest.raises(SynthesisError, match="does not close with"):
        lw.straight_line("roberts", 1.0, proportions={"arm": 0.1})
