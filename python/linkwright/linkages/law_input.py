"""Laws of the crank from a user: a table of times and angles, a formula of the time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.formula import NUMBERS, FormulaError, names, parse
from linkwright.kernel.errors import InputError, MachineFileError, Problem, UnitError
from linkwright.kernel.files.text_file import TextError, text_of
from linkwright.kernel.limits import POINT_BYTES
from linkwright.kernel.numerics.formula_value import OPERATIONS, value
from linkwright.kernel.units import ANGLE, NUMBER, TIME, Kind, show
from linkwright.kernel.units import parse as parse_quantity
from linkwright.linkages.law import FunctionLaw


def read_law_table(path: Path) -> tuple[list[float], list[float]]:
    """Read times [s] and angles [rad], a line for each point, parted by a comma or a semicolon.

    A first line without numbers is the head. Raises `MachineFileError`, with file and line, if the file
    cannot be read, or a line is no time and angle.
    """
    try:
        lines = text_of(path, POINT_BYTES).splitlines()
    except TextError as error:
        expected = "a table of times and angles"
        raise MachineFileError([Problem("", error.found, expected, error.remedy, str(path))]) from None
    rows: list[tuple[float, float]] = []
    for nth, line in enumerate(lines, start=1):
        cells = [cell.strip() for cell in line.replace(";", ",").split(",")]
        are_numbers = [NUMBER.fullmatch(cell) is not None for cell in cells]
        if are_numbers == [True, True]:
            rows.append((_number(cells[0], TIME, path, nth), _number(cells[1], ANGLE, path, nth)))
        elif any(are_numbers) or (nth > 1 and line.strip()):
            expected = "a time [s] and an angle [rad]"
            raise MachineFileError([Problem("", show(line), expected, "", str(path), nth)])
    return [time for time, _ in rows], [angle for _, angle in rows]


def _number(cell: str, kind: Kind, path: Path, line: int) -> float:
    """A number of the table; its line, if it is no such quantity."""
    try:
        return parse_quantity(float(cell), kind)
    except UnitError as error:
        raise MachineFileError([replace(error.problem, path=str(path), line=line)]) from None


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
            asked = names(parse(self.text))
        except FormulaError as error:
            remedy = f"; {error.remedy}" if error.remedy else ""
            raise InputError(
                f'law: found "{self.text}", expected a formula of t: {error.expected}{remedy}'
            ) from None
        wrong = [name for name in asked if name != "t" and name not in NUMBERS]
        if wrong:
            raise InputError(
                f'law: found "{wrong[0]}" in "{self.text}", expected t, pi, g, numbers and functions'
            )

    def at(self, times: Floats) -> Floats:
        """See `Law.at`."""
        tree = parse(self.text)
        return FunctionLaw(lambda t: value(tree, {**NUMBERS, "t": t}, _OPERATIONS)).at(times)
