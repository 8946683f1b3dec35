"""A function y(x) given as text, read as an expression and nothing else, on the scales of crank and rocker.

Allowed: numbers, ``x``, ``pi``, ``e``, + − * / and powers (``^`` or ``**``), parentheses, and the functions
of `FUNCTIONS`. Angles are in proportion to x and y,

    φ = φ₀ + Δφ (x − x₀)/(x_n − x₀)          ψ = ψ₀ + Δψ (y − y₀)/(y_n − y₀)

Source: Hartenberg, Denavit, Kinematic Synthesis of Linkages, 1964.
"""

from __future__ import annotations

import ast
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import close_match
from linkwright.kernel.errors import InputError, show
from linkwright.synthesis.task import FunctionTask

FUNCTIONS: dict[str, Callable[[Any], Any]] = {
    "sin": np.sin,
    "cos": np.cos,
    "tan": np.tan,
    "asin": np.arcsin,
    "acos": np.arccos,
    "atan": np.arctan,
    "sinh": np.sinh,
    "cosh": np.cosh,
    "tanh": np.tanh,
    "exp": np.exp,
    "log": np.log,
    "ln": np.log,
    "log10": np.log10,
    "sqrt": np.sqrt,
    "abs": np.abs,
}
_CONSTANTS = {"pi": np.pi, "e": np.e}
_BINARY: dict[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: np.add,
    ast.Sub: np.subtract,
    ast.Mult: np.multiply,
    ast.Div: np.divide,
    ast.Pow: np.power,
    # Mathematicians write ^ for a power; Python reads it as another operator.
    ast.BitXor: np.power,
}
_UNARY: dict[type[ast.unaryop], Callable[[Any], Any]] = {ast.UAdd: np.positive, ast.USub: np.negative}

# Longer texts are no formula for one function.
_LONGEST = 400


def function_of(text: str) -> Callable[[Floats], Floats]:
    """Read an expression in x. Raises InputError: the text is no such expression; names what is wrong."""
    if len(text) > _LONGEST:
        raise InputError(f"function: a text of {len(text)} letters, expected at most {_LONGEST}")
    try:
        # The caret binds weaker than + in Python, so it is exchanged before reading.
        tree = ast.parse(text.replace("^", "**").strip(), mode="eval").body
        _check(tree)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise InputError(f'function: found {show(text)}, expected an expression such as "log10(x)"') from None
    return lambda x: _values(tree, np.asarray(x, dtype=float), text)


def _values(tree: ast.expr, x: Floats, text: str) -> Floats:
    with np.errstate(all="ignore"):
        y = np.broadcast_to(np.asarray(_evaluated(tree, x), dtype=float), x.shape)
    if not np.isfinite(y).all():
        at = float(x[~np.isfinite(y)][0])
        raise InputError(f"function: {text} has no finite value at x = {at:.6g}; change the range")
    return y


def _check(node: ast.expr) -> None:
    match node:
        case ast.Constant(value=bool()):
            pass
        case ast.Constant(value=int() | float()):
            return
        case ast.Name(id=name) if name == "x" or name in _CONSTANTS:
            return
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _BINARY:
            _check(left)
            _check(right)
            return
        case ast.UnaryOp(op=op, operand=operand) if type(op) in _UNARY:
            _check(operand)
            return
        case ast.Call(func=ast.Name(id=name), args=[argument], keywords=[]) if name in FUNCTIONS:
            _check(argument)
            return
    found = show(ast.unparse(node))
    near = close_match(ast.unparse(getattr(node, "func", node)), [*FUNCTIONS, "x"])
    expected = f"numbers, x, pi, e, + - * / ^ and {', '.join(FUNCTIONS)}"
    raise InputError(f"function: found {found}, expected {expected}" + (f"; {near}" if near else ""))


