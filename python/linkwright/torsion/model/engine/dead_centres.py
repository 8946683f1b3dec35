r"""Dead centres and strokes of the pistons of a throw.

A dead centre is where :math:`x' = 0`. On the crank pin crank and rod are in line there; the stroke of a
central cylinder is 2r. An offset turns the dead centres and lengthens the stroke:

.. math::

    \sin(φ_t - β) = \frac{e}{l + r}, \quad \sin(φ_b - β - π) = \frac{e}{l - r}, \quad
    s = \sqrt{(l + r)^2 - e^2} - \sqrt{(l - r)^2 - e^2}.

On an articulated pin there is no such form: they are found by Newton on :math:`x'` with the exact
:math:`x''`.

References
----------
.. [1] Norton, Design of Machinery, chapter 4: offset slider-crank.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.errors import ConvergenceError
from linkwright.torsion.model.engine.running_gear import RunningGear, throw_motion

Array = NDArray[np.float64]

# Angles of the revolution from whose highest and lowest Newton starts, 1.4 degrees apart.
_SAMPLES = 256
# Newton squares the error of 0.01 rad at each step; the rest is for dead centres that are nearly flat.
_STEPS = 12
# Maximum speed at a dead centre, over that of the crank pin: rounding of a few operations.
_AT_REST = 1e-12


class DeadCentres(NamedTuple):
    """Where a piston turns back."""

    # `top`, `bottom`: crank angles of the throw from the vertical [rad]: top within half a revolution of the
    # cylinder's axis, bottom within a revolution after it.
    top: float
    bottom: float
    # `highest`, `lowest`: distance of the piston pin from the axis of the crank there [m].
    highest: float
    lowest: float

    @property
    def stroke(self) -> float:
        """Way of the piston between them [m]."""
        return self.highest - self.lowest


def dead_centres(crank_radius: float, gears: Sequence[RunningGear]) -> tuple[DeadCentres, ...]:
    """Dead centres of all pistons of one throw, to rounding. `crank_radius`: r [m]."""
    if not gears:
        return ()
    phi = np.linspace(0.0, 2.0 * math.pi, _SAMPLES, endpoint=False)
    samples = throw_motion(crank_radius, gears, phi)
    start = np.array([[each.piston.argmax(), each.piston.argmin()] for each in samples])
    angle, piston = _refined(crank_radius, gears, phi[start])
    return tuple(map(_counted, angle, piston, (gear.bank_angle for gear in gears)))


def _refined(crank_radius: float, gears: Sequence[RunningGear], start: Array) -> tuple[Array, Array]:
    """Angles where the pistons rest, and their places there, (gears, 2); Newton within a sample's reach."""
    angle, reach = start, 2.0 * math.pi / _SAMPLES
    for _ in range(_STEPS):
        piston, d1, d2 = _own_rows(crank_radius, gears, angle)
        with np.errstate(divide="ignore", invalid="ignore"):
            step = np.nan_to_num(d1 / d2)
        after = np.clip(angle - step, start - reach, start + reach)
        if np.abs(after - angle).max() <= np.finfo(float).eps * 2.0 * math.pi:
            break
        angle = after
    worst = int(np.abs(d1).max(axis=1).argmax())
    residual = float(np.abs(d1[worst]).max()) / crank_radius
    if residual > _AT_REST:
        text = (
            f"the dead centres of {gears[worst].name} were not found: its piston still moves at "
            f"{residual:.3g} of the crank pin's speed after {_STEPS} steps; check lengths and places of its "
            "rod and its pin"
        )
        raise ConvergenceError(text, method="dead centres", iterations=_STEPS, residual=residual)
    return angle, piston


def _own_rows(crank_radius: float, gears: Sequence[RunningGear], angle: Array) -> tuple[Array, ...]:
    """x, x′, x″ of each gear at its own angles, (gears, 2) each."""
    motion = throw_motion(crank_radius, gears, angle)
    rows = [(each.piston[at], each.piston_d1[at], each.piston_d2[at]) for at, each in enumerate(motion)]
    return tuple(np.array(each) for each in zip(*rows, strict=True))


def _counted(angle: Array, piston: Array, bank_angle: float) -> DeadCentres:
    """Dead centres with their angles counted from the cylinder's axis."""
    top = bank_angle + math.remainder(float(angle[0]) - bank_angle, 2.0 * math.pi)
    bottom = top + (float(angle[1]) - top) % (2.0 * math.pi)
    return DeadCentres(top, bottom, float(piston[0]), float(piston[1]))
