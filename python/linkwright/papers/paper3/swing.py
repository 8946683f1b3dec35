"""Formulas (13) to (15) of paper 3, tried on a rod that swings as the exact laws have it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from linkwright.papers.paper3.inertia import KGF_CM_S2
from linkwright.torsion.model.engine import pendulum
from linkwright.torsion.model.engine.pendulum import PRINTED_GRAVITY
from linkwright.torsion.model.engine.rod import Rod

# Metres a square second and centimetres a metre.
_GRAVITY = PRINTED_GRAVITY / 100
_CM = 100.0

# g (60/π)² with the paper's g [cm/min²].
PENDULUM = PRINTED_GRAVITY * (60 / math.pi) ** 2


@dataclass(frozen=True)
class SwingChecks:
    """Moments of inertia from swings counted without error.

    Attributes
    ----------
    swings : tuple of float
        Single swings a minute in small and in big end.
    factor : float
        358 000 over g (60/π)² with the paper's g, less one [–].
    edge, centre, axis : float
        (13), (14), (15) as printed over exact, less one [–].
    two_point : float
        b of the swings about both heads with 358 000 over exact, less one [–].
    two_point_exact : float
        The same without rounding [–].
    """

    swings: tuple[float, float]
    factor: float
    edge: float
    centre: float
    axis: float
    two_point: float
    two_point_exact: float


def swing_checks(rod: Rod, printed: dict[str, Any], bore_radius: float) -> SwingChecks:
    """Swing a rod, and work out its moments of inertia as printed.

    Parameters
    ----------
    rod : Rod
        The rod.
    printed : dict
        Printed numbers.
    bore_radius : float
        Of the small end, on whose bore the rod hangs [m].

    Returns
    -------
    SwingChecks
        Each formula against the rod's own moments.
    """
    m, centre, J = rod.body
    b = rod.length - centre + bore_radius
    n = _swings(m, b, J)
    b_cm, c = _CM * b, _CM * bore_radius
    edge = pendulum.printed_inertia_about_edge(m, b_cm, n) * KGF_CM_S2
    about = pendulum.printed_inertia_about_centre(m, b_cm, n) * KGF_CM_S2
    axis = pendulum.printed_inertia_about_axis(m, b_cm, n, c) * KGF_CM_S2
    # Swings in the big end, on an edge at its axis.
    other = _swings(m, centre, J)
    apart = rod.length + bore_radius
    exact, rounded = (
        pendulum.two_point_centre(factor / other**2 / _CM, factor / n**2 / _CM, apart) / b - 1
        for factor in (PENDULUM, printed["pendulum"])
    )
    return SwingChecks(
        swings=(n, other),
        factor=printed["pendulum"] / PENDULUM - 1,
        edge=edge / (J + m * b**2) - 1,
        centre=about / J - 1,
        axis=axis / rod.moment_small_end - 1,
        two_point=rounded,
        two_point_exact=exact,
    )


def _swings(mass: float, edge: float, inertia: float) -> float:
    """Single swings a minute of a body that hangs a distance below an edge."""
    return 60 / math.pi * math.sqrt(mass * _GRAVITY * edge / (inertia + mass * edge**2))