def _evaluated(node: ast.expr, x: Floats) -> Any:
    """Value of a checked expression; numbers become floats, so that no power of whole numbers grows huge."""
    match node:
        case ast.Constant(value=value):
            return np.float64(value)  # type: ignore[arg-type]
        case ast.Name(id=name):
            return x if name == "x" else _CONSTANTS[name]
        case ast.BinOp(left=left, op=op, right=right):
            return _BINARY[type(op)](_evaluated(left, x), _evaluated(right, x))
        case ast.UnaryOp(op=op, operand=operand):
            return _UNARY[type(op)](_evaluated(operand, x))
        case ast.Call(func=ast.Name(id=name), args=[argument]):
            return FUNCTIONS[name](_evaluated(argument, x))
    raise AssertionError(ast.dump(node))


# Intervals of the range at which the machine is analysed again.
_STEPS = 720


def chebyshev_points(start: float, end: float, n: int) -> Floats:
    r"""Arguments spread so that the error between them tends to be even.

    .. math:: x_j = \tfrac12 (x_0 + x_n) - \tfrac12 (x_n - x_0) \cos\frac{(2j - 1)\pi}{2n}

    `start`, `end`: first and last argument of the range. Returns: (n,) in order from start to end.

    Source: Hartenberg, Denavit, Kinematic Synthesis of Linkages, 1964.
    """
    j = np.arange(1, n + 1)
    return 0.5 * (start + end) - 0.5 * (end - start) * np.cos((2 * j - 1) * np.pi / (2 * n))


@dataclass(frozen=True)
class Scale:
    """The function on its scales: points, crank and rocker angles from their starts, and the same "
    "over the range."""

    points: Floats
    crank: Floats
    rocker: Floats
    x: Floats
    wanted: Floats
    crank_over: Floats
    rocker_over: Floats
    per_angle: float

    @classmethod
    def of(cls, task: FunctionTask) -> Scale:
        """The scales of a task."""
        ends = task.range if task.range is not None else (min(task.x or ()), max(task.x or ()))
        points = _points(task, ends)
        function = _function(task)
        x = np.linspace(ends[0], ends[1], _STEPS + 1)
        y, y0, yn = function(points), *function(np.array(ends))
        if not np.isfinite(yn - y0) or abs(yn - y0) <= 1e-12 * max(abs(yn), abs(y0), 1e-300):
            raise InputError(
                f"function: {y0:.6g} at both ends of the range, so rocker_range has no scale; expected "
                "different values"
            )
        per_angle = (yn - y0) / task.rocker_range
        part, over = (points - ends[0]) / (ends[1] - ends[0]), np.linspace(0, 1, _STEPS + 1)
        wanted = function(x)
        angles = ((y - y0) / per_angle, (wanted - y0) / per_angle)
        crank = (part * task.crank_range, over * task.crank_range)
        return cls(points, crank[0], angles[0], x, wanted, crank[1], angles[1], float(per_angle))


def _points(task: FunctionTask, ends: tuple[float, ...]) -> Floats:
    if task.x is not None:
        return np.asarray(task.x)
    if task.spacing == "even":
        return np.linspace(ends[0], ends[1], task.points)
    return chebyshev_points(ends[0], ends[1], task.points)


def _function(task: FunctionTask) -> Callable[[Floats], Floats]:
    """The function of a task; one given by points is a polynomial through few, straight between many."""
    if task.function is not None:
        return function_of(task.function)
    x, y = np.asarray(task.x), np.asarray(task.y)
    order = np.argsort(x)
    x, y = x[order], y[order]
    if (np.diff(x) <= 0).any():
        raise InputError("x: the same argument twice, expected different ones")
    if len(x) <= 6:
        middle, half = 0.5 * (x[0] + x[-1]), 0.5 * (x[-1] - x[0])
        factors = np.linalg.solve(np.vander((x - middle) / half), y)
        return lambda at: np.polyval(factors, (np.asarray(at) - middle) / half)
    return lambda at: np.interp(at, x, y)
