r"""What no law of rest to rest can go below, with the law that gets there.

For x from 0 to 1 over a length of one:

.. math:: C_v \ge 1, \quad C_a \ge 4, \quad C_j \ge 32, \quad \int \ddot x^2 \ge 12,
          \quad \int \dddot x^2 \ge 720

Each follows by integrating by parts against a fixed function. With the velocity zero at both ends,
:math:`1 = \int (\tfrac12 - z)\,\ddot x\,dz`, so that :math:`1 \le C_a \int |\tfrac12 - z| dz = C_a/4` and, by
Schwarz, :math:`1 \le \int \ddot x^2 \cdot \tfrac1{12}`. With the acceleration zero there too,
:math:`1 = \int p\,\dddot x\,dz` for every :math:`p = \tfrac12 z^2 - \tfrac12 z + c`; the best c gives
:math:`1 \le C_j/32` (c = 3/32) and :math:`1 \le \int \dddot x^2/720` (c = 1/12).
"""

from __future__ import annotations

from typing import NamedTuple


class LowerBound(NamedTuple):
    """A bound from below.

    Attributes
    ----------
    name : str
        Of the factor.
    value : float
        The bound.
    reached_by : str
        Law of the catalogue that has this value.
    holds_for : str
        Laws that it holds for.
    """

    name: str
    value: float
    reached_by: str
    holds_for: str


_REST = "velocity zero at both ends"
_SOFT = "velocity and acceleration zero at both ends"

BOUNDS = (
    LowerBound("C_v", 1.0, "constant_velocity", "every law"),
    LowerBound("C_a", 4.0, "parabolic", _REST),
    LowerBound("C_j", 32.0, "minimum_jerk", _SOFT),
    LowerBound("acceleration_squared", 12.0, "optimal", _REST),
    LowerBound("jerk_squared", 720.0, "polynomial_3_4_5", _SOFT),
)
