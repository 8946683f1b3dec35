r"""The catalogue of motion laws, each described once with its source; theoretical bounds of their factors.

A law without parameters of its own is here in full; a law with some has them as arguments of ``law``, with
their usual values.

What no law of rest to rest from 0 to 1 over a length of one can go below:

.. math:: C_v \ge 1, \quad C_a \ge 4, \quad C_j \ge 32, \quad \int \ddot x^2 \ge 12,
          \quad \int \dddot x^2 \ge 720

Each follows by integrating by parts against a fixed function. With the velocity zero at both ends,
:math:`1 = \int (\tfrac12 - z)\,\ddot x\,dz`, so that :math:`1 \le C_a \int |\tfrac12 - z| dz = C_a/4` and, by
Schwarz, :math:`1 \le \int \ddot x^2 \cdot \tfrac1{12}`. With the acceleration zero there too,
:math:`1 = \int p\,\dddot x\,dz` for every :math:`p = \tfrac12 z^2 - \tfrac12 z + c`; the best c gives
:math:`1 \le C_j/32` (c = 3/32) and :math:`1 \le \int \dddot x^2/720` (c = 1/12).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import Any, NamedTuple

from linkwright.cam.laws.boundary import Boundary, by_conditions, straight, suited
from linkwright.cam.laws.handbook import (
    constant_velocity,
    cycloidal,
    double_harmonic,
    freudenstein_1_3,
    freudenstein_1_3_5,
    gutman_1_3,
    harmonic,
    modified_sine,
    modified_trapezoid,
    parabolic,
)
from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.cam.laws.optimal import minimum_acceleration, minimum_jerk, optimal_section
from linkwright.cam.laws.polynomial import polynomial_3_4_5, polynomial_4_5_6_7
from linkwright.cam.laws.ramps import s_curve, start_and_stop, trapezoidal_velocity

REST_TO_REST = Boundary(1.0)


@dataclass(frozen=True)
class Entry:
    """A law of the catalogue.

    Attributes
    ----------
    words : str
        What it is, on one line.
    source : str
        Where it is from.
    law : callable or None
        Gives f(z) from 0 to 1 of the parameters; None if the law is made of its task.
    of_task : callable or None
        Gives x(z) of a section of the task and the parameters; None if it follows from f.
    parameters : dict
        Usual values of the parameters.
    """

    words: str
    source: str
    law: Callable[..., MotionLaw] | None = None
    of_task: Callable[..., MotionLaw] | None = None
    parameters: dict[str, Any] = field(default_factory=dict)

    def normalised(self, **parameters: Any) -> MotionLaw:
        """f(z) from rest to rest, z and f from 0 to 1; missing parameters have their usual values."""
        if self.law is not None:
            return self.law(**self.parameters | parameters)
        return self.section(REST_TO_REST, **parameters)

    def section(self, task: Boundary, **parameters: Any) -> MotionLaw:
        """The law x(z) of a section from 0 to 1, beginning with 0, with any boundary values.

        Parameters that are missing have their usual values. Raises `LawError` if it cannot meet these
        boundary values.
        """
        if self.of_task is not None:
            return self.of_task(task, **self.parameters | parameters)
        return suited(self.normalised(**parameters), task)


_HANDBOOK = "Rothbart (ed.), Cam Design Handbook (2004)"
_VDI = "VDI 2143 Blatt 1 (1980)"
_SHARE = {"share": 1 / 8}
_SIXTHS = {"start": 1 / 6, "stop": 1 / 6}
_THIRDS = {"start": 1 / 3, "stop": 1 / 3}

# In the order of the tables: from the simple ones on, then by boundary values, then with constant velocity.
LAWS: dict[str, Entry] = {
    "constant_velocity": Entry("straight line", _VDI, constant_velocity, straight),
    "parabolic": Entry("constant acceleration, then as much deceleration", _VDI, parabolic),
    "harmonic": Entry("one cosine, the motion of a Scotch yoke", _VDI, harmonic),
    "double_harmonic": Entry("two cosines, soft at its start only", _HANDBOOK, double_harmonic),
    "cycloidal": Entry("acceleration of one sine (Bestehorn)", _VDI, cycloidal),
    "modified_trapezoid": Entry(
        "constant acceleration with ramps of quarter sines", _VDI, modified_trapezoid, parameters=_SHARE
    ),
    "modified_sine": Entry(
        "slow cosine between two quick quarter sines", _VDI, modified_sine, parameters=_SHARE
    ),
    "gutman_1_3": Entry("harmonics 1 and 3 of the parabola", "Gutman (1961), by " + _HANDBOOK, gutman_1_3),
    "freudenstein_1_3": Entry(
        "sines 1 and 3, small peak of acceleration",
        "Freudenstein (1960), by " + _HANDBOOK,
        freudenstein_1_3,
    ),
    "freudenstein_1_3_5": Entry(
        "sines 1, 3 and 5, small peak of acceleration",
        "Freudenstein (1960), by " + _HANDBOOK,
        freudenstein_1_3_5,
    ),
    "polynomial_3_4_5": Entry("velocity and acceleration by task", _VDI, polynomial_3_4_5, by_conditions),
    "polynomial_4_5_6_7": Entry(
        "jerk zero at the ends too",
        _HANDBOOK,
        polynomial_4_5_6_7,
        partial(by_conditions, continuity_start=3, continuity_end=3),
    ),
    "optimal": Entry(
        "minimum ∫ of the square of a derivative (here: acceleration)",
        "Gelfand and Fomin, Calculus of Variations (1963)",
        of_task=optimal_section,
        parameters={"order": 2},
    ),
    "minimum_acceleration": Entry(
        "minimum peak of acceleration", "Pontryagin et al. (1962)", of_task=minimum_acceleration
    ),
    "minimum_jerk": Entry(
        "minimum peak of jerk, no acceleration at the ends", "Pontryagin et al. (1962)", of_task=minimum_jerk
    ),
    "combined": Entry(
        "start, constant velocity, braking; ramps of minimum ∫ jerk²",
        "paper 2, equations (1)–(10)",
        start_and_stop,
        parameters=_SIXTHS | {"ramp": "optimal_jerk"},
    ),
    "trapezoidal_velocity": Entry(
        "straight ramps of the velocity",
        "Biagiotti and Melchiorri, Trajectory Planning (2008)",
        trapezoidal_velocity,
        parameters=_THIRDS,
    ),
    "s_curve": Entry(
        "ramps with rounded corners",
        "Biagiotti and Melchiorri, Trajectory Planning (2008)",
        s_curve,
        parameters=_THIRDS | {"rounding": 1 / 4},
    ),
}


class LowerBound(NamedTuple):
    """A bound from below."""

    name: str  # of the factor
    value: float
    reached_by: str  # law of the catalogue that has this value
    holds_for: str  # laws that it holds for


_REST = "velocity zero at both ends"
_SOFT = "velocity and acceleration zero at both ends"

BOUNDS = (
    LowerBound("C_v", 1.0, "constant_velocity", "every law"),
    LowerBound("C_a", 4.0, "parabolic", _REST),
    LowerBound("C_j", 32.0, "minimum_jerk", _SOFT),
    LowerBound("acceleration_squared", 12.0, "optimal", _REST),
    LowerBound("jerk_squared", 720.0, "polynomial_3_4_5", _SOFT),
)
