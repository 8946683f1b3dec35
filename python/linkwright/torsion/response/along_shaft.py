r"""The torque along a shaft with distributed inertia, and where it counts.

Along such a shaft the torque changes, by what its own inertia takes up:

.. math:: T(x) = -G I_p\,\theta'(x)

It is known in closed form from the angle and the torque of one end. Of the stations along the shaft, so close
that β between two of them is at most 0.15 at the highest order, that one counts at which the vibratory torque
of all orders comes closest to what its section bears; between two stations there may be 0.3 % more.

References
----------
.. [1] Rao, Mechanical Vibrations, 5th ed. 2011, section 8.4: torsional vibration of a shaft or rod.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.arrays import Complexes, Floats
from linkwright.torsion.core.rod import Rod, along
from linkwright.torsion.core.train import HELD
from linkwright.torsion.excitation.excited_train import ExcitedTrain
from linkwright.torsion.excitation.harmonics import span
from linkwright.torsion.model.shaft_limit import StressedSection
from linkwright.torsion.model.shaft_row import RodPiece
from linkwright.torsion.model.train import Shaft
from linkwright.torsion.model.whole_train import RodShaft

# Largest β between two stations: the torque between them is at most 1/cos(β/2) of theirs.
_STATION = 0.15


@dataclass(frozen=True)
class StationTorques:
    """Torques at both ends of the pieces of a shaft between its stations."""

    rod: Rod  # in pieces from station to station
    piece: NDArray[np.int64]  # (2 × pieces,) of `RodShaft.pieces`; first ends, then second ends
    torques: Complexes  # (orders, 2 × pieces, speeds) at the speed of the shaft [N m]
    ratio: Floats  # (2 × pieces, speeds) range of the torque over what the section bears, but for a factor
    heat: Floats  # (speeds,) that its losses take [W]


@dataclass(frozen=True)
class WorstPlace:
    """Where along a shaft its torque counts."""

    piece: NDArray[np.int64]  # (speeds,) of `RodShaft.pieces`
    torques: Complexes  # (orders, speeds) at the speed of the shaft [N m]
    heat: Floats  # (speeds,) that its losses take [W]


def worst_place(at: ExcitedTrain, q: Complexes, flow: Complexes, n: int) -> WorstPlace:
    """Where the torque of a rod counts at each speed; as `station_torques`."""
    at_stations = station_torques(at, q, flow, n)
    best = at_stations.ratio.argmax(axis=0)
    torques = at_stations.torques[:, best, np.arange(len(best))]
    return WorstPlace(at_stations.piece[best], torques, at_stations.heat)


def station_torques(at: ExcitedTrain, q: Complexes, flow: Complexes, n: int) -> StationTorques:
    """Torques along a rod; `q`: (orders, masses, speeds) [rad]; `flow`: (orders, speeds) [N m]."""
    assert at.distributed is not None
    referred, rod = at.referred, at.referred.rods[n]
    omega = at.torques.omega
    shaft = at.train.shafts[referred.shafts[rod.shaft]]
    assert isinstance(shaft, RodShaft)
    k, s = at.operating.stiffness[rod.shaft], rod.shaft
    lossy = 1 + 1j * (referred.loss_factor[s] + omega * referred.damping[s] / k)
    first = referred.ends[s, 0]
    start = np.zeros_like(flow) if first == HELD else q[:, first]
    fine, of = rod.refined(float(omega.max(initial=0.0)), _STATION)
    torque = flow - omega**2 * at.distributed.first[:, n] * start
    state = along(fine, omega, lossy, start, torque)
    lead = float(referred.lead[s])
    # Each piece has two ends; of those that meet the weaker section counts.
    before, after = state.torques[:, :-1], state.torques[:, 1:]
    torques: NDArray[Any] = np.concatenate([before, after], axis=1) / lead
    pieces = np.concatenate([of, of])
    greatest, least = span(at.torques.together, torques)
    severity = np.array([_severity(shaft, shaft.pieces[piece]) for piece in pieces.tolist()])
    ratio = np.nan_to_num((greatest - least) * severity[:, None], nan=np.inf)
    power = (state.torques * state.angles.conj()).imag
    heat = 0.5 * (omega * (power[:, 0] - power[:, -1])).sum(axis=0)
    return StationTorques(fine, pieces, torques, ratio, heat)


def _severity(shaft: Shaft, piece: RodPiece) -> float:
    """Utilisation of a piece per torque, up to a factor; equal for all where it is not known."""
    limit = shaft.limit
    if piece.section_modulus is None or (limit is not None and limit.has_section):
        return 1.0
    section = StressedSection(piece.section_modulus, piece.diameter)
    return 1 / piece.section_modulus if limit is None else limit.severity(section)
