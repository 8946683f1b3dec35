"""The figures of forces with their captions."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.kernel.figure.captioned import Captioned
from linkwright.kernel.page.numbers import number
from linkwright.kinetostatics.figures.forces import forces_figure, hodograph_figure, polar_figure
from linkwright.kinetostatics.result import Forces


def captioned_forces(forces: Forces) -> Iterator[Captioned]:
    """The figures of forces with their captions."""
    pins = forces.reaction_max
    largest = max(pins, key=lambda name: pins[name])
    caption = (
        f"Joint reactions along the steady motion: {largest} at most {number(pins[largest])} N. "
        f"The drive gives up to {number(forces.torque_drive_max)} N m at the crank."
    )
    yield Captioned("forces", "Forces in the pairs", caption, forces_figure(forces))
    caption = (
        f"Ends of the force vectors over one revolution, a mark at φ = 0; the shaking force is up to "
        f"{number(forces.shaking_force_max)} N."
    )
    yield Captioned("hodographs", "Hodographs of forces", caption, hodograph_figure(forces))
    caption = "Size of the largest reactions over the crank angle: where a journal is loaded, and when."
    yield Captioned("reactions", "Reactions, polar", caption, polar_figure(forces))
