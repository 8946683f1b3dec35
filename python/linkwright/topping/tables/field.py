"""Tables of a topper over a field of roots, of a sweep and of the best knife; curves and maps as CSV."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.page.table import Row, Table, columns_csv
from linkwright.kernel.reader.numbers import number, quantity
from linkwright.topping.best.best_knife import BestKnife, KnifeSearch
from linkwright.topping.field import TopperField
from linkwright.topping.sweep import FieldSweep

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


def field_tables(field: TopperField) -> Iterator[Table]:
    """Shares, haulm, loss, and lengths."""
    pieces = "rows" if field.clusters == "rows" else "measured roots, each in many phases"
    title = (
        f"Field: {field.n_roots} heads of {field.n_clusters} {pieces}; "
        f"edge of {quantity(field.edge_length, 'm')}"
    )
    yield Table("topper_field", title, ("", "", "value", _interval(field.level)), list(_rows(field)))
    rows: list[Row] = [
        (f"for {100 * share:.4g} % of the heads", "L", _length(value), _between(_length(low), _length(high)))
        for share, value, low, high in zip(
            field.quantile,
            field.quantile_length,
            field.quantile_length_low,
            field.quantile_length_high,
            strict=True,
        )
    ]
    yield Table("topper_lengths", "Length of the edge", ("", "", "value", _interval(field.level)), rows)


def _interval(level: float) -> str:
    return f"{100 * level:.4g} % within"


def _rows(field: TopperField) -> Iterator[Row]:
    shares = (
        ("heads cut through", "", "share_complete"),
        ("uncut share of the head, mean", "", "haulm_mean"),
        ("loss: share of the roots above the cut", "", "loss_share"),
    )
    for word, symbol, key in shares:
        value, low, high = (100 * text for text in _three(field, key))
        yield word, symbol, f"{number(value)} %", _between(number(low), f"{number(high)} %")
    value, low, high = (1e6 * text for text in _three(field, "loss_mean"))
    yield "loss of a root, mean", "V", f"{number(value)} cm³", _between(number(low), f"{number(high)} cm³")
    if field.loss_mass_mean is not None:
        yield "mass of it", "m", quantity(field.loss_mass_mean, "kg", usual="g"), ""
    yield "mean draw-cut ratio", "", number(field.slicing_ratio_mean), ""
    counts = (("heads that the knife passes above", field.n_missed), ("roots lost as a whole", field.n_lost))
    for word, count in counts:
        if count:
            yield word, "", str(count), ""


def _three(field: TopperField, key: str) -> tuple[float, float, float]:
    value, low, high = (getattr(field, f"{key}{end}") for end in ("", "_low", "_high"))
    return value, low, high


def _between(low: str, high: str) -> str:
    return f"{low} to {high}"


def _length(value: float) -> str:
    return "none" if math.isinf(value) else quantity(value, "m")


def sweep_table(swept: FieldSweep) -> Table:
    """Variants of a knife over the same roots."""
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
        value, low, high = (number(100 * float(share)) for share in shares)
        rows.append(
            (
                *(varied if len(varied) == 2 else (*varied, "")),
                f"{value} %",
                _between(low, high),
                f"{number(100 * float(swept.haulm_mean[i]), 3)} %",
                lengths,
                f"{number(1e6 * float(swept.loss_mean[i]))} cm³",
                number(float(swept.slicing_ratio_mean[i])),
            )
        )
    columns = ("cut through", _interval(swept.level), "left", "L for 95 %", "loss", "draw-cut ratio")
    some = "" if len(kept) == n else f", {len(kept)} of {n}"
    return Table("topper_field_sweep", f"The same roots, knife varied{some}", (*heads, *columns), rows)


def _shown(name: str, value: float) -> str:
    if name == "edge_angle":
        return f"{number(math.degrees(value))}°"
    return f"{number(value)} {WORDS[name][2]}"


def field_csv(columns: Mapping[str, Floats]) -> str:
    """Columns of a field, of a sweep or of a search as CSV. ``columns`` (n,): by name."""
    return columns_csv({f"{name} [{_UNITS.get(name, '-')}]": column for name, column in columns.items()})


def best_table(search: KnifeSearch, best: BestKnife) -> Table:
    """The best knife, over the roots that it was sought with and over others."""
    limits = search.limits
    rows: list[Row] = [
        ("edge angle", "α", f"{number(math.degrees(best.edge_angle))}°", "", ""),
        ("length of the edge", "L", quantity(best.edge_length, "m"), "", _at_most(search.length_max, "m")),
        ("speed of the knife", "v_h", quantity(best.knife_speed, "m/s"), "", ""),
        ("speed along the row", "v", quantity(best.forward_speed, "m/s"), "", ""),
    ]
    if best.crank_speed is not None:
        rows.append(("speed of its crank", "ω", quantity(best.crank_speed, "rad/s"), "", ""))
    least = "" if limits.slicing_min is None else f"≥ {number(limits.slicing_min)}"
    rows.append(("mean draw-cut ratio", "", number(best.slicing_ratio_mean), "", least))
    share = _percent(best.share_complete)
    other = _with_ends(best.share_verified, best.share_verified_low, best.share_verified_high)
    rows.append(("heads cut through", "", share, other, f"≥ {_percent(limits.complete_min)}"))
    other = _with_ends(best.haulm_verified, best.haulm_verified_low, best.haulm_verified_high)
    most = math.inf if limits.haulm_max is None else 100 * limits.haulm_max
    rows.append(("uncut share of the head, mean", "", _percent(best.haulm_mean), other, _at_most(most, "%")))
    title = {"shortest": "Shortest edge", "fastest": "Fastest along the row"}[search.objective]
    return Table(
        "topper_best",
        f"{title}; {search.tried} knives evaluated",
        ("", "", "found", "over other roots", "limit"),
        rows,
    )


def _percent(share: float) -> str:
    return f"{number(100 * share)} %"


def _with_ends(value: float, low: float, high: float) -> str:
    return f"{number(100 * value)} % ({number(100 * low)} to {number(100 * high)})"


def _at_most(value: float, unit: str) -> str:
    return f"≤ {number(value)} {unit}" if math.isfinite(value) else ""


def best_warnings(search: KnifeSearch) -> Iterator[str]:
    """What to know of the best knife."""
    best = search.best
    if best is None:
        return
    if not best.is_verified:
        yield (
            f"Over other roots it cuts {_percent(best.share_verified)} of the heads and leaves "
            f"{_percent(best.haulm_verified)}, which is beyond chance: take more roots."
        )
    if search.limits.slicing_min is None:
        yield (
            "No slicing_min is given: a slanted or moving edge then has no advantage, and the shortest "
            "edge stands still, square to the row as far as the bounds allow."
        )
    elif best.knife_speed == 0:
        yield (
            "A slanted edge at rest reaches the required draw-cut ratio; if "
            f"{math.degrees(best.edge_angle):.3g}° is too much, or if the knife must move, limit the angle "
            "or set knife_speed_min."
        )
    if best.knife_speed == 0:
        yield (
            "At rest the knife stands at mid-stroke. Once it moves, however slowly, heads meet it at any "
            "position of its stroke, and the edge must be longer by up to the stroke over cos α."
        )
    listed = [key for key in best.at_bounds if key not in ("knife_speed_min", "angle_min")]
    if listed:
        yield f"The best lies on a bound of the search: {', '.join(listed)}."


def best_lines(best: BestKnife) -> str:
    """The best knife as entries of a machine file."""
    entries = {
        "edge_angle": best.edge_angle,
        "edge_length": best.edge_length,
        "forward_speed": best.forward_speed,
    }
    if best.crank_speed is None:
        entries["knife_speed"] = best.knife_speed
    lines = ["[topper]", *(f"{key} = {value!r}" for key, value in entries.items())]
    if best.crank_speed is not None:
        lines += ["[drive]", f"speed = {best.crank_speed!r}"]
    return "\n".join(lines) + "\n"


def map_csv(search: KnifeSearch) -> str:
    """The map of a search as CSV."""
    angle, speed = np.meshgrid(search.map_angle, search.map_speed, indexing="ij")
    columns = {"edge_angle": angle, "knife_speed": speed, "length": search.map_length}
    columns["slicing_ratio_mean"] = search.map_slicing
    return field_csv({name: column.ravel() for name, column in columns.items()})
