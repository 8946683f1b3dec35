"""Where a motion in time loses contact: a follower leaves its cam, a cable becomes slack.

The motion is that of a machine in contact. The forces along it say whether it stays so: where one that can
only press would have to pull, the motion behind that place is not that of the machine.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import NamedTuple

import numpy as np

from linkwright.drive.motion_events import states
from linkwright.drive.transient import Transient
from linkwright.kernel.arrays import Floats
from linkwright.kernel.numerics.zeros import zero as zero_of
from linkwright.kernel.public import public
from linkwright.kernel.reader.angle_zero import Zero
from linkwright.kernel.reader.numbers import degrees, number
from linkwright.kinetostatics.collect import KEEPS, LEAVES, TIGHTENS
from linkwright.kinetostatics.contact import contacts
from linkwright.kinetostatics.forces import forces
from linkwright.kinetostatics.motion import Motion
from linkwright.machine.machine import Machine

# Places in a step of the solver, over which speed and acceleration are polynomials of degree 7 and 6. They
# lie inside: at its ends a law of a cam may go over into the next one.
_PLACES = np.linspace(1e-6, 1 - 1e-6, 17)

# Steps whose forces are computed at once.
_STEPS = 250

# Share of the maximum force below which a pull is none: the acceleration of a motion is exact to so much at
# the loosest accuracy that is usual, 1e-8 of the speed over a hundredth of a step.
_NOTHING = 1e-6

_FILE = Zero()


class ContactLoss(NamedTuple):
    """A contact that a motion loses.

    Attributes
    ----------
    kind : str
        ``"cam"`` or ``"cable"``.
    name : str
        Of the cam, or of the cable.
    time : float
        Where it is lost first [s].
    crank_angle : float
        There, counted on over the revolutions [rad].
    speed : float
        Of the crank there [rad/s].
    pull : float
        The largest force that would have to pull, or of a cable to push [N].
    pull_time : float
        Its time [s].
    """

    kind: str
    name: str
    time: float
    crank_angle: float
    speed: float
    pull: float
    pull_time: float

    def sentence(self, zero: Zero = _FILE) -> str:
        """Which contact is lost, where, and what holds it; crank angles count from `zero`."""
        where = f"after {number(self.time)} s, at crank angle {degrees(self.crank_angle - zero.angle)}"
        at = f"{where} and {number(self.speed)} rad/s"
        most = f"after {number(self.pull_time)} s it would have to be"
        if self.kind == "cam":
            return (
                f"{LEAVES} {self.name} {at}; {most} pulled with {number(self.pull)} N; this motion applies "
                f"to a follower in contact; {KEEPS}"
            )
        return (
            f"The cable {self.name} becomes slack {at}; {most} pushed with {number(self.pull)} N; this "
            f"motion applies to a taut cable; {TIGHTENS}"
        )


@public
def contact_losses(machine: Machine, motion: Transient) -> tuple[ContactLoss, ...]:
    """Losses of contact in a motion, from the forces at 17 stations of each step of the solver.

    Parameters
    ----------
    machine : Machine
    motion : Transient
        Its motion in time.

    Returns
    -------
    tuple of ContactLoss
        A follower that nothing but a spring or its load keeps on the cam, or a cable; none where all press.

    Raises
    ------
    FindingError
        There are no forces along a part of the motion.

    See Also
    --------
    linkwright.kinetostatics.forces.forces : Forces along the motion.
    """
    watched = contacts(machine)
    if not watched or motion.steps == 0:
        return ()
    return tuple(_losses(machine, motion, watched))


def _losses(machine: Machine, motion: Transient, watched: list[tuple[str, str]]) -> Iterator[ContactLoss]:
    time = (motion.time[:-1, None] + np.diff(motion.time)[:, None] * _PLACES).ravel()
    held = partial(_held, machine, motion, watched)
    parts = np.array_split(time, -(-motion.steps // _STEPS))
    for i, force in enumerate(np.concatenate([held(part) for part in parts], axis=1)):
        if np.isnan(force).all():
            continue
        worst = int(np.nanargmin(force))
        lost = np.flatnonzero(force < -_NOTHING * np.nanmax(np.abs(force)))
        if len(lost):
            at = _first(partial(_of_one, held, i), time, force, int(lost[0]))
            angle, speed, _ = (float(x[0]) for x in states(motion, np.array([at])))
            yield ContactLoss(*watched[i], at, angle, speed, float(-force[worst]), float(time[worst]))


def _held(machine: Machine, motion: Transient, watched: list[tuple[str, str]], time: Floats) -> Floats:
    """Force with which each contact is held at times (n,) of a motion, (watched, n) [N]."""
    acting = forces(machine, Motion(*states(motion, time), time), contributions=False)
    tensions = {pair.second: pair.normal for pair in acting.pairs.values() if pair.kind == "cable"}
    return np.array([acting.drives[name] if kind == "cam" else tensions[name] for kind, name in watched])


def _of_one(held: Callable[[Floats], Floats], i: int, time: float) -> float:
    return float(held(np.array([time]))[i, 0])


def _first(held: Callable[[float], float], time: Floats, force: Floats, lost: int) -> float:
    if lost == 0 or not force[lost - 1] > 0:
        return float(time[lost])
    return zero_of(held, float(time[lost - 1]), float(time[lost]))
