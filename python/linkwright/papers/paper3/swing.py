"""Formulas (13) to (15) of paper 3, tried on a rod that swings as the exact laws have it."""

from __future__ import annotations

import math
from typing import Any

from linkwright.papers.paper3.inertia import KGF_CM_S2
from linkwright.torsion.model.engine import pendulum
from linkwright.torsion.model.engine.pendulum import PRINTED_GRAVITY
from linkwright.torsion.model.engine.rod import Rod

# Metres a square second and centimetres a metre.
_GRAVITY, _CM = PRINTED_GRAVITY / 100, 100.0

# g (60/π)² with the paper's g [cm/min²].
PENDULUM = PRINTED_GRAVITY * (60 / math.pi) ** 2


def swing_checks(rod: Rod, printed: dict[str, Any], bore_radius: float) -> dict[str, Any]:
    """Swing a rod on the bore of its small end [m], and work out its moments of inertia as printed.

    Swings are counted without error; deviations are printed over exact, less one [–].
    """
    m, centre, J = rod.body
    b = rod.length - centre + bore_radius
    # Single swings a minute in the small end, and in the big end on an edge at its axis.
    n, other = _swings(m, b, J), _swings(m, centre, J)
    b_cm, c = _CM * b, _CM * bore_radius
    edge = pendulum.printed_inertia_about_edge(m, b_cm, n) * KGF_CM_S2
    about = pendulum.printed_inertia_about_centre(m, b_cm, n) * KGF_CM_S2
    axis = pendulum.printed_inertia_about_axis(m, b_cm, n, c) * KGF_CM_S2
    # b of the swings about both heads, with the factor unrounded and as printed.
    exact, rounded = (
        pendulum.two_point_centre(factor / other**2 / _CM, factor / n**2 / _CM, rod.length + bore_radius)
        for factor in (PENDULUM, printed["pendulum"])
    )
    return {
        "swings": (n, other),
        "factor": printed["pendulum"] / PENDULUM - 1,
        "edge": edge / (J + m * b**2) - 1,
        "centre": about / J - 1,
        "axis": axis / rod.moment_small_end - 1,
        "two_point": rounded / b - 1,
        "two_point_exact": exact / b - 1,
    }


def _swings(mass: float, edge: float, inertia: float) -> float:
    """Single swings a minute of a body that hangs a distance below an edge."""
    return 60 / math.pi * math.sqrt(mass * _GRAVITY * edge / (inertia + mass * edge**2))
