"""Tables of a topper over a field of roots, and its curves as CSV."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.page.csv import columns_csv
from linkwright.kernel.page.numbers import number
from linkwright.kernel.page.table import Row, Table
from linkwright.topping.field import TopperField
from linkwright.topping.sweep import FieldSweep

Floats = NDArray[np.float64]

# Variants in a table; the others are in the CSV file.
_ROWS = 40

# Words and symbols of what varies.
WORDS = {
    "edge_length": ("length of the edge", "L", "m"),
    "edge_angle": ("edge angle", "α", "°"),
    "forward_speed": ("speed along the row", "v", "m/s"),
    "knife_speed": ("speed of the knife", "v_h", "m/s"),
    "cut_height": ("mean height of the slice", "h_p", "m"),
}

_UNITS = {
    "edge_angle": "rad",
    "edge_length": "m",
    "cut_height": "m",
    "length": "m",
    "forward_speed": "m/s",
    "knife_speed": "m/s",
    "loss_mean": "m³",
    "length_for_95": "m",
}


def field_tables(found: TopperField) -> Iterator[Table]:
    """Shares, haulm, loss, and lengths.

    Parameters
    ----------
    found : TopperField
        What to write.

    Yields
    ------
    Table
        For terminal and report.
    """
    each = "rows" if found.clusters == "rows" else "measured roots, each in many phases"
    title = (
        f"Field: {found.n_roots} heads of {found.n_clusters} {each}; edge of {number(found.edge_length)} m"
    )
    yield Table("topper_field", title, ("", "", "value", _interval(found.level)), list(_rows(found)))
    rows: list[Row] = [
        (f"for {100 * share:.4g} % of the heads", "L", _length(value), _between(_length(low), _length(high)))
        for share, value, low, high in zip(
            found.quantile,
            found.quantile_length,
            found.quantile_length_low,
            found.quantile_length_high,
            strict=True,
        )
    ]
    yield Table("topper_lengths", "Length of the edge", ("", "", "value", _interval(found.level)), rows)


def _interval(level: float) -> str:
    return f"{100 * level:.4g} % within"


def _rows(found: TopperField) -> Iterator[Row]:
    shares = (
        ("heads cut right through", "", "share_complete"),
        ("left of the head, mean", "", "haulm_mean"),
        ("loss: share of the roots above the cut", "", "loss_share"),
    )
    for word, symbol, key in shares:
        value, low, high = (100 * each for each in _three(found, key))
        yield word, symbol, f"{number(value)} %", _between(number(low), f"{number(high)} %")
    value, low, high = (1e6 * each for each in _three(found, "loss_mean"))
    yield "loss of a root, mean", "V", f"{number(value)} cm³", _between(number(low), f"{number(high)} cm³")
    if found.loss_mass_mean is not None:
        yield "mass of it", "m", f"{number(1e3 * found.loss_mass_mean)} g", ""
    yield "mean draw-cut ratio", "", number(found.slicing_ratio_mean), ""
    counts = (("heads that the knife passes above", found.n_missed), ("roots lost as a whole", found.n_lost))
    for word, count in counts:
        if count:
            yield word, "", str(count), ""


def _three(found: TopperField, key: str) -> tuple[float, float, float]:
    value, low, high = (getattr(found, f"{key}{end}") for end in ("", "_low", "_high"))
    return value, low, high


def _between(low: str, high: str) -> str:
    return f"{low} to {high}"


def _length(value: float) -> str:
    return "none" if math.isinf(value) else f"{number(value, 4)} m"


def sweep_table(swept: FieldSweep) -> Table:
    """Variants of a knife over the same roots.

    Parameters
    ----------
    swept : FieldSweep
        What to write.

    Returns
    -------
    Table
        Of many variants, some evenly among all.
    """
    n = len(swept.share_complete)
    kept = np.unique(np.linspace(0, n - 1, min(n, _ROWS)).astype(int))
    names = list(swept.entries)
    heads = tuple(WORDS[name][1] for name in names)
    # A table begins with a word and a symbol.
    heads = heads if len(heads) == 2 else (*heads, "")
    rows: list[Row] = []
    for i in kept:
        varied = tuple(_shown(name, float(swept.entries[name][i])) for name in names)
        lengths = _length(float(swept.length_for_95[i]))
        shares = (swept.share_complete[i], swept.share_complete_low[i], swept.share_complete_high[i])
        value, low, high = (number(100 * float(each), 4) for each in shares)
        rows.append(
            (
                *(varied if len(varied) == 2 else (*varied, "")),
                f"{value} %",
                _between(low, high),
                f"{number(100 * float(swept.haulm_mean[i]), 3)} %",
                lengths,
                f"{number(1e6 * float(swept.loss_mean[i]), 4)} cm³",
                number(float(swept.slicing_ratio_mean[i]), 4),
            )
        )
    found = ("cut right through", _interval(swept.level), "left", "L for 95 %", "loss", "draw-cut ratio")
    some = "" if len(kept) == n else f", {len(kept)} of {n}"
    return Table("topper_field_sweep", f"The same roots, knife varied{some}", (*heads, *found), rows)


def _shown(name: str, value: float) -> str:
    if name == "edge_angle":
        return f"{number(math.degrees(value))}°"
    return f"{number(value)} {WORDS[name][2]}"


def field_csv(columns: Mapping[str, Floats]) -> str:
    """Columns of a field, of a sweep or of a search as CSV.

    Parameters
    ----------
    columns : mapping of str to ndarray, shape (n,)
        By name.

    Returns
    -------
    str
        SI, with the unit of each column in its head.
    """
    return columns_csv({f"{name} [{_UNITS.get(name, '-')}]": column for name, column in columns.items()})
