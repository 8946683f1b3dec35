r"""Torque in the gear stages of a train, and where their teeth lose contact.

An elastic mesh carries what its twist says. A rigid stage has no twist; what it carries follows from the
discs behind it: with the torques from outside, inertia, damping and shafts of each disc, referred to the
first,

.. math:: f_d = n_d\,(M_d + \omega^2 J_d \theta_d - i\omega c_d \theta_d) + \sum_s \pm n_s T_s, \qquad
    \sum_{g} B_{dg}\, n_g T_g = f_d

B having +1 for the first and −1 for the second disc of a stage. Where rigid stages close a loop, statics does
not say how they share the torque.

The application factor of ISO 6336-1, as classification societies have it computed, is
:math:`K_A = (|T_m| + T_v)/|T_m|` with the vibratory torque T_v, half the peak-to-peak value of all orders.

Teeth lose contact, and hammer, where the torque comes to be against its mean: the drop below the mean is
larger than the mean.

References
----------
.. [1] Den Hartog, Mechanical Vibrations, 4th ed. 1956, section 5.3: geared systems.
.. [2] ISO 6336-1:2019, application factor; DNV-CG-0036, Calculation of gear rating for marine transmissions.
.. [3] Korean Register, Rules for the Classification of Steel Ships, part 5, chapter 4, 206: gears that
    chatter.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from linkwright.kernel.arrays import Bools, Complexes, Floats
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.machine.machine import Machine
from linkwright.torsion.core.train import HELD
from linkwright.torsion.excitation.excited_train import ExcitedTrain, excited_train
from linkwright.torsion.excitation.harmonics import span
from linkwright.torsion.response.forced import TorsionResponse, shaft_flow, torsion_response

# Share of a stage's torque that statics leaves open before it is called undetermined.
_OPEN = 1e-9

_TOOTHED = ("external", "internal")


@dataclass(frozen=True)
class MeshTorque(Result):
    """Torques of gear stages at their first discs, positive where the first drives in its sense."""

    speeds: Annotated[Floats, Label("speed of the first disc", "ω", "rad/s", shape="(speeds,)")]
    stages: Annotated[tuple[str, ...], About("Gear stages in the order of the file.")]
    toothed: Annotated[
        tuple[bool, ...], About("Whether a stage can lose contact; belts are taken to be tight.")
    ]
    orders: Annotated[
        Floats, Label("excitation order of the first disc", "ν", "", shape="(orders,)", over="orders")
    ]
    torques: Annotated[
        Complexes,
        Label(
            "torque of each stage",
            "",
            "N m",
            "Complex, by orders; NaN where rigid stages close a loop.",
            shape="(orders, stages, speeds)",
        ),
    ]
    mean: Annotated[Floats, Label("mean torque of each stage", "", "N m", shape="(stages, speeds)")]
    greatest: Annotated[
        Floats,
        Label("maximum torque of each stage", "", "N m", "Mean and vibration.", shape="(stages, speeds)"),
    ]
    least: Annotated[
        Floats,
        Label("minimum torque of each stage", "", "N m", "Mean and vibration.", shape="(stages, speeds)"),
    ]

    @property
    def vibratory(
        self,
    ) -> Annotated[Floats, Label("vibratory torque of each stage", "", "N m", shape="(stages, speeds)")]:
        """Half the peak-to-peak torque, (stages, speeds) [N m]."""
        return 0.5 * (self.greatest - self.least)

    @property
    def application_factor(
        self,
    ) -> Annotated[Floats, Label("application factor of each stage", "K_A", "", shape="(stages, speeds)")]:
        """K_A: mean and vibratory torque over the mean one, (stages, speeds); infinite without a mean."""
        mean = np.abs(self.mean)
        factor = np.divide(mean + self.vibratory, mean, out=np.full_like(mean, np.inf), where=mean > 0)
        return np.where(np.isnan(self.vibratory), np.nan, factor)

    @property
    def separation(self) -> tuple[tuple[tuple[float, float], ...], ...]:
        """Lowest and highest speed of each row of speeds at which the teeth of a stage part [rad/s]."""
        return tuple(tuple(_runs(self.speeds, row)) for row in self.contact_lost)

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """By stage: torques and K_A over the speeds, and where teeth part."""
        rows = zip(self.stages, self.mean, self.vibratory, self.least, self.application_factor, strict=True)
        stages = {
            name: {
                "torque_mean": mean.tolist(),
                "torque_vibratory": vibratory.tolist(),
                "torque_least": least.tolist(),
                "application_factor": factor.tolist(),
                "separation": [list(pair) for pair in parted],
            }
            for (name, mean, vibratory, least, factor), parted in zip(rows, self.separation, strict=True)
        }
        return {"speeds": self.speeds.tolist(), "stages": stages}

    @property
    def drop(
        self,
    ) -> Annotated[
        Floats, Label("drop of the torque of each stage below its mean", "", "N m", shape="(stages, speeds)")
    ]:
        """How far the torque falls below its mean, seen in the sense of the mean, (stages, speeds) [N m]."""
        return np.where(self.mean >= 0, self.mean - self.least, self.greatest - self.mean)

    @property
    def contact_lost(
        self,
    ) -> Annotated[Bools, About("Where teeth lose contact, shape (stages, speeds).")]:
        """Where teeth lose contact, shape (stages, speeds)."""
        # Rounding of torques that cancel is no vibration.
        size = np.maximum(np.abs(self.greatest), np.abs(self.least))
        parted: Bools = self.drop > np.abs(self.mean) + 1e-12 * size
        parted &= np.array(self.toothed, bool)[:, None]
        return parted


def _runs(speeds: Floats, lost: Bools) -> Iterator[tuple[float, float]]:
    edges = np.flatnonzero(np.diff(np.concatenate([[False], lost, [False]]).astype(int)))
    for first, after in zip(edges[::2], edges[1::2], strict=True):
        yield float(speeds[first]), float(speeds[after - 1])


@public
def mesh_torques(machine: Machine, speeds: Floats | None = None) -> MeshTorque:
    """Torques of the gear stages of a train over its speeds.

    Parameters
    ----------
    machine : Machine
        With a [train] that something excites.
    speeds : ndarray, shape (speeds,), optional
        Of the first disc; without them those of `[train.run]` [rad/s].

    Returns
    -------
    MeshTorque
        Of all stages, rigid and elastic.

    Raises
    ------
    InputError
        Nothing excites the train, or it has no speeds.
    """
    at = excited_train(machine, speeds)
    return meshed(at, torsion_response(at))


def meshed(at: ExcitedTrain, response: TorsionResponse) -> MeshTorque:
    """Torques of the gear stages of a train of which the vibration is there."""
    gears = at.train.gears
    omega = response.omega
    J = np.array([disc.inertia for disc in at.train.discs.values()])[:, None]
    theta = response.amplitudes
    inertia, shafts = (J, response.shaft_torques) if at.distributed is None else _rods(at, J, theta)
    outside = at.harmonics + (omega**2 * inertia - 1j * omega * at.disc_damping) * theta
    outside = outside - _modal_torques(at, J, response) - at.torques.control[:, None] * theta
    waves = _stage_torques(at, outside, shafts)
    mean = _stage_torques(at, _mean_outside(at, J)[None], at.mean_torques[None].astype(complex))[0].real
    greatest, least = span(response.together, waves, mean)
    return MeshTorque(
        speeds=response.speeds,
        stages=tuple(gears),
        toothed=tuple(gear.kind in _TOOTHED for gear in gears.values()),
        orders=response.orders,
        torques=waves,
        mean=mean,
        greatest=greatest,
        least=least,
    )


def _rods(at: ExcitedTrain, J: Floats, theta: Complexes) -> tuple[Complexes, Complexes]:
    """Inertia of discs [kg m²] and shaft torque [N m] with distributed inertia, (orders, …, speeds)."""
    referred, there = at.referred, at.distributed
    assert there is not None
    inertia = np.repeat(J[None].astype(complex), len(theta), axis=0) + np.zeros_like(theta)
    for n, rod in enumerate(referred.rods):
        both = zip(
            referred.tip[rod.shaft].tolist(), (there.first[:, n], there.second[:, n]), rod.ends, strict=True
        )
        for disc, end, lumped in both:
            if disc != HELD:
                inertia[:, disc] += (end - lumped) / referred.speed[disc] ** 2
    first = np.unique(referred.mass, return_index=True)[1]
    q = theta[:, first] / referred.scale[first, None]
    return inertia, shaft_flow(at, q, there.stiffness) / referred.lead[:, None]


def _modal_torques(at: ExcitedTrain, J: Floats, response: TorsionResponse) -> Complexes | float:
    """Torques of given damping ratios on the discs, by inertia, (orders, discs, speeds) [N m]."""
    referred = at.referred
    if at.operating.modal is None:
        return 0.0
    # One disc of each mass tells how it moves.
    first = np.unique(referred.mass, return_index=True)[1]
    q = response.amplitudes[:, first] / referred.scale[first, None]
    velocity = 1j * response.omega * q
    acceleration = at.operating.modal.torques(velocity) / referred.inertia[:, None]
    torques: Complexes = J * referred.scale[:, None] * acceleration[:, referred.mass]
    return torques


def _mean_outside(at: ExcitedTrain, J: Floats) -> Floats:
    """Mean torques on the discs, less the accelerating part if they do not balance."""
    mean, n = at.torques.mean, at.referred.speed[:, None]
    if at.referred.is_free:
        mean = mean - J * n * (n * mean).sum(axis=0) / at.referred.rigid_inertia
    return mean


def _stage_torques(at: ExcitedTrain, outside: Complexes | Floats, shafts: Complexes) -> Complexes:
    """Torque of each stage at its first disc, (…, stages, speeds)."""
    referred, gears = at.referred, at.train.gears
    flow = referred.lead[:, None] * shafts
    # The ground is a last disc.
    net = np.zeros((len(outside), len(referred.discs) + 1, outside.shape[-1]), complex)
    net[:, :-1] = referred.scale[:, None] * outside
    for s, (first, second) in enumerate(referred.tip.tolist()):
        if referred.twist is not None:
            net[:, :-1] -= (referred.scale * referred.twist[s])[:, None] * shafts[:, s, None]
            continue
        net[:, first] -= flow[:, s]
        net[:, second] += flow[:, s]
    torques = np.empty((len(outside), len(gears), outside.shape[-1]), complex)
    rigid = [name for name, gear in gears.items() if gear.stiffness is None]
    # Engaged clutches pass torque on as rigid stages do.
    pairs = [gears[name].between for name in rigid] + at.train.engaged
    passed = passed_on(referred.discs, pairs, net[:, :-1])
    for g, name in enumerate(gears):
        first_speed = referred.scale[referred.discs.index(gears[name].between[0])]
        if name in rigid:
            torques[:, g] = passed[:, rigid.index(name)] / first_speed
        else:
            torques[:, g] = shafts[:, referred.shafts.index(name)]
    return torques


def passed_on(discs: tuple[str, ...], pairs: Sequence[tuple[str, str]], net: Complexes | Floats) -> Complexes:
    """Torques between rigid pairs (…, pairs, n) by those left at discs (…, discs, n) [N m]; NaN in loops."""
    joins = np.zeros((len(discs), len(pairs)))
    for g, (first, second) in enumerate(pairs):
        joins[discs.index(first), g] += 1.0
        joins[discs.index(second), g] -= 1.0
    inverse = np.linalg.pinv(joins)
    passed = np.asarray(np.einsum("gd,odw->ogw", inverse, net), complex)
    known = np.abs(np.diag(inverse @ joins) - 1.0) < _OPEN
    passed[:, ~known] = np.nan
    return passed
