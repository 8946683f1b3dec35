r"""Derivatives of the modes of a train with distributed inertia, from its dynamic stiffness.

With the angles x of all masses and of stations along the rods, :math:`D(\omega^2)\,x = 0`, and with
:math:`\hat M = -\partial D/\partial\omega^2`, which is what counts in the kinetic energy [1]_,

.. math:: d\omega^2 = \frac{x^T dD\,x}{x^T \hat M x}, \qquad \begin{pmatrix} D & \hat M x \\ x^T \hat M & 0
    \end{pmatrix} \begin{pmatrix} dx \\ \mu \end{pmatrix} = \begin{pmatrix} \hat M x\,d\omega^2 - dD\,x \\ 0
    \end{pmatrix}

so that no other mode is needed [2]_. Of r modes of one frequency, with X in the place of x, the mean of the
squares has :math:`\mathrm{tr}\bigl((X^T \hat M X)^{-1} X^T dD\,X\bigr)/r`.

References
----------
.. [1] Wittrick and Williams, A general algorithm for computing natural frequencies of elastic structures,
   Quarterly Journal of Mechanics and Applied Mathematics 24 (1971) 263-284.
.. [2] Nelson, Simplified calculation of eigenvector derivatives, AIAA J. 14 (1976) 1201-1205.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from linkwright.kernel.arrays import Floats, Integers
from linkwright.torsion.core.distributed import SHAPE, bare_inertia, bordered, exact_modes, null_vectors
from linkwright.torsion.core.train import HELD, ReferredTrain
from linkwright.torsion.gradient.distributed import CutTrain, PartSlopes, cut_train, lossless, rod_numbers
from linkwright.torsion.gradient.train import TrainTangents


class ModeAngles(NamedTuple):
    """Angles of a mode at the speeds of its parts, in any size, in the sense in which the mode is shown.

    Discs first, then the stations along rods.
    """

    values: Floats  # (angles,)
    slopes: Floats  # (angles, variables)


class _Basis(NamedTuple):
    """Modes of one frequency."""

    train: CutTrain
    shapes: Floats  # (nodes, modes) X
    momenta: Floats  # (nodes, modes) M̂X
    moved: Floats  # (nodes, modes, variables) dD X


class DistributedModes:
    """The lowest modes of a train with distributed inertia, with derivatives by the variables of `d`."""

    def __init__(self, referred: ReferredTrain, d: TrainTangents, count: int) -> None:
        self._referred, self._d = lossless(referred), d
        self._modes = exact_modes(referred, count)
        self._bare = bare_inertia(referred)
        self._found: dict[tuple[int, ...], _Basis] = {}
        self.omega: Floats = np.array([mode.omega for mode in self._modes])

    def square(self, group: list[int]) -> Floats:
        """Of the mean of ω² of modes of one frequency, (variables,)."""
        basis = self._basis(tuple(group))
        inverse = np.linalg.inv(basis.shapes.T @ basis.momenta)
        slope: Floats = np.einsum("ij,nj,niv->v", inverse, basis.shapes, basis.moved, optimize=True)
        return slope / len(group)

    def angles(self, i: int, square: Floats) -> ModeAngles:
        """Of a mode whose frequency stands alone. `square`: (variables,) derivatives of its ω²."""
        basis, referred, d = self._basis((i,)), self._referred, self._d
        sense = self._sense(i, basis)
        x, right = sense * basis.shapes[:, 0], np.outer(basis.momenta[:, 0], square) - basis.moved[:, 0]
        # A train that rotates as a rigid body has one shape, whatever its parts.
        dx = np.zeros_like(right)
        if self.omega[i] > 0:
            still = np.zeros((1, len(square)))
            dx = sense * bordered(basis.train.stiffness.real, basis.momenta, right, still)
        node = np.concatenate([referred.mass, np.arange(len(self._bare), len(x))])
        disc = np.concatenate([np.arange(len(referred.speed)), _lead_discs(basis.train, len(self._bare))])
        speed = referred.speed[disc]
        return ModeAngles(speed * x[node], speed[:, None] * dx[node] + d.speed[disc] * x[node, None])

    def _sense(self, i: int, basis: _Basis) -> float:
        """1 if a shape has the sense in which the mode is shown, its largest disc ahead; else −1."""
        masses = self._modes[i].masses
        discs = self._referred.speed * masses[self._referred.mass]
        shown = discs[np.abs(discs).argmax()] < 0
        return -1.0 if (masses @ basis.shapes[: len(masses), 0] < 0) != shown else 1.0

    def _basis(self, group: tuple[int, ...]) -> _Basis:
        """Modes of one frequency, by their places."""
        if group not in self._found:
            omega = float(self.omega[list(group)].mean())
            self._found[group] = self._at(omega, len(group))
        return self._found[group]

    def _at(self, omega: float, count: int) -> _Basis:
        """As many modes as have one frequency [rad/s]."""
        referred, d = self._referred, self._d
        train = cut_train(referred, omega, [rod.refined(omega, SHAPE)[0] for rod in referred.rods])
        shapes = null_vectors(train.stiffness.real, train.inertia, count).vectors
        momenta = np.stack([train.momenta(x, self._bare).real for x in shapes.T], axis=1)
        of_rods = rod_numbers(referred)
        rods = [rod.shaft for rod in referred.rods]
        slopes = PartSlopes(
            -(omega**2) * d.bare_inertia,
            np.delete(d.stiffness, rods, axis=0),
            d.rod_stiffness / of_rods.stiffness[:, None],
            d.rod_inertia / of_rods.inertia[:, None],
            d.joins,
        )
        moved = np.stack([train.moved(x, slopes).real for x in shapes.T], axis=1)
        return _Basis(train, shapes, momenta, moved)


def _lead_discs(train: CutTrain, masses: int) -> Integers:
    """The disc at whose speed each station turns, (stations,)."""
    cut = train.cut
    first, second = cut.tip[cut.ends[:, 1] >= masses].T
    discs: Integers = np.where(first == HELD, second, first)
    return discs
