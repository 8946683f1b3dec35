"""Numbers and arrays with their derivatives by several variables, which follow the rules of arithmetic.

What is worked out of such numbers comes out with its derivatives, f(a + b ε) = f(a) + f′(a) b ε, of all
variables at once; a number is an array of shape (). A description is translated by plain arithmetic on its
entries: an entry that is a `Tangent` carries its derivatives through it. Comparisons look at the values
alone. What has no rule here is refused: a derivative is never dropped on the way.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from linkwright.kernel.arrays import Floats


class Tangent:
    """Values and their derivatives by n variables.

    Parameters
    ----------
    value : float, or ndarray, shape (…)
        The numbers.
    d : ndarray, shape (…, n)
        Their derivatives.
    """

    __slots__ = ("d", "value")
    __hash__ = None  # type: ignore[assignment]

    if TYPE_CHECKING:
        # Operators are made below.
        def __abs__(self) -> Any: ...
        def __neg__(self) -> Any: ...
        def __add__(self, other: Any) -> Any: ...
        def __sub__(self, other: Any) -> Any: ...
        def __mul__(self, other: Any) -> Any: ...
        def __truediv__(self, other: Any) -> Any: ...
        def __pow__(self, other: Any) -> Any: ...
        def __lt__(self, other: Any) -> Any: ...

        __radd__, __rsub__, __rmul__, __rtruediv__, __rpow__ = __add__, __sub__, __mul__, __truediv__, __pow__

    def __init__(self, value: Any, d: Any) -> None:
        # One number stays a number: most of a description is.
        self.value: Any = value if type(value) is float else _of_value(value)
        self.d = np.asarray(d)

    # -- an array like any other -------------------------------------------------------------------------

    @property
    def shape(self) -> tuple[int, ...]:
        """Of the values."""
        return self.d.shape[:-1]

    @property
    def ndim(self) -> int:
        """Of the values."""
        return self.d.ndim - 1

    @property
    def size(self) -> int:
        """How many values."""
        return math.prod(self.shape)

    @property
    def T(self) -> Tangent:
        """The axes in reverse."""
        return Tangent(self.value.T, self.d.transpose(*range(self.ndim - 1, -1, -1), self.ndim))

    @property
    def real(self) -> Tangent:
        """Real parts."""
        return Tangent(self.value.real, self.d.real)

    @property
    def imag(self) -> Tangent:
        """Imaginary parts."""
        return Tangent(self.value.imag, self.d.imag)

    def conj(self) -> Tangent:
        """Complex conjugates."""
        return Tangent(np.conj(self.value), np.conj(self.d))

    def __len__(self) -> int:
        return len(self.value)

    def __repr__(self) -> str:
        return f"Tangent({self.value!r}, {self.d!r})"

    def __getitem__(self, key: Any) -> Tangent:
        return Tangent(self.value[key], self.d[_with_lanes(key)])

    def __setitem__(self, key: Any, new: Any) -> None:
        if not isinstance(new, Tangent) and _is_simple(new):
            self.value[key], self.d[_with_lanes(key)] = new, 0.0
            return
        new = _lifted(new, self.d.shape[-1])
        self.value[key], self.d[_with_lanes(key)] = new.value, new.d

    def __pos__(self) -> Tangent:
        return self

    def __bool__(self) -> bool:
        return bool(self.value)

    def __array__(self, *_: Any, **__: Any) -> Any:
        """Refuse to become an array without derivatives."""
        raise TypeError("an array with derivatives does not become one without")

    def copy(self) -> Tangent:
        """A copy of values and derivatives."""
        return Tangent(self.value if type(self.value) is float else self.value.copy(), self.d.copy())

    def reshape(self, *shape: Any) -> Tangent:
        """The same numbers in another shape."""
        value = np.reshape(self.value, shape[0] if isinstance(shape[0], tuple) else shape)
        return Tangent(value, self.d.reshape((*np.shape(value), self.d.shape[-1])))

    def mean(self) -> Tangent:
        """Mean of all values."""
        total: Any = self.sum()
        mean: Tangent = total / self.size
        return mean

    def sum(self, axis: int | None = None) -> Tangent:
        """Sum over an axis or all."""
        axes = tuple(range(self.ndim)) if axis is None else (axis % self.ndim,)
        return Tangent(np.sum(self.value, axis=axes), self.d.sum(axis=axes))

    def max(self) -> float:
        """The largest value."""
        return float(np.max(self.value))

    def min(self) -> float:
        """The smallest value."""
        return float(np.min(self.value))

    # -- arithmetic --------------------------------------------------------------------------------------

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **options: Any) -> Any:
        """NumPy's functions of numbers."""
        if method == "at" and ufunc is np.add:
            array, key, more = inputs
            more = _lifted(more, array.d.shape[-1])
            np.add.at(array.value, key, more.value)
            return np.add.at(array.d, _with_lanes(key), more.d)
        if method != "__call__" or options:
            raise TypeError(f"no derivative of numpy.{ufunc.__name__} with {method} and {sorted(options)}")
        own = _OWN_RULES.get(ufunc)
        if own is not None and all(map(_is_simple, inputs)):
            result = own(*inputs)
            if result is not None:
                return result
        if ufunc.__name__ in _OF_VALUES:
            return ufunc(*(primal(_simple(x, self.d.shape[-1])) for x in inputs))
        arrays = [_lifted(x, self.d.shape[-1]) for x in inputs]
        values = [np.asarray(x.value) for x in arrays]
        if len(inputs) == 1 and ufunc.__name__ in _SLOPES:
            value, slope = _SLOPES[ufunc.__name__](values[0])
            return Tangent(value, _times(slope, arrays[0].d))
        if len(inputs) == 2 and ufunc.__name__ in _SLOPES_OF_TWO:
            value, *slopes = _SLOPES_OF_TWO[ufunc.__name__](*values)
            d = _times(slopes[0], arrays[0].d) + _times(slopes[1], arrays[1].d)
            if ufunc.__name__ in _CHOICES:
                first, second = (x.d for x in arrays)
                d = np.where(np.equal(*values)[..., None] & (first == second), first, d)
            return Tangent(value, np.broadcast_to(d, (*np.shape(value), self.d.shape[-1])))
        raise TypeError(f"no derivative of numpy.{ufunc.__name__}")

    def __array_function__(self, function: Any, types: Any, inputs: Any, options: Any) -> Any:
        """NumPy's functions of arrays."""
        rule = _FUNCTIONS.get(function)
        if rule is None:
            raise TypeError(f"no derivative of numpy.{function.__name__}")
        return rule(*inputs, **options)


