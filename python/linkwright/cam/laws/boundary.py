r"""What a section of a programme has to do, counted over its own z from 0 to 1: the task of VDI 2143.

Derivatives count by z: a section over the angle β with the slope s′ has the velocity s′ β and the
acceleration s″ β² here. The ends of VDI 2143 are

| letter | end | velocity | acceleration |
| --- | --- | --- | --- |
| R | dwell (Rast) | 0 | 0 |
| G | constant speed (Geschwindigkeit) | v | 0 |
| U | turning point (Umkehr) | 0 | a |
| B | any motion (Bewegung) | v | a |

Source: VDI 2143 Blatt 1 (1980).
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Boundary:
    """Lift over a section, and velocity and acceleration at its ends, by z.

    Attributes
    ----------
    lift : float
        Change over the section [m or rad].
    velocity_start, velocity_end : float
        [m or rad].
    acceleration_start, acceleration_end : float or None
        [m or rad]; None leaves it to the law, which has none unless it says so.
    """

    lift: float
    velocity_start: float = 0.0
    velocity_end: float = 0.0
    acceleration_start: float | None = None
    acceleration_end: float | None = None

    @property
    def letters(self) -> str:
        """The task in the letters of VDI 2143, such as ``"R-G"``."""
        ends = (
            (self.velocity_start, self.acceleration_start or 0.0),
            (self.velocity_end, self.acceleration_end or 0.0),
        )
        return "-".join("RGUB"[(v != 0) + 2 * (a != 0)] for v, a in ends)
