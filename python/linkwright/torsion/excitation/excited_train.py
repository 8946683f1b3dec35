"""A train made ready for forced vibration: its torques, and what it is at each speed.

Mean torques go through the shafts as statics has it, and set couplings to the slope of their curve there.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Complexes, Floats
from linkwright.kernel.errors import InputError, require_within
from linkwright.kernel.limits import RESPONSE
from linkwright.kernel.numerics.tangent import zeros_for
from linkwright.machine.machine import Machine
from linkwright.torsion.core.response import (
    DynamicOrders,
    OperatingState,
    by_columns,
    by_equilibrium,
    dynamic_orders,
    modal_losses,
    tree_of,
)
from linkwright.torsion.core.train import ReferredTrain, refer
from linkwright.torsion.excitation.drive_line import mechanism_sources, steady_speed, train_of
from linkwright.torsion.excitation.engine_torques import EnginePlace, engine_sources
from linkwright.torsion.excitation.harmonics import Source, Torques, torques_of
from linkwright.torsion.excitation.mounted import mounted_sources
from linkwright.torsion.model.drive_train import CRANK
from linkwright.torsion.model.train import Shaft, Train, TrainRun

# Speeds of a driveline over its steady speed, and how many: where a motor works, not where it runs up.
_ABOUT = (0.8, 1.2)
_POINTS = 200

# Share of the largest torque on a mass below which a shaft carries rounding.
_ROUNDING = 1e-11


@dataclass(frozen=True)
class ExcitedTrain:
    """A train with its torques at some speeds."""

    train: Train  # of discs, shafts and gears
    referred: ReferredTrain  # the same, referred to its first disc
    torques: Torques  # on the discs
    mean_torques: Floats  # (shafts, speeds) in the shafts at their own speed [N m]
    operating: OperatingState  # stiffness and damping at each speed

    @cached_property
    def disc_damping(self) -> Floats:
        """Of each disc at its own speed, (discs, speeds) [N m s/rad]."""
        discs = zip(self.train.discs.values(), self.torques.damping, strict=True)
        return np.stack([disc.damping + of_loads for disc, of_loads in discs])

    @cached_property
    def distributed(self) -> DynamicOrders | None:
        """What it is where orders excite it, if inertia of shafts is distributed; else None."""
        if not self.referred.rods:
            return None
        return dynamic_orders(self.referred, self.operating, self.torques.omega)

    @cached_property
    def joint_twists(self) -> Complexes | None:
        """Angle by which joints drive their shafts ahead, (orders, shafts, speeds) [rad]; None without."""
        if not any(shaft.joint_angle is not None for shaft in self.train.shafts.values()):
            return None
        return np.repeat(self.twists_of(self.train)[:, :, None], len(self.torques.speeds), axis=2)

    def twists_of(self, train: Train) -> Any:
        """Those of a train of its shafts, whose angles may have derivatives, (orders, shafts) [rad]."""
        sizes = [
            # sin 2k(φ + φ₀)
            (
                self.torques.is_of(2 * k * float(self.referred.speed[first])),
                s,
                -1j * size * np.exp(2j * k * shaft.joint_phase),
            )
            for s, first, shaft in self.joints(train)
            for k, size in enumerate(shaft.joint_harmonics, start=1)
        ]
        shape = len(self.torques.orders), len(self.referred.shafts)
        twists = zeros_for([size for *_, size in sizes], shape, complex)
        for of, s, size in sizes:
            twists[of, s] = size
        return twists

    def joints(self, train: Train | None = None) -> Iterator[tuple[int, int, Shaft]]:
        """Shafts with a joint, and the disc at it."""
        for s, name in enumerate(self.referred.shafts):
            shaft = (train or self.train).shafts.get(name)
            if shaft is not None and shaft.joint_angle is not None:
                yield s, int(self.referred.tip[s, 0]), shaft

    @cached_property
    def harmonics(self) -> Complexes:
        """Torques on the discs, (orders, discs, speeds) [N m]: from outside, and what joints take unevenly.

        A joint that carries the mean torque M takes M dψ/dφ of the disc before it.
        """
        harmonics, twists = self.torques.harmonics, self.joint_twists
        if twists is None:
            return harmonics
        harmonics = harmonics.copy()
        for s, first, _ in self.joints():
            order = (self.torques.orders / self.referred.speed[first])[:, None]
            harmonics[:, first] -= 1j * order * twists[:, s] * self.mean_torques[s]
        return harmonics

    @cached_property
    def exciting(self) -> Complexes:
        """Torques on the discs with those of shafts that joints twist, (orders, discs, speeds) [N m]."""
        twists = self.joint_twists
        if twists is None:
            return self.torques.harmonics
        exciting, omega = self.harmonics.copy(), self.torques.omega
        for s, first, _ in self.joints():
            lossy = 1 + 1j * self.referred.loss_factor[s]
            stiffness = self.operating.stiffness[s] * lossy + 1j * omega * self.referred.damping[s]
            twisted = stiffness / self.referred.lead[s] ** 2 * twists[:, s]
            exciting[:, first] -= twisted
            exciting[:, int(self.referred.tip[s, 1])] += twisted
        return exciting

    @cached_property
    def referred_harmonics(self) -> Complexes:
        """Torques on the masses, (orders, masses, speeds) [N m]."""
        return onto_masses(self.referred, self.exciting)


def excited_train(machine: Machine, speeds: Floats | None = None) -> ExcitedTrain:
    """Make a train ready for forced vibration. `speeds`: (speeds,) [rad/s]."""
    at = prepared(machine, speeds)
    if not len(at.torques.orders):
        remedy = "give [train.excitations], harmonics of [train.loads], or a [train.engine]"
        raise InputError(f"nothing excites the train of {machine.name}: {remedy}")
    return at


def prepared(machine: Machine, speeds: Floats | None = None) -> ExcitedTrain:
    """As `excited_train`, also for a train that nothing excites; `speeds`: (speeds,) [rad/s]."""
    train = train_of(machine)
    referred = refer(train)
    place = {name: k for k, name in enumerate(train.discs)}
    speeds = _speeds(machine, referred.speed, place) if speeds is None else np.atleast_1d(speeds) * 1.0
    sources, damping = _sources(machine, referred.speed, place, speeds)
    return under(machine, train, referred, speeds, sources, damping)


def under(
    machine: Machine,
    train: Train,
    referred: ReferredTrain,
    speeds: Floats,
    sources: Iterable[Source],
    damping: Floats | None = None,
    *,
    loads_follow: bool | None = None,
) -> ExcitedTrain:
    """A train under torques of its engine or mechanism, and those of its file.

    What the train is under each column of torques; couplings have the slope at the mean torque. `speeds`:
    (speeds,) [rad/s]; `damping`: (discs, speeds) [N m s/rad].
    """
    run = None if machine.train is None else machine.train.run
    follow = (run is not None and run.loads_follow) if loads_follow is None else loads_follow
    listed = list(sources)
    _require_room(train, listed, len(speeds))
    torques = torques_of(
        train,
        referred.speed,
        speeds,
        listed,
        damping,
        is_free=referred.is_free,
        has_engine=machine.train is not None and not machine.train.is_driven,
        loads_follow=follow,
    )
    return loaded(machine, train, referred, torques)


def _require_room(train: Train, sources: Sequence[Source], speeds: int) -> None:
    own = [torque for part in (train.excitations, train.loads) for torque in part.values()]
    orders = sum(len(order.harmonics) for order in own) + sum(len(source.orders) for source in sources)
    remedy = "take fewer train.run.points, or fewer orders"
    require_within(RESPONSE, orders * len(train.discs) * speeds, "train", remedy)


def loaded(machine: Machine, train: Train, referred: ReferredTrain, torques: Torques) -> ExcitedTrain:
    """A train at the speeds of its torques: mean torques of its shafts, stiffness and damping."""
    mean = mean_shaft_torques(referred, torques.mean)
    return ExcitedTrain(train, referred, torques, mean, _operating(machine.train, referred, torques, mean))


def is_excited(machine: Machine) -> bool:
    """Whether a machine has a train with something that excites it, and the speeds at which to look."""
    train = machine.train
    if train is None:
        drive = machine.drive
        return drive is not None and drive.twists and not (drive.motor is None and drive.speed is None)
    return train.run is not None and pulsates(train)


def pulsates(train: Train) -> bool:
    """Whether a train has torques that pulsate."""
    waves = any(load.harmonics for load in train.loads.values())
    joints = any(shaft.joint_angle is not None for shaft in train.shafts.values())
    return bool(train.excitations or train.installed or train.mechanisms) or waves or joints


def highest_order(train: Train) -> float:
    """Last order of an engine's torques."""
    return float(TrainRun.model_fields["orders_max"].default if train.run is None else train.run.orders_max)


