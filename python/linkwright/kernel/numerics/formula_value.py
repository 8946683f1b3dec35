"""The value of a formula: its tree worked through with numpy."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import reduce
from typing import Any

import numpy as np

from linkwright.kernel.description.formula import Node

# Operators and functions of the grammar.
OPERATIONS: dict[str, Callable[..., Any]] = {
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
    "step": lambda x: np.where(x < 0, 0.0, 1.0),
    "min": lambda *x: reduce(np.minimum, x),
    "max": lambda *x: reduce(np.maximum, x),
    "asin": np.arcsin,
    "acos": np.arccos,
    "atan": np.arctan,
    "atan2": np.arctan2,
    **{
        name: getattr(np, name) for name in ("sin", "cos", "tan", "tanh", "exp", "log", "sqrt", "abs", "sign")
    },
}


def value(
    node: Node, names: Mapping[str, Any], operations: Mapping[str, Callable[..., Any]] = OPERATIONS
) -> Any:
    """The value of a formula, a number or (n,); NaN or infinite where it has none.

    `names`: number or array of each variable and constant; `operations`: what operators and functions are, as
    others than those of numpy serve other kinds of numbers.
    """
    if node.op == "number":
        return float(node.value)
    if node.op == "name":
        return names[str(node.value)]
    return operations[node.op](*(value(arg, names, operations) for arg in node.args))
