"""A law of the driver written as a text, ``2*pi*t + 0.1*sin(5*t)``."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import reduce
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.analysis.law import FunctionLaw
from linkwright.errors import InputError
from linkwright.machine.formula import NUMBERS, FormulaError, Node, names, parse

Floats = NDArray[np.float64]

# What the operations and functions of a formula are in numpy; those of two arguments take more by repetition.
_OPERATIONS: dict[str, Callable[..., Any]] = {
    "negative": np.negative,
    "+": np.add,
    "-": np.subtract,
    "*": np.multiply,
    "/": np.divide,
    "^": np.power,
    "pow": np.power,
    "<": np.less,
    "<=": np.less_equal,
    ">": np.greater,
    ">=": np.greater_equal,
    "where": np.where,
    "min": np.minimum,
    "max": np.maximum,
    "sin": np.sin,
    "cos": np.cos,
    "tan": np.tan,
    "asin": np.arcsin,
    "acos": np.arccos,
    "atan": np.arctan,
    "tanh": np.tanh,
    "exp": np.exp,
    "log": np.log,
    "sqrt": np.sqrt,
    "abs": np.absolute,
    "sign": lambda x: np.where(x > 0, 1.0 + 0.0 * x, np.where(x < 0, -1.0 + 0.0 * x, 0.0 * x)),
    "step": lambda x: np.where(x >= 0, 1.0 + 0.0 * x, 0.0 * x),
    "atan2": lambda y, x: 2 * np.arctan(y / (np.sqrt(x * x + y * y) + x)),
}


@dataclass(frozen=True)
class FormulaLaw:
    """The crank angle [rad] as a formula of the time t [s].

    Attributes
    ----------
    text : str
        In the language of the loads' formulas, with ``t`` as the only variable.
    """

    text: str

    def __post_init__(self) -> None:
        """Read it once, for its errors.

        Raises
        ------
        InputError
            It is no formula of t.
        """
        try:
            found = names(parse(self.text))
        except FormulaError as error:
            remedy = f"; {error.remedy}" if error.remedy else ""
            raise InputError(
                f'law: found "{self.text}", expected a formula of t: {error.expected}{remedy}'
            ) from None
        wrong = [name for name in found if name != "t" and name not in NUMBERS]
        if wrong:
            raise InputError(
                f'law: found "{wrong[0]}" in "{self.text}", expected t, pi, g, numbers and functions'
            )

    def at(self, times: Floats) -> Floats:
        """See `Law.at`."""
        tree = parse(self.text)
        return FunctionLaw(lambda t: _value(tree, t)).at(times)


def _value(node: Node, t: Any) -> Any:
    """Value of a part of the formula."""
    if node.op == "number":
        return float(node.value)
    if node.op == "name":
        return t if node.value == "t" else NUMBERS[str(node.value)]
    args = [_value(each, t) for each in node.args]
    operation = _OPERATIONS[node.op]
    return reduce(operation, args) if node.op in ("min", "max") else operation(*args)
