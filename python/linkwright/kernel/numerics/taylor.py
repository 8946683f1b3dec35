r"""Numbers that carry their first three derivatives by time, for functions written with numpy.

A `Taylor` holds the coefficients of :math:`f(t + h) = \sum c_k h^k`. Sums and products follow from Cauchy's
product; functions from their differential equation, coefficient by coefficient (Griewank and Walther,
*Evaluating Derivatives*, section 13.2). The derivatives are exact; nothing is differenced.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats

# Coefficients: value and three derivatives.
TERMS = 4

_FACTORIALS = np.array([[1.0], [1.0], [2.0], [6.0]])


class Taylor:
    """A function of time at n times, with three derivatives.

    Parameters
    ----------
    coefficients : ndarray, shape (4, n)
        Of its Taylor series at each time.
    """

    def __init__(self, coefficients: Floats) -> None:
        self.c = coefficients

    @classmethod
    def variable(cls, times: Floats) -> Taylor:
        """The time itself, (n,) [s]."""
        return cls(np.stack([times, np.ones_like(times), np.zeros_like(times), np.zeros_like(times)]))

    @property
    def derivatives(self) -> Floats:
        """Value and three derivatives, (4, n)."""
        derivatives: Floats = self.c * _FACTORIALS
        return derivatives

    # -- numpy -------------------------------------------------------------------------------------------

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **options: Any) -> Any:
        """Functions of numpy that have a derivative, and comparisons of values."""
        if method != "__call__" or options:
            return NotImplemented
        if ufunc in _COMPARISONS:
            return ufunc(*(x.c[0] if isinstance(x, Taylor) else x for x in inputs))
        rule = _RULES.get(ufunc)
        return NotImplemented if rule is None else rule(*(self._like(x) for x in inputs))

    def __array_function__(self, function: Any, _types: Any, args: Any, options: Any) -> Any:
        """`numpy.where`, for laws in pieces."""
        if function is not np.where or len(args) != 3 or options:
            return NotImplemented
        condition, first, second = args
        return Taylor(np.where(condition, self._like(first).c, self._like(second).c))

    def _like(self, x: Any) -> Taylor:
        """A number or an array as a constant."""
        if isinstance(x, Taylor):
            return x
        c = np.zeros_like(self.c)
        c[0] = x
        return Taylor(c)

    def __add__(self, other: Any) -> Any:
        return _apply(np.add, self, other)

    def __sub__(self, other: Any) -> Any:
        return _apply(np.subtract, self, other)

    def __mul__(self, other: Any) -> Any:
        return _apply(np.multiply, self, other)

    def __truediv__(self, other: Any) -> Any:
        return _apply(np.divide, self, other)

    def __pow__(self, other: Any) -> Any:
        return _apply(np.power, self, other)

    def __radd__(self, other: Any) -> Any:
        return _apply(np.add, other, self)

    def __rsub__(self, other: Any) -> Any:
        return _apply(np.subtract, other, self)

    def __rmul__(self, other: Any) -> Any:
        return _apply(np.multiply, other, self)

    def __rtruediv__(self, other: Any) -> Any:
        return _apply(np.divide, other, self)

    def __rpow__(self, other: Any) -> Any:
        return _apply(np.power, other, self)

    def __neg__(self) -> Taylor:
        return Taylor(-self.c)

    def __abs__(self) -> Taylor:
        return _absolute(self)

    def __lt__(self, other: Any) -> Any:
        return _apply(np.less, self, other)

    def __le__(self, other: Any) -> Any:
        return _apply(np.less_equal, self, other)

    def __gt__(self, other: Any) -> Any:
        return _apply(np.greater, self, other)

    def __ge__(self, other: Any) -> Any:
        return _apply(np.greater_equal, self, other)


def _apply(function: Any, *args: Any) -> Any:
    """A function of numpy, whose types know nothing of this class."""
    return function(*args)


def _product(a: Taylor, b: Taylor) -> Taylor:
    """Cauchy's product."""
    return Taylor(np.array([sum(a.c[j] * b.c[k - j] for j in range(k + 1)) for k in range(TERMS)]))


def _quotient(a: Taylor, b: Taylor) -> Taylor:
    c: list[Any] = []
    for k in range(TERMS):
        c.append((a.c[k] - sum(c[j] * b.c[k - j] for j in range(k))) / b.c[0])
    return Taylor(np.array(c))


