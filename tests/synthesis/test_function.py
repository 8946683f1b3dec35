"""Function generation: points are met, errors are those of the analysed machine."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import linkwright as lw
from linkwright.kernel.errors import InputError, MachineError, SynthesisError
from linkwright.synthesis.expression import function_of
from linkwright.synthesis.four_bar import FourBar
from linkwright.synthesis.freudenstein import lengths, solve
from linkwright.synthesis.function_scale import chebyshev_points
from linkwright.synthesis.task import FunctionTask

DEG = np.pi / 180
LOG = {"function": "log10(x)", "range": (1, 2), "crank_range": 60 * DEG, "rocker_range": 90 * DEG}


def rocker(machine: lw.Machine, angles: np.ndarray) -> np.ndarray:
    """Angle of the rocker from the core [rad]."""
    table = lw.motions(machine, angles, links=["B.rocker"])[0]
    return np.unwrap(np.arctan2(table[1], table[0]))


@pytest.mark.parametrize(
    "given",
    [
        {"points": 3, "crank_start": 45 * DEG, "rocker_start": 135 * DEG},
        {"points": 4, "rocker_start": 250 * DEG},
        {"points": 4, "crank_start": 35 * DEG},
        {"points": 5},
    ],
)
def test_points_are_met(given: dict[str, float]) -> None:
    found = lw.function_generator(FunctionTask(**(LOG | given)))
    share = found.points - 1
    turned = rocker(found.machine, 60 * DEG * np.array([0.0, *share])) - found.rocker_start
    if found.rocker_opposite:
        turned -= np.pi
    wanted = 90 * DEG * np.log10(found.points) / np.log10(2)
    # Rounding of the solution, enlarged by small transmission angles.
    off = np.angle(np.exp(1j * (turned[1:] - wanted)))
    assert np.abs(off).max() < 1e-10
    assert found.angle_error_points < 1e-10
    assert found.residual == 0
    assert found.angle_error_max > 1e-5


def test_structural_error_is_that_of_a_finer_analysis() -> None:
    found = lw.function_generator(FunctionTask(**LOG, points=3, crank_start=45 * DEG, rocker_start=135 * DEG))
    x = np.linspace(1, 2, 20_001)
    turned = rocker(found.machine, 60 * DEG * (x - 1))
    off = turned - turned[0] - 90 * DEG * np.log10(x) / np.log10(2)
    first = (found.generated[0] - found.wanted[0]) / np.log10(2) * 90 * DEG
    # The greatest deviation lies at most half an interval of the range from where it is looked at.
    assert np.abs(off + first).max() == pytest.approx(found.angle_error_max, rel=1e-4)
    # It changes its sign at each of the three points.
    signs = np.sign((found.generated - found.wanted)[np.abs(found.generated - found.wanted) > 1e-12])
    assert (np.diff(signs) != 0).sum() == 3


@settings(max_examples=60, deadline=None, derandomize=True)
@given(
    st.tuples(st.floats(0.3, 3), st.floats(0.3, 3), st.floats(0.3, 3)),
    st.floats(-3, 3),
    st.sampled_from(["left", "right"]),
)
def test_a_known_linkage_solves_the_equation(size: tuple[float, ...], start: float, side: str) -> None:
    bar = FourBar(0j, 1 + 0j, *size, side, start)
    steps = np.array([0.0, 0.2, 0.45])
    angles = rocker(bar.machine("known"), steps)
    if np.isnan(angles).any() or bar.transmission_angle(steps).min() < 0.1:
        return
    (fit,) = solve(steps, angles - angles[0], start, float(angles[0]))
    found = lengths(fit.K)
    assert found is not None
    # Condition of the three equations over a small range.
    assert found == pytest.approx(size, rel=1e-6)


def test_known_linkage_is_among_the_solutions_for_five_points() -> None:
    bar = FourBar(0j, 1 + 0j, 1.3, 1.9, 1.6, "left", 0.6)
    steps = np.linspace(0, 1.2, 5)
    angles = rocker(bar.machine("known"), steps)
    fits = solve(steps, angles - angles[0], None, None)
    exact = [lengths(fit.K) for fit in fits if fit.residual < 1e-11]
    assert any(each == pytest.approx((1.3, 1.9, 1.6), rel=1e-6) for each in exact if each)


def test_least_squares_is_least() -> None:
    task = FunctionTask(**LOG, points=30, spacing="even", crank_start=45 * DEG, rocker_start=135 * DEG)
    found = lw.function_generator(task)
    share = np.linspace(0, 1, 30)
    phi = 45 * DEG + share * 60 * DEG
    psi = 135 * DEG + 90 * DEG * np.log10(1 + share) / np.log10(2)
    rows = np.stack([np.cos(psi), -np.cos(phi), np.ones(30)], axis=1)
    K, *_ = np.linalg.lstsq(rows, np.cos(phi - psi), rcond=None)
    assert (1 / abs(K[0]), 1 / abs(K[1])) == pytest.approx((found.crank, found.rocker), rel=1e-9)
    assert found.residual == pytest.approx(np.sqrt(np.mean((rows @ K - np.cos(phi - psi)) ** 2)), rel=1e-9)


def test_free_starts_reduce_the_error() -> None:
    held = lw.function_generator(FunctionTask(**LOG, points=20, crank_start=45 * DEG, rocker_start=135 * DEG))
    free = lw.function_generator(FunctionTask(**LOG, points=20))
    assert free.angle_error_max < 0.2 * held.angle_error_max
    good = lw.function_generator(FunctionTask(**LOG, points=20, transmission_angle_min=20 * DEG))
    assert good.transmission_angle_min >= 20 * DEG


def test_chebyshev_spacing() -> None:
    """Zeros of the third Chebyshev polynomial, 4 x³ − 3 x: 0 and ± √3/2."""
    assert chebyshev_points(1, 3, 3) == pytest.approx([2 - np.sqrt(3) / 2, 2, 2 + np.sqrt(3) / 2], rel=1e-15)


def test_table_instead_of_a_function() -> None:
    x = chebyshev_points(1, 2, 3)
    task = FunctionTask(
        x=tuple(x),
        y=tuple(x**2),
        range=(1, 2),
        crank_range=90 * DEG,
        rocker_range=60 * DEG,
        crank_start=0.5,
        rocker_start=1.2,
    )
    by_formula = FunctionTask(**(task.model_dump(exclude_unset=True) | {"function": "x^2", "y": None}))
    a, b = lw.function_generator(task), lw.function_generator(by_formula)
    # Three points of a parabola are the parabola.
    assert a.angle_error_max == pytest.approx(b.angle_error_max, rel=1e-9)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("x^2 + 1", 5.0),
        ("-x**3/4", -2.0),
        ("log10(10*x)", np.log10(20)),
        ("2*sin(pi*x/4)", 2.0),
        ("e^-x", np.exp(-2)),
    ],
)
def test_expressions(text: str, value: float) -> None:
    assert function_of(text)(np.array([2.0])) == pytest.approx([value], rel=1e-15)


@pytest.mark.parametrize(
    "text",
    [
        "__import__('os')",
        "x.real",
        "lambda: 1",
        "y",
        "log10(",
        "sin(x, 2)",
        "x if x else 1",
        "True",
        "",
        "9**9**9**9*x",
    ],
)
def test_what_is_no_expression(text: str) -> None:
    with pytest.raises(InputError, match="function"):
        function_of(text)(np.array([2.0]))


def test_findings_and_faults() -> None:
    with pytest.raises(MachineError, match="5 unknowns"):
        FunctionTask(**LOG, points=3)
    with pytest.raises(InputError, match=r"no finite value at x = -0\.9"):
        lw.function_generator(FunctionTask(**(LOG | {"range": (-1, 2)}), points=5))
    with pytest.raises(SynthesisError, match="none of which can be used"):
        lw.function_generator(
            FunctionTask(**LOG, points=3, crank_start=45 * DEG, rocker_start=135 * DEG, length_ratio_max=1.5)
        )