def _sources(
    machine: Machine, turning: Floats, place: dict[str, int], speeds: Floats
) -> tuple[list[Source], Floats | None]:
    """Torques of the engine or of the mechanism, and their damping (discs, speeds)."""
    if machine.train is None:
        return mechanism_sources(machine, turning, place, speeds)
    sources: list[Source] = []
    damping = None
    if machine.train.mechanisms:
        sources, damping = mounted_sources(machine, turning, place, speeds)
    for engine in machine.train.installed:
        first = place[engine.throws[0]]
        sources += engine_sources(
            engine.engine,
            speeds,
            highest_order(machine.train),
            EnginePlace(first, float(turning[first]), engine.phase),
        )
    return sources, damping


def _speeds(machine: Machine, turning: Floats, place: dict[str, int]) -> Floats:
    """Speeds of the run of the file; of a driveline those about its steady speed."""
    if machine.train is None:
        of_crank: Floats = np.linspace(*_ABOUT, _POINTS) * steady_speed(machine)
        return of_crank / float(turning[place[CRANK]])
    run = machine.train.run
    if run is None:
        remedy = 'give [train.run] speed_min and speed_max, such as "500 rpm" and "2000 rpm"'
        raise InputError(f"{machine.name} has no speeds for forced vibration: {remedy}")
    return run.speeds


