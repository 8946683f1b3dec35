"""Cards of a field day: their files, and what is shown and written of them."""

from __future__ import annotations

from collections.abc import Iterator
from glob import has_magic
from pathlib import Path
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError
from linkwright.kernel.figure.lines import Line, Panel, line_figure
from linkwright.kernel.figure.style import BLUE, RED, CaptionedFigure, styled
from linkwright.kernel.files.points import columns_of
from linkwright.kernel.page.table import Row, Table, csv_text, head, part_table, parts_of
from linkwright.kernel.quantities import shown
from linkwright.kernel.reader.numbers import measured, number
from linkwright.kernel.reader.out_units import shown_columns
from linkwright.rods.many_cards import CardDiagnoses

# Quantities of a day whose range is shown.
_RANGES = ("load_max", "load_min", "plunger_stroke", "fillage", "fluid_load", "production", "loading_max")


def card_files(place: str) -> list[Path]:
    """Files of cards: those of a folder, of a pattern, or of a CSV file with a column ``file``."""
    path = Path(place)
    if path.is_dir():
        files = sorted(path.glob("*.csv"))
    elif has_magic(path.name):
        files = sorted(path.parent.glob(path.name))
    else:
        columns = columns_of(path, "", numbers=())[0]
        if "file" not in columns:
            raise InputError(
                f"--cards: found the columns {', '.join(columns)} in {path}, expected a column file; "
                "--card reads a single card"
            )
        files = [path.parent / name for name in columns["file"]]
    if not files:
        raise InputError(f"--cards: found no files by {place}, expected CSV files, a card in each")
    return files


def require_some(day: CardDiagnoses) -> None:
    """Refuse a day without any card that could be diagnosed."""
    if all(day.faults):
        raise InputError(f"cards: none of {len(day.faults)} could be diagnosed; {day.faults[0]}")


def day_tables(day: CardDiagnoses) -> Iterator[Table]:
    """Ranges of the day, a row for each card, and what is wrong with those that were not diagnosed."""
    heads = ("quantity", "", "minimum", "median", "maximum")
    diagnosed = sum(not fault for fault in day.faults)
    rows: list[Row] = [("cards that were diagnosed", "", "", f"{diagnosed} of {len(day.faults)}", "")]
    rows += [_range(day, name) for name in _RANGES if not np.isnan(getattr(day, name)).all()]
    rows.append(("damping", "c", "", measured(day.damping, "1/s"), ""))
    yield Table("day", "Cards of the field day", heads, rows)
    words = dict(zip(day.names, day.verdicts, strict=True))
    yield part_table(
        "day_cards",
        "Measured cards",
        parts_of(day, "names"),
        ("card", "", "PPRL", "MPRL", "plunger stroke", "fillage", "fluid load", "production", "verdict"),
        lambda card: str(card.name),
        "",
        *("load_max", "load_min", "plunger_stroke", "fillage", "fluid_load"),
        lambda card: measured(card.production, "m³/s", usual="m^3/d"),
        lambda card: words[card.name],
    )
    faults: list[Row] = [
        (name, "", fault) for name, fault in zip(day.names, day.faults, strict=True) if fault
    ]
    if faults:
        yield Table("day_faults", "Cards that were not diagnosed", ("card", "", "reason"), faults)


def _range(day: CardDiagnoses, name: str) -> Row:
    mark, values = shown(CardDiagnoses, name), getattr(day, name)
    ends = (np.nanmin(values), np.nanmedian(values), np.nanmax(values))
    return mark.word, mark.symbol, *(measured(float(x), mark.unit, usual=mark.usual) for x in ends)


def day_figures(day: CardDiagnoses) -> Iterator[CaptionedFigure]:
    """Loads and fillage from card to card."""
    caption = (
        f"The fillage is {number(100 * np.nanmin(day.fillage))} to {number(100 * np.nanmax(day.fillage))} % "
        "over the cards of the day."
    )
    yield CaptionedFigure("day", "Cards of the field day", caption, _drawn(day))


@styled
def _drawn(day: CardDiagnoses) -> Any:
    cards = np.arange(1, len(day.names) + 1, dtype=float)

    def dots(values: Floats, colour: str, label: str = "") -> Line:
        return Line(values, colour, label, cards, ".")

    loads = [dots(day.load_max, RED, "PPRL"), dots(day.load_min, BLUE, "MPRL")]
    return line_figure(
        np.array([0.5, len(cards) + 0.5]),
        Panel("load $F$ [N]", loads, None),
        Panel("fillage [%]", [dots(100 * day.fillage, RED)], None),
        height=4.2,
        over="card",
    )


def day_columns(day: CardDiagnoses) -> dict[str, Any]:
    """Columns of a table with a row for each card: head with unit → values."""
    numbers = {head(day, name): getattr(day, name) for name in day.parts_by_name()}
    return {"card": day.names, **shown_columns(numbers), "verdict": day.verdicts, "fault": day.faults}


def day_csv(day: CardDiagnoses) -> str:
    """The columns as CSV."""
    columns = day_columns(day)
    cells = (values.tolist() if isinstance(values, np.ndarray) else values for values in columns.values())
    return csv_text(list(columns), zip(*cells, strict=True))


def day_parquet(day: CardDiagnoses) -> bytes:
    """The columns as Parquet; needs pyarrow."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    out = pa.BufferOutputStream()
    pq.write_table(pa.table({name: pa.array(values) for name, values in day_columns(day).items()}), out)
    return out.getvalue().to_pybytes()  # type: ignore[no-any-return]
