"""The best knife of a topper: table, warnings, lines of a machine file, map as CSV."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from linkwright.kernel.page.numbers import number
from linkwright.kernel.page.table import Row, Table
from linkwright.topping.best.best_knife import BestKnife, KnifeSearch
from linkwright.topping.tables.field import field_csv


def best_table(found: KnifeSearch, best: BestKnife) -> Table:
    """The best knife, over the roots that it was sought with and over others.

    Parameters
    ----------
    found : KnifeSearch
        The search.
    best : BestKnife
        What it found.

    Returns
    -------
    Table
        For terminal and report.
    """
    limits = found.limits
    rows: list[Row] = [
        ("edge angle", "α", f"{number(math.degrees(best.edge_angle))}°", "", ""),
        ("length of the edge", "L", f"{number(best.edge_length)} m", "", _at_most(found.length_max, "m")),
        ("speed of the knife", "v_h", f"{number(best.knife_speed)} m/s", "", ""),
        ("speed along the row", "v", f"{number(best.forward_speed)} m/s", "", ""),
    ]
    if best.crank_speed is not None:
        rows.append(("speed of its crank", "ω", f"{number(best.crank_speed)} rad/s", "", ""))
    least = "" if limits.slicing_min is None else f"≥ {number(limits.slicing_min)}"
    rows.append(("mean draw-cut ratio", "", number(best.slicing_ratio_mean), "", least))
    share = _percent(best.share_complete)
    other = _with_ends(best.share_verified, best.share_verified_low, best.share_verified_high)
    rows.append(("heads cut right through", "", share, other, f"≥ {_percent(limits.complete_min)}"))
    other = _with_ends(best.haulm_verified, best.haulm_verified_low, best.haulm_verified_high)
    most = math.inf if limits.haulm_max is None else 100 * limits.haulm_max
    rows.append(("left of the head, mean", "", _percent(best.haulm_mean), other, _at_most(most, "%")))
    title = {"shortest": "Shortest edge", "fastest": "Fastest along the row"}[found.objective]
    return Table(
        "topper_best",
        f"{title}; {found.tried} knives looked at",
        ("", "", "found", "over other roots", "limit"),
        rows,
    )


def _percent(share: float) -> str:
    return f"{number(100 * share, 4)} %"


def _with_ends(value: float, low: float, high: float) -> str:
    return f"{number(100 * value, 4)} % ({number(100 * low, 4)} to {number(100 * high, 4)})"


def _at_most(value: float, unit: str) -> str:
    return f"≤ {number(value)} {unit}" if math.isfinite(value) else ""


def best_warnings(found: KnifeSearch) -> Iterator[str]:
    """What to know of the best knife.

    Parameters
    ----------
    found : KnifeSearch
        The search.

    Yields
    ------
    str
        A sentence.
    """
    best = found.best
    if best is None:
        return
    if not best.is_verified:
        yield (
            f"Over other roots it cuts {_percent(best.share_verified)} of the heads and leaves "
            f"{_percent(best.haulm_verified)}, which is beyond chance: take more roots."
        )
    if found.limits.slicing_min is None:
        yield (
            "No slicing_min is asked for: nothing then speaks for a slanted or a moving edge, and the "
            "shortest one rests across the row as far as the bounds allow."
        )
    elif best.knife_speed == 0:
        yield (
            "A slanted edge that rests slices as much as is asked for; bound its angle, or set "
            f"knife_speed_min, where {math.degrees(best.edge_angle):.3g}° is too much, or the knife moves."
        )
    if best.knife_speed == 0:
        yield (
            "At rest the knife stands in the middle of its stroke. Once it moves, however slowly, heads meet "
            "it anywhere in its stroke, and the edge must be longer by up to the stroke over cos α."
        )
    listed = [key for key in best.at_bounds if key not in ("knife_speed_min", "angle_min")]
    if listed:
        yield f"The best lies on a bound of the search: {', '.join(listed)}."


def best_lines(best: BestKnife) -> str:
    """The best knife as entries of a machine file.

    Parameters
    ----------
    best : BestKnife
        What to write.

    Returns
    -------
    str
        TOML.
    """
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


def map_csv(found: KnifeSearch) -> str:
    """The map of a search as CSV.

    Parameters
    ----------
    found : KnifeSearch
        The search.

    Returns
    -------
    str
        A line for each knife; empty cells where the edge runs backwards.
    """
    angle, speed = np.meshgrid(found.map_angle, found.map_speed, indexing="ij")
    columns = {"edge_angle": angle, "knife_speed": speed, "length": found.map_length}
    columns["slicing_ratio_mean"] = found.map_slicing
    return field_csv({name: column.ravel() for name, column in columns.items()})
