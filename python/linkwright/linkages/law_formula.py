"""A law of the driver written as a text, ``2*pi*t + 0.1*sin(5*t)``."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.description.formula import NUMBERS, FormulaError, names, parse
from linkwright.kernel.errors import InputError
from linkwright.kernel.numerics.formula_value import OPERATIONS, value
from linkwright.linkages.law import FunctionLaw

Floats = NDArray[np.float64]

# Functions that a number with derivatives does not know, made of others that it does.
_OPERATIONS: dict[str, Callable[..., Any]] = {
    **OPERATIONS,
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
        """Read it once, for its errors. Raises InputError: it is no formula of t."""
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
        return FunctionLaw(lambda t: value(tree, {**NUMBERS, "t": t}, _OPERATIONS)).at(times)
