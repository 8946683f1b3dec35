"""Numbers of a machine as they cross the border: parameters, tables, formulas, motion laws."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from linkwright import _core
from linkwright.kernel.description import formula
from linkwright.kernel.numerics.tangent import primal

if TYPE_CHECKING:
    # A machine without cams has no use for their laws.
    from linkwright.cam.laws.motion_law import MotionLaw


def core_law(law: MotionLaw, first: int | None = None) -> _core.MotionLaw:
    """A motion law as the core has it.

    `first`: the first of the parameters that its numbers are as well.
    """
    pieces = [
        _core.Piece(
            start=low,
            length=high - low,
            polynomial=list(piece.polynomial),
            harmonics=[_core.Harmonic(**wave._asdict()) for wave in piece.harmonics],
        )
        for (low, high), piece in zip(pairwise(law.breaks), law.pieces, strict=True)
    ]
    return _core.MotionLaw(pieces, first)


class Numbers:
    """Collects parameters, and makes formulas of them."""

    def __init__(self) -> None:
        self.parameters: list[Any] = []
        self.varying: list[int] = []

    def slot(self, value: Any) -> int:
        """Adds a parameter; one that is an array varies from row to row."""
        if isinstance(value, np.ndarray) and value.ndim:
            self.varying.append(len(self.parameters))
        self.parameters.append(value)
        return len(self.parameters) - 1

    def table(self, x: Sequence[Any], y: Sequence[Any]) -> _core.Table:
        """Straight lines between points, whose places and values are parameters as well."""
        first = len(self.parameters)
        for number in (*x, *y):
            self.slot(number)
        return _core.Table([primal(place) for place in x], [primal(value) for value in y], first)

    def motion_law(self, law: MotionLaw) -> _core.MotionLaw:
        """A motion law, the numbers of whose pieces are parameters as well."""
        first = len(self.parameters)
        for (low, high), piece in zip(pairwise(law.breaks), law.pieces, strict=True):
            for number in (low, high - low, *piece.numbers):
                self.slot(number)
        return core_law(law.primal, first)

    def formula(self, term: formula.Node, constants: dict[str, int]) -> _core.Formula:
        """A formula, whose constants have their slots."""
        return _core.Formula(
            [self._instruction(op, operand, constants) for op, operand in formula.program(term)]
        )

    def _instruction(self, op: str, operand: Any, constants: dict[str, int]) -> tuple[str, int | str | None]:
        """One instruction as the core reads it: numbers by their slot."""
        match op:
            case "number" if operand == 0:
                return "zero", None
            case "number":
                return "number", self.slot(operand)
            case "name" if operand in constants:
                return "number", constants[operand]
            case "name" if operand in formula.NUMBERS:
                return "number", self.slot(formula.NUMBERS[operand])
            case "name" | "power":
                return op, operand
        return op, None


def table(x: Sequence[float], y: Sequence[float]) -> _core.Table:
    """Straight lines between points."""
    return _core.Table(list(x), list(y))
