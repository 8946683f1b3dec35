"""The four-bar linkage with pylinkage: its compiled solver, with velocities and accelerations."""

from __future__ import annotations

from typing import Any

import numpy as np

from peers.four_bar import ACROSS, ALONG, CRANK, FRAME, ROCKER

# Steps per revolution.
STEPS = 360


def linkage(coupler: float) -> Any:
    """The linkage, ready for its fastest call.

    Parameters
    ----------
    coupler : float
        Length of the coupler [m].

    Returns
    -------
    pylinkage.simulation.Linkage
        With the crank's speed set to one.
    """
    from pylinkage.actuators import Crank
    from pylinkage.components import Ground
    from pylinkage.dyads import FixedDyad, RRRDyad
    from pylinkage.simulation import Linkage

    origin, pivot = Ground(0.0, 0.0, name="O"), Ground(FRAME, 0.0, name="D")
    crank = Crank(origin, CRANK, angular_velocity=2 * np.pi / STEPS, name="A")
    # The joint above the ground, as the product's "left".
    joint = RRRDyad(crank.output, pivot, coupler, ROCKER, x=0.3, y=0.3, name="C")
    point = FixedDyad(
        crank.output, joint, float(np.hypot(ALONG, ACROSS)), float(np.arctan2(ACROSS, ALONG)), name="P"
    )
    made = Linkage([origin, pivot, crank, joint, point])
    made.set_input_velocity(crank, omega=1.0)
    return made


def motion(made: Any) -> tuple[Any, Any, Any]:
    """Positions, velocities and accelerations of all joints over one revolution, (steps, joints, 2) each."""
    return made.step_fast_with_kinematics(STEPS)
