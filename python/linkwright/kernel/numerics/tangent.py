"""A number with its derivatives by several variables, which follows the arithmetic of a description.

A description is translated by plain arithmetic on its entries; an entry that is a `Tangent` carries its
derivatives through it, f(a + b ε) = f(a) + f′(a) b ε. What has no rule here is refused: a derivative is never
dropped on the way.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.arrays import Floats


class Tangent:
    """A value and its derivatives by n variables.

    Parameters
    ----------
    value : float
        The number.
    d : ndarray, shape (n,)
        Its derivatives.
    """

    __slots__ = ("d", "value")

    def __init__(self, value: float, d: Floats) -> None:
        self.value, self.d = float(value), d

    def __repr__(self) -> str:
        return f"Tangent({self.value!r}, {self.d!r})"

    # Comparisons and signs look at the value alone.
    def __bool__(self) -> bool:
        return bool(self.value)

    def __eq__(self, other: object) -> bool:
        return bool(self.value == primal(other))

    def __lt__(self, other: Any) -> bool:
        return bool(self.value < primal(other))

    def __le__(self, other: Any) -> bool:
        return bool(self.value <= primal(other))

    def __gt__(self, other: Any) -> bool:
        return bool(self.value > primal(other))

    def __ge__(self, other: Any) -> bool:
        return bool(self.value >= primal(other))

    __hash__ = None  # type: ignore[assignment]

    def __neg__(self) -> Tangent:
        return Tangent(-self.value, -self.d)

    def __pos__(self) -> Tangent:
        return self

    def __abs__(self) -> Tangent:
        return -self if self.value < 0 else self

    def __add__(self, other: Any) -> Any:
        if _is_array(other):
            return NotImplemented
        if isinstance(other, Tangent):
            return Tangent(self.value + other.value, self.d + other.d)
        return Tangent(self.value + other, self.d)

    __radd__ = __add__

    def __sub__(self, other: Any) -> Any:
        return self.__add__(-other)

    def __rsub__(self, other: Any) -> Any:
        return (-self).__add__(other)

    def __mul__(self, other: Any) -> Any:
        if _is_array(other):
            return NotImplemented
        if isinstance(other, Tangent):
            return Tangent(self.value * other.value, self.d * other.value + self.value * other.d)
        return Tangent(self.value * other, self.d * float(other))

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Any:
        if _is_array(other):
            return NotImplemented
        return self.__mul__(other.reciprocal() if isinstance(other, Tangent) else 1.0 / other)

    def __rtruediv__(self, other: Any) -> Any:
        return self.reciprocal().__mul__(other)

    def __pow__(self, power: Any) -> Any:
        if _is_array(power):
            return NotImplemented
        if isinstance(power, Tangent):
            return power.__mul__(self.log()).exp()
        return self._by(self.value**power, power * self.value ** (power - 1) if power else 0.0)

    def __rpow__(self, base: Any) -> Any:
        return self.__mul__(math.log(base)).exp()

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **options: Any) -> Any:
        """NumPy's functions of numbers; element by element where an array takes part."""
        if any(
            hasattr(value, "__array_function__") and not isinstance(value, np.ndarray) for value in inputs
        ):
            # Arrays of tangents know what to do.
            return NotImplemented
        rule = _RULES.get(ufunc.__name__)
        if rule is None or method != "__call__" or options:
            raise TypeError(f"no derivative of numpy.{ufunc.__name__}")
        if not any(np.ndim(value) for value in inputs if not isinstance(value, Tangent)):
            return rule(*inputs)
        arrays = [_held(value) if isinstance(value, Tangent) else np.asarray(value) for value in inputs]
        return np.vectorize(rule, otypes=[object])(*arrays)

    def _by(self, value: float, slope: float) -> Tangent:
        """A function of the number, by its value and its slope."""
        return Tangent(value, slope * self.d)

    def reciprocal(self) -> Tangent:
        """1/x."""
        inverse = 1.0 / self.value
        return self._by(inverse, -inverse * inverse)

    def sqrt(self) -> Tangent:
        """√x."""
        root = math.sqrt(self.value)
        return self._by(root, 0.5 / root)

    def exp(self) -> Tangent:
        """eˣ."""
        e = math.exp(self.value)
        return self._by(e, e)

    def log(self) -> Tangent:
        """ln x."""
        return self._by(math.log(self.value), 1.0 / self.value)

    def sin(self) -> Tangent:
        """sin x."""
        return self._by(math.sin(self.value), math.cos(self.value))

    def cos(self) -> Tangent:
        """cos x."""
        return self._by(math.cos(self.value), -math.sin(self.value))

    def tan(self) -> Tangent:
        """tan x."""
        return self._by(math.tan(self.value), 1.0 / math.cos(self.value) ** 2)

    def arcsin(self) -> Tangent:
        """arcsin x."""
        return self._by(math.asin(self.value), 1.0 / math.sqrt(1.0 - self.value**2))

    def arccos(self) -> Tangent:
        """arccos x."""
        return self._by(math.acos(self.value), -1.0 / math.sqrt(1.0 - self.value**2))

    def arctan(self) -> Tangent:
        """arctan x."""
        return self._by(math.atan(self.value), 1.0 / (1.0 + self.value**2))


