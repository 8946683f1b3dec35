r"""Free vibration of a train without damping: natural frequencies, mode shapes, nodes, energy.

With the angles θ of the discs, J their inertias and K the stiffness of the shafts,

.. math:: (K - \omega^2 J)\,\theta = 0

In a mode, disc d has the share :math:`J_d\theta_d^2/\sum J\theta^2` of the kinetic and shaft s the share
:math:`k_s\Delta_s^2/\sum k\Delta^2` of the potential energy, Δ its twist. By Rayleigh's quotient these are
also how much the frequency follows a change of a part,

.. math:: \frac{\partial\ln\omega^2}{\partial\ln k_s} = \frac{k_s\Delta_s^2}{\sum k\Delta^2}, \qquad
    \frac{\partial\ln\omega^2}{\partial\ln J_d} = -\frac{J_d\theta_d^2}{\sum J\theta^2}

for a frequency that stands alone.

References
----------
.. [1] Den Hartog, Mechanical Vibrations, 4th ed. 1956, sections 4.9 and 5.1 to 5.4.
.. [2] Fox and Kapoor, Rates of change of eigenvalues and eigenvectors, AIAA J. 6 (1968) 2426-2429.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Annotated, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.arrays import Floats
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.machine.machine import Machine
from linkwright.torsion.core.distributed import ExactMode, RodShape, exact_modes
from linkwright.torsion.core.rod import along, ends, energies, node_shares, stations
from linkwright.torsion.core.train import HELD, ReferredTrain, refer
from linkwright.torsion.excitation.drive_line import train_of
from linkwright.torsion.model.train import Train
from linkwright.torsion.model.whole_train import RodShaft

# Share of the largest amplitude below which a disc is at rest: rounding of a mode leaves less.
_AT_REST = 1e-9


class Node(NamedTuple):
    """A place that is at rest in a mode.

    Attributes
    ----------
    at : str
        Shaft, elastic mesh or disc.
    share : float
        Of the twist of the shaft from its first end to the node, 0 to 1; 0 for a disc.
    distance : float or None
        From the first end of a shaft of sections [m].
    """

    at: str
    share: float
    distance: float | None


class ShaftShapes(NamedTuple):
    """How a shaft with distributed inertia swings in every mode.

    Attributes
    ----------
    name : str
        Of the shaft.
    between : tuple of str
        Its two ends.
    share : ndarray, shape (stations,)
        Of the flexibility of the shaft before each station, 0 to 1.
    distance : ndarray or None, shape (stations,)
        From the first end of a shaft of sections [m].
    angles : ndarray, shape (modes, stations)
        As `mode_shapes`, of the shaft in the sense of its first end.
    """

    name: str
    between: tuple[str, str]
    share: Floats
    distance: Floats | None
    angles: Floats


_MODE_SHAPES = (
    "The largest amplitude is 1, along shafts of distributed inertia too; of several, the first in the file. "
    "Each disc counts in the sense in which it turns with the train."
)
_TWISTS = "Angle of the first end less that of the second; of a mesh, as angle of its first disc."


@dataclass(frozen=True)
class FreeVibration(Result):
    """Free vibration of a train, one row a mode."""

    natural_frequencies: Annotated[
        Floats,
        Label(
            "natural frequencies",
            "ω/2π",
            "Hz",
            "Increasing; zero for the motion of a free train as a whole.",
            shape="(modes,)",
        ),
    ]
    discs: Annotated[tuple[str, ...], About("Discs in the order of the file.")]
    mode_shapes: Annotated[Floats, Label("mode shapes", "θ", "", _MODE_SHAPES, shape="(modes, discs)")]
    shafts: Annotated[tuple[str, ...], About("Shafts, then elastic meshes, in the order of the file.")]
    twists: Annotated[
        Floats,
        Label("twist of each shaft per unit of amplitude", "Δ", "rad", _TWISTS, shape="(modes, shafts)"),
    ]
    nodes: Annotated[tuple[tuple[Node, ...], ...], About("Nodes of each mode; the ground does not count.")]
    kinetic_shares: Annotated[
        Floats,
        Label(
            "share of each disc in the kinetic energy",
            "",
            "",
            "Less their sign the sensitivities of ω² to the inertias.",
            shape="(modes, discs)",
        ),
    ]
    potential_shares: Annotated[
        Floats,
        Label(
            "share of each shaft in the potential energy",
            "",
            "",
            "The sensitivities of ω² to the stiffnesses; zero where ω = 0.",
            shape="(modes, shafts)",
        ),
    ]
    modal_inertia: Annotated[Floats, Label("modal inertia", "Σ J θ²", "kg m²")]
    joined: Annotated[tuple[tuple[str, str], ...], About("The two ends of every shaft and gear stage.")]
    shaft_kinetic_shares: Annotated[
        Floats,
        Label(
            "share of each shaft in the kinetic energy",
            "",
            "",
            "Of those with distributed inertia.",
            shape="(modes, shafts)",
        ),
    ]
    along: Annotated[
        tuple[ShaftShapes, ...], About("Shapes along the shafts whose inertia is distributed.")
    ] = ()

    @property
    def angular_frequencies(self) -> Annotated[Floats, Label("angular natural frequencies", "ω", "rad/s")]:
        """ω."""
        return 2 * math.pi * self.natural_frequencies

    @property
    def modal_stiffness(self) -> Annotated[Floats, Label("modal stiffness", "ω² Σ J θ²", "N m/rad")]:
        """ω² Σ J θ²."""
        return self.angular_frequencies**2 * self.modal_inertia

    @property
    def sensitivity_to_stiffness(
        self,
    ) -> Annotated[
        Floats, Label("sensitivity to the stiffness of each shaft", "", "", shape="(modes, shafts)")
    ]:
        """∂ln ω²/∂ln k, (modes, shafts)."""
        return self.potential_shares

    @property
    def sensitivity_to_inertia(
        self,
    ) -> Annotated[Floats, Label("sensitivity to the inertia of each disc", "", "", shape="(modes, discs)")]:
        """∂ln ω²/∂ln J, (modes, discs); zero where ω = 0."""
        return np.where(self.natural_frequencies[:, None] > 0, -self.kinetic_shares, 0.0)


@public
def free_vibration(machine: Machine) -> FreeVibration:
    """Natural frequencies and mode shapes of a train.

    Parameters
    ----------
    machine : Machine
        With a [train], or a [drive] that twists.

    Returns
    -------
    FreeVibration
        All modes.

    Raises
    ------
    InputError
        The machine has no train.
    AssemblyError
        The mechanism behind the driveline does not close all round.

    References
    ----------
    .. [1] Den Hartog, Mechanical Vibrations, 4th ed. 1956, chapter 5.
    """
    train = train_of(machine)
    referred = refer(train)
    modes = train_modes(referred, modes_wanted(machine, train))
    free = modes_table(train, referred, modes, disc_inertias(train, referred), own_stiffness(referred))
    shapes = free.mode_shapes
    nodes = tuple(tuple(_nodes(train, referred, shape, modes, k)) for k, shape in enumerate(shapes))
    return replace(free, nodes=nodes)


def modes_table(
    train: Train, referred: ReferredTrain, modes: TrainModes, inertia: Floats, stiffness: Floats
) -> FreeVibration:
    """Modes of a train, or of several of one structure one after another, without nodes.

    `inertia`: (discs,) or (modes, discs) at their own speeds [kg m²]; `stiffness`: likewise of the shafts
    [N m/rad].
    """
    shapes, size = _sized(referred, modes)
    twists = twists_of(referred, shapes)
    kinetic, potential = inertia * shapes**2, stiffness * twists**2
    of_shafts = np.zeros_like(potential)
    for n, rod in enumerate(referred.rods):
        energy = [_energies(mode, n, factor) for mode, factor in zip(modes.exact, size, strict=True)]
        of_shafts[:, rod.shaft], potential[:, rod.shaft] = np.array(energy).T
    moving = modes.omega[:, None] > 0
    total = np.where(moving, potential.sum(axis=1, keepdims=True), 1.0)
    modal = kinetic.sum(axis=1) + of_shafts.sum(axis=1)
    return FreeVibration(
        natural_frequencies=modes.omega / (2 * math.pi),
        discs=referred.discs,
        mode_shapes=shapes,
        shafts=referred.shafts,
        twists=twists,
        nodes=(),
        kinetic_shares=kinetic / modal[:, None],
        shaft_kinetic_shares=of_shafts / modal[:, None],
        potential_shares=np.where(moving, potential, 0.0) / total,
        modal_inertia=modal,
        joined=tuple(row.between for table in (train.shafts, train.gears) for row in table.values()),
        along=tuple(_along(train, referred, modes, n, size) for n in range(len(referred.rods))),
    )


# Modes beyond those that a train has with the inertia of each section at its ends.
_FURTHER = 2


def modes_wanted(machine: Machine, train: Train) -> int:
    """How many modes of a train with distributed inertia are sought."""
    if machine.train is not None and machine.train.modes is not None:
        return machine.train.modes
    sections = [
        len(shaft.sections or (None,)) for shaft in train.shafts.values() if isinstance(shaft, RodShaft)
    ]
    return len(train.discs) + sum(sections) + _FURTHER


def disc_inertias(train: Train, referred: ReferredTrain) -> Floats:
    """Inertia of each disc at its own speed, without that of shafts that have it distributed, (discs,)."""
    J: Floats = np.array([disc.inertia for disc in train.discs.values()], dtype=float)
    for rod in referred.rods:
        for disc, lumped in zip(referred.tip[rod.shaft], rod.ends, strict=True):
            if disc != HELD:
                J[disc] -= lumped / referred.speed[disc] ** 2
    own: Floats = np.maximum(J, 0.0)
    return own


class TrainModes(NamedTuple):
    """Modes of a train, lumped or exact."""

    omega: Floats  # (modes,) [rad/s]
    masses: Floats  # (modes, masses) the kinetic energy of each is ½ ω²
    exact: tuple[ExactMode, ...]  # of a train with distributed inertia; else empty


def train_modes(referred: ReferredTrain, count: int) -> TrainModes:
    """Modes of a train: all of a lumped one, the lowest of one with distributed inertia."""
    if not referred.rods:
        return TrainModes(*referred.modes(), ())
    modes = exact_modes(referred, count)
    return TrainModes(
        np.array([mode.omega for mode in modes]), np.array([mode.masses for mode in modes]), modes
    )


def _sized(referred: ReferredTrain, modes: TrainModes) -> tuple[Floats, Floats]:
    """Shapes of the discs with a largest amplitude of 1, and the factor of each mode."""
    angles = referred.scale * modes.masses[:, referred.mass]
    if not modes.exact:
        return scaled(angles), np.ones(len(angles))
    lead = referred.lead
    inside = [[lead[one.rod.shaft] * np.abs(one.angles).max() for one in mode.rods] for mode in modes.exact]
    largest = np.maximum(np.abs(angles).max(axis=1), np.max(inside, axis=1))
    angles[np.abs(angles) < _AT_REST * largest[:, None]] = 0.0
    first = np.take_along_axis(angles, np.abs(angles).argmax(axis=1)[:, None], 1)[:, 0]
    size: Floats = np.where(first < 0, -1.0, 1.0) / largest
    return size[:, None] * angles, size


def _energies(mode: ExactMode, rod: int, factor: float) -> tuple[float, float]:
    """Kinetic energy over ω², and potential energy, each twice, of a shaft in a mode that counts `factor`."""
    shape = mode.rods[rod]
    energy = energies(shape.rod, mode.omega, factor * shape.angles)
    return float(energy.kinetic.sum()), float(energy.potential.sum())


def _along(train: Train, referred: ReferredTrain, modes: TrainModes, n: int, size: Floats) -> ShaftShapes:
    """Shapes of a shaft with distributed inertia, at the stations that the highest mode needs."""
    place = referred.rods[n].shaft
    name = referred.shafts[place]
    rod, _ = referred.rods[n].refined(float(modes.omega[-1]), math.pi / 8)
    lead = float(referred.lead[place])
    angles = []
    for mode, factor in zip(modes.exact, size, strict=True):
        shape = mode.rods[n]
        omega, lossy = np.array([[mode.omega]]), np.ones((1, 1), complex)
        first, torque = (
            np.array([[value + 0j]]) for value in (shape.angles[0], _first_torque(shape, mode.omega))
        )
        swing = along(rod, omega, lossy, first, torque)
        angles.append(lead * factor * swing.angles[0, :, 0].real)
    share = stations(rod)
    shaft = train.shafts[name]
    distance = (
        None if shaft.sections is None else np.array([shaft.distance(value) for value in share.tolist()])
    )
    return ShaftShapes(name, shaft.between, share, distance, np.array(angles))


def _first_torque(shape: RodShape, omega: float) -> float:
    first = replace(shape.rod, stiffness=shape.rod.stiffness[:1], inertia=shape.rod.inertia[:1])
    (piece,) = ends([first], np.array([omega]))
    a, b = shape.angles[:2]
    return float((piece.spring * (a - b) - omega**2 * piece.first * a).real[0])


def twists_of(referred: ReferredTrain, amplitudes: Floats) -> Floats:
    """Twist of each shaft, counted at its first end, from the amplitudes of the discs, (n, shafts).

    Angle of the first end less that of the second [rad]. `amplitudes`: (n, discs) angles of the discs [rad].
    """
    if referred.twist is not None:
        of_meshes: Floats = amplitudes @ referred.twist.T
        return of_meshes
    first, second = _at_ends(referred, amplitudes)
    twists: Floats = first - second
    return twists


def own_stiffness(referred: ReferredTrain) -> Floats:
    """Stiffness of each shaft at its own speed, of a mesh at its first disc, (shafts,) [N m/rad]."""
    own: Floats = referred.stiffness / referred.lead**2
    return own


def _at_ends(referred: ReferredTrain, amplitudes: Floats) -> tuple[Floats, Floats]:
    """Angles of both ends of each shaft, that of the second disc of a mesh as seen from the first."""
    # The ground is a last disc that is at rest, HELD = −1.
    angles = np.concatenate([amplitudes, np.zeros((*amplitudes.shape[:-1], 1))], axis=-1)
    speed = np.append(referred.scale, 1.0)
    first, second = referred.tip.T
    lead = referred.lead
    return angles[..., first], angles[..., second] * np.where(second == HELD, 1.0, lead / speed[second])


def scaled(shapes: NDArray[Any]) -> NDArray[Any]:
    """Rows whose largest entry is 1, without phase."""
    size = np.abs(shapes)
    # Of entries that are equal within rounding the first counts.
    largest = np.argmax(size > (1 - 1e-9) * size.max(axis=1, keepdims=True), axis=1)
    return np.asarray(shapes / shapes[np.arange(len(shapes)), largest][:, None])


def _joins_two(train: Train, name: str) -> bool:
    """Whether a shaft or mesh joins two discs alone: between gears on a carrier there is no node."""
    return name not in train.gears or train.gears[name].carrier is None


def _nodes(train: Train, referred: ReferredTrain, shape: Floats, modes: TrainModes, k: int) -> Iterator[Node]:
    """Nodes: discs, points between ends that swing in antiphase, points along rods."""
    for name, amplitude in zip(referred.discs, shape, strict=True):
        if abs(amplitude) < _AT_REST:
            yield Node(name, 0.0, None)
    first, second = _at_ends(referred, shape)
    rods = {rod.shaft: n for n, rod in enumerate(referred.rods)}
    for s, (name, a, b) in enumerate(zip(referred.shafts, first.tolist(), second.tolist(), strict=True)):
        shares: list[float] = []
        if s in rods and modes.omega[k] > 0:
            swing = modes.exact[k].rods[rods[s]]
            angles = np.where(np.abs(swing.angles) < _AT_REST * np.abs(swing.angles).max(), 0.0, swing.angles)
            shares = node_shares(swing.rod, modes.omega[k], angles).tolist()
            shares += [float(stations(swing.rod)[n]) for n in np.flatnonzero(angles[1:-1] == 0) + 1]
        elif _joins_two(train, name) and a * b < 0 and min(abs(a), abs(b)) >= _AT_REST:
            shares = [a / (a - b)]
        shaft = train.shafts.get(name)
        for share in sorted(shares):
            yield Node(name, share, shaft.distance(share) if shaft is not None else None)