def _of_value(value: Any) -> Any:
    """The values; of one real number a float."""
    value = np.asarray(value)
    return value if value.ndim else value.item() if value.dtype.kind == "c" else float(value)


def _lane(x: Any) -> Any:
    """Values along the axis of the variables."""
    return x[..., None] if isinstance(x, np.ndarray) else x


def _times(slope: Any, d: Floats) -> Any:
    """A slope times derivatives; where these are zero it need not exist."""
    slope = _lane(slope)
    if _is_finite(slope):
        return slope * d
    with np.errstate(invalid="ignore"):
        return np.where(d == 0.0, 0.0, slope * d)


def _is_finite(x: Any) -> bool:
    """Whether all numbers are finite; not where their squares overflow, which costs time alone."""
    return math.isfinite(x if isinstance(x, float | int) else np.vdot(x, x).real)


def _is_simple(x: Any) -> bool:
    """Whether a number or an array has derivatives in one array, or none."""
    return type(x) in _SIMPLE or (isinstance(x, np.ndarray) and x.dtype != object)


# Rules for what is worked out most, without a general rule; None where a slope does not exist.


def _sum(x: Any, y: Any) -> Tangent:
    """x + y, of which one has derivatives."""
    if not isinstance(y, Tangent):
        return _with_shape(x.value + y, x.d, x)
    if not isinstance(x, Tangent):
        return _with_shape(x + y.value, y.d, y)
    return _with_shape(x.value + y.value, x.d + y.d)


def _difference(x: Any, y: Any) -> Tangent:
    """x − y, of which one has derivatives."""
    if not isinstance(y, Tangent):
        return _with_shape(x.value - y, x.d, x)
    if not isinstance(x, Tangent):
        return _with_shape(x - y.value, -y.d)
    return _with_shape(x.value - y.value, x.d - y.d)


