"""Crank throw, swing of the connecting rod, and inertia of the crank train by paper 3, tried on its V-12."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.machine import address
from linkwright.machine.machine import Machine
from linkwright.torsion.model.engine import pendulum
from linkwright.torsion.model.engine.engine import ReciprocatingEngine
from linkwright.torsion.model.engine.engine_motion import own_inertia, running_gears, throw_stiffness
from linkwright.torsion.model.engine.equivalent_inertia import (
    articulated_inertia,
    central_mean_inertia,
    disc_by_distribution,
    disc_by_two_masses,
    mean_inertia,
    printed_disc,
    published_piston_speed,
    published_throw_inertia,
)
from linkwright.torsion.model.engine.pendulum import PRINTED_GRAVITY
from linkwright.torsion.model.engine.rod import ArticulatedRod, Rod
from linkwright.torsion.model.engine.rod_motion import slider_crank
from linkwright.torsion.model.engine.running_gear import RunningGear, dead_centres
from linkwright.torsion.model.engine.throw import CrankThrow
from linkwright.torsion.model.engine.throw_compliance import compliances, restraint_length
from linkwright.torsion.model.engine.throw_inertia import published_inertia
from linkwright.torsion.modes.free import FreeVibration, free_vibration

# Modes that are examined: that of the coupling, and the first two of the crankshaft.
MODES = (1, 2, 3)


@dataclass(frozen=True)
class Shift:
    """What a formula makes of the natural frequencies."""

    # The formula, in words; `"J"` of the disc of a throw, or `"k"` of the shaft between throws.
    name: str
    what: str
    # By the formula [kg m²] or [N m/rad]; from the exact mean inertia or the stiffness by (17) [–].
    value: float
    deviation: float
    # (modes,): of `MODES` [Hz], and shares of those of the exact train [–].
    frequencies: Floats
    changes: Floats
    critical: float  # speed at which the order of the firing meets the first mode of the crankshaft [rad/s]


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
        machine = address.replace(
            self.machine, {"train.engine.throw_inertia": self.own + inertia - self.inertia}
        )
        return self._shift(name, "J", inertia, inertia / self.inertia - 1, machine)

    def with_stiffness(self, name: str, stiffness: float) -> Shift:
        """Frequencies with the stiffness between throws [N m/rad] by a formula."""
        machine = address.replace(self.machine, {"train.engine.stiffness": stiffness})
        return self._shift(name, "k", stiffness, stiffness / self.stiffness - 1, machine)

    def _shift(self, name: str, what: str, value: float, deviation: float, machine: Machine) -> Shift:
        frequencies = free_vibration(machine).natural_frequencies[list(MODES)]
        changes = frequencies / self.frequencies - 1
        return Shift(name, what, value, deviation, frequencies, changes, self.critical(float(frequencies[1])))


_NAMES = {
    "constrained": "(17), k by Castigliano",
    "free": "(17), k → ∞",
    "carter": "Carter",
    "ker_wilson": "Ker Wilson",
    "zimanenko": "Zimanenko",
}


def throw_checks(trial: TrialEngine) -> dict[str, Any]:
    """(16), rebuilt, over the exact inertia, less one [–]; k of (17) [m]; stiffness by formula [N m/rad]."""
    throw = trial.engine.throw
    assert throw is not None
    stiffness = {_NAMES[name]: 1 / compliance for name, compliance in compliances(throw).items()}
    return {
        "inertia": published_inertia(throw) / trial.own - 1,
        "restraint": throw.restraint_length or restraint_length(throw),
        "stiffness": stiffness,
        "shifts": tuple(_shifts(trial, throw, stiffness)),
    }


def _shifts(trial: TrialEngine, throw: CrankThrow, stiffness: dict[str, float]) -> Iterator[Shift]:
    """The train with (16), and with each stiffness but that of the machine file."""
    disc = trial.inertia + published_inertia(throw) - trial.own
    yield trial.with_inertia("(16), drillings taken as parallel to the shaft", disc)
    for name, value in stiffness.items():
        if name != _NAMES[trial.engine.stiffness_formula]:
            yield trial.with_stiffness(name, value)


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
    return 60 / math.pi * math.sqrt(mass * _GRAVITY * edge / (inertia + mass * edge**2))


# Crank angles at which speeds are compared.
_ANGLES = 3600

# 1 kgf cm s² is so many kg m², with the paper's g.
KGF_CM_S2 = PRINTED_GRAVITY * 1e-4


def inertia_checks(trial: TrialEngine, printed: dict[str, Any]) -> dict[str, Any]:
    """Compare (1) to (12), each with the exact value; deviations are shares, less one [–]."""
    e, own, exact = trial.engine, trial.own, trial.master_inertia
    rod, R, m_3 = e.rod, e.radius, e.piston_mass
    seven = disc_by_two_masses(R, rod.length, (rod.mass_pin, rod.mass_piston, m_3), own)
    nine = disc_by_distribution(R, rod.share, rod.mass, m_3, own)
    two = Rod(length=rod.length, mass=rod.mass, distribution=rod.share)
    of_two = central_mean_inertia(R, two, m_3, own)
    in_kgf = printed_disc(100 * R, rod.share, rod.mass, m_3, own / KGF_CM_S2) * KGF_CM_S2
    return {
        # k of the master rod, (8) [–].
        "share": rod.share,
        # Its centre of mass from the big end, and that of the two masses of (1), (2) [m].
        "centre": rod.body.centre,
        "centre_split": two.body.centre,
        # Mean inertia of a throw with the master rod alone, as two masses over exact.
        "split": of_two / exact - 1,
        # (3): maximum difference, as a share of the maximum speed.
        "speed": _speed_difference(R, rod.length),
        # (7) over the exact mean of the same two masses, and of the master rod; (9) in SI over the latter.
        "series": seven / of_two - 1,
        "one_rod": seven / exact - 1,
        "simple": nine / exact - 1,
        # 0.00051 over 1/(2·981), and (9) as printed over (9) in SI.
        "factor": 2 * PRINTED_GRAVITY * printed["factor"] - 1,
        "printed": in_kgf / nine - 1,
        # The articulated rod about its small end, exact and by (12); what it adds to the exact mean [kg m²].
        "articulated": trial.articulated.moment_small_end,
        "articulated_printed": articulated_inertia(rod.moment_small_end, rod.mass, trial.articulated.mass),
        "articulated_share": _without_piston(trial) - exact,
        # Of both banks [m].
        "strokes": tuple(centre.stroke for centre in dead_centres(R, trial.gears)),
        "shifts": tuple(_inertia_shifts(trial, printed)),
    }


def _speed_difference(crank_radius: float, length: float) -> float:
    """(3) against the exact speed of the piston, as a share of the maximum."""
    phi = 2 * np.pi * np.arange(_ANGLES) / _ANGLES
    # Exact speeds are counted away from the crank, that of (3) towards it.
    exact = -slider_crank(crank_radius, length, phi).piston_d1
    printed = published_piston_speed(crank_radius, length, 1.0, phi)
    return float(np.abs(printed - exact).max() / np.abs(exact).max())


def _without_piston(trial: TrialEngine) -> float:
    master, articulated = trial.gears
    return mean_inertia(trial.engine.radius, (master, replace(articulated, piston_mass=0.0)), trial.own).mean


def _inertia_shifts(trial: TrialEngine, printed: dict[str, Any]) -> Iterator[Shift]:
    e, own = trial.engine, trial.own
    R, rod, light, m_3 = e.radius, e.rod, trial.articulated.mass, e.piston_mass
    literal = published_throw_inertia(R, trial.gears, own)
    yield trial.with_inertia("(7) with I_a by (12), as printed", literal)
    # The articulated rod as a second rod of the same k and length on the crank pin.
    second = disc_by_two_masses(R, rod.length, (rod.share * light, (1 - rod.share) * light, m_3))
    first = disc_by_two_masses(R, rod.length, (rod.mass_pin, rod.mass_piston, m_3), own)
    yield trial.with_inertia("(7), I_a reduced to the crank pin", first + second)
    for k in (rod.share, *printed["k"]):
        both = disc_by_distribution(R, k, rod.mass + light, 2 * m_3)
        scaled = own + both * 2 * PRINTED_GRAVITY * printed["factor"]
        yield trial.with_inertia(f"(9), both rods with k = {k:.2f}", scaled)
