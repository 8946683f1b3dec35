"""Loads on links as tables of text."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from linkwright.finite_elements.result import LinkLoads
from linkwright.kernel.page.table import Row, Table
from linkwright.kernel.reader.numbers import crank_angle, cycle_of_angles, measured, number


def links_tables(links: Mapping[str, LinkLoads]) -> Iterator[Table]:
    """Mass, bending moment and balance of every link; then the loads of each at their peaks."""
    heads = ("link", "", "mass", "maximum bending moment", "at φ", "residual of the balance")
    rows: list[Row] = []
    for name, loads in links.items():
        peak = _peak(loads.bending)
        scale = max(loads.force_max.values(), default=0.0) * loads.size
        moment = measured(float(loads.bending[peak]), "N m", scale)
        at = _at(loads, peak) if moment != measured(0.0, "N m") else "–"
        rows.append((name, "", measured(loads.mass, "kg"), moment, at, number(loads.residual, 2)))
    yield Table("links", "Links", heads, rows)
    yield from (loads_table(loads) for loads in links.values())


def loads_table(loads: LinkLoads) -> Table:
    """The largest force of each joint, drive and load of a link in its own axes."""
    forces = max(loads.force_max.values(), default=0.0)
    rows: list[Row] = []
    for name, load in loads.loads.items():
        peak = _peak(load.size if load.size.any() else load.moment)
        along, across = load.force[peak].tolist()
        rows.append(
            (
                name,
                "",
                measured(float(load.size[peak]), "N", forces),
                _at(loads, peak),
                measured(along, "N", forces),
                measured(across, "N", forces),
                measured(float(load.moment[peak]), "N m", forces * loads.size),
            )
        )
    heads = ("load", "", "peak", "at φ", "along", "across", "moment")
    return Table(f"loads_{loads.link}", f"Loads on {loads.link} in its own axes", heads, rows)


def _peak(curve: np.ndarray) -> int:
    return int(np.nanargmax(np.abs(curve)))


def _at(loads: LinkLoads, place: int) -> str:
    return crank_angle(float(loads.crank_angle[place]), cycle=cycle_of_angles(loads.crank_angle))
