"""Measured curves from a file of comma-separated values: a column of speeds, a column for each curve.

The head names shafts and discs, and the unit says what was measured, as in ``speed [rpm], line [MPa], front
[deg]``; one order alone is ``line_order_2_5 [MPa]``, here order 2.5.
"""

from __future__ import annotations

import os
import re
from pathlib import Path

from pydantic import ValidationError

from linkwright.kernel.errors import MachineFileError, Problem, UnitError
from linkwright.kernel.files.columns import read_columns
from linkwright.kernel.files.points import columns_of
from linkwright.kernel.public import public
from linkwright.kernel.units import ANGLE, PRESSURE, SPEED, TORQUE, Kind, parse, show
from linkwright.torsion.model.measured_response import MeasuredResponse

_KINDS: dict[str, Kind] = {"stress": PRESSURE, "torque": TORQUE, "angle": ANGLE}

_ORDER = re.compile(r"(.+)_order_(\d+)(?:_(\d+))?")


@public
def read_measured(path: str | os.PathLike[str]) -> dict[str, MeasuredResponse]:
    """Read curves measured over the speed, such as those of a sea trial.

    Parameters
    ----------
    path : path
        The file; see the head of the module, and `docs/torsion.md`.

    Returns
    -------
    dict of str to MeasuredResponse
        By the head of the column.

    Raises
    ------
    MachineFileError
        The file cannot be read, has no such head or holds something else; with file and line.
    """
    place = Path(path)
    speed = read_columns(place, {"speed": SPEED})["speed"]
    columns, lines = columns_of(place, "", "response")
    curves = [name for name in columns if name != "speed"]
    kinds = {name: _kind(columns[name][0], name, place, lines[0]) for name in curves}
    values = read_columns(place, {name: _KINDS[kind] for name, kind in kinds.items()})
    if not curves:
        expected = "a column for each shaft or disc beside the speed"
        raise MachineFileError([Problem("", "speed alone", expected, path=str(place), line=lines[0])])
    found = {}
    for name, kind in kinds.items():
        on, order = _part(name)
        entries = {"on": on, "order": order, "speed": tuple(speed.tolist())}
        try:
            found[name] = MeasuredResponse.model_validate(entries | {kind: tuple(values[name].tolist())})
        except ValidationError as error:
            raise MachineFileError([_problem(error, name, place, lines)]) from None
    return found


def _kind(entry: object, name: str, path: Path, line: int) -> str:
    """What a column holds, by its unit."""
    for what, kind in _KINDS.items():
        try:
            parse(entry, kind)
        except UnitError:
            continue
        if isinstance(entry, str):
            return what
    expected = "a unit of stress, torque or angle in brackets"
    remedy = f"such as {name} [MPa], {name} [kN m] or {name} [deg]"
    raise MachineFileError([Problem(f"column {name}", show(str(entry)), expected, remedy, str(path), line)])


def _part(name: str) -> tuple[str, float | None]:
    """Shaft or disc, and the order, of a column."""
    match = _ORDER.fullmatch(name)
    if match is None:
        return name, None
    return match[1], float(f"{match[2]}.{match[3] or 0}")


def _problem(error: ValidationError, name: str, path: Path, lines: list[int]) -> Problem:
    """The first of what a curve does not allow, with its line."""
    first = error.errors()[0]
    place = next((part for part in first["loc"] if isinstance(part, int)), None)
    line = lines[0] if place is None else lines[1 + place]
    key = "column speed" if "speed" in first["loc"] else f"column {name}"
    context = first.get("ctx", {})
    found, expected = (
        str(context.get("found", first.get("input"))),
        str(context.get("expected", first["msg"])),
    )
    return Problem(key, found, expected, str(context.get("remedy", "")), str(path), line)
