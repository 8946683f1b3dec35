"""Tables of the torsional vibration of a train."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from linkwright.analysis.torsion.free import FreeVibration, Node
from linkwright.analysis.torsion.holzer import HolzerTable
from linkwright.analysis.torsion.study import TorsionStudy
from linkwright.report.table import Row, Table

Floats = NDArray[np.float64]

# Parts that share most of the energy, as far as they have a twentieth of it.
_NAMED, _SHARE = 2, 0.05

# Columns of shapes beside each other on a terminal.
_SHAPES = 5


def study_tables(study: TorsionStudy) -> Iterator[Table]:
    """All tables of a study of torsional vibration.

    Parameters
    ----------
    study : TorsionStudy
        What to write.

    Yields
    ------
    Table
        For terminal and report.
    """
    yield from torsion_tables(study.free)
    for each in study.holzer:
        yield from holzer_tables(each)


def torsion_tables(found: FreeVibration) -> Iterator[Table]:
    """Frequencies with nodes and energy; then the shapes.

    Parameters
    ----------
    found : FreeVibration
        What to write.

    Yields
    ------
    Table
        For terminal and report.
    """
    yield _frequencies(found)
    for start in range(0, len(found.natural_frequencies), _SHAPES):
        yield _shapes(found, range(start, min(start + _SHAPES, len(found.natural_frequencies))))


def _frequencies(found: FreeVibration) -> Table:
    rows: list[Row] = [
        (
            _energy(found, k),
            f"f_{k}",
            f"{f:.6g}",
            f"{60 * f:.6g}",
            ", ".join(map(_node, found.nodes[k])) or "–",
        )
        for k, f in enumerate(found.natural_frequencies.tolist())
    ]
    heads = ("most energy in", "", "Hz", "1/min", "nodes")
    return Table("natural_frequencies", "Natural frequencies", heads, rows)


def _node(node: Node) -> str:
    """Where a node is: a disc, or a shaft and the share of its twist."""
    return node.at if node.share == 0 else f"{node.at} {node.share:.3f}"


def _energy(found: FreeVibration, k: int) -> str:
    """The shafts that twist most and the discs that swing most."""
    if found.natural_frequencies[k] == 0:
        return "turns as a whole"
    parts = (
        _most(found.shafts, found.potential_shares[k]),
        _most(found.discs, found.kinetic_shares[k]),
    )
    return "; ".join(parts)


def _most(names: tuple[str, ...], shares: Floats) -> str:
    order = np.argsort(-shares, kind="stable")[:_NAMED]
    return ", ".join(f"{names[n]} {100 * shares[n]:.0f} %" for n in order if shares[n] >= _SHARE)


def _shapes(found: FreeVibration, modes: range) -> Table:
    rows: list[Row] = [
        (name, "", *(f"{found.mode_shapes[k, n]:.6f}" for k in modes)) for n, name in enumerate(found.discs)
    ]
    heads = ("disc", "", *(f"mode {k}" for k in modes))
    return Table("mode_shapes", "Mode shapes, largest amplitude 1", heads, rows)


def holzer_tables(found: HolzerTable) -> Iterator[Table]:
    """Holzer's table: discs, then shafts.

    Parameters
    ----------
    found : HolzerTable
        What to write.

    Yields
    ------
    Table
        For terminal and report.
    """
    columns = (found.inertia, found.inertia_squared, found.amplitude, found.torque)
    rows: list[Row] = [
        (name, "", *(f"{column[n]:.6g}" for column in columns)) for n, name in enumerate(found.discs)
    ]
    rows.append(("left over at " + found.end, "", "", "", "", f"{found.residual_torque:.6g}"))
    heads: Row = ("disc", "", "J [kg m²]", "J ω² [N m/rad]", "amplitude θ", "J ω² θ [N m]")
    yield Table("holzer_discs", f"Holzer's table at {found.frequency:.6g} Hz", heads, rows)
    of_shafts = (found.stiffness, found.twist, found.shaft_torque)
    rows = [(name, "", *(f"{column[n]:.6g}" for column in of_shafts)) for n, name in enumerate(found.shafts)]
    yield Table("holzer_shafts", "Its shafts", ("shaft", "", "k [N m/rad]", "twist", "torque [N m]"), rows)
