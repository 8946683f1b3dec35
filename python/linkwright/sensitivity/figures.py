"""What a response owes to each entry, as bars by influence."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from linkwright.kernel.figure.style import ADDRESS_LETTERS, BLUE, INK, RED, panels, shortened, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from linkwright.sensitivity.gradient import Gradient

# Entries that are shown: what comes after changes a response by less than these.
ROWS = 12


@styled
def influence_figure(gradient: Gradient, *responses: str) -> Figure:
    """Draw by how much responses change for 1 % more of each entry, what matters most at the top.

    `responses`: those of ``gradient.responses`` that are wanted, none of them zero.
    """
    shown = {response: _shown(gradient, response) for response in responses}
    height = sum(0.9 + 0.24 * max(len(entries), 3) for entries in shown.values())
    figure, axes = panels(len(shown), height=height, shared=False)
    for axis, (response, entries) in zip(axes, shown.items(), strict=True):
        _bars(axis, gradient, gradient.responses.index(response), entries)
    return figure


def _shown(gradient: Gradient, response: str) -> list[int]:
    row = gradient.responses.index(response)
    return [at for at in gradient.ranked(response) if np.isfinite(gradient.elasticities[row, at])][:ROWS][
        ::-1
    ]


def _bars(axes: Axes, gradient: Gradient, row: int, shown: list[int]) -> None:
    shares = gradient.elasticities[row, shown]
    names = [shortened(gradient.variables[at], ADDRESS_LETTERS) for at in shown]
    axes.barh(range(len(names)), shares, color=[BLUE if share > 0 else RED for share in shares], height=0.62)
    axes.set_yticks(range(len(names)), names)
    axes.axvline(0.0, color=INK, linewidth=0.8)
    axes.grid(visible=False, axis="y")
    # The axes stand to the right of long names: one line would leave the picture.
    axes.set_xlabel(f"change of the {gradient.words[row]}\nfor 1 % more of the entry [%]")
    axes.margins(x=0.12)
    for place, share in enumerate(shares):
        side = "left" if share > 0 else "right"
        axes.annotate(
            f"{share:+.2g}".replace("-", "−"),
            (share, place),
            xytext=(3 if share > 0 else -3, 0),
            textcoords="offset points",
            ha=side,
            va="center",
            fontsize=8,
        )
