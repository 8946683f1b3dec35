"""Connecting rods: the published split, pendulum tests against a swinging body, contradictions."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError
from scipy.integrate import solve_ivp

from linkwright import InputError
from linkwright.torsion import ArticulatedRod, Rod
from linkwright.torsion.model.engine import pendulum

# Rounding of closed forms over a few operations.
ROUNDING = 1e-13

# Three point masses of a rod (mass, distance from the big end) [kg, m]: heads and shank.
POINTS = ((2.1, -0.02), (1.3, 0.12), (0.9, 0.26))
LENGTH = 0.25
MASS = sum(m for m, _ in POINTS)
CENTRE = sum(m * a for m, a in POINTS) / MASS
INERTIA = sum(m * (a - CENTRE) ** 2 for m, a in POINTS)
SMALL_END = sum(m * (a - LENGTH) ** 2 for m, a in POINTS)


def rod(**entries: Any) -> Rod:
    return Rod(length=LENGTH, mass=MASS, **entries)


def swings_per_minute(pivot: float, gravity: float = 9.81) -> float:
    """Single swings a minute of the three masses about a pivot on their line, by integration in time."""
    below = np.array([a - pivot for _, a in POINTS])
    mass = np.array([m for m, _ in POINTS])
    hanging = np.sign((mass * below).sum())

    def moving(_: float, state: np.ndarray) -> list[float]:
        torque = -gravity * (mass * below).sum() * hanging * math.sin(state[0])
        return [state[1], torque / (mass * below**2).sum()]

    def at_rest(_: float, state: np.ndarray) -> float:
        return float(state[1])

    found = solve_ivp(moving, (0, 5), [1e-4, 0], events=at_rest, rtol=1e-11, atol=1e-16)
    rests = found.t_events[0]
    return 60 * (len(rests) - 1) / (rests[-1] - rests[0])


def faults(error: pytest.ExceptionInfo[ValidationError]) -> list[tuple[str, str]]:
    return [(".".join(map(str, each["loc"])), each["msg"]) for each in error.value.errors()]


def test_published_split_keeps_mass_and_moment_about_the_small_end() -> None:
    """(1), (2), (8)."""
    found = rod(centre=CENTRE, inertia=INERTIA)
    assert found.moment_small_end == pytest.approx(SMALL_END, rel=ROUNDING)
    assert found.mass_pin == pytest.approx(SMALL_END / LENGTH**2, rel=ROUNDING)
    assert found.mass_pin + found.mass_piston == pytest.approx(MASS, rel=ROUNDING)
    assert found.share == pytest.approx(found.mass_pin / MASS, rel=ROUNDING)


@pytest.mark.parametrize(
    "entries",
    [
        {"centre": CENTRE, "inertia": INERTIA},
        {"centre": CENTRE, "inertia_small_end": SMALL_END},
        {"centre": CENTRE, "distribution": SMALL_END / (MASS * LENGTH**2)},
    ],
)
def test_all_ways_tell_the_same_body(entries: dict[str, float]) -> None:
    found = rod(**entries)
    assert found.body == pytest.approx((MASS, CENTRE, INERTIA), rel=1e-12)
    assert found.moment_small_end == pytest.approx(SMALL_END, rel=ROUNDING)


@pytest.mark.parametrize("about", ["small_end", "big_end"])
@pytest.mark.parametrize("edge", [0.0, 0.021])
def test_single_swing_against_a_swinging_body(about: str, edge: float) -> None:
    """An amplitude of 1e-4 rad lengthens the period by its square over 16, far below the tolerance."""
    pivot = LENGTH + edge if about == "small_end" else -edge
    n = swings_per_minute(pivot)
    found = rod(centre=CENTRE, swing={"about": about, "swings_per_minute": n, "edge": edge})
    assert found.body.inertia == pytest.approx(INERTIA, rel=1e-7)
    timed = rod(centre=CENTRE, swing={"about": about, "period": 120 / n, "edge": edge})
    assert timed.body == pytest.approx(found.body, rel=1e-12)
    # (13) about the edge, (15) about the axis of the small end.
    b = abs(CENTRE - pivot)
    A = pendulum.pendulum_length(pendulum.swing_period(n))
    about_edge = sum(m * (a - pivot) ** 2 for m, a in POINTS)
    assert MASS * b * A == pytest.approx(about_edge, rel=1e-7)
    c = abs(LENGTH - pivot)
    about_axis = MASS * (A * b - 2 * b * c + c**2)
    assert about_axis == pytest.approx(SMALL_END, rel=1e-7)
    assert found.moment_small_end == pytest.approx(about_axis, rel=1e-12)


@pytest.mark.parametrize("edges", [(0.0, 0.0), (0.04, 0.02)])
def test_two_point_swing_finds_the_centre_of_mass(edges: tuple[float, float]) -> None:
    gravity = 9.83
    tests = {
        head: {"swings_per_minute": swings_per_minute(pivot, gravity), "edge": edge, "gravity": gravity}
        for head, pivot, edge in (
            ("big_end", -edges[0], edges[0]),
            ("small_end", LENGTH + edges[1], edges[1]),
        )
    }
    found = rod(two_point_swing=tests)
    # The periods are good to about 1e-9; A₁ + A₂ − 2 l₁ is a tenth of its terms or more.
    assert found.body == pytest.approx((MASS, CENTRE, INERTIA), rel=1e-6)


@given(st.floats(0.02, 0.4), st.floats(0.02, 0.4), st.floats(0.3, 3.0))
def test_two_point_formula_inverts_the_pendulums(a: float, b: float, factor: float) -> None:
    """Any body: A = (J_S + m b²)/(m b) on each edge. Where J_S = m a b the formula has no answer."""
    if abs(factor - 1) < 0.05:
        return
    square = factor * a * b
    found = pendulum.two_point_centre((square + a**2) / a, (square + b**2) / b, a + b)
    # A₁ + A₂ − 2 l₁ = (a + b)(factor − 1) loses what lies between its terms and it: at most 40 l/20 b times.
    assert found == pytest.approx(b, rel=1e-11)


def test_two_pendulums_as_long_as_the_edges_are_apart() -> None:
    with pytest.raises(InputError, match="the centre of mass is undetermined"):
        pendulum.two_point_centre(0.25, 0.25, 0.25)


def test_share_alone_is_two_point_masses_in_the_heads() -> None:
    for entries in ({"distribution": 0.7}, {"inertia_small_end": 0.7 * MASS * LENGTH**2}):
        found = rod(**entries)
        m_1, m_2 = 0.7 * MASS, 0.3 * MASS
        assert (found.mass_pin, found.mass_piston) == pytest.approx((m_1, m_2), rel=ROUNDING)
        centre = m_2 * LENGTH / MASS
        inertia = m_1 * centre**2 + m_2 * (LENGTH - centre) ** 2
        assert found.body == pytest.approx((MASS, centre, inertia), rel=ROUNDING)


def test_printed_forms_differ_by_their_rounding_of_358000() -> None:
    """A body of m kg weighs m kgf; with its g the paper has 1 kg m² = 1e4/981 kgf cm s²."""
    G, b, n, c = 4.3, 17.0, 88.0, 2.1
    A = pendulum.pendulum_length(pendulum.swing_period(n))
    assert 981 * (60 / math.pi) ** 2 == pytest.approx(357826, abs=0.5)
    assert n**2 * A * 100 == pytest.approx(357826, abs=0.5)
    excess = pendulum.PRINTED_LENGTH / (9.81 * (60 / math.pi) ** 2 * 100)
    assert excess == pytest.approx(1.000487, abs=5e-7)
    si = 1e4 / 981
    edge = G * b / 100 * A * si
    assert pendulum.printed_inertia_about_edge(G, b, n) == pytest.approx(edge * excess, rel=ROUNDING)
    centre = pendulum.inertia_about_centre(G, b / 100, A * excess) * si
    assert pendulum.printed_inertia_about_centre(G, b, n) == pytest.approx(centre, rel=ROUNDING)
    axis = G * (A * excess * b / 100 - 2 * b * c / 100**2 + (c / 100) ** 2) * si
    assert pendulum.printed_inertia_about_axis(G, b, n, c) == pytest.approx(axis, rel=ROUNDING)
    # (15) is (14) and the theorem of parallel axes.
    assert axis == pytest.approx(centre + G / 981 * (b - c) ** 2, rel=ROUNDING)


def test_texts_with_units_and_articulated_rods() -> None:
    found = ArticulatedRod(
        length="255.6 mm",
        mass="2.4 kg",
        distribution="60 %",
        pin_radius="64.4 mm",
        pin_angle="67 deg",
    )
    assert found.mass_pin == pytest.approx(1.44)
    assert found.pin_angle == pytest.approx(math.radians(67))
    with pytest.raises(ValidationError, match="pin_radius"):
        ArticulatedRod(length=1, mass=1, distribution=0.5, pin_radius=-0.1, pin_angle=0)


@pytest.mark.parametrize(
    ("entries", "key", "text"),
    [
        ({}, "", "found nothing, expected one of inertia"),
        ({"centre": 0.1}, "", "found nothing, expected one of inertia"),
        ({"distribution": 0.6, "inertia_small_end": 0.1}, "", "inertia_small_end and distribution"),
        ({"inertia": 0.02}, "centre", "the centre of mass, which inertia needs"),
        ({"swing": {"swings_per_minute": 100}}, "centre", "which swing needs"),
        ({"distribution": 1.2}, "distribution", "between 0 and 1"),
        ({"inertia_small_end": 0.5}, "inertia_small_end", "less than mass times length squared"),
        ({"centre": 0.1, "inertia_small_end": 0.09}, "inertia_small_end", "more than mass times distance"),
        ({"centre": 0.1, "distribution": 0.3}, "distribution", "more than 0.36 with this centre of mass"),
        ({"centre": 0.5, "inertia": 0.02}, "centre", "between -0.125 and 0.375 m"),
        ({"centre": 0.1, "inertia": 0.9}, "inertia", "up to 0.26606"),
        ({"centre": 0.1, "swing": {}}, "swing", "either swings_per_minute or period"),
        ({"centre": 0.1, "swing": {"swings_per_minute": 90, "period": 1}}, "swing", 'found "both"'),
        (
            # √(357826/15 cm) single swings a minute belong to the thread down to the centre of mass.
            {"centre": 0.1, "swing": {"swings_per_minute": 160}},
            "swing.swings_per_minute",
            "fewer than 154.451",
        ),
        ({"centre": 0.1, "swing": {"period": 0.7}}, "swing.period", "more than 0.776946 s"),
        ({"centre": 0.26, "swing": {"period": 0.7}}, "centre", "below the knife edge"),
        (
            {"two_point_swing": {"big_end": {"period": 1.1}, "small_end": {"period": 0.9}}},
            "two_point_swing",
            "both longer or both shorter than the 0.25 m",
        ),
        (
            # Both threads are 0.25 m long at a period of 2π √(0.25/9.81) = 1.00303 s.
            {"two_point_swing": {"big_end": {"period": 1.004}, "small_end": {"period": 1.005}}},
            "two_point_swing",
            "that differ from the 0.25 m between the edges",
        ),
        (
            {"two_point_swing": {"big_end": {"period": 0.6}, "small_end": {"period": 0.3}}},
            "two_point_swing",
            "swings of a body with a positive moment of inertia",
        ),
        (
            {"centre": 0.1, "two_point_swing": {"big_end": {"period": 1.1}, "small_end": {"period": 1.1}}},
            "centre",
            "expected no entry",
        ),
    ],
)
def test_contradictions_are_told(entries: dict[str, Any], key: str, text: str) -> None:
    with pytest.raises(ValidationError) as error:
        rod(**entries)
    ((where, told),) = faults(error)
    assert where == key
    assert text in told
