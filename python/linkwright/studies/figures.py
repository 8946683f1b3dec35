"""Pictures of the rows of a sweep, and of a fit beside its record.

Curves, maps with contours, a scatter matrix, parallel coordinates show all rows of a small sweep, of a large
one rows drawn without order and those with the extremes: every k-th row of a Sobol sequence leaves out parts
of its ranges.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.arrays import Floats, Indices
from linkwright.kernel.errors import FindingError
from linkwright.kernel.figure.style import (
    BLUE,
    INK,
    LINES,
    PAPER,
    RED,
    SMALL,
    SOFT,
    WIDTH,
    broken,
    panels,
    roomy,
    styled,
    turn_axis,
)
from linkwright.kernel.reader.numbers import number
from linkwright.studies.fit import Fit
from linkwright.studies.folder import SweepFolder
from linkwright.studies.parquet import columns_of

if TYPE_CHECKING:
    from matplotlib.axis import Axis as MatplotlibAxis
    from matplotlib.figure import Figure

# Rows in a scatter matrix and lines in parallel coordinates: more make one dark patch.
_POINTS, _LINES = 4_000, 600

# Behind names between lines.
_BEHIND: Any = {"facecolor": PAPER, "edgecolor": "none", "alpha": 0.75, "pad": 0.6}

# Letters of a label beside a panel of curves, along the side of a map, and of small ones an inch.
_HIGH, _WIDE, _PER_INCH = 20, 44, 12

# Columns of a matrix that can still be read on a page.
_PANELS = 7


@dataclass(frozen=True)
class StudyRows:
    """Rows to be drawn."""

    columns: dict[str, Floats]  # (n,): variables and responses; angles in degrees
    labels: dict[str, str]  # name with unit
    # Which are which.
    variables: tuple[str, ...]
    responses: tuple[str, ...]
    is_grid: bool  # whether the rows are all combinations of the values of two variables or one
    # Variable that is no number, whose values are places → names of the values.
    choices: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    # Rows of the sweep, where these are some of them.
    n_rows: int = 0

    def is_number(self, name: str) -> bool:
        """Whether a column has numbers, and no places of names."""
        return name not in self.choices


@styled
def curve_figure(shown: StudyRows) -> Figure:
    """Draw every response over the one variable."""
    figure, axes = panels(len(shown.responses), height=1.0 + 1.9 * len(shown.responses))
    name = shown.variables[0]
    order = np.argsort(shown.columns[name], kind="stable")
    for panel, response in zip(axes, shown.responses, strict=True):
        values = shown.columns[response][order]
        marker = "." if len(order) < 40 or not shown.is_number(name) else None
        line = "-" if shown.is_number(name) else ""
        panel.plot(shown.columns[name][order], values, linestyle=line, color=BLUE, marker=marker)
        panel.set_ylabel(broken(shown.labels[response], _HIGH))
        if np.isfinite(values).any():
            roomy(panel, values[np.isfinite(values)])
    axes[-1].set_xlabel(broken(shown.labels[name], _WIDE))
    _name_places(shown, name, axes[-1].xaxis)
    return figure


@styled
def map_figure(shown: StudyRows, response: str) -> Figure:
    """Draw a response over two variables as colours and contours, with its minimum and maximum."""
    figure, (panel,) = panels(1, height=4.6)
    first, second = shown.variables
    x, y = (np.unique(shown.columns[name]) for name in (first, second))
    table = np.full((len(y), len(x)), np.nan)
    at = np.searchsorted(y, shown.columns[second]), np.searchsorted(x, shown.columns[first])
    table[at] = shown.columns[response]
    drawn = panel.pcolormesh(x, y, table, cmap="viridis", shading="nearest", rasterized=True)
    figure.colorbar(drawn, ax=panel, label=broken(shown.labels[response], _WIDE))
    is_sloped = np.isfinite(table).any() and np.nanmin(table) < np.nanmax(table)
    if min(table.shape) > 1 and is_sloped and shown.is_number(first) and shown.is_number(second):
        lines = panel.contour(x, y, table, colors="white", linewidths=0.8, levels=9)
        panel.clabel(lines, fontsize=SMALL, fmt=lambda level: number(level))
    for pick, mark, word in ((np.nanargmin, "v", "minimum"), (np.nanargmax, "^", "maximum")):
        if np.isfinite(table).any():
            row, column = np.unravel_index(pick(table), table.shape)
            word = f"{word} {number(table[row, column])}"
            panel.plot(x[column], y[row], mark, color=RED, markeredgecolor="white", markersize=9, label=word)
    panel.set(xlabel=broken(shown.labels[first], _WIDE), ylabel=broken(shown.labels[second], _WIDE))
    _name_places(shown, first, panel.xaxis)
    _name_places(shown, second, panel.yaxis)
    panel.grid(visible=False)
    panel.legend(loc="lower left", bbox_to_anchor=(0, 1.0), ncols=2, borderaxespad=0.2)
    return figure


@styled
def scatter_figure(shown: StudyRows) -> Figure:
    """Draw each column over each other one, and the distribution of each on the diagonal."""
    names = _chosen(shown)
    size = max(WIDTH, 1.25 * len(names))
    figure, axes = panels(len(names), height=size, columns=len(names), shared=False)
    figure.set_size_inches(size, size)
    letters = int(_PER_INCH * size / len(names))
    rows = _drawn(shown, np.arange(len(shown.columns[names[0]])), _POINTS)
    _say_how_many(figure, shown, len(rows))
    for place, panel in enumerate(axes):
        i, j = divmod(place, len(names))
        x, y = (shown.columns[names[k]][rows] for k in (j, i))
        if i == j:
            panel.hist(x[np.isfinite(x)], bins=30, color=SOFT)
            panel.set_yticks([])
        else:
            panel.plot(x, y, ".", color=BLUE, markersize=1.5, alpha=0.5, rasterized=True)
        panel.tick_params(labelsize=SMALL)
        panel.grid(visible=False)
        _name_places(shown, names[j], panel.xaxis, 60.0)
        if i != j:
            _name_places(shown, names[i], panel.yaxis)
        if i == len(names) - 1:
            panel.set_xlabel(broken(shown.labels[names[j]], letters), fontsize=SMALL)
        elif not shown.is_number(names[j]):
            panel.tick_params(labelbottom=False)
        if j == 0:
            panel.set_ylabel(broken(shown.labels[names[i]], letters), fontsize=SMALL)
        elif not shown.is_number(names[i]):
            panel.tick_params(labelleft=False)
    return figure


@styled
def parallel_figure(shown: StudyRows) -> Figure:
    """Draw each row as a line across all columns, coloured by its rank in the last response."""
    from matplotlib import colormaps
    from matplotlib.collections import LineCollection

    names = _chosen(shown)
    figure, (panel,) = panels(1, height=4.2)
    rows = _drawn(shown, _whole_rows(shown), _LINES)
    _say_how_many(figure, shown, len(rows))
    scaled = np.stack([_scaled(shown.columns[name][rows]) for name in names], axis=1)
    # The colour is that of the last response that varies.
    ranked = (
        next((k for k in reversed(range(len(names))) if np.ptp(scaled[:, k]) > 0), None)
        if len(rows)
        else None
    )
    if ranked is not None:
        panel.set_title(f"coloured by {broken(shown.labels[names[ranked]], _WIDE)}", fontsize=8)
    order = np.argsort(scaled[:, -1 if ranked is None else ranked], kind="stable")
    places = np.arange(len(names))
    lines = [np.column_stack([places, row]) for row in scaled[order]]
    shades = np.zeros(len(lines)) if ranked is None else np.linspace(0, 1, len(lines))
    colours = colormaps["viridis"](shades)
    panel.add_collection(LineCollection(lines, colors=colours, linewidths=0.6, alpha=0.7))
    panel.set(xlim=(0, max(len(names) - 1, 1)), ylim=(-0.08, 1.08), yticks=[])
    letters = int(_PER_INCH * WIDTH / len(names))
    panel.set_xticks(places, [broken(shown.labels[name], letters) for name in names], fontsize=8)
    for place, name in enumerate(names):
        for text, height in _marks(shown, name, shown.columns[name][rows]):
            panel.text(place, height, text, ha="center", fontsize=SMALL, bbox=_BEHIND)
    panel.grid(visible=False)
    panel.grid(visible=True, axis="x", color=LINES[0], linewidth=0.8)
    return figure


def _marks(shown: StudyRows, name: str, values: Floats) -> list[tuple[str, float]]:
    """Texts along an axis of parallel coordinates with their heights: both ends, or names of all values."""
    low, high = values.min(), values.max()
    if shown.is_number(name):
        return [(number(low), -0.06), (number(high), 1.03)]
    places = np.unique(values)
    heights = np.where(places == low, -0.06, _scaled(places) + 0.03)
    return [(shown.choices[name][int(at)], float(height)) for at, height in zip(places, heights, strict=True)]


def _name_places(shown: StudyRows, name: str, axis: MatplotlibAxis, slope: float = 20.0) -> None:
    """Write the names of values along an axis in place of their numbers, `slope` degrees upwards below."""
    if shown.is_number(name):
        return
    names = shown.choices[name]
    if axis is axis.axes.xaxis:
        axis.set_ticks(range(len(names)), names, rotation=slope, ha="right", rotation_mode="anchor")
        axis.axes.set_xlim(-0.5, len(names) - 0.5)
    else:
        axis.set_ticks(range(len(names)), names)
        axis.axes.set_ylim(-0.5, len(names) - 0.5)


def figures(shown: StudyRows) -> dict[str, Figure]:
    """The pictures that suit the rows: a curve of one variable, maps of a grid of two, else two overviews."""
    varying = tuple(name for name in shown.variables if len(np.unique(shown.columns[name])) > 1)
    if shown.is_grid and len(varying) == 1:
        # What has one value makes no map.
        shown = replace(shown, variables=varying)
    if len(shown.variables) == 1:
        return {"curve": curve_figure(shown)}
    drawn: dict[str, Figure] = {}
    if shown.is_grid and len(shown.variables) == 2:
        drawn |= {f"map_{response}": map_figure(shown, response) for response in shown.responses}
        return drawn
    drawn["scatter"] = scatter_figure(shown)
    if _whole_rows(shown).size:
        drawn["parallel"] = parallel_figure(shown)
    return drawn


def _whole_rows(shown: StudyRows) -> Indices:
    """Numbers of the rows in which each column has a value: a line goes through all of them."""
    return np.flatnonzero(np.isfinite(np.stack([shown.columns[name] for name in _chosen(shown)])).all(axis=0))


def _chosen(shown: StudyRows) -> Sequence[str]:
    responses = shown.responses[: _PANELS - 1]
    return (*shown.variables[: _PANELS - len(responses)], *responses)


def _drawn(shown: StudyRows, rows: Indices, most: int) -> Indices:
    """A sample of the rows in random order, with those of the extremes of each column."""
    if len(rows) <= most:
        return rows
    some = np.random.default_rng(0).choice(rows, most, replace=False)
    ends = [rows[_ends(shown.columns[name][rows])] for name in _chosen(shown)]
    return np.unique(np.concatenate([some, *ends]))


def _ends(values: Floats) -> Indices:
    known = np.flatnonzero(np.isfinite(values))
    return known[[values[known].argmin(), values[known].argmax()]] if len(known) else known


def _say_how_many(figure: Figure, shown: StudyRows, n: int) -> None:
    """Write how many rows of how many are drawn, unless all are."""
    if n < shown.n_rows:
        figure.suptitle(f"{n} of {shown.n_rows} rows", fontsize=8)


def _scaled(values: Floats) -> Floats:
    span = np.ptp(values)
    return (values - values.min()) / span if span > 0 else np.full(len(values), 0.5)


_WORDS = {"motor_speed": "motor speed", "angle": "crank angle", "speed": "speed"}


@styled
def fit_figure(fit: Fit) -> Figure:
    """Draw each channel with the fitted motion, and below it the residuals with twice their noise."""
    record = fit.record
    is_angle = record.over == "angle"
    at = np.degrees(record.at) if is_angle else record.at
    figure, axes = panels(2 * len(record.channels), height=0.8 + 3.2 * len(record.channels))
    for place, (name, measured) in enumerate(record.channels.items()):
        above, below = axes[2 * place], axes[2 * place + 1]
        unit, fitted = record.unit(name), fit.predicted[name]
        above.plot(at, measured, ".", color=SOFT, markersize=3, label="record")
        above.plot(at, fitted, color=BLUE, linewidth=1.2, label="fitted machine")
        above.set_ylabel(f"{_WORDS.get(name, name)} [{unit or '–'}]")
        above.legend(loc="best")
        below.plot(at, measured - fitted, ".", color=RED, markersize=3)
        for side in (-2, 2):
            below.axhline(side * fit.noise[name], color=SOFT, linewidth=0.8, linestyle="--")
        below.axhline(0.0, color=INK, linewidth=0.8)
        below.set_ylabel(f"residual [{unit or '–'}]")
    axes[-1].set_xlabel("crank angle [°]" if is_angle else "time [s]")
    if is_angle:
        turn_axis(axes[-1], at, label=False)
    return figure


# Rows that are read for pictures; a grid is read as a whole, up to its own limit.
_ROWS, _GRID = 40_000, 4_000_000


def rows_of(folder: SweepFolder) -> dict[str, NDArray[Any]]:
    """Columns of a sweep, (n,) each; of a large one some rows. A `FindingError` without rows yet."""
    is_grid = folder.manifest["study"].get("sweep", {}).get("method", "grid") == "grid"
    every = -(-folder.n_rows // (_GRID if is_grid else _ROWS))
    names = ["row", *folder.units, "status", "reason"]
    parts = []
    for path in folder.parts():
        columns = columns_of(path, names)
        kept = columns["row"] % every == 0 if is_grid else _mixed(columns["row"]) % np.uint64(every) == 0
        if every > 1 and not is_grid:
            kept[np.concatenate([_ends(columns[name]) for name in folder.units])] = True
        parts.append({name: column[kept] for name, column in columns.items()})
    if not parts:
        raise FindingError(f"{folder.path}: no rows are computed yet")
    return {name: np.concatenate([part[name] for part in parts]) for name in names}


def _mixed(numbers: NDArray[Any]) -> NDArray[np.uint64]:
    """Numbers without any order, each always the same: splitmix64 (Steele, Lea, Flood, *OOPSLA*, 2014)."""
    mixed = numbers.astype(np.uint64) * np.uint64(0x9E3779B97F4A7C15)
    for shift, factor in ((30, 0xBF58476D1CE4E5B9), (27, 0x94D049BB133111EB)):
        mixed = (mixed ^ (mixed >> np.uint64(shift))) * np.uint64(factor)
    return mixed ^ (mixed >> np.uint64(31))
