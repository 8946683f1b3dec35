r"""Orders of the shaking force and couple of inertia at a constant speed.

Both are series in the crank angle,

.. math:: \mathbf F = \sum_k \mathbf a_k \cos k\varphi + \mathbf b_k \sin k\varphi

whose orders k = 1 and 2 are the primary and secondary forces and couples of engines; each order draws an
ellipse, of which the longer semi-axis is its maximum. A mechanism that repeats after T revolutions has orders
of 1/T, 2/T, … too.

References
----------
.. [1] Norton, Design of Machinery, chapter 14: multicylinder engines.
.. [2] Biezeno, Grammel, Technische Dynamik, vol. 2: mass balance of engines.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.cycle import TURNS_MAX
from linkwright.kernel.errors import InputError
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.reader.numbers import NOISE
from linkwright.kernel.result import Result
from linkwright.kinetostatics.couple import inertia_force_and_couple
from linkwright.kinetostatics.envelope import Harmonics, harmonics
from linkwright.kinetostatics.motion import motion_at
from linkwright.kinetostatics.places import Scene
from linkwright.kinetostatics.wrench import masses
from linkwright.linkages.whole_cycle import over_whole_motion
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine

# Steps of the revolution: harmonics of linkages have faded far below half of them.
_STEPS = 720

# Highest order.
_HIGHEST = 100


@dataclass(frozen=True)
class ShakingOrders(Result):
    """Orders of the shaking force and couple of inertia at a constant speed."""

    speed: Annotated[float, Label("speed of the crank", "ω", "rad/s")]
    order: Annotated[Floats, Label("order", "", "", "Cycles per revolution of the crank.", shape="(n,)")]
    force_max: Annotated[
        Floats, Label("maximum shaking force of an order", "", "N", "Longer semi-axis of its ellipse.")
    ]
    couple_max: Annotated[
        Floats, Label("maximum shaking couple of an order", "", "N m", "Likewise, about the plane z = 0.")
    ]
    force: Annotated[Harmonics, About("Components of the force along x and y [N].")]
    couple: Annotated[Harmonics, About("Components of the couple about x and y [N m].")]

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """Speed, and by order the maxima and amplitudes of the components; ready for JSON, SI."""
        rows = zip(
            self.order.tolist(),
            self.force_max.tolist(),
            self.couple_max.tolist(),
            self.force.amplitude[1:].tolist(),
            self.couple.amplitude[1:].tolist(),
            strict=True,
        )
        names = ("force_max", "couple_max", "force", "couple")
        return {
            "speed": self.speed,
            "orders": {f"{order:g}": dict(zip(names, row, strict=True)) for order, *row in rows},
        }


@public
def shaking_orders(machine: Machine, *, speed: float | None = None, highest: int = 8) -> ShakingOrders:
    """Orders of the shaking force and couple of inertia of a machine at a constant speed.

    Parameters
    ----------
    machine : Machine
        With masses in ``bodies``, and their places along the crankshaft as ``axial``.
    speed : float, optional
        Of the crank [rad/s]. Default: the mean speed of the steady motion, or the drive's design speed.
    highest : int
        Highest order, 1 to 100.

    Returns
    -------
    ShakingOrders
        From the first order, of primary forces and couples, on; of a cycle of T revolutions from 1/T on.

    Raises
    ------
    InputError
        The motion does not repeat within 24 revolutions, or the order makes no sense.
    AssemblyError
        The crank does not rotate fully.
    """
    if not 1 <= highest <= _HIGHEST:
        raise InputError(f"highest: found {highest}, expected an order from 1 to {_HIGHEST}")
    if over_whole_motion(compile_machine(machine)) is None:
        raise InputError(
            f"shaking orders: found a motion that does not repeat within {TURNS_MAX} revolutions of the crank"
        )
    if speed is None:
        motion = motion_at(machine, None)
        speed = float((motion.crank_angle[-1] - motion.crank_angle[0]) / (motion.time[-1] - motion.time[0]))
    scene = Scene(machine, motion_at(machine, None, speed=speed, n=_STEPS))
    parts = [
        harmonics(scene.motion.crank_angle, values, highest) for values in inertia_force_and_couple(scene)
    ]
    force, couple = parts
    forces, couples = (
        np.where(axis > NOISE * size, axis, 0.0)
        for axis, size in zip((_longer_axis(part)[1:] for part in parts), _sizes(scene), strict=True)
    )
    return ShakingOrders(speed, force.order[1:], forces, couples, force, couple)


def _sizes(scene: Scene) -> tuple[float, float]:
    """Sums of the peak forces and couples of all bodies, beside which rounding is zero."""
    peaks = [
        (float(mass.mass * np.hypot(*mass.acceleration(scene).T).max()), abs(mass.axial))
        for mass in masses(scene)
    ]
    return sum(peak for peak, _ in peaks), sum(peak * arm for peak, arm in peaks)


def _longer_axis(part: Harmonics) -> Floats:
    """Longer semi-axis of the ellipse that the two components of each order draw, (orders,)."""
    x, y = (part.cosine - 1j * part.sine).T
    axis: Floats = 0.5 * (np.abs(x + 1j * y) + np.abs(x - 1j * y))
    return axis
