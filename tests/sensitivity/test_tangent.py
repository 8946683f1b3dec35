"""Numbers with derivatives: their rules against differences, and what has no rule is refused."""

import math

import numpy as np
import pytest

from linkwright.kernel.numerics.implicit import solution_along
from linkwright.kernel.numerics.tangent import Tangent, primal, zeros_for


def _at(x: float, y: float) -> tuple[Tangent, Tangent]:
    return Tangent(x, np.array([1.0, 0.0])), Tangent(y, np.array([0.0, 1.0]))


@pytest.mark.parametrize(
    "formula",
    [
        lambda x, y: (x + 2) * (3 - y) / (x * y) - -x,
        lambda x, y: x**2.5 + 2**y + x**y,
        lambda x, y: np.sqrt(x) * np.exp(-y) + np.log(x) / np.cos(y),
        lambda x, y: np.hypot(x, y) + np.arctan2(y, x) + np.arctan2(-y, -x),
        lambda x, y: np.sin(x) * np.tan(y) + np.arcsin(y / 4) + np.arccos(x / 4) + np.arctan(x),
        lambda x, y: np.maximum(x, y) * np.minimum(x, y) ** 2 + abs(y - x) + np.abs(x - y),
        lambda x, y: np.float64(3) * x / np.float64(7) - np.float64(2) / y + np.square(x) + np.deg2rad(y),
    ],
)
def test_rules_against_differences(formula):
    """Central differences with h = 1e-6 err by h² f‴/6 and by rounding, 1e-10 of numbers of size 1."""
    x, y, h = 1.3, 0.7, 1e-6
    found = formula(*_at(x, y))
    slopes = [
        (formula(x + h, y) - formula(x - h, y)) / (2 * h),
        (formula(x, y + h) - formula(x, y - h)) / (2 * h),
    ]
    assert found.value == pytest.approx(formula(x, y), rel=1e-14)
    assert found.d == pytest.approx(slopes, rel=1e-8, abs=1e-8)


def test_comparisons_look_at_the_value():
    x, y = _at(1.3, 0.7)
    assert x > y
    assert y < 1
    assert x >= 1.3
    assert max([x, y]) is x
    assert primal(x) == 1.3
    assert primal(2.0) == 2.0


@pytest.mark.parametrize("lose", [float, math.sin, np.cbrt, lambda x: np.array([x, 1.0], dtype=float)])
def test_a_derivative_is_never_dropped(lose):
    x, _ = _at(1.3, 0.7)
    with pytest.raises(TypeError):
        lose(x)


def test_where_two_are_equal_the_larger_has_no_derivative_unless_theirs_are() -> None:
    x = Tangent(np.array([0.0, 1.0]), np.array([[1.0], [1.0]]))
    np.testing.assert_array_equal(np.maximum(x, 0.0).d[:, 0], [np.nan, 1.0])
    np.testing.assert_array_equal(np.minimum(x, 0.0).d[:, 0], [np.nan, 0.0])
    np.testing.assert_array_equal(np.maximum(x, x).d[:, 0], [1.0, 1.0])


def test_a_negative_base_has_no_derivative_by_its_power() -> None:
    base = Tangent(np.array([-2.0]), np.array([[1.0, 0.0]]))
    power = Tangent(np.array([2.0]), np.array([[0.0, 1.0]]))
    np.testing.assert_array_equal((base**power).d, [[-4.0, np.nan]])


def _rows(formula, x: Tangent, y: Tangent) -> Tangent:
    """A formula of one number after another."""
    pairs = zip(x.value, x.d, y.value, y.d, strict=True)
    numbers = [formula(Tangent(a, da), Tangent(b, db)) for a, da, b, db in pairs]
    return Tangent([number.value for number in numbers], [number.d for number in numbers])


@pytest.mark.parametrize(
    "formula",
    [
        lambda x, y: (x + y) * (x - y) / (x * y) - -x,
        lambda x, y: (2.0 + x) * (3 - y) / (0.5 * x) + 1.0 / y - x / 7,
        lambda x, y: x**2 + y**3.0 + x**1 + y**-1.5 + x**y,
        lambda x, y: np.sqrt(x) * np.hypot(x, y) + np.sin(x) / np.cos(y),
    ],
)
def test_arrays_follow_the_rules_of_numbers(formula) -> None:
    rng = np.random.default_rng(3)
    x, y = (Tangent(rng.uniform(0.5, 1.4, 5), rng.normal(size=(5, 4))) for _ in range(2))
    expected = _rows(formula, x, y)
    for found in (formula(x, y), formula(x[:, None], y[:, None])[:, 0]):
        np.testing.assert_allclose(found.value, expected.value, rtol=1e-14)
        np.testing.assert_allclose(found.d, expected.d, rtol=1e-12, atol=1e-13)


