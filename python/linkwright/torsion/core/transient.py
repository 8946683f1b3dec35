r"""A train in motion in the core's terms: discs with inertias that change with the angle, shafts, torques.

.. math:: J(\theta)\,\ddot\theta + \tfrac12 J'(\theta)\,\dot\theta^2 + c\,\dot\theta
    + d\,(\dot\theta - \omega) + \sum M_\mathrm{shaft} = \sum M

with the speed ω of the train as a whole, the mean over its inertia.

Everything is said of the discs at their own speeds; discs behind rigid gears move as one mass, as in
`linkwright.torsion.core.train`.

Hysteresis has no meaning in time: what loses the same share of its energy whatever the frequency is no law
of the instant. A shaft of the loss factor η becomes a viscous one that loses as much at one frequency,
:math:`c = \eta k/\omega`.

References
----------
.. [1] Crandall, The role of damping in vibration theory, J. Sound Vib. 11 (1970) 3-18.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from linkwright import _core
from linkwright.kernel.core.curve import Curve
from linkwright.kernel.core.periodic_table import PeriodicTable, smooth
from linkwright.kernel.errors import InputError, ShapeError
from linkwright.torsion.core.encoding import encoded
from linkwright.torsion.core.torque import TrainTorque
from linkwright.torsion.core.train import HELD, ReferredTrain

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

# Share of the largest slope by which given slopes may differ from those of the samples.
_SLOPES_AGREE = 1e-3


@dataclass(frozen=True)
class VariableInertia:
    """An inertia that changes with the angle of its disc.

    Attributes
    ----------
    on : int
        Disc.
    table : PeriodicTable
        [kg m²].
    phase : float
        Angle of the table where that of the disc is zero [rad].
    """

    on: int
    table: PeriodicTable
    phase: float = 0.0


def variable_inertia(
    on: int, inertia: ArrayLike, slope: ArrayLike | None = None, phase: float = 0.0
) -> VariableInertia:
    """An inertia from even samples over one revolution.

    Parameters
    ----------
    on : int
        Disc.
    inertia : array_like, shape (samples,)
        From angle zero on, without the repetition at the end of the revolution [kg m²].
    slope : array_like, shape (samples,), optional
        Its derivative by the angle, to check that the samples tell all of it [kg m²/rad].
    phase : float
        Angle of the table where that of the disc is zero [rad].

    Returns
    -------
    VariableInertia
        By the trigonometric polynomial through the samples.

    Raises
    ------
    InputError
        A sample is no positive number, or the slopes are not those of the samples.
    ShapeError
        There are not as many slopes as samples.
    """
    J = np.asarray(inertia, dtype=float)
    if not len(J) or not (np.isfinite(J).all() and (J > 0).all()):
        raise InputError("inertia over the revolution: expected finite numbers above zero")
    table = smooth(J)
    if slope is not None:
        given = np.asarray(slope, dtype=float)
        if given.shape != J.shape:
            raise ShapeError(f"slope has shape {given.shape}, expected {J.shape}, that of the inertia")
        off = float(np.abs(table.slope[:: len(table.slope) // len(J)] - given).max())
        if not off <= _SLOPES_AGREE * float(np.abs(given).max() or J.mean()):
            raise InputError(
                f"slope of an inertia: differs by {off:.3g} kg m²/rad from that of its {len(J)} samples; "
                "sample the revolution more finely"
            )
    return VariableInertia(on, table, phase)


@dataclass(frozen=True)
class TrainMotion:
    """A motion as the core gives it, in terms of masses.

    Attributes
    ----------
    end : str
        "time" when it is over; "too many steps", "inaccurate" where no step keeps the accuracy, "not finite".
    method : str
        That was used.
    steps, rejected, evaluations : int
        Work done.
    time : float
        Reached [s].
    fastest : float
        Bound of the fastest swing at the start [rad/s].
    energies : tuple of float
        Kinetic and potential at the start, and at the end [J].
    angle, speed : ndarray, shape (masses, times)
        Of the masses, at the speed of the first disc [rad, rad/s].
    torque : ndarray, shape (shafts, times)
        At the speed of each shaft [N m].
    kinetic, potential : ndarray, shape (times,)
        Energy [J].
    extremes : ndarray, shape (shafts + masses, 4)
        Largest value, its time, minimum value, its time, of torques and speeds.
    work : ndarray, shape (torques + shafts + masses,)
        Of torques, and lost in shafts and at masses [J].
    """

    end: str
    method: str
    steps: int
    rejected: int
    evaluations: int
    time: float
    fastest: float
    energies: tuple[float, float, float, float]
    angle: Floats
    speed: Floats
    torque: Floats
    kinetic: Floats
    potential: Floats
    extremes: Floats
    work: Floats


@dataclass(frozen=True)
class MovingTrain:
    """Discs, shafts and torques of a train that moves in time.

    Attributes
    ----------
    discs : tuple of str
        Names.
    speed : ndarray, shape (discs,)
        n, speed of each disc over that of the first, without its sense.
    mass : ndarray of int, shape (discs,)
        Discs of one number move as one.
    inertia, damping, swing_damping : ndarray, shape (discs,)
        Constant part of the inertia [kg m²], damping against the ground, and damping that resists only what
        goes beyond the speed of the train as a whole [N m s/rad].
    shafts : tuple of str
        Names of what twists.
    tip : ndarray of int, shape (shafts, 2)
        Discs that each joins; `HELD` for the ground.
    stiffness, shaft_damping : ndarray, shape (shafts,)
        At the first end that is a disc [N m/rad, N m s/rad].
    curves : tuple of Curve or None
        Torque over twist of each shaft, in addition to its stiffness [N m, rad].
    inertias : tuple of VariableInertia
        In addition to the constant ones.
    torques : tuple of TrainTorque
        From outside.
    notes : tuple of str
        What was assumed.
    """

    discs: tuple[str, ...]
    speed: Floats
    mass: Ints
    inertia: Floats
    damping: Floats
    swing_damping: Floats
    shafts: tuple[str, ...]
    tip: Ints
    stiffness: Floats
    shaft_damping: Floats
    curves: tuple[Curve | None, ...]
    inertias: tuple[VariableInertia, ...] = ()
    torques: tuple[TrainTorque, ...] = ()
    notes: tuple[str, ...] = field(default=())

    @property
    def masses(self) -> int:
        """How many masses."""
        return int(self.mass.max()) + 1

    @property
    def lead(self) -> Floats:
        """Speed of the end of each shaft where its twist counts, over that of the first disc, (shafts,)."""
        first, second = self.tip.T
        speed: Floats = self.speed[np.where(first == HELD, second, first)]
        return speed

    @property
    def mean_inertia(self) -> Floats:
        """Inertia of the discs, averaged over the revolution, (discs,) [kg m²]."""
        J = np.array(self.inertia, dtype=float)
        np.add.at(J, [each.on for each in self.inertias], [each.table.mean for each in self.inertias])
        return J

    @cached_property
    def system(self) -> _core.TorsionSystem:
        """The train as the core takes it."""
        return encoded(self)

    def net_torques(self, time: float, angle: ArrayLike, speed: ArrayLike) -> tuple[Floats, Floats]:
        """Sum of all torques on each mass, and its inertia.

        Parameters
        ----------
        time : float
            [s].
        angle : array_like, shape (rows, masses)
            At the speed of the first disc [rad].
        speed : array_like, shape (masses,)
            Likewise [rad/s].

        Returns
        -------
        tuple of ndarray, shape (rows, masses)
            Torques, less ½ J′ω² [N m], and inertias [kg m²].
        """
        rows = np.ascontiguousarray(angle, dtype=np.float64)
        return self.system.net_torques(time, rows, np.ascontiguousarray(speed, dtype=np.float64))

    def follow(
        self,
        angle: ArrayLike,
        speed: ArrayLike,
        times: ArrayLike,
        *,
        accuracy: float,
        start: float = 0.0,
        method: str = "auto",
        steps_max: int,
    ) -> TrainMotion:
        """The motion from given angles and speeds.

        Parameters
        ----------
        angle, speed : array_like, shape (masses,)
            At the start, at the speed of the first disc [rad, rad/s].
        times : array_like, shape (times,)
            To sample at, from zero to the end [s].
        accuracy : float
            Relative, of a step, at its end and on the way there.
        start : float
            When the motion begins, zero or before; it is recorded from zero on [s].
        method : str
            "auto", "explicit" or "implicit".
        steps_max : int
            Steps after which it is given up.

        Returns
        -------
        TrainMotion
            Samples beyond the time reached are NaN.
        """
        at, turning, sampled = (
            np.ascontiguousarray(each, dtype=np.float64) for each in (angle, speed, times)
        )
        end = float(sampled[-1])
        found = self.system.follow(at, turning, sampled, start, end, accuracy, method, steps_max)
        samples = found.samples
        n, m = self.masses, len(self.shafts)
        return TrainMotion(
            end=found.end,
            method=found.method,
            steps=found.steps,
            rejected=found.rejected,
            evaluations=found.evaluations,
            time=found.time,
            fastest=found.fastest,
            energies=found.energies,
            angle=samples[:n],
            speed=samples[n : 2 * n],
            torque=samples[2 * n : 2 * n + m],
            kinetic=samples[-2],
            potential=samples[-1],
            extremes=found.extremes,
            work=found.work,
        )


def moving(
    referred: ReferredTrain,
    inertia: ArrayLike,
    *,
    damping: ArrayLike = 0.0,
    swing_damping: ArrayLike = 0.0,
    shaft_damping: ArrayLike = 0.0,
    curves: Sequence[Curve | None] | None = None,
    inertias: Iterable[VariableInertia] = (),
    torques: Iterable[TrainTorque] = (),
    notes: Iterable[str] = (),
) -> MovingTrain:
    """A train in motion from the train for vibration.

    Parameters
    ----------
    referred : ReferredTrain
        Its discs and shafts.
    inertia : array_like, shape (discs,)
        Constant part, at the speed of each disc [kg m²].
    damping : array_like, shape (discs,)
        Against the ground [N m s/rad].
    swing_damping : array_like, shape (discs,)
        Against what goes beyond the speed of the train as a whole [N m s/rad].
    shaft_damping : array_like, shape (shafts,)
        At the first end of each that is a disc [N m s/rad].
    curves : sequence of Curve or None, optional
        Of shafts with a torque that is no straight line over the twist: in place of their stiffness.
    inertias : iterable of VariableInertia
        In addition to the constant ones.
    torques : iterable of TrainTorque
        From outside.
    notes : iterable of str
        What was assumed.

    Returns
    -------
    MovingTrain
        Ready to be followed.
    """
    n, m = len(referred.discs), len(referred.shafts)
    shapes = tuple(curves) if curves is not None else (None,) * m
    first, second = referred.tip.T
    lead = referred.speed[np.where(first == HELD, second, first)]
    straight = np.array([curve is None for curve in shapes], dtype=float)
    return MovingTrain(
        referred.discs,
        referred.speed,
        referred.mass,
        np.broadcast_to(np.asarray(inertia, dtype=float), n),
        np.broadcast_to(np.asarray(damping, dtype=float), n),
        np.broadcast_to(np.asarray(swing_damping, dtype=float), n),
        referred.shafts,
        referred.tip,
        referred.stiffness / lead**2 * straight,
        np.broadcast_to(np.asarray(shaft_damping, dtype=float), m),
        shapes,
        tuple(inertias),
        tuple(torques),
        tuple(notes),
    )


def viscous(stiffness: ArrayLike, loss_factor: ArrayLike, omega: ArrayLike) -> Floats:
    """Viscous damping that loses as much at one frequency as hysteresis does: c = ηk/ω.

    Parameters
    ----------
    stiffness : array_like, any shape
        k, of any shape [N m/rad].
    loss_factor : array_like, any shape
        η, of the same shape [–].
    omega : array_like
        The frequency, of the same shape or one for all [rad/s].

    Returns
    -------
    ndarray
        Of the same shape [N m s/rad].
    """
    k, eta = np.asarray(stiffness, dtype=float), np.asarray(loss_factor, dtype=float)
    damping: Floats = k * eta / np.asarray(omega, dtype=float)
    return damping
