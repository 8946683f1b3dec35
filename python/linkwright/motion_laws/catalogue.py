"""The catalogue of motion laws: each described once, for the machine file, the command line and the pages.

A law without parameters of its own is here in full; a law with some has them as arguments of ``law``, with
their usual values.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from linkwright.motion_laws import sine_series
from linkwright.motion_laws.boundary import Boundary
from linkwright.motion_laws.half_law import with_boundary
from linkwright.motion_laws.harmonic import double_harmonic, harmonic
from linkwright.motion_laws.modified_sine import modified_sine
from linkwright.motion_laws.modified_trapezoid import modified_trapezoid
from linkwright.motion_laws.motion_law import MotionLaw
from linkwright.motion_laws.parabolic import constant_velocity, parabolic
from linkwright.motion_laws.polynomial import polynomial_3_4_5, polynomial_4_5_6_7
from linkwright.motion_laws.shapes import at_rest_only, by_conditions, straight

Make = Callable[..., MotionLaw]


@dataclass(frozen=True)
class Entry:
    """A law of the catalogue.

    Attributes
    ----------
    law : callable
        Gives f(z) from 0 to 1; its arguments are the parameters of the law.
    words : str
        What it is, on one line.
    source : str
        Where it is from.
    section : callable
        Gives x(z) of a section with any boundary values, of the law and the task.
    parameters : dict
        Usual values of the parameters.
    """

    law: Make
    words: str
    source: str
    section: Callable[[MotionLaw, Boundary], MotionLaw] = with_boundary
    parameters: dict[str, Any] = field(default_factory=dict)

    def over(self, task: Boundary, **parameters: Any) -> MotionLaw:
        """The law of a section.

        Parameters
        ----------
        task : Boundary
            What the section has to do.
        **parameters
            Of the law.

        Returns
        -------
        MotionLaw
            x(z) from 0 to 1, beginning with 0.

        Raises
        ------
        LawError
            The law cannot meet these boundary values.
        """
        return self.section(self.law(**self.parameters | parameters), task)


def _by_task(make: Callable[[Boundary], MotionLaw]) -> Callable[[MotionLaw, Boundary], MotionLaw]:
    """A section that is made of the task alone."""
    return lambda law, task: make(task)


_HANDBOOK = "Rothbart (ed.), Cam Design Handbook (2004)"
_VDI = "VDI 2143 Blatt 1 (1980)"

# In the order of the tables.
LAWS: dict[str, Entry] = {
    "constant_velocity": Entry(constant_velocity, "straight line", _VDI, _by_task(straight)),
    "parabolic": Entry(parabolic, "constant acceleration, then as much deceleration", _VDI),
    "harmonic": Entry(harmonic, "one cosine, the motion of a Scotch yoke", _VDI),
    "double_harmonic": Entry(double_harmonic, "two cosines, soft at its start only", _HANDBOOK, at_rest_only),
    "cycloidal": Entry(sine_series.cycloidal, "acceleration of one sine (Bestehorn)", _VDI),
    "modified_trapezoid": Entry(
        modified_trapezoid,
        "constant acceleration with ramps of quarter sines",
        _VDI,
        parameters={"share": 1 / 8},
    ),
    "modified_sine": Entry(
        modified_sine, "slow cosine between two quick quarter sines", _VDI, parameters={"share": 1 / 8}
    ),
    "gutman_1_3": Entry(sine_series.gutman_1_3, "first and third harmonic of the parabola", "Gutman (1961)"),
    "freudenstein_1_3": Entry(
        sine_series.freudenstein_1_3, "sines 1 and 3, small peak of acceleration", "Freudenstein (1960)"
    ),
    "freudenstein_1_3_5": Entry(
        sine_series.freudenstein_1_3_5, "sines 1, 3 and 5, small peak of acceleration", "Freudenstein (1960)"
    ),
    "polynomial_3_4_5": Entry(
        polynomial_3_4_5, "least ∫ jerk² of rest to rest", _VDI, _by_task(by_conditions)
    ),
    "polynomial_4_5_6_7": Entry(
        polynomial_4_5_6_7,
        "jerk vanishes at the ends",
        _HANDBOOK,
        _by_task(partial(by_conditions, continuity_start=3, continuity_end=3)),
    ),
}

# What stands in a section with a lift and without a law.
USUAL = "polynomial_3_4_5"
