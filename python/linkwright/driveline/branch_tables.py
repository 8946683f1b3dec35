"""Branches of steady motions of an elastic driveline as a table and a figure."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from linkwright.driveline.branches import ElasticBranch, ElasticBranches
from linkwright.kernel.figure.lines import Line, Panel, line_figure
from linkwright.kernel.figure.style import LINES, styled
from linkwright.kernel.page.table import Row, Table
from linkwright.kernel.reader.numbers import number, parted

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Rows of a branch in a table.
_ROWS = 12


def branch_tables(branches: ElasticBranches) -> Iterator[Table]:
    """Motions along the branches, and where their stability changes."""
    heads: Row = (
        "motion",
        "",
        branches.address,
        *(f"{name}: peak torque" for name in branches.shafts),
        "|μ|",
    )
    rows: list[Row] = []
    for k, branch in enumerate(branches.branches):
        for n in np.unique(np.linspace(0, len(branch.parameter) - 1, _ROWS).astype(int)):
            peaks = (" ".join(parted(float(peak), "N m")) for peak in branch.torque_peak[:, n])
            state = "stable" if branch.is_stable[n] else "unstable"
            at, multiplier = number(float(branch.parameter[n])), number(float(branch.multiplier_max[n]))
            rows.append((f"branch {k + 1}: {state}", "", at, *peaks, multiplier))
    yield Table(
        "elastic_branches", "Elastic driveline: steady motions over a number of the file", heads, rows
    )
    special: list[Row] = [
        (f"branch {k + 1}: {point.kind}", "", number(point.parameter))
        for k, branch in enumerate(branches.branches)
        for point in branch.special
    ]
    if special:
        title = "Elastic driveline: changes of stability"
        yield Table("elastic_special", title, ("point", "", branches.address), special)


@styled
def branch_figure(branches: ElasticBranches) -> Figure:
    """Draw the peak torque of every shaft: stable motions as lines, unstable ones dashed, folds as dots."""
    panels = [
        Panel(f"peak torque of\n{name} [N m]", list(_lines(branches, shaft)), room=None)
        for shaft, name in enumerate(branches.shafts)
    ]
    over = np.concatenate([branch.parameter for branch in branches.branches])
    ends = np.array([over.min(), over.max()])
    return line_figure(ends, *panels, height=1.4 + 2.4 * len(panels), over=branches.address)


def _lines(branches: ElasticBranches, shaft: int) -> Iterator[Line]:
    for k, branch in enumerate(branches.branches):
        colour = LINES[k % len(LINES)]
        for is_stable, form, label in ((True, "-", "stable"), (False, ":", "unstable")):
            y = np.where(_beside(branch.is_stable == is_stable), branch.torque_peak[shaft], np.nan)
            if np.isfinite(y).any():
                yield Line(y, colour, label if k == 0 else "", branch.parameter, form)
        yield from _marks(branch, shaft)


def _beside(chosen: np.ndarray) -> np.ndarray:
    """The chosen motions and the one before each, so that lines of both kinds meet."""
    before = chosen.copy()
    before[:-1] |= chosen[1:]
    return before


def _marks(branch: ElasticBranch, shaft: int) -> Iterator[Line]:
    folds = np.array([point.parameter for point in branch.special if point.kind == "fold"])
    at = [int(np.argmin(np.abs(branch.parameter - fold))) for fold in folds]
    if at:
        yield Line(branch.torque_peak[shaft, at], "black", "", folds, "o", {"markersize": 3})