def _with_shape(value: Any, d: Floats, of: Tangent | None = None) -> Tangent:
    """Values with derivatives that are the same along the axes that they lack.

    Those of another array are shared with it: neither copied, nor changed through the second.
    """
    if type(value) is float:
        return Tangent(value, d)
    shape = (*np.shape(value), d.shape[-1])
    if d.shape != shape:
        return Tangent(value, np.broadcast_to(d, shape))
    if of is not None:
        d = d.view()
        d.flags.writeable = False
    return Tangent(value, d)


def _product(x: Any, y: Any) -> Tangent | None:
    """x·y, of which one has derivatives."""
    if not isinstance(y, Tangent):
        return _scaled(x, y)
    if not isinstance(x, Tangent):
        return _scaled(y, x)
    value = x.value * y.value
    # A finite product has finite factors.
    if not _is_finite(value):
        return None
    d = _lane(y.value) * x.d
    d += _lane(x.value) * y.d
    return Tangent(value, d)


def _scaled(x: Tangent, factor: Any) -> Tangent | None:
    """An array times a factor without derivatives."""
    if not _is_finite(factor):
        return None
    return Tangent(x.value * factor, _lane(factor) * x.d)


def _quotient(x: Any, y: Any) -> Tangent | None:
    """x/y, of which one has derivatives."""
    value = primal(x) / primal(y)
    if not _is_finite(value):
        return None
    below = _lane(primal(y))
    if not isinstance(y, Tangent):
        return Tangent(value, x.d / below)
    change = _lane(value) * y.d
    change = x.d - change if isinstance(x, Tangent) else -change
    return Tangent(value, change / below)


def _to_power(x: Any, power: Any) -> Tangent | None:
    """xᵖ with a number p from 1 up, or 0, whose slope exists everywhere."""
    if type(power) not in (int, float) or (power < 1 and power != 0):
        return None
    if power % 1 and type(x.value) is float and x.value < 0:
        return None
    value = x.value**power
    return Tangent(value, _times(power * x.value ** (power - 1) if power else 0.0, x.d))


def _negative(x: Tangent) -> Tangent:
    return Tangent(-x.value, -x.d)


_SIMPLE = {Tangent, float, int, np.float64}

_OWN_RULES: dict[Any, Callable[..., Tangent | None]] = {
    np.add: _sum,
    np.subtract: _difference,
    np.multiply: _product,
    np.divide: _quotient,
    np.power: _to_power,
    np.negative: _negative,
}


def _operator(ufunc: Any, *, turned: bool = False) -> Callable[..., Any]:
    own = _OWN_RULES.get(ufunc)

    def apply(self: Tangent, *others: Any) -> Any:
        inputs = (*others, self) if turned else (self, *others)
        if own is not None and (not others or _is_simple(others[0])):
            result = own(*inputs)
            if result is not None:
                return result
        return self.__array_ufunc__(ufunc, "__call__", *inputs)

    return apply


def _comparison(of_values: Callable[[Any, Any], Any]) -> Callable[[Tangent, Any], Any]:
    return lambda self, other: of_values(self.value, primal(other))


_OPERATORS = {"add": np.add, "sub": np.subtract, "mul": np.multiply, "truediv": np.divide, "pow": np.power}
for _name, _ufunc in (_OPERATORS | {"neg": np.negative, "abs": np.absolute}).items():
    setattr(Tangent, f"__{_name}__", _operator(_ufunc))
for _name, _ufunc in _OPERATORS.items():
    setattr(Tangent, f"__r{_name}__", _operator(_ufunc, turned=True))
for _name in ("lt", "le", "gt", "ge", "eq", "ne"):
    setattr(Tangent, f"__{_name}__", _comparison(getattr(operator, _name)))


def plain(x: Any) -> Any:
    """One number of arrays as a number, with its derivatives if it has some."""
    return x if isinstance(x, Tangent) else float(x)


def primal(x: Any) -> Any:
    """The numbers alone, where derivatives have no part: starting points, sides, windings."""
    return x.value if isinstance(x, Tangent) else x


def total(terms: Iterable[Any]) -> Any:
    """The sum of numbers, rounded once; with derivatives if a term has them."""
    listed = list(terms)
    value, slopes = math.fsum(map(primal, listed)), [x.d for x in listed if isinstance(x, Tangent)]
    return Tangent(value, np.sum(slopes, axis=0)) if slopes else value


