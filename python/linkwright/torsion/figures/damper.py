"""A damper for a mode of a train: what it leaves of the resonance."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkwright.kernel.figure.style import BLUE, RED, SOFT, legend_above, level, panels, styled

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from linkwright.torsion.damper.damper_design import DamperDesign

# Height of the picture over the best damper's peak: the resonance without damping has no end.
_TOP = 3.0


@styled
def damper_figure(found: DamperDesign) -> Figure:
    """Draw the twist of the watched shaft over the frequency, without damper and with it."""
    figure, (axes,) = panels(1, height=3.2)
    lines = (
        (found.response_bare, SOFT, "without damper"),
        (found.response_rule, RED, "mode alone"),
        (found.response_best, BLUE, "best"),
    )
    for response, colour, label in lines:
        axes.plot(found.frequencies, response, color=colour, label=label)
    level(axes, found.magnification, "promised")
    axes.set_ylim(0, _TOP * max(found.magnification_best, found.magnification))
    axes.set_xlim(found.frequencies[0], found.frequencies[-1])
    axes.set_xlabel("frequency [Hz]")
    axes.set_ylabel(f"twist of {found.watched}\nover that at rest [–]")
    legend_above(axes)
    return figure
