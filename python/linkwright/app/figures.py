"""Curves of a study in one picture: those of one unit on one axis."""

from __future__ import annotations

from collections.abc import Sequence
from io import BytesIO
from typing import TYPE_CHECKING

import numpy as np

from linkwright.app.curves import CRANK_ANGLE, Curve
from linkwright.kernel.figure.style import LINES, legend_above, named, panels, roomy, styled, zero_line
from linkwright.kernel.page.out_units import OutUnits

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Height of each axis, and of what stands around them [inch].
_PANEL, _AROUND = 2.0, 0.8

_DEGREE = np.pi / 180


@styled
def curves_figure(curves: Sequence[Curve], units: OutUnits, zero: str = "") -> Figure:
    """Draw curves, an axis for each unit.

    `curves`: over one quantity; `units`: those of the axes; `zero`: from where crank angles are counted.
    """
    by_unit: dict[tuple[str, float], list[Curve]] = {}
    for curve in curves:
        by_unit.setdefault(units.shown(curve.unit), []).append(curve)
    figure, axes = panels(len(by_unit), height=_AROUND + _PANEL * len(by_unit))
    colours = iter(LINES * len(curves))
    for panel, ((unit, factor), group) in zip(axes, by_unit.items(), strict=True):
        for member in group:
            x = member.x / _over_unit(member, units)[1]
            panel.plot(x, member.values / factor, color=next(colours), label=named(_short(member)))
        panel.set_ylabel(f"[{unit or '–'}]")
        roomy(panel, *(member.values[np.isfinite(member.values)] / factor for member in group))
        zero_line(panel)
        legend_above(panel)
    _under(axes[-1], curves, units, zero)
    return figure


def _under(axes: Axes, curves: Sequence[Curve], units: OutUnits, zero: str) -> None:
    """What is along x."""
    first = curves[0]
    unit, factor = _over_unit(first, units)
    word = "crank angle φ" if first.over == CRANK_ANGLE else first.over
    if zero and first.over == CRANK_ANGLE:
        word += f" from the {zero}"
    axes.set_xlabel(f"{word} [{unit or '–'}]")
    low = min(float(np.nanmin(curve.x)) for curve in curves) / factor
    high = max(float(np.nanmax(curve.x)) for curve in curves) / factor
    if high > low:
        axes.set_xlim(low, high)
    if unit == "°" and 0 < high - low <= 720.5:
        axes.set_xticks(
            np.arange(np.ceil(low / 45 - 1e-6) * 45, high + 1e-6, 45 if high - low <= 361 else 90)
        )


def _over_unit(curve: Curve, units: OutUnits) -> tuple[str, float]:
    """Unit along x: crank angles in degrees, unless another unit of angles is wanted."""
    found = units.shown(curve.over_unit)
    return ("°", _DEGREE) if found[0] == "rad" and curve.over == CRANK_ANGLE else found


def _short(curve: Curve) -> str:
    """A name without the analysis."""
    return curve.name.split(".", 1)[1]


@styled
def bytes_of(figure: Figure, ending: str) -> bytes:
    """A figure as a file: ``".png"``, ``".svg"`` or ``".pdf"``; the same bytes in every run."""
    from linkwright.kernel.figure.svg import png, svg

    if ending == ".png":
        return png(figure)
    if ending == ".svg":
        return svg(figure).encode()
    data = BytesIO()
    figure.savefig(data, format="pdf", metadata={"CreationDate": None})
    return data.getvalue()
