"""What the designer of a linkage should know although it moves, in sentences."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from linkwright.kernel.reader.numbers import cycle_of_angles, degrees
from linkwright.linkages.cycle import Linkage

# Links this near to a line go on one way or the other by tolerances of their lengths; nearer than the first
# they are in line, as in a parallelogram, and go on as they came [rad].
_IN_LINE, _NEAR = 1e-6, np.radians(1.0)


def linkage_warnings(linkage: Linkage, zero: float = 0.0) -> Iterator[str]:
    """Elements whose links almost come into line. `zero`: crank angle from which angles are counted [rad]."""
    for element in linkage.elements:
        worst = element.transmission_angle_worst
        if worst is None or not _IN_LINE < worst < _NEAR:
            continue
        is_least = worst == element.transmission_angle_min
        at = element.transmission_angle_min_angle if is_least else element.transmission_angle_max_angle
        angle = ((at or 0.0) - zero) % cycle_of_angles(linkage.crank_angle)
        yield (
            f"The links of {element.element} come within {degrees(worst)} of a straight line at a crank "
            f"angle of {degrees(angle)}, close to a change point: small length errors may switch the "
            "assembly mode, and velocities and forces grow as this angle decreases"
        )
