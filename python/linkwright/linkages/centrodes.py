r"""Instant centres of a link, and the centrodes that they trace on the frame and on the link.

With a point P of the link, its direction θ and derivatives by the crank angle φ, the instant centre C, whose
velocity as a point of the link is zero, is

.. math:: x_C = x_P - y_P'/\theta', \qquad y_C = y_P + x_P'/\theta'

On the frame C traces the fixed centrode, on the link the moving one, which rolls on the first without
slipping: both arcs have the same length.

References
----------
.. [1] Norton, Design of Machinery, 6th ed. 2020, sections 6.3 and 6.5.
.. [2] Uicker, Pennock and Shigley, Theory of Machines and Mechanisms, 5th ed. 2017, sections 3.12 to 3.21.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import MachineError, Problem
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.linkages.kinematics import Kinematics, kinematics
from linkwright.machine.machine import Machine

# Turn of a link per radian of the crank below which it translates: rounding of a link that never turns.
_TRANSLATES = 1e-12


@dataclass(frozen=True)
class Centrodes(Result):
    """Instant centres of a link against the frame over the crank angle."""

    crank_angle: Annotated[Floats, Label("crank angle", "φ", "rad")]
    x: Annotated[
        Floats,
        Label(
            "instant centre, x", "x_C", "m", "On the fixed centrode; NaN where the link translates, as is y."
        ),
    ]
    y: Annotated[Floats, Label("instant centre, y", "y_C", "m")]
    along: Annotated[
        Floats,
        Label(
            "instant centre along the link", "u_C", "m", "On the moving centrode, from the start of the link."
        ),
    ]
    across: Annotated[
        Floats,
        Label(
            "instant centre across the link",
            "v_C",
            "m",
            "Distance from the line of the link, positive to the left.",
        ),
    ]
    link: Annotated[str, About("Name of the link.")]


@public
def centrodes(machine: Machine, link: str, angles: ArrayLike | None = None) -> Centrodes:
    r"""Instant centres of a link, as points of the fixed and of the moving centrode.

    Parameters
    ----------
    machine : Machine
        One machine.
    link : str
        Name of the link, such as ``"cart1.rod"``.
    angles : array_like, shape (n,), optional
        Crank angles [rad]; without them a revolution by single degrees.

    Returns
    -------
    Centrodes

    Raises
    ------
    MachineError
        There is no such link.
    AssemblyError
        The mechanism does not close at one of the angles.

    Examples
    --------
    The centre of the rod of a crank-slider lies on the line of the crank, above the slider:

    >>> import linkwright as lw
    >>> found = lw.centrodes(lw.read("roller_one_cart"), "cart1.rod", [0.5])
    >>> round(float(found.y[0] / found.x[0] / np.tan(0.5)), 12)
    1.0
    """
    links = machine.linkage.links()
    if link not in links:
        known = suggestion(link, sorted(links))
        raise MachineError([Problem(key="link", found=f'no link "{link}"', expected=known)])
    return centrodes_of(machine, link, kinematics(machine, angles))


def centrodes_of(machine: Machine, link: str, motion: Kinematics) -> Centrodes:
    """`centrodes` of a motion that is known."""
    start, turn = machine.linkage.links()[link].start, motion.links[link]
    point = motion.points.get(start)
    if point is None:
        fixed = machine.linkage.fixed_points()[start]
        place = np.broadcast_to([float(fixed.x), float(fixed.y)], (len(motion.angles), 2))
        rate = np.zeros_like(place)
    else:
        place, rate = point.position, point.d1
    with np.errstate(divide="ignore", invalid="ignore"):
        apart = np.stack([-rate[:, 1], rate[:, 0]], axis=-1) / turn.d1[:, None]
    apart[np.abs(turn.d1) < _TRANSLATES] = np.nan
    cos, sin = np.cos(turn.angle), np.sin(turn.angle)
    centre = place + apart
    along, across = cos * apart[:, 0] + sin * apart[:, 1], cos * apart[:, 1] - sin * apart[:, 0]
    return Centrodes(motion.angles, centre[:, 0].copy(), centre[:, 1].copy(), along, across, link)
