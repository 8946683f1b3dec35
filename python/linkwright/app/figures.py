"""Curves of a study in one picture: those of one unit on one axis."""

from __future__ import annotations

from collections.abc import Sequence
from io import BytesIO
from typing import TYPE_CHECKING

import numpy as np

from linkwright.app.curves import CRANK_ANGLE, Curve
from linkwright.kernel.figure.style import LINES, legend_above, named, panels, roomy, styled, zero_line
from linkwright.kernel.page.out_units import reader

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Height of each axis, and of what stands around them [inch].
_PANEL, _AROUND = 2.0, 0.8


@styled
def curves_figure(curves: Sequence[Curve], zero: str = "") -> Figure:
    """Draw curves over one quantity, an axis for each unit; `zero`: from where crank angles are counted."""
    by_unit: dict[tuple[str, float], list[Curve]] = {}
    for curve in curves:
        by_unit.setdefault(_shown(curve.unit), []).append(curve)
    figure, axes = panels(len(by_unit), height=_AROUND + _PANEL * len(by_unit))
    colours = iter(LINES * len(curves))
    for panel, ((unit, factor), group) in zip(axes, by_unit.items(), strict=True):
        for member in group:
            x = member.x / _shown(member.over_unit)[1]
            panel.plot(x, member.values / factor, color=next(colours), label=named(_short(member)))
        panel.set_ylabel(f"[{unit or '–'}]")
        roomy(panel, *(member.values[np.isfinite(member.values)] / factor for member in group))
        zero_line(panel)
        legend_above(panel)
    _under(axes[-1], curves, zero)
    return figure


def _under(axes: Axes, curves: Sequence[Curve], zero: str) -> None:
    """What is along x."""
    first = curves[0]
    unit, factor = _shown(first.over_unit)
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


def _shown(unit: str) -> tuple[str, float]:
    """The unit of an axis and its size: angles in degrees, unless another unit of angles is wanted."""
    return reader().shown(unit, "deg" if unit == "rad" else "")


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
