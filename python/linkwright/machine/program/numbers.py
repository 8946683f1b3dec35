"""Numbers of a machine as they cross the border: parameters in their slots, tables, formulas, motion laws."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.kernel.description import formula

# Variables and instructions of formulas in the order of the core's modules `kernel::formula` and `plan`.
_VARIABLES = ("phi", "omega", "t", "x", "y", "vx", "vy", "v", "s", "psi", "psi_dot")
_INSTRUCTIONS = (
    *("number", "zero", "name", "+", "-", "*", "/", "negative", "power", "pow"),
    *("sin", "cos", "tan", "asin", "acos", "atan", "atan2", "exp", "log", "sqrt", "tanh"),
    *("abs", "sign", "step", "min", "max", "where"),
)


def encoded(law: MotionLaw) -> list[float]:
    """A motion law as the core reads it, `MotionLaw::decode` in `crates/linkwright-core`."""
    numbers = [float(len(law.pieces))]
    for (low, high), piece in zip(pairwise(law.breaks), law.pieces, strict=True):
        numbers += [low, high - low, len(piece.polynomial), *piece.polynomial, len(piece.harmonics)]
        numbers += [x for harmonic in piece.harmonics for x in harmonic]
    return numbers


class Numbers:
    """Collects parameters, tables, formulas and motion laws."""

    def __init__(self) -> None:
        self.parameters: list[Any] = []
        self.varying: list[int] = []
        self.tables: list[tuple[Sequence[float], Sequence[float]]] = []
        self.formulas: list[int] = []
        self.n_formulas = 0
        self.motion_laws: list[float] = []
        self.n_motion_laws = 0

    def slot(self, value: Any) -> int:
        """Adds a parameter; one that is an array varies from row to row."""
        if isinstance(value, np.ndarray) and value.ndim:
            self.varying.append(len(self.parameters))
        self.parameters.append(value)
        return len(self.parameters) - 1

    def slots(self, *values: Any) -> list[int]:
        """Adds several parameters."""
        return [self.slot(value) for value in values]

    def _table(self, x: Sequence[float], y: Sequence[float]) -> int:
        self.tables.append((x, y))
        return len(self.tables) - 1

    def _motion_law(self, law: MotionLaw) -> int:
        """Adds a motion law over one revolution."""
        self.motion_laws += encoded(law)
        self.n_motion_laws += 1
        return self.n_motion_laws - 1

    def _formula(self, term: formula.Node, constants: dict[str, int]) -> int:
        """Adds the instructions of a formula."""
        code: list[int] = []
        for op, operand in formula.program(term):
            code += self._instruction(op, operand, constants)
        self.formulas += [len(code) // 2, *code]
        self.n_formulas += 1
        return self.n_formulas - 1

    def _instruction(self, op: str, operand: Any, constants: dict[str, int]) -> list[int]:
        """One instruction as the core reads it."""
        match op:
            case "number" if operand == 0:
                return [1, 0]
            case "number":
                return [0, self.slot(operand)]
            case "name" if operand in constants:
                return [0, constants[operand]]
            case "name" if operand in formula.NUMBERS:
                return [0, self.slot(formula.NUMBERS[operand])]
            case "name":
                return [2, _VARIABLES.index(operand)]
            case "power":
                return [8, operand]
        return [_INSTRUCTIONS.index(op), 0]
