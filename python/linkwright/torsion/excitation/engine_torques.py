r"""Torques of an engine on its throws: gas, inertia, weight; and what an engine is in a train.

With ψ the angle of a throw from where it points along a cylinder at its firing, the gas gives
:math:`M_g(\psi)`; all moving parts of a throw together give about constant speed

.. math:: M = -\tfrac12 J'(\varphi)\,\Omega^2 - V'(\varphi)

with the inertia J and the potential energy V of the true mechanism. A throw at the angle α, a cylinder that
fires at :math:`\varphi_f`, turn the harmonics by :math:`e^{i\nu\alpha}` and :math:`e^{-i\nu\varphi_f}`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, NamedTuple

import numpy as np

from linkwright.kernel.arrays import Complexes, Floats
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.kernel.units.kinds import SPEED
from linkwright.kernel.units.marks import positive
from linkwright.torsion.excitation.harmonics import Source
from linkwright.torsion.model.engine.cylinder import Cylinder, GasTorque, gas_torque
from linkwright.torsion.model.engine.engine import ReciprocatingEngine, firing_angles
from linkwright.torsion.model.engine.engine_motion import (
    mean_throw_inertia,
    own_inertia,
    piston_positions,
    reduced_throw,
    running_gears,
    throw_stiffness,
)
from linkwright.torsion.model.engine.equivalent_inertia import published_throw_inertia
from linkwright.torsion.model.engine.throw_compliance import compliances


@dataclass(frozen=True)
class CylinderTorques:
    """Gas torques of all cylinders."""

    orders: Floats  # (orders,) cycles per revolution, from 0
    # `firing`, `motored`: (cylinders, orders, speeds) M_ν of each cylinder on its throw, sound and without
    # combustion [N m].
    firing: Complexes
    motored: Complexes
    banks: tuple[GasTorque, ...]  # of one sound cylinder of each bank, before its phase


@dataclass(frozen=True)
class CylinderStates:
    r"""How cylinders work, in some states of an engine.

    .. math:: M_\nu = \kappa M_\nu^\mathrm{motored}
        + x\,e^{-i\nu\delta}\left(M_\nu^\mathrm{firing} - M_\nu^\mathrm{motored}\right)
    """

    combustion: Floats  # (cylinders, states) x: 1 healthy, 0 without combustion
    # (cylinders, states) δ, crank angle by which the torque of the combustion is late [rad].
    delay: Floats | float = 0.0
    compression: Floats | float = 1.0  # (cylinders, states) κ: 1 tight, less where the cylinder leaks

    def torque(self, gas: CylinderTorques) -> Complexes:
        """Gas torques of the cylinders, (cylinders, orders, states). M_ν [N m]."""
        combustion, delay, compression = (
            array[:, None]
            for array in np.broadcast_arrays(self.combustion, np.asarray(self.delay), self.compression)
        )
        burns = combustion * (gas.firing - gas.motored)
        if delay.any():
            burns *= np.exp(-1j * gas.orders[:, None] * delay)
        M: Complexes = compression * gas.motored + burns
        return M


def cylinder_torques(engine: ReciprocatingEngine, speeds: Floats, highest: float = 24.0) -> CylinderTorques:
    """Gas torques of the cylinders of an engine, each with its phase. `speeds`: (speeds,) [rad/s]."""
    banks = _banks(engine, speeds, highest)
    orders = banks[0].orders
    fires, _ = firing_angles(engine.places, engine.firing_order, engine.cycle)
    phase = np.exp(-1j * np.outer(fires, orders))[:, :, None]
    of_bank = [place.bank for place in engine.places]
    firing = np.stack([bank.firing.T for bank in banks])[of_bank] * phase
    motored = np.stack([bank.motored.T for bank in banks])[of_bank] * phase
    return CylinderTorques(orders, firing, motored, banks)


# Rounding of a place of a piston, over the radius of the crank.
_ALIKE = 1e-14


def _banks(engine: ReciprocatingEngine, speeds: Floats, highest: float) -> tuple[GasTorque, ...]:
    """Gas torque of a cylinder of each bank; pistons of rods side by side share one."""
    made: list[tuple[Floats, GasTorque]] = []
    for places in piston_positions(engine):
        alike = (gas for known, gas in made if np.abs(known - places).max() <= _ALIKE * engine.radius)
        gas = next(alike, None)
        if gas is None:
            cylinder = Cylinder(engine.bore, engine.strokes, places)
            gas = gas_torque(engine.gas.cycle_pressure(cylinder, speeds), cylinder, highest)
        made.append((places, gas))
    return tuple(gas for _, gas in made)


class EnginePlace(NamedTuple):
    """Where an engine is in its train."""

    first: int = 0  # place of its first throw among the discs
    turning: float = 1.0  # speed of its crank over that of the first disc of the train
    phase: float = 0.0  # angle by which its crank leads [rad]


def engine_sources(
    engine: ReciprocatingEngine, speeds: Floats, highest: float = 24.0, place: EnginePlace | None = None
) -> list[Source]:
    """Torques on the throws of an engine with their mean, one a throw; `speeds`: (speeds,) [rad/s]."""
    place = place or EnginePlace()
    gas = cylinder_torques(engine, place.turning * speeds, highest)
    return throw_sources(engine, gas, CylinderStates(sound_factors(engine)[:, None]), place)


def sound_factors(engine: ReciprocatingEngine) -> Floats:
    """Share of the combustion in each cylinder as its file says, (cylinders,)."""
    return np.array([engine.factor(n + 1) for n in range(engine.n_cylinders)])


def throw_sources(
    engine: ReciprocatingEngine,
    gas: CylinderTorques,
    states: CylinderStates,
    place: EnginePlace | None = None,
) -> list[Source]:
    """Torques on the throws by cylinders that work more or less, a column for each speed or state."""
    place = place or EnginePlace()
    torque = states.torque(gas)
    moving = _moving_parts(engine, gas.banks[0].speeds, gas.orders)
    sources = []
    for n, angle in enumerate(engine.throws):
        own = sum(torque[c] for c, place in enumerate(engine.places) if place.throw == n)
        total = own + moving * np.exp(1j * gas.orders * angle)[:, None]
        total = total * np.exp(1j * gas.orders * place.phase)[:, None]
        orders = place.turning * gas.orders[1:]
        sources.append(Source(place.first + n, orders, total[1:], total[0].real))
    return sources


def _moving_parts(engine: ReciprocatingEngine, speeds: Floats, orders: Floats) -> Complexes:
    """Harmonics of inertia and weight of the first throw, (orders, speeds)."""
    samples = max(256, 8 * int(np.ceil(orders[-1])))
    phi = 2 * np.pi * np.arange(samples) / samples
    throw = reduced_throw(engine, phi)
    curves = (throw.inertia_torque(1.0), throw.weight_torque)
    inertia, weight = (np.fft.rfft(curve) * 2 / samples for curve in curves)
    M = np.zeros((len(orders), len(speeds)), complex)
    # A motion that repeats every revolution has whole orders alone.
    places = np.flatnonzero(orders == np.round(orders))
    nu = orders[places].astype(int)
    M[places] = inertia[nu, None] * speeds**2 + weight[nu, None]
    M[0] *= 0.5
    return M


@dataclass(frozen=True)
class EngineData(Result):
    """An engine's part of a train."""

    own_inertia: Annotated[
        float, Label("moment of inertia of the rotating parts of a throw", "J_k", "kg m²", "Without rods.")
    ]
    throw_inertia: Annotated[
        float,
        Label(
            "moment of inertia of the disc of a throw",
            "",
            "kg m²",
            "Mean over the revolution of its exact inertia.",
        ),
    ]
    throw_inertia_published: Annotated[float, Label("the same by paper 3, (7) and (12)", "", "kg m²")]
    stiffness: Annotated[
        float | None,
        Label("stiffness from throw to throw", "k", "N m/rad", "As it is used; None with a single throw."),
    ]
    stiffness_by: Annotated[str, About('Formula that it is by, or "given".')]
    stiffness_formulas: Annotated[
        dict[str, float], About("Stiffness by every formula, where the geometry is known [N m/rad].")
    ]
    firing: Annotated[
        dict[str, float], About("Crank angle at which each cylinder fires, by number, in their order [rad].")
    ]
    speed: Annotated[float, Label("speed at which the gas is reported", "ω", "rad/s")]
    mean_effective_pressure: Annotated[tuple[float, ...], About("Of a sound cylinder of each bank [Pa].")]
    peak_pressure: Annotated[tuple[float, ...], About("Of a sound cylinder of each bank [Pa].")]
    machine: Annotated[str, About('"engine" or "compressor".')] = "engine"

    @property
    def intervals(self) -> tuple[float, ...]:
        """Angles from one firing to the next, in their order, but for the last [rad]."""
        return tuple(np.diff(list(self.firing.values())).tolist())

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """All of it."""
        tables = {"stiffness_formulas": self.stiffness_formulas, "firing": self.firing}
        return super().to_dict(curves=curves) | tables