def moves(x: Any) -> bool:
    """Whether a number is other than zero, or does not stay zero."""
    return bool(x) or (isinstance(x, Tangent) and bool(np.any(x.d)))


def sqrt(x: Any) -> Any:
    """√x of a number or a tangent."""
    return np.sqrt(x) if isinstance(x, Tangent) else math.sqrt(x)


def sin(x: Any) -> Any:
    """sin x of a number or a tangent."""
    return np.sin(x) if isinstance(x, Tangent) else math.sin(x)


def cos(x: Any) -> Any:
    """cos x of a number or a tangent."""
    return np.cos(x) if isinstance(x, Tangent) else math.cos(x)


def tan(x: Any) -> Any:
    """Tangent of an angle that is a number or a tangent."""
    return np.tan(x) if isinstance(x, Tangent) else math.tan(x)


def variables_of(numbers: Iterable[Any]) -> int | None:
    """By how many variables numbers have derivatives; None if none has any."""
    return next((x.d.shape[-1] for x in numbers if isinstance(x, Tangent)), None)


def numbers(listed: Sequence[Any]) -> Any:
    """A list of numbers as an array, with derivatives if one of them has some."""
    n = variables_of(listed)
    return np.asarray(listed) if n is None else _row(listed, n)


def zeros_for(numbers: Iterable[Any], shape: tuple[int, ...], dtype: Any = float) -> Any:
    """Zeros that numbers are added to, with derivatives if one of these has some."""
    n, zeros = variables_of(numbers), np.zeros(shape, dtype)
    return zeros if n is None else Tangent(zeros, np.zeros((*shape, n), dtype))


def on_lines(x: Any, places: Sequence[Any], values: Sequence[Any], period: float | None = None) -> Any:
    """Straight lines between points, which may have derivatives, as `numpy.interp` has them."""
    return np.interp(x, numbers(places), numbers(values), period=period)


def lifted(x: Any, n: int) -> Tangent:
    """A number or an array, with derivatives or without, as an array with derivatives by n variables."""
    return _lifted(x, n).copy()


def _lifted(x: Any, n: int) -> Tangent:
    """The same; what has no derivatives shares its memory."""
    if isinstance(x, Tangent):
        return x
    values = np.asarray(x)
    if values.dtype != object:
        return Tangent(values, np.broadcast_to(0.0, (*values.shape, n)))
    numbers = [_lifted(entry, n) for entry in values.ravel().tolist()]
    value = np.array([entry.value for entry in numbers], dtype=float).reshape(values.shape)
    return Tangent(value, np.array([entry.d for entry in numbers]).reshape((*values.shape, n)))


def _simple(x: Any, n: int) -> Any:
    """A number or an array with derivatives in one array, or none."""
    return x if _is_simple(x) else _lifted(x, n)


def _with_lanes(key: Any) -> Any:
    """An index of the values as one of the derivatives, whose last axis is that of the variables."""
    for entry in key if isinstance(key, tuple) else (key,):
        if entry is Ellipsis:
            return (*key, slice(None)) if isinstance(key, tuple) else (key, slice(None))
    return key


def _lanes(arrays: Sequence[Any]) -> int:
    return int(next(x.d.shape[-1] for x in arrays if isinstance(x, Tangent)))


_OF_VALUES = {
    *("less", "less_equal", "greater", "greater_equal", "equal", "not_equal"),
    *("isfinite", "isnan", "sign", "floor"),
}


def _inverse(x: Floats) -> Floats:
    return np.asarray(1.0 / x)


# Value and slope of functions of one number.
_SLOPES: dict[str, Callable[[Floats], tuple[Any, Any]]] = {
    "negative": lambda x: (-x, np.full_like(x, -1.0, dtype=float)),
    # At zero it has none.
    "absolute": lambda x: (np.abs(x), np.where(x == 0, np.nan, np.sign(x))),
    "sqrt": lambda x: (np.sqrt(x), 0.5 / np.sqrt(x)),
    "reciprocal": lambda x: (1.0 / x, -1.0 / (x * x)),
    "deg2rad": lambda x: (np.deg2rad(x), np.full_like(x, math.pi / 180)),
    "rad2deg": lambda x: (np.rad2deg(x), np.full_like(x, 180 / math.pi)),
    "square": lambda x: (x * x, 2.0 * x),
    "exp": lambda x: (np.exp(x), np.exp(x)),
    "log": lambda x: (np.log(x), _inverse(x)),
    "sin": lambda x: (np.sin(x), np.cos(x)),
    "cos": lambda x: (np.cos(x), -np.sin(x)),
    "tan": lambda x: (np.tan(x), 1.0 / np.cos(x) ** 2),
    "tanh": lambda x: (np.tanh(x), 1.0 - np.tanh(x) ** 2),
    "arcsin": lambda x: (np.arcsin(x), 1.0 / np.sqrt(1.0 - x * x)),
    "arccos": lambda x: (np.arccos(x), -1.0 / np.sqrt(1.0 - x * x)),
    "arctan": lambda x: (np.arctan(x), 1.0 / (1.0 + x * x)),
}


