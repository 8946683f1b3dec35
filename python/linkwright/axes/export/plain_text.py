"""Cam tables as plain text: CSV, `.tab` and pairs of numbers; written, and read back.

Sources: ISG, *Kernel documentation*, cam tables; SEW-Eurodrive, *MOVIKIT MultiMotion*, curve point tables.
"""

from __future__ import annotations

import csv

import numpy as np

from linkwright.axes.export.cam_data import CamData, CamTitle
from linkwright.axes.export.structured_text import identifier, plain
from linkwright.kernel.files.cam_tables import TAB_STEP, TableRow, law_heads, pair_rows, tab_rows
from linkwright.kernel.page.table import csv_text


def write_csv(data: CamData, title: CamTitle) -> str:
    """Master, position, velocity, acceleration, jerk."""
    assert data.v is not None
    assert data.a is not None
    assert data.j is not None
    rows = zip(*(column.tolist() for column in (data.x, data.y, data.v, data.a, data.j)), strict=True)
    return csv_text(law_heads(title.unit, is_angle=title.is_angle), rows)


def read_csv(text: str) -> CamData:
    """The columns of such a file."""
    rows = list(csv.reader(text.splitlines()))[1:]
    return CamData(*np.array([[float(cell) for cell in row] for row in rows]).T)


# Type of a table of two columns of whole numbers; linear interpolation.
_TWO_COLUMNS, _LINEAR = 7, 1


def write_tab(data: CamData, title: CamTitle) -> str:
    """The table of a CNC: whole numbers, and not the last point, which is the first of the next cycle."""
    pairs = (np.round(np.column_stack([data.x, data.y]) / TAB_STEP)).astype(int)[:-1]
    head = [
        f"# {plain(title.machine)}: law of {plain(title.name)}",
        f"# in steps of 0.0001 deg and 0.0001 {title.unit}",
        f"Tablename = {identifier(title.name)}",
        "Table-ID = 1",
        f"Tabletype = {_TWO_COLUMNS}  # two columns of whole numbers",
        f"Functiontype = {_LINEAR}  # linear",
        f"Lines = {len(pairs)}",
        "Begintable",
    ]
    return "\n".join([*head, *(f"{x} {y}" for x, y in pairs.tolist()), "EndTable"]) + "\n"


def read_tab(text: str) -> CamData:
    """The pairs of such a table, and the first once more one revolution on."""
    x, y = _pairs(tab_rows(text) or [])
    return CamData(np.append(x, x[0] + 360 / TAB_STEP) * TAB_STEP, np.append(y, y[0]) * TAB_STEP)


def write_pairs(data: CamData, title: CamTitle) -> str:
    """The number of pairs, and a pair on each line, separated by a tab."""
    rows = zip(data.x.tolist(), data.y.tolist(), strict=True)
    return "\n".join([str(len(data.x)), *(f"{x!r}\t{y!r}" for x, y in rows)]) + "\n"


def read_pairs(text: str) -> CamData:
    """The pairs of such a table."""
    return CamData(*_pairs(pair_rows(text) or []))


def _pairs(rows: list[TableRow]) -> np.ndarray:
    """Columns master and slave."""
    return np.array([[float(row.entries[name]) for row in rows] for name in ("master", "slave")])
