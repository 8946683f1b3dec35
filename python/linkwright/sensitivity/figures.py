"""What a response owes to each entry, as bars by influence."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from linkwright.kernel.figure.style import ADDRESS_LETTERS, BLUE, INK, RED, panels, shortened, styled
from linkwright.sensitivity.tables import ROWS, ranked

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from linkwright.sensitivity.gradient import Gradient


@styled
def influence_figure(gradient: Gradient, response: str) -> Figure:
    """Draw by how much a response changes for 1 % more of each entry, what matters most at the top.

    `response`: one of ``gradient.responses`` that is not zero.
    """
    row = gradient.responses.index(response)
    shown = [at for at in ranked(gradient, response) if np.isfinite(gradient.elasticities[row, at])][:ROWS]
    shares = gradient.elasticities[row, shown][::-1]
    names = [shortened(gradient.variables[at], ADDRESS_LETTERS) for at in shown][::-1]
    figure, (axes,) = panels(1, height=0.9 + 0.24 * max(len(shown), 3))
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
    return figure
