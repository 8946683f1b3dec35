"""A table of times and crank angles, the law of a motion in time: two columns of plain numbers in SI."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from linkwright.kernel.errors import MachineFileError, Problem, UnitError
from linkwright.kernel.files.text_file import TextError, text_of
from linkwright.kernel.limits import POINT_BYTES
from linkwright.kernel.units import ANGLE, NUMBER, TIME, Kind, parse, show


def read_law_table(path: Path) -> tuple[list[float], list[float]]:
    """Read a table of times and angles.

    Parameters
    ----------
    path : Path
        A line for each point, its numbers parted by a comma or a semicolon. A first line without numbers is
        the head.

    Returns
    -------
    times, angles : list of float
        [s], [rad].

    Raises
    ------
    MachineFileError
        The file cannot be read, or a line is no time and angle; with file and line.
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
        return parse(float(cell), kind)
    except UnitError as error:
        raise MachineFileError([replace(error.problem, path=str(path), line=line)]) from None
