"""Which cylinder of an engine is weak, from a record of a disc's speed over the crank angle."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import InputError
from linkwright.kernel.public import public
from linkwright.machine.machine import Machine
from linkwright.torsion.core.train import refer
from linkwright.torsion.diagnosis.diagnosis import Diagnosis
from linkwright.torsion.diagnosis.engine_diagnosis import engine_diagnosis
from linkwright.torsion.diagnosis.engine_speed import of_orders, the_engine
from linkwright.torsion.diagnosis.measured_speed import recorded_speed
from linkwright.torsion.excitation.drive_line import train_of
from linkwright.torsion.excitation.excited_train import excited_train
from linkwright.torsion.model.engine.engine import ReciprocatingEngine, firing_angles

# Factors beyond these are no shares of a combustion, at whatever load: something else does not fit.
_LEAST, _GREATEST = -0.25, 4.0
# Mean factor beyond which the load is another than that of the file.
_OTHER_LOAD = 0.1


@dataclass(frozen=True)
class RecordDiagnosis:
    """What a record says of the cylinders.

    Attributes
    ----------
    disc : str
        Where the speed was measured.
    speed : float
        Mean of the crank [rad/s].
    orders : int
        How many orders it was read at.
    found : Diagnosis
        Factors of the cylinders.
    """

    disc: str
    speed: float
    orders: int
    found: Diagnosis

    @property
    def is_plausible(self) -> bool:
        """Whether all factors may be shares of a combustion."""
        half = np.where(np.isfinite(self.found.deviation), self.found.half_width(), np.inf)
        inside = (self.found.factor + half >= _LEAST) & (self.found.factor - half <= _GREATEST)
        return bool(inside.all())

    @public
    def weak(self, level: float = 0.95) -> tuple[str, ...]:
        """Cylinders that fire less than a healthy one; none where the factors are not plausible.

        Parameters
        ----------
        level : float
            As of `Diagnosis.weak`.

        Returns
        -------
        tuple of str
            The weakest first.
        """
        return self.found.weak(level) if self.is_plausible else ()

    @public
    def late(self, level: float = 0.95) -> tuple[str, ...]:
        """Cylinders that fire late; none where the factors are not plausible.

        Parameters
        ----------
        level : float
            As of `Diagnosis.late`.

        Returns
        -------
        tuple of str
            The latest first.
        """
        return self.found.late(level) if self.is_plausible else ()

    @public
    def early(self, level: float = 0.95) -> tuple[str, ...]:
        """Cylinders that fire early; none where the factors are not plausible.

        Parameters
        ----------
        level : float
            As of `Diagnosis.early`.

        Returns
        -------
        tuple of str
            The earliest first.
        """
        return self.found.early(level) if self.is_plausible else ()

    @public
    def leaking(self, level: float = 0.95) -> tuple[str, ...]:
        """Cylinders that compress less than a tight one; none where the factors are not plausible.

        Parameters
        ----------
        level : float
            As of `Diagnosis.leaking`.

        Returns
        -------
        tuple of str
            The worst first.
        """
        return self.found.leaking(level) if self.is_plausible else ()

    @property
    def warnings(self) -> tuple[str, ...]:
        """What limits the diagnosis, in sentences."""
        listed = [f"{warning}." for warning in self.found.warnings]
        mean = float(self.found.factor.mean())
        if not self.is_plausible:
            worst = float(self.found.factor[np.argmax(np.abs(self.found.factor - 1))])
            listed.append(
                f"A factor of {worst:.3g} is not physical: check the disc, the angle 0 of the record and "
                "its revolution, and the train."
            )
        elif abs(mean - 1) > _OTHER_LOAD:
            listed.append(
                f"The factors are {mean:.3g} on average: if the load was not that of the file, compare the "
                "factors relative to this mean."
            )
        return tuple(listed)


def record_diagnosis(
    machine: Machine,
    disc: str,
    angle: ArrayLike,
    speed: ArrayLike,
    *,
    noise: float | None = None,
    zero: int | None = None,
    rigid: bool = False,
) -> RecordDiagnosis:
    """Judge the cylinders of an engine by a record.

    Parameters
    ----------
    machine : Machine
        With a [train.engine]; cylinders that its file calls weak are taken as healthy.
    disc : str
        Where the speed was measured.
    angle : array_like, shape (n,)
        Crank angles at even steps over whole cycles [rad].
    speed : array_like, shape (n,)
        Of the disc at each [rad/s].
    noise : float, optional
        Standard deviation of a sample; without it, estimated from what the cylinders leave over [rad/s].
    zero : int, optional
        Number of the cylinder at whose firing dead centre the angle is 0. Default: throw 1 points to the
        vertical there, in the revolution in which the first cylinder of the firing order fires.
    rigid : bool
        Whether the train is taken as rigid, to see what that costs.

    Returns
    -------
    RecordDiagnosis
        At all orders of the train that the record can tell.

    Raises
    ------
    InputError
        The machine has no engine, or the record does not fit it.
    """
    engine = the_engine(machine)
    turns = engine.strokes // 2
    record = recorded_speed(np.asarray(angle, float) + _offset(engine, zero), speed, turns)
    if record.mean <= 0:
        raise InputError(f"a mean speed of {record.mean:.6g} rad/s: expected more than 0")
    crank = record.mean / _turning(machine, disc)
    orders = record.orders(excited_train(of_orders(machine), np.array([crank])).torques.orders)
    measured = record.harmonics(disc, orders, noise)
    return RecordDiagnosis(disc, crank, len(orders), engine_diagnosis(machine, measured, crank, rigid=rigid))


def _offset(engine: ReciprocatingEngine, zero: int | None) -> float:
    """Crank angle at which the record has its angle 0 [rad]."""
    if zero is None:
        return 0.0
    if not 1 <= zero <= engine.n_cylinders:
        raise InputError(f"zero: found {zero}, expected the number of a cylinder, 1 to {engine.n_cylinders}")
    return firing_angles(engine.places, engine.firing_order, engine.cycle)[0][zero - 1]


def _turning(machine: Machine, disc: str) -> float:
    referred = refer(train_of(machine))
    if disc not in referred.discs:
        raise InputError(
            f'disc: found "{disc}", expected one of the train; {suggestion(disc, referred.discs)}'
        )
    return float(referred.speed[referred.discs.index(disc)])