def _hypot(x: Floats, y: Floats) -> tuple[Any, Any, Any]:
    """Where both vanish the length has no derivative."""
    r = np.hypot(x, y)
    with np.errstate(invalid="ignore", divide="ignore"):
        return r, x / r, y / r


def _power(x: Floats, p: Floats) -> tuple[Any, Any, Any]:
    """By the power it has a slope where the base is not negative."""
    with np.errstate(invalid="ignore", divide="ignore"):
        by_power = np.where(
            x > 0, np.power(x, p) * np.log(np.where(x > 0, x, 1.0)), np.where(x < 0, np.nan, 0.0)
        )
        return np.power(x, p), p * np.power(x, p - 1.0), by_power


def _chosen(pick: Callable[[Floats, Floats], Any]) -> Callable[[Floats, Floats], tuple[Any, Any, Any]]:
    """The larger or the smaller; where both are equal there is a derivative if theirs are equal too."""

    def rule(x: Floats, y: Floats) -> tuple[Any, Any, Any]:
        first = np.where(x == y, np.nan, (pick(x, y) == x).astype(float))
        return pick(x, y), first, 1.0 - first

    return rule


_CHOICES = ("maximum", "minimum")

# Value and both slopes of functions of two numbers.
_SLOPES_OF_TWO: dict[str, Callable[[Floats, Floats], tuple[Any, Any, Any]]] = {
    "add": lambda x, y: (x + y, np.ones_like(x), np.ones_like(y)),
    "subtract": lambda x, y: (x - y, np.ones_like(x), -np.ones_like(y, dtype=float)),
    "multiply": lambda x, y: (x * y, y, x),
    "divide": lambda x, y: (x / y, 1.0 / y, -x / y / y),
    "power": _power,
    "hypot": _hypot,
    "arctan2": lambda y, x: (np.arctan2(y, x), x / (x * x + y * y), -y / (x * x + y * y)),
    "maximum": _chosen(np.maximum),
    "minimum": _chosen(np.minimum),
    "remainder": lambda x, y: (np.mod(x, y), np.ones_like(x), -np.floor(x / y)),
}


def _joining(function: Callable[..., Any]) -> Callable[..., Tangent]:
    """A function of NumPy that joins arrays along an axis, for arrays with derivatives."""

    def joined(arrays: Sequence[Any], axis: int = 0) -> Tangent:
        n = _lanes(arrays)
        listed = [_lifted(x, n) for x in arrays]
        place = axis if axis >= 0 else axis - 1
        return Tangent(
            function([x.value for x in listed], axis=axis), function([x.d for x in listed], axis=place)
        )

    return joined


_stack, _concatenate = _joining(np.stack), _joining(np.concatenate)


def _where(condition: Any, first: Any, second: Any) -> Tangent:
    n = _lanes((first, second))
    x, y = _lifted(first, n), _lifted(second, n)
    return Tangent(
        np.where(condition, x.value, y.value), np.where(np.asarray(condition)[..., None], x.d, y.d)
    )


def _einsum(subscripts: str, *arrays: Any) -> Tangent:
    """The product rule; the letter z is that of the variables."""
    simple = [_simple(x, _lanes(arrays)) for x in arrays]
    values = [primal(x) for x in simple]
    names, out = subscripts.split("->")
    terms = names.split(",")
    d: Any = 0.0
    for k, array in enumerate(simple):
        if isinstance(array, Tangent):
            parts = [name + "z" if k == i else name for i, name in enumerate(terms)]
            d = d + np.einsum(f"{','.join(parts)}->{out}z", *values[:k], array.d, *values[k + 1 :])
    return Tangent(np.einsum(subscripts, *values), d)


