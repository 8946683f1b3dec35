"""Pumping units of a maker from a file of comma-separated values that a machine file names.

The head names each column, with its unit in brackets: ``type, A [in], C [in], I [in], K [in], P [in],
R [in]``. A cell of ``R`` may hold several crank radii, from the outermost hole in, separated by spaces;
``hole`` in the machine file chooses one. ``H`` and ``G`` may stand in place of ``K``.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from linkwright.kernel.errors import MachineFileError, Problem, show
from linkwright.kernel.files.catalogue_file import CatalogueFile, Columns
from linkwright.kernel.files.named_file import named_file
from linkwright.kernel.units.kinds import FORCE, LENGTH
from linkwright.kernel.units.marks import Quantity, QuantityList

_KEY = "pumping_unit.file"

_COLUMNS = Columns(
    noun="pumping units",
    numbers={
        **{name: Quantity(LENGTH) for name in ("A", "C", "I", "K", "P", "H", "G", "cable")},
        "R": QuantityList(LENGTH),
        "structural_unbalance": Quantity(FORCE),
    },
    words=("geometry", "designation", "rotation", "remark"),
    example="type, A [in], C [in], I [in], K [in], P [in], R [in]",
)

# Entries that a type has as texts.
_WORDS = ("geometry", "designation", "rotation")


def with_unit_of_file(tables: dict[str, Any], folder: Path, *, allow_outside: bool = False) -> None:
    """Put the entries of a unit from the file that it names into its table; `tables` is changed in place.

    Entries that the machine file gives go first. Raises MachineFileError: the file lies outside, cannot be
    read, has no such type, no such crank hole, or a wrong head or number, with its line.
    """
    unit = tables.get("pumping_unit")
    if not isinstance(unit, dict) or not isinstance(unit.get("file"), str):
        return
    name, wanted, hole = unit.pop("file"), unit.pop("catalogue", None), unit.pop("hole", 1)
    rows = CatalogueFile(named_file(name, folder, _KEY, allow_outside=allow_outside), _KEY, _COLUMNS)
    type = rows.known(wanted)
    row = rows.numbers(type)
    radii = row.pop("R", ())
    if isinstance(hole, bool) or not isinstance(hole, int) or not 1 <= hole <= max(len(radii), 1):
        expected = f"a crank hole from 1, the outermost, to {len(radii)}"
        raise MachineFileError([Problem("pumping_unit.hole", show(hole), expected)])
    if radii:
        row["R"] = radii[hole - 1]
    if "K" in unit or {"H", "G"} & unit.keys():
        for key in ("K", "H", "G"):
            row.pop(key, None)
    words = {key: rows.word(type, key) for key in _WORDS}
    for key, value in (row | {key: word for key, word in words.items() if word}).items():
        unit.setdefault(key, value)
