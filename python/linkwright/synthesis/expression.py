"""A function y(x) given as text, read as an expression and nothing else.

Allowed: numbers, ``x``, ``pi``, ``e``, + − * / and powers (``^`` or ``**``), parentheses, and the functions
of `FUNCTIONS`.
"""

from __future__ import annotations

import ast
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.description.base import close_match
from linkwright.kernel.errors import InputError
from linkwright.kernel.units import show

Floats = NDArray[np.float64]

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
    """The expression at x, finite or refused."""
    with np.errstate(all="ignore"):
        y = np.broadcast_to(np.asarray(_evaluated(tree, x), dtype=float), x.shape)
    if not np.isfinite(y).all():
        at = float(x[~np.isfinite(y)][0])
        raise InputError(f"function: {text} has no finite value at x = {at:.6g}; change the range")
    return y


def _check(node: ast.expr) -> None:
    """Refuse anything that is not arithmetic."""
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