def _is_array(x: Any) -> bool:
    """Whether an array works out what it makes with a number."""
    return hasattr(x, "__array_ufunc__") and not isinstance(x, Tangent | np.generic)


def primal(x: Any) -> Any:
    """The number alone, where derivatives have no part: starting points, sides, windings."""
    return x.value if isinstance(x, Tangent) else x


def total(terms: Iterable[Any]) -> Any:
    """The sum, rounded once; with derivatives if a term has them."""
    listed = list(terms)
    value, slopes = math.fsum(map(primal, listed)), [x.d for x in listed if isinstance(x, Tangent)]
    return Tangent(value, np.sum(slopes, axis=0)) if slopes else value


def moves(x: Any) -> bool:
    """Whether a number is other than zero, or does not stay zero."""
    return bool(x) or (isinstance(x, Tangent) and bool(np.any(x.d)))


def sqrt(x: Any) -> Any:
    """√x of a number or a tangent."""
    return x.sqrt() if isinstance(x, Tangent) else math.sqrt(x)


def sin(x: Any) -> Any:
    """sin x of a number or a tangent."""
    return x.sin() if isinstance(x, Tangent) else math.sin(x)


def cos(x: Any) -> Any:
    """cos x of a number or a tangent."""
    return x.cos() if isinstance(x, Tangent) else math.cos(x)


def _held(x: Tangent) -> NDArray[Any]:
    """The number as an array of one object."""
    array = np.empty((), dtype=object)
    array[()] = x
    return array


def _arctan2(y: Any, x: Any) -> Any:
    """Angle of (x, y): dψ = (x dy − y dx)/(x² + y²)."""
    a, b = float(primal(y)), float(primal(x))
    square = a * a + b * b
    return math.atan2(a, b) + (y * (b / square) - a * b / square) - (x * (a / square) - a * b / square)


def _of_one(name: str) -> Callable[[Any], Any]:
    return lambda x: getattr(x, name)() if isinstance(x, Tangent) else getattr(np, name)(x)


_RULES: dict[str, Callable[..., Any]] = {
    name: _of_one(name)
    for name in ("sqrt", "exp", "log", "sin", "cos", "tan", "arcsin", "arccos", "arctan", "reciprocal")
} | {
    "add": lambda x, y: y + x if isinstance(y, Tangent) else x + y,
    "subtract": lambda x, y: -y + x if isinstance(y, Tangent) else x - y,
    "multiply": lambda x, y: y * x if isinstance(y, Tangent) else x * y,
    "divide": lambda x, y: y.reciprocal() * x if isinstance(y, Tangent) else x / y,
    "power": lambda x, y: x**y,
    "square": lambda x: x * x,
    "negative": lambda x: -x,
    "absolute": abs,
    "hypot": lambda x, y: (x * x + y * y) ** 0.5,
    "arctan2": _arctan2,
    "remainder": lambda x, y: x - math.floor(primal(x) / primal(y)) * y,
    "deg2rad": lambda x: x * (math.pi / 180),
    "rad2deg": lambda x: x * (180 / math.pi),
    "radians": lambda x: x * (math.pi / 180),
    "degrees": lambda x: x * (180 / math.pi),
    "maximum": lambda x, y: y if primal(y) > primal(x) else x,
    "minimum": lambda x, y: y if primal(y) < primal(x) else x,
    "sign": lambda x: float(np.sign(primal(x))),
    "less": lambda x, y: primal(x) < primal(y),
    "less_equal": lambda x, y: primal(x) <= primal(y),
    "greater": lambda x, y: primal(x) > primal(y),
    "greater_equal": lambda x, y: primal(x) >= primal(y),
    "equal": lambda x, y: primal(x) == primal(y),
    "not_equal": lambda x, y: primal(x) != primal(y),
    "isfinite": lambda x: math.isfinite(primal(x)),
    "isnan": lambda x: math.isnan(primal(x)),
}
