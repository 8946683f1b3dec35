"""The V-12 on which paper 3 is tried, and what another inertia or stiffness does to its frequencies."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from linkwright.machine.address import replace
from linkwright.machine.machine import Machine
from linkwright.torsion.model.engine.engine import ReciprocatingEngine
from linkwright.torsion.model.engine.engine_motion import own_inertia, running_gears, throw_stiffness
from linkwright.torsion.model.engine.equivalent_inertia import mean_inertia
from linkwright.torsion.model.engine.rod import ArticulatedRod
from linkwright.torsion.model.engine.running_gear import RunningGear
from linkwright.torsion.modes.free import FreeVibration, free_vibration

Floats = NDArray[np.float64]

# Modes that are looked at: that of the coupling, and the first two of the crankshaft.
MODES = (1, 2, 3)


@dataclass(frozen=True)
class Shift:
    """What a formula makes of the natural frequencies.

    Attributes
    ----------
    name, what : str
        The formula, in words; ``"J"`` of the disc of a throw, or ``"k"`` of the shaft between throws.
    value, deviation : float
        By the formula [kg m²] or [N m/rad]; from the exact mean inertia or the stiffness by (17) [–].
    frequencies, changes : ndarray, shape (modes,)
        Of `MODES` [Hz], and shares of those of the exact train [–].
    critical : float
        Speed at which the order of the firing meets the first mode of the crankshaft [rad/s].
    """

    name: str
    what: str
    value: float
    deviation: float
    frequencies: Floats
    changes: Floats
    critical: float


@dataclass(frozen=True)
class TrialEngine:
    """The engine by the letters of paper 3: a machine with a train, whose throw is given by its geometry."""

    machine: Machine

    @property
    def engine(self) -> ReciprocatingEngine:
        """The engine."""
        assert self.machine.train is not None
        assert self.machine.train.engine is not None
        return self.machine.train.engine

    @property
    def articulated(self) -> ArticulatedRod:
        """Its articulated rod."""
        assert self.engine.articulated is not None
        return self.engine.articulated

    @cached_property
    def gears(self) -> tuple[RunningGear, ...]:
        """Rod and piston of each bank."""
        return running_gears(self.engine)

    @cached_property
    def own(self) -> float:
        """I_k, of what turns with a throw [kg m²]."""
        return own_inertia(self.engine)

    @cached_property
    def inertia(self) -> float:
        """Exact mean over the revolution of the inertia of a throw with both rods and pistons [kg m²]."""
        return mean_inertia(self.engine.radius, self.gears, self.own).mean

    @cached_property
    def master_inertia(self) -> float:
        """The same with the master rod and its piston alone [kg m²]."""
        return mean_inertia(self.engine.radius, self.gears[:1], self.own).mean

    @cached_property
    def stiffness(self) -> float:
        """From throw to throw, by the formula of the machine file [N m/rad]."""
        return throw_stiffness(self.engine)

    @cached_property
    def free(self) -> FreeVibration:
        """Free vibration of the exact train."""
        return free_vibration(self.machine)

    @cached_property
    def frequencies(self) -> Floats:
        """Of `MODES` [Hz]."""
        return self.free.natural_frequencies[list(MODES)]

    @property
    def order(self) -> float:
        """Firings a revolution, the order that all cylinders excite together."""
        return 2 * self.engine.n_cylinders / self.engine.strokes

    @property
    def service(self) -> float:
        """Speed of service [rad/s]."""
        assert self.machine.train is not None
        assert self.machine.train.run is not None
        return self.machine.train.run.service

    def critical(self, frequency: float) -> float:
        """Speed at which the order of the firing meets a frequency [Hz → rad/s]."""
        return 2 * math.pi * frequency / self.order

    def with_inertia(self, name: str, inertia: float) -> Shift:
        """Frequencies with the disc of each throw [kg m²] by a formula."""
        # What does not turn with the crank stays as it is: the difference goes to what does.
        machine = replace(self.machine, {"train.engine.throw_inertia": self.own + inertia - self.inertia})
        return self._shift(name, "J", inertia, inertia / self.inertia - 1, machine)

    def with_stiffness(self, name: str, stiffness: float) -> Shift:
        """Frequencies with the stiffness between throws [N m/rad] by a formula."""
        machine = replace(self.machine, {"train.engine.stiffness": stiffness})
        return self._shift(name, "k", stiffness, stiffness / self.stiffness - 1, machine)

    def _shift(self, name: str, what: str, value: float, deviation: float, machine: Machine) -> Shift:
        found = free_vibration(machine).natural_frequencies[list(MODES)]
        changes = found / self.frequencies - 1
        return Shift(name, what, value, deviation, found, changes, self.critical(float(found[1])))