def test_arrays_with_and_without_derivatives_stretch_like_those_of_numpy() -> None:
    rng = np.random.default_rng(4)
    x = Tangent(rng.uniform(1, 2, (3, 1)), rng.normal(size=(3, 1, 4)))
    y = Tangent(rng.uniform(1, 2, 2), rng.normal(size=(2, 4)))
    plain = rng.uniform(1, 2, (3, 2))
    for found, value, d in (
        (x + y, x.value + y.value, x.d + y.d),
        (x - y, x.value - y.value, x.d - y.d),
        (plain - y, plain - y.value, np.broadcast_to(-y.d, (3, 2, 4))),
        (x * y, x.value * y.value, x.value[..., None] * y.d + x.d * y.value[:, None]),
        (plain * y, plain * y.value, plain[..., None] * y.d),
        (y / plain, y.value / plain, y.d / plain[..., None]),
        (plain / y, plain / y.value, -(plain / y.value**2)[..., None] * y.d),
    ):
        np.testing.assert_allclose(found.value, value, rtol=1e-15)
        np.testing.assert_allclose(found.d, d, rtol=1e-13)
    assert x.T.shape == (1, 3)
    np.testing.assert_array_equal(x.T.d, np.swapaxes(x.d, 0, 1))


def test_a_slope_that_does_not_exist_counts_where_something_moves() -> None:
    """0·∞ and 1/0 leave no derivative by what moves the zero, and none is needed by what does not."""
    x = Tangent(np.array([0.0, 2.0]), np.array([[1.0, 0.0], [1.0, 0.0]]))
    with np.errstate(all="ignore"):
        for found in (x * np.inf, np.array([np.inf, np.inf]) * x, x * Tangent(np.inf, np.zeros(2))):
            np.testing.assert_array_equal(found.d, [[np.inf, 0.0], [np.inf, 0.0]])
        inverse = 1.0 / x
        np.testing.assert_array_equal(inverse.d, [[-np.inf, 0.0], [-0.25, 0.0]])
        np.testing.assert_array_equal((x / 0.0).d, [[np.inf, 0.0], [np.inf, 0.0]])


def test_a_sum_with_a_constant_does_not_change_what_it_is_of() -> None:
    """Both have the same derivatives: they are not copied, and cannot be written to through the sum."""
    array = Tangent(np.arange(3.0), np.eye(3))
    for other in (array + 1.0, 1.0 + array, array - 1.0):
        with pytest.raises(ValueError, match="read-only"):
            other[0] = 5.0
    assert np.array_equal(array.d, np.eye(3))
    own = (array + 1.0).copy()
    own[0] = 5.0
    assert not own.d[0].any()


def test_a_number_is_an_array_without_axes() -> None:
    """One table of rules: numbers meet arrays, and leave them, with the derivatives of each entry."""
    x = Tangent(2.0, np.array([1.0, 0.0]))
    found = np.array([1.0, 3.0]) * x + x**2
    np.testing.assert_array_equal(found.value, [6.0, 10.0])
    np.testing.assert_array_equal(found.d, [[5.0, 0.0], [7.0, 0.0]])
    assert type(found[1].value) is float
    assert (x.shape, x.ndim, x.size) == ((), 0, 1)
    with pytest.raises(ZeroDivisionError):
        1.0 / (x - 2.0)


def test_sums_at_places_count_each_as_often_as_it_is_named() -> None:
    sums = zeros_for([Tangent(1.0, np.ones(1))], (3,))
    np.add.at(sums, [0, 2, 2], Tangent(np.array([1.0, 2.0, 4.0]), np.array([[1.0], [3.0], [5.0]])))
    np.testing.assert_array_equal(sums.value, [1.0, 0.0, 6.0])
    np.testing.assert_array_equal(sums.d[:, 0], [1.0, 0.0, 8.0])


def test_a_solution_follows_its_equation() -> None:
    """Closed forms: z² = p has dz = dp/2z, and A z = b with A held has dz = A⁻¹ db."""
    p = Tangent(np.array([4.0, 9.0]), np.array([[1.0], [2.0]]))
    z = np.array([2.0, 3.0])
    np.testing.assert_allclose(solution_along(z, z * z - p, 2 * z).d, [[1 / 4], [2 / 6]], rtol=1e-15)
    A = np.array([[2.0, 1.0], [1.0, 3.0]])
    b = Tangent(np.array([3.0, 4.0]), np.eye(2))
    z = np.linalg.solve(A, b.value)
    np.testing.assert_allclose(solution_along(z, A @ z - b, A).d, np.linalg.inv(A), rtol=1e-14)
    assert solution_along(2.0, 0.0, 4.0) == 2.0
