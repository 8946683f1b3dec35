"""Forces at the joints of a link and its bending moment over the crank angle."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np

from linkwright.finite_elements.result import LinkLoads
from linkwright.kernel.figure.lines import Line, Panel, line_figure
from linkwright.kernel.figure.style import LINES, LOAD, CaptionedFigure, named, styled

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Forces that are drawn: the largest.
_MOST = 6


def captioned_links(links: Mapping[str, LinkLoads]) -> Iterator[CaptionedFigure]:
    """A figure for each link."""
    for name, loads in links.items():
        caption = (
            "Sizes of the forces at its joints, and the bending moment of the section where it is largest, "
            "with its sign."
        )
        yield CaptionedFigure(f"loads_{name}", f"Loads on {name}", caption, loads_figure(loads))


@styled
def loads_figure(loads: LinkLoads) -> Figure:
    """Draw forces and bending moment over the crank angle."""
    largest = sorted(loads.loads.values(), key=lambda load: -loads.force_max[load.name])[:_MOST]
    forces = [Line(load.size, colour, named(load.name)) for load, colour in zip(largest, LINES, strict=False)]
    panels = [Panel("force [N]", forces, room=None)] if forces else []
    return line_figure(
        np.degrees(loads.crank_angle),
        *panels,
        Panel("bending moment [N m]", [Line(loads.bending, LOAD)]),
        height=4.2,
    )
