"""What each formula of paper 3 does to the natural frequencies, as a table."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from linkwright.papers.paper3.rows import share

if TYPE_CHECKING:
    from linkwright.papers.paper3.engine import Shift
    from linkwright.papers.paper3.paper import Paper3

# Heads, with the units that stand in brackets.
COLUMNS = (
    ("disc or stiffness by", ""),
    ("of the throw", ""),
    ("coupling", "Hz"),
    ("crank 1", "Hz"),
    ("crank 2", "Hz"),
    ("crank 1 met by the firing", "rpm"),
)


def cells(paper: Paper3) -> list[list[str]]:
    """Texts of the table, the exact train first.

    Parameters
    ----------
    paper : Paper3
        What was computed.

    Returns
    -------
    list of list of str
        A row a formula, a text a column.
    """
    trial = paper.trial
    exact = [f"{f:.1f}" for f in trial.frequencies]
    critical = _rpm(trial.critical(float(trial.frequencies[1])))
    values = f"J = {trial.inertia:.4f} kg m², k = {1e-6 * trial.stiffness:.3f} MN m/rad"
    first = ["exact mean of J(φ), (17) with k by Castigliano", values, *exact, critical]
    return [first, *(_row(each) for each in (*paper.inertia.shifts, *paper.throw.shifts))]


def _row(shift: Shift) -> list[str]:
    """One formula."""
    texts = [f"{f:.1f} ({share(c)})" for f, c in zip(shift.frequencies, shift.changes, strict=True)]
    return [shift.name, f"{shift.what} {share(shift.deviation)}", *texts, _rpm(shift.critical)]


def _rpm(speed: float) -> str:
    return f"{speed * 30 / math.pi:.0f}"