@public
def engine_data(engine: ReciprocatingEngine, speed: float) -> EngineData:
    """Data of an engine in a train.

    Parameters
    ----------
    engine : ReciprocatingEngine
    speed : float
        Of its crank, at which its gas is reported [rad/s].

    Returns
    -------
    EngineData
        Discs, stiffness, firing, gas.

    Raises
    ------
    InputError
        A speed that is not above zero.
    """
    in_range(speed=(speed, positive(SPEED)))
    given = engine.stiffness is not None
    formulas = {} if engine.throw is None else compliances(engine.throw)
    angles, _ = firing_angles(engine.places, engine.firing_order, engine.cycle)
    gas = cylinder_torques(engine, np.array([speed]), 1.0).banks
    return EngineData(
        own_inertia=own_inertia(engine),
        throw_inertia=mean_throw_inertia(engine),
        throw_inertia_published=published_throw_inertia(
            engine.radius, running_gears(engine), own_inertia(engine)
        ),
        stiffness=throw_stiffness(engine) if len(engine.throws) > 1 else None,
        stiffness_by="given" if given else engine.stiffness_formula,
        stiffness_formulas={name: 1.0 / formula for name, formula in formulas.items()},
        firing={str(number): angles[number - 1] for number in engine.firing_order},
        speed=speed,
        mean_effective_pressure=tuple(float(load.mean_effective_pressure[0]) for load in gas),
        peak_pressure=tuple(float(load.peak_pressure[0]) for load in gas),
        machine=engine.machine,
    )
