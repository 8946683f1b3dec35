"""Columns of quantities from a file of comma-separated values, such as a measurement.

The head names each column, with its unit in brackets: ``angle [deg], speed [rpm]``; without a unit the
numbers are SI. Lines that begin with ``#`` are comments.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.errors import MachineFileError, Problem, UnitError
from linkwright.kernel.files.points import columns_of
from linkwright.kernel.units import Kind, parse, show


def read_columns(path: str | os.PathLike[str], kinds: Mapping[str, Kind]) -> dict[str, NDArray[np.float64]]:
    """Read columns of a file; others in it are passed over.

    Parameters
    ----------
    path : path
        The file.
    kinds : mapping of str to Kind
        Name of each column that is wanted, and the quantity in it.

    Returns
    -------
    dict of str to ndarray, shape (n,)
        In SI.

    Raises
    ------
    MachineFileError
        The file cannot be read, lacks a column, or holds something else in it; with file and line.
    """
    place = Path(path)
    columns, lines = columns_of(place, "")
    missing = [name for name in kinds if name not in columns]
    if missing:
        wanted = ", ".join(f"{name} [{kind.unit}]" for name, kind in kinds.items())
        found = f"no column {missing[0]} among {show(', '.join(columns))}"
        remedy = f"begin the file with a head such as: {wanted}"
        raise MachineFileError([Problem("", found, "a column of each name", remedy, str(place), lines[0])])
    return {name: _values(columns[name], kind, name, place, lines[1:]) for name, kind in kinds.items()}


def _values(
    entries: Sequence[Any], kind: Kind, name: str, path: Path, lines: Sequence[int]
) -> NDArray[np.float64]:
    """The entries of a column in SI."""
    found = []
    for entry, line in zip(entries, lines, strict=True):
        try:
            found.append(parse(entry, kind))
        except UnitError as error:
            problem = replace(error.problem, key=f"column {name}", path=str(path), line=line)
            raise MachineFileError([problem]) from None
    return np.array(found)
