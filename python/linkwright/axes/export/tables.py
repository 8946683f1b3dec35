"""Formats compared: points, numbers, and the deviations that each causes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from linkwright.axes.export.exported import LawExport
from linkwright.kernel.page.table import Row, Table
from linkwright.kernel.reader.numbers import degrees, number
from linkwright.kernel.reader.out_units import reader

# Quantity of which there is a deviation, and the units in which it is shown where the reader wants no other.
_QUANTITIES = {
    "m": (("position", "m", "mm"), ("velocity", "m/rad", "mm/rad"), ("acceleration", "m/rad^2", "mm/rad^2")),
    "rad": (("position", "rad", "deg"), ("velocity", "", ""), ("acceleration", "1/rad", "")),
}


def export_tables(exports: Sequence[LawExport], refused: Mapping[str, str], unit: str) -> list[Table]:
    """What each format is, and the deviations that it causes.

    `refused`: formats that cannot hold the law; `unit`: SI unit of the position.
    """
    rows: list[Row] = [(e.format, "", e.maker, e.interpolation, e.numbers, str(e.n_points)) for e in exports]
    rows += [(name, "", "–", "–", "–", "–") for name in refused]
    heads = ("format", "", "maker", "interpolation", "numbers", "points")
    return [
        Table("law_formats", "Cam tables", heads, rows),
        *([_deviations(exports, unit)] if exports else []),
    ]


def _deviations(exports: Sequence[LawExport], unit: str) -> Table:
    """Largest deviations with the master angles where they are."""
    heads, columns = ["format", ""], [[e.format for e in exports], [""] * len(exports)]
    for name, si, usual in _QUANTITIES[unit]:
        shown, factor = reader().shown(si, usual)
        heads += [f"Δ {name} [{shown or '–'}]", "at"]
        values = [getattr(e, f"{name}_deviation") / factor for e in exports]
        texts = [
            number(value, scale=getattr(e, f"{name}_peak") / factor)
            for e, value in zip(exports, values, strict=True)
        ]
        places = [degrees(getattr(e, f"{name}_deviation_angle")) for e in exports]
        columns += [texts, ["–" if t == "0" else place for t, place in zip(texts, places, strict=True)]]
    title = "Largest deviations over the master angle"
    return Table("law_deviations", title, tuple(heads), list(zip(*columns, strict=True)))
