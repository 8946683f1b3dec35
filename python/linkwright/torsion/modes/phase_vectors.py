r"""Phase vectors of the orders at the modes of a train: star diagrams and vector sums.

At the critical speed of an order ν and a mode, the torque on each disc does its work in the mode by its size
and its phase. Over the largest of them, and times the amplitude of the disc in the mode,

.. math:: v_d = \theta_d\,\frac{M_{\nu d}}{\max_d|M_{\nu d}|}, \qquad S = \left|\sum_d v_d\right|

Equal cylinders have vectors as long as their discs swing, turned by the firing order: the *phase vector sum*
of the handbooks. An order with a large sum shakes the mode, one whose star closes does not.

References
----------
.. [1] Ker Wilson, Practical Solution of Torsional Vibration Problems, vol. 2, 1963: phase vector sums.
.. [2] Den Hartog, Mechanical Vibrations, 4th ed. 1956, section 5.5: star diagrams.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated, Any

import numpy as np

from linkwright.kernel.arrays import Complexes, Floats
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.torsion.excitation.excited_train import ExcitedTrain
from linkwright.torsion.modes.campbell import CampbellDiagram
from linkwright.torsion.modes.free import FreeVibration, train_modes

# Share of the largest torque of an order below which a disc is not excited by it.
_ROUNDING = 1e-9

# Orders that differ by a smaller share are one.
_EQUAL = 1e-9


@dataclass(frozen=True)
class PhaseVectors(Result):
    """Phase vectors of one order in one mode."""

    order: Annotated[float, Label("excitation order of the first disc", "ν", "")]
    mode: Annotated[int, About("Row of `FreeVibration`.")]
    speed: Annotated[float, Label("critical speed of the first disc", "ω", "rad/s")]
    discs: Annotated[tuple[str, ...], About("Discs that the order excites.")]
    vectors: Annotated[
        Complexes,
        Label("phase vector of each disc", "v", "", "Complex; times its amplitude.", shape="(discs,)"),
    ]
    torque: Annotated[float, Label("largest torque of the order on a disc", "", "N m")]

    @property
    def vector_sum(self) -> Annotated[float, Label("phase vector sum", "S", "")]:
        """S."""
        return float(np.abs(self.vectors.sum()))

    @property
    def largest_sum(self) -> Annotated[float, Label("sum of the lengths of the vectors", "", "")]:
        """The sum if all torques were in phase with the mode."""
        return float(np.abs(self.vectors).sum())

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """By name; each vector as its length and its angle [rad]."""
        return {
            "order": self.order,
            "mode": self.mode,
            "speed": self.speed,
            "vector_sum": self.vector_sum,
            "largest_sum": self.largest_sum,
            "torque": self.torque,
            "vectors": {
                name: {"length": float(abs(vector)), "angle": float(np.angle(vector))}
                for name, vector in zip(self.discs, self.vectors.tolist(), strict=True)
            },
        }


def phase_vectors(
    free: FreeVibration, diagram: CampbellDiagram, at: ExcitedTrain
) -> tuple[PhaseVectors, ...]:
    """Phase vectors of critical speeds, `at` which an order excites more than one disc, by speed."""
    stars = []
    for n, critical in enumerate(diagram.critical):
        if critical.fixed:
            continue
        same = at.torques.is_of(critical.order)
        torques = at.exciting[same, :, n].sum(axis=0)
        largest = float(np.abs(torques).max(initial=0.0))
        excited = np.flatnonzero(np.abs(torques) > _ROUNDING * largest)
        if len(excited) < 2:
            continue
        vectors = _shape(free, at, n, critical.mode)[excited] * torques[excited] / largest
        names = tuple(free.discs[disc] for disc in excited)
        stars.append(PhaseVectors(critical.order, critical.mode, critical.speed, names, vectors, largest))
    return tuple(stars)


def _shape(free: FreeVibration, at: ExcitedTrain, n: int, mode: int) -> Floats:
    """The mode at a critical speed, where couplings may be stiffer than at rest, (discs,)."""
    stiffness = np.ascontiguousarray(at.operating.stiffness[:, n])
    if np.array_equal(stiffness, at.referred.stiffness):
        at_rest: Floats = free.mode_shapes[mode]
        return at_rest
    train = replace(at.referred, stiffness=stiffness)
    masses = train_modes(train, len(free.natural_frequencies)).masses[mode]
    angles = train.speed * masses[train.mass]
    shape: Floats = angles / np.abs(angles).max()
    return shape


def most_severe(diagram: CampbellDiagram, stars: tuple[PhaseVectors, ...], count: int) -> list[PhaseVectors]:
    """The stars of the most severe critical speeds, by mode and order."""
    severity = {(one.order, one.mode): one.resonance_amplitude or 0.0 for one in diagram.critical}
    worst = sorted(stars, key=lambda star: -severity[star.order, star.mode])[:count]
    return sorted(worst, key=lambda star: (star.mode, star.order))
