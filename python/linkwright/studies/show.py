"""Rows of a folder, as they are drawn: all of a small sweep, of a large one rows spread over all files."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.errors import FindingError
from linkwright.studies.folder import SweepFolder
from linkwright.studies.parquet import columns_of

# Rows that are read for pictures; a grid is read as a whole, up to its own limit.
_ROWS, _GRID = 40_000, 4_000_000


def rows_of(folder: SweepFolder) -> dict[str, NDArray[Any]]:
    """Columns of a sweep, (n,) each; of a large one every k-th row.

    Raises
    ------
    FindingError
        The folder has no rows yet.
    """
    is_grid = folder.manifest["study"].get("sweep", {}).get("method", "grid") == "grid"
    every = -(-folder.n_rows // (_GRID if is_grid else _ROWS))
    names = ["row", *folder.units, "status", "reason"]
    found = []
    for path in folder.parts():
        columns = columns_of(path, names)
        kept = columns["row"] % every == 0
        found.append({name: column[kept] for name, column in columns.items()})
    if not found:
        raise FindingError(f"{folder.path}: no rows are computed yet")
    return {name: np.concatenate([each[name] for each in found]) for name in names}