def _solution(
    value: Callable[[Floats], Floats], slope: Callable[[Taylor, Taylor], Taylor], x: Taylor
) -> Taylor:
    """y(x) with y′ = slope(x, y): each round is right in one coefficient more."""
    y = Taylor(np.zeros_like(x.c))
    y.c[0] = value(x.c[0])
    for k in range(1, TERMS):
        g = slope(x, y).c
        y.c[k] = sum(j * x.c[j] * g[k - j] for j in range(1, k + 1)) / k
    return y


def _power(a: Taylor, b: Taylor) -> Taylor:
    """Constant powers, whole ones by products; others by exp and log."""
    if (b.c[1:] == 0).all() and np.ptp(b.c[0]) == 0:
        exponent = float(b.c[0].flat[0])
        if exponent == int(exponent) and 0 <= exponent <= 64:
            power = a._like(1.0)
            for _ in range(int(exponent)):
                power = _product(power, a)
            return power
        # x y′ = p y
        return _solution(lambda v: v**exponent, lambda x, y: _quotient(_product(b, y), x), a)
    return _exp(_product(b, _log(a)))


def _exp(x: Taylor) -> Taylor:
    return _solution(np.exp, lambda _, y: y, x)


def _log(x: Taylor) -> Taylor:
    return _solution(np.log, lambda x, _: _quotient(x._like(1.0), x), x)


def _sqrt(x: Taylor) -> Taylor:
    return _power(x, x._like(0.5))


def _sine(x: Taylor, shift: float) -> Taylor:
    """sin(x + shift): its derivatives by x are shifts by a quarter revolution."""
    d = [np.sin(x.c[0] + shift + 0.5 * np.pi * k) for k in range(TERMS)]
    c1, c2, c3 = x.c[1:]
    return Taylor(
        np.array(
            [d[0], d[1] * c1, d[1] * c2 + d[2] * c1**2 / 2, d[1] * c3 + d[2] * c1 * c2 + d[3] * c1**3 / 6]
        )
    )


def _one_minus_square(_: Taylor, y: Taylor) -> Taylor:
    return Taylor(y._like(1.0).c - _product(y, y).c)


def _one_plus_square(x: Taylor) -> Taylor:
    return Taylor(x._like(1.0).c + _product(x, x).c)


def _arcsine_slope(x: Taylor, _: Taylor) -> Taylor:
    return _quotient(x._like(1.0), _sqrt(_one_minus_square(x, x)))


def _absolute(x: Taylor) -> Taylor:
    return Taylor(np.where(x.c[0] < 0, -x.c, x.c))


def _hyperbolic(x: Taylor, sign: float) -> Taylor:
    return Taylor(0.5 * (_exp(x).c + sign * _exp(-x).c))


_COMPARISONS = (np.less, np.less_equal, np.greater, np.greater_equal, np.equal, np.not_equal)

_RULES: dict[Any, Callable[..., Taylor]] = {
    np.add: lambda a, b: Taylor(a.c + b.c),
    np.subtract: lambda a, b: Taylor(a.c - b.c),
    np.multiply: _product,
    np.divide: _quotient,
    np.negative: lambda a: Taylor(-a.c),
    np.positive: lambda a: a,
    np.power: _power,
    np.float_power: _power,
    np.square: lambda a: _product(a, a),
    np.sqrt: _sqrt,
    np.exp: _exp,
    np.log: _log,
    np.sin: lambda x: _sine(x, 0.0),
    np.cos: lambda x: _sine(x, 0.5 * np.pi),
    np.tan: lambda x: _solution(np.tan, lambda _, y: _one_plus_square(y), x),
    np.tanh: lambda x: _solution(np.tanh, _one_minus_square, x),
    np.sinh: lambda x: _hyperbolic(x, -1.0),
    np.cosh: lambda x: _hyperbolic(x, 1.0),
    np.arctan: lambda x: _solution(np.arctan, lambda x, _: _quotient(x._like(1.0), _one_plus_square(x)), x),
    np.arcsin: lambda x: _solution(np.arcsin, _arcsine_slope, x),
    np.arccos: lambda x: _solution(np.arccos, lambda x, y: -_arcsine_slope(x, y), x),
    np.absolute: _absolute,
    np.maximum: lambda a, b: Taylor(np.where(a.c[0] >= b.c[0], a.c, b.c)),
    np.minimum: lambda a, b: Taylor(np.where(a.c[0] <= b.c[0], a.c, b.c)),
}