def onto_masses(referred: ReferredTrain, torques: Complexes) -> Complexes:
    """Torques on discs as torques on masses, (…, masses, speeds)."""
    on_masses = np.zeros((len(torques), len(referred.inertia), torques.shape[-1]), torques.dtype)
    for disc, (mass, n) in enumerate(zip(referred.mass, referred.scale, strict=True)):
        on_masses[:, mass] += n * torques[:, disc]
    return on_masses


def mean_shaft_torques(referred: ReferredTrain, mean: Floats) -> Floats:
    """Torque of each shaft at its own speed under torques that do not pulsate."""
    M = onto_masses(referred, mean[None].astype(complex))[0].real
    if referred.is_free:
        # What is left over speeds the train up as a whole.
        surplus = (referred.rigid @ M) / (referred.rigid @ referred.inertia)
        M = M - by_columns(referred.inertia) * referred.rigid[:, None] * surplus
    carried = carried_by_shafts(referred, M)
    # What is left of the rounding of large torques is none.
    carried[np.abs(carried) < _ROUNDING * np.abs(M).max(initial=0.0)] = 0.0
    return carried / referred.lead[:, None]


def static_stiffness(referred: ReferredTrain) -> Floats:
    """Stiffness by which shafts share a mean torque, (shafts,) [N m/rad]."""
    # The ring of a fluid hangs on nothing else, so that any stiffness tells what takes it along.
    return np.where(referred.stiffness > 0, referred.stiffness, referred.stiffness.max(initial=0.0) or 1.0)


def carried_by_shafts(referred: ReferredTrain, M: Floats) -> Floats:
    """Torque of each shaft, (shafts, …), that holds torques on the masses which balance, (masses, …)."""
    k, tree = static_stiffness(referred), tree_of(referred)
    if tree is None:
        # Of all torques that balance those of minimum energy, Σ T²/k: so ways in parallel share by stiffness.
        scale = np.sqrt(k)[:, None]
        carried: Floats = scale * (np.linalg.pinv((scale * referred.joins).T, rcond=1e-13) @ M)
    else:
        stiffness = np.broadcast_to(by_columns(k)[None].astype(complex), (1, len(k), M.shape[1]))
        carried = by_equilibrium(referred, tree, stiffness, M[None].astype(complex))[0].real
    return carried


def _operating(
    train: Train | None, referred: ReferredTrain, torques: Torques, mean: Floats
) -> OperatingState:
    columns = len(torques.speeds)
    stiffness = np.broadcast_to(by_columns(referred.stiffness), (len(referred.shafts), columns)).copy()
    lead = referred.lead
    for name, coupling in ({} if train is None else train.couplings).items():
        if coupling.twist is not None:
            s = referred.shafts.index(name)
            stiffness[s] = lead[s] ** 2 * coupling.slope(mean[s])
    for name, pendulum in ({} if train is None else train.pendulums).items():
        s = referred.shafts.index(name)
        stiffness[s] = lead[s] ** 2 * pendulum.stiffness(lead[s] * torques.speeds)
    damping = np.broadcast_to(by_columns(referred.disc_damping), (len(referred.inertia), columns)).copy()
    np.add.at(damping, referred.mass, referred.scale[:, None] ** 2 * torques.damping)
    held = np.zeros(len(referred.inertia))
    np.add.at(held, referred.mass, referred.scale**2 * torques.control)
    modal = modal_losses(referred, stiffness)
    return OperatingState(torques.speeds, stiffness, damping, modal, held if held.any() else None)