def _interp(x: Any, knots: Any, heights: Any, period: float | None = None) -> Tangent:
    """Straight lines between knots; at a knot where they meet at an angle there is no derivative."""
    n = _lanes([x, *knots, *heights])
    at: Any = _lifted(x, n)
    xp: Any = _row(knots, n)
    fp: Any = _row(heights, n)
    if period is not None:
        at = np.remainder(at, period)
        order = np.argsort(np.mod(xp.value, period))
        xp, fp = np.remainder(xp, period)[order], fp[order]
        xp, fp = _concatenate([xp[-1:] - period, xp, xp[:1] + period]), _concatenate([fp[-1:], fp, fp[:1]])
    # Before the first knot and behind the last it is level.
    span = np.where(np.diff(xp.value) > 0, np.diff(xp.value), np.nan)
    slopes = np.concatenate([[0.0], np.diff(fp.value) / span, [0.0]])
    left, right = (np.searchsorted(xp.value, at.value, side=side) for side in ("left", "right"))
    i = np.clip(right - 1, 0, len(xp) - 2)
    share = (at - xp[i]) / (xp[i + 1] - xp[i])
    between = fp[i] + (fp[i + 1] - fp[i]) * share
    outside = _where(right == 0, fp[np.zeros_like(i)], fp[np.full_like(i, len(fp) - 1)])
    result = _where((right == 0) | (right == len(xp)), outside, between)
    corner = _times(np.where(slopes[left] == slopes[right], 0.0, np.nan), at.d - xp[i].d)
    return Tangent(result.value, result.d + corner)


def _row(numbers: Any, n: int) -> Tangent:
    """A list of numbers as an array."""
    return numbers if isinstance(numbers, Tangent) else _stack([*map(partial(_lifted, n=n), numbers)])


def _as_rows(*arrays: Any) -> Any:
    """Arrays of two axes at least."""
    n = _lanes(arrays)
    rows = [_lifted(x, n) for x in arrays]
    rows = [x if x.ndim > 1 else x.reshape(1, -1) for x in rows]
    return rows[0] if len(rows) == 1 else rows


def _like(of_values: Callable[..., Any]) -> Callable[..., Any]:
    return lambda x, *others, **options: of_values(x.value, *others, **options)


_FUNCTIONS: dict[Any, Callable[..., Any]] = {
    np.stack: _stack,
    np.concatenate: _concatenate,
    np.where: _where,
    np.einsum: _einsum,
    np.interp: _interp,
    np.clip: lambda x, low, high: np.minimum(np.maximum(x, low), high),
    np.sum: lambda x, axis=None: (
        x.sum(axis) if isinstance(x, Tangent) else _stack(list(x)).sum(0 if axis is None else axis)
    ),
    np.moveaxis: lambda x, source, to: Tangent(
        np.moveaxis(x.value, source, to),
        np.moveaxis(x.d, source % x.ndim, to % x.ndim),
    ),
    np.swapaxes: lambda x, one, other: Tangent(
        np.swapaxes(x.value, one, other), np.swapaxes(x.d, one % x.ndim, other % x.ndim)
    ),
    np.unwrap: lambda x: Tangent(np.unwrap(x.value), x.d),
    np.broadcast_to: lambda x, shape: Tangent(
        np.broadcast_to(x.value, shape), np.broadcast_to(x.d, (*shape, x.d.shape[-1]))
    ),
    np.atleast_1d: lambda x: x if x.ndim else x.reshape(1),
    np.atleast_2d: lambda *arrays: _as_rows(*arrays),
    np.cumsum: lambda x: Tangent(np.cumsum(x.value), np.cumsum(x.d, axis=0)),
    np.shape: lambda x: x.shape,
    np.ndim: lambda x: x.ndim,
    np.zeros_like: _like(np.zeros_like),
    np.ones_like: _like(np.ones_like),
    np.full_like: _like(np.full_like),
    np.argmax: _like(np.argmax),
    np.argmin: _like(np.argmin),
    np.nanargmax: _like(np.nanargmax),
    np.nanargmin: _like(np.nanargmin),
    np.nanmax: lambda x: x.reshape(-1)[int(np.nanargmax(x.value))],
}
