r"""Shafts with distributed inertia, exact at any frequency: dynamic stiffness and counting of frequencies.

A uniform rod of stiffness k and inertia j swings by :math:`k L^2\theta'' + j\omega^2\theta = 0`. With
:math:`\beta = \omega\sqrt{j/k}` its ends feel

.. math:: \begin{pmatrix} M_1 \\ M_2 \end{pmatrix} = \frac{k\beta}{\sin\beta}
    \begin{pmatrix} \cos\beta & -1 \\ -1 & \cos\beta \end{pmatrix}
    \begin{pmatrix} \theta_1 \\ \theta_2 \end{pmatrix}

which is a spring with an inertia at each of its ends, both depending on the frequency,

.. math:: s = k\,\frac{\beta}{\sin\beta}, \qquad J_1 = J_2 = \frac j2\,\frac{\tan(\beta/2)}{\beta/2}

Two such in a row, with :math:`X = s_a + s_b - \omega^2 m` and m the inertias that meet between them, are
again one: :math:`s = s_a s_b/X`, :math:`J_1 = J_{1a} + m s_a/X`, :math:`J_2 = J_{2b} + m s_b/X`. So a whole
shaft counts between its discs as a spring and two inertias, without any loss. With hysteresis or damping k is
complex, and so are they.

The number of natural frequencies below ω is, by Wittrick and Williams, that of the negative eigenvalues of
the dynamic stiffness of the train plus those of all shafts with both ends held, which a rod has
:math:`\lceil\beta/\pi\rceil - 1` of.

References
----------
.. [1] Wittrick and Williams, A general algorithm for computing natural frequencies of elastic structures,
   Quarterly Journal of Mechanics and Applied Mathematics 24 (1971) 263-284.
.. [2] Rao, Mechanical Vibrations, 5th ed. 2011, section 8.4: torsional vibration of a shaft or rod.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, partial, reduce
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.arrays import Complexes, Floats


@dataclass(frozen=True)
class Rod:
    """A shaft with distributed inertia, referred to the first disc, as uniform pieces in a row."""

    shaft: int  # its place among the shafts
    stiffness: Floats  # (pieces,) [N m/rad]
    inertia: Floats  # (pieces,) [kg m²]
    ends: tuple[float, float]  # what the lumped train counts at its two discs [kg m²]

    @cached_property
    def delay(self) -> Floats:
        """β/ω of each piece, (pieces,) [s]."""
        delay: Floats = np.sqrt(self.inertia / self.stiffness)
        return delay

    def parts(self, omega: float | None = None, angle: float = 0.0) -> list[Rod]:
        """Its pieces as rods; those next to each other in one rod of about one β at a frequency [rad/s]."""
        along = np.cumsum(self.delay * (omega or 0.0)) / (angle or 1.0)
        of = (
            np.arange(len(along)) if omega is None else np.minimum(along, along[-1] * (1 - 1e-12)).astype(int)
        )
        cuts = np.flatnonzero(np.diff(of)) + 1
        pairs = zip(np.split(self.stiffness, cuts), np.split(self.inertia, cuts), strict=True)
        return [Rod(self.shaft, k, j, (float(j.sum()) / 2,) * 2) for k, j in pairs]

    def refined(self, omega: float, angle: float) -> tuple[Rod, NDArray[np.int64]]:
        """The rod in pieces of smaller β at `omega` [rad/s], and the piece that each is of."""
        parts = np.maximum(np.ceil(self.delay * omega / angle), 1).astype(np.int64)
        of = np.repeat(np.arange(len(parts)), parts)
        n = parts[of]
        return Rod(self.shaft, self.stiffness[of] * n, self.inertia[of] / n, self.ends), of


class Ends(NamedTuple):
    """What a rod is between its ends at some frequencies."""

    spring: Complexes  # (n,) s [N m/rad]
    first: Complexes  # (n,) J₁ [kg m²]
    second: Complexes  # (n,) J₂ [kg m²]
    # (n,) natural frequencies that it has below with both ends held; without losses.
    held: NDArray[np.int64]


def ends(rods: Sequence[Rod], omega: Floats | Complexes, lossy: NDArray[Any] | float = 1.0) -> list[Ends]:
    """Rods as springs and inertias. `omega`: (n,) [rad/s]; `lossy`: (rods, n) complex over real stiffness."""
    result: dict[int, Ends] = {}
    factor = np.broadcast_to(np.asarray(lossy, complex), (len(rods), len(omega)))
    by_pieces: dict[int, list[int]] = {}
    for n, rod in enumerate(rods):
        by_pieces.setdefault(len(rod.stiffness), []).append(n)
    # Rods of as many pieces go through the same steps.
    for alike in by_pieces.values():
        k = np.stack([rods[n].stiffness for n in alike], axis=1)[:, :, None]
        j = np.stack([rods[n].inertia for n in alike], axis=1)[:, :, None]
        pieces = (_piece(stiff, own, omega, factor[alike]) for stiff, own in zip(k, j, strict=True))
        together = reduce(partial(_in_a_row, omega), pieces)
        result |= {n: Ends(*(row[i] for row in together)) for i, n in enumerate(alike)}
    return [result[n] for n in range(len(rods))]


def _piece(k: Floats, j: Floats, omega: Floats | Complexes, lossy: Complexes) -> Ends:
    """Uniform rods. `k`, `j`: (rods, 1)."""
    beta = np.asarray(omega * np.sqrt(j / (k * lossy)), complex)
    half = j / 2 * _over(np.tan(beta / 2), beta / 2)
    held = np.maximum(np.ceil(beta.real / math.pi) - 1, 0).astype(np.int64)
    return Ends(k * lossy / _over(np.sin(beta), beta), half, half, held)


def _over(value: NDArray[Any], small: NDArray[Any]) -> Any:
    """A value that is proportional to its small argument, over it; 1 at zero."""
    return np.divide(value, small, out=np.ones_like(value), where=np.not_equal(small, 0))


def _in_a_row(omega: Floats | Complexes, a: Ends, b: Ends) -> Ends:
    m = a.second + b.first
    X = a.spring + b.spring - omega**2 * m
    held = a.held + b.held + (X.real < 0)
    return Ends(a.spring * b.spring / X, a.first + m * a.spring / X, b.second + m * b.spring / X, held)


class RodState(NamedTuple):
    """What a rod does along its stations: its two ends and where pieces meet."""

    angles: Complexes  # (orders, stations, speeds) [rad]
    torques: Complexes  # (orders, stations, speeds) that the part before drives the part after with [N m]


def along(rod: Rod, omega: Floats, lossy: Complexes, start: Complexes, torque: Complexes) -> RodState:
    """State along a rod, (orders, speeds); `lossy`: complex over real stiffness; θ₁ [rad]; torque [N m]."""
    angles, torques = [start], [torque]
    for k, j in zip(rod.stiffness.tolist(), rod.inertia.tolist(), strict=True):
        stiff = k * lossy
        beta = omega * np.sqrt(j / stiff)
        sine, cosine = np.sin(beta), np.cos(beta)
        θ, T = angles[-1], torques[-1]
        angles.append(θ * cosine - T * _over(sine, beta) / stiff)
        torques.append(T * cosine + stiff * beta * sine * θ)
    return RodState(np.stack(angles, axis=1), np.stack(torques, axis=1))


class PieceEnergy(NamedTuple):
    """Energies of the pieces of a rod whose stations swing by some angles at one frequency, each twice."""

    kinetic: Floats  # (pieces,) ∫ j θ² over ω² and the piece [kg m²]
    potential: Floats  # (pieces,) [N m]


# β below which the integral of θ² is that of a straight line: the next term is β²/12 of a small difference.
_STRAIGHT = 1e-4


def energies(rod: Rod, omega: float, angles: Floats) -> PieceEnergy:
    r"""Energies of a rod that swings at its frequency. `omega`: [rad/s]; `angles`: (stations,) [rad].

    .. math:: \int_0^1\theta^2 d\xi = \frac{(\theta_1^2 + \theta_2^2)
        (\frac12 - \frac{\sin 2\beta}{4\beta}) + 2\theta_1\theta_2 (\frac{\sin\beta}{2\beta} -
        \frac{\cos\beta}{2})}{\sin^2\beta}
    """
    beta, a, b = rod.delay * omega, angles[:-1], angles[1:]
    straight = (a * a + a * b + b * b) / 3
    β = np.maximum(beta, _STRAIGHT)
    own, mixed = 0.5 - np.sin(2 * β) / (4 * β), np.sin(β) / β - np.cos(β)
    bent = ((a * a + b * b) * own + a * b * mixed) / np.sin(β) ** 2
    kinetic = rod.inertia * np.where(beta > _STRAIGHT, bent, straight)
    half = rod.inertia / 2 * _over(np.tan(beta / 2), beta / 2)
    spring = rod.stiffness / _over(np.sin(beta), beta)
    potential = spring * (a - b) ** 2 - omega**2 * half * (a * a + b * b) + omega**2 * kinetic
    return PieceEnergy(kinetic, potential)


def node_shares(rod: Rod, omega: float, angles: Floats) -> Floats:
    """Nodes between stations as shares of the flexibility of the rod; `angles`: (stations,) [rad]."""
    a, b, beta = angles[:-1], angles[1:], rod.delay * omega
    crossed = np.flatnonzero(a * b < 0)
    β, first, second = beta[crossed], a[crossed], b[crossed]
    inside = np.arctan2(first * np.sin(β), first * np.cos(β) - second) / np.where(β > 0, β, 1.0)
    inside = np.where(β > 0, np.mod(inside, np.pi / np.where(β > 0, β, 1.0)), first / (first - second))
    flexibility = 1 / rod.stiffness
    before = np.concatenate([[0.0], np.cumsum(flexibility)])
    shares: Floats = (before[crossed] + inside * flexibility[crossed]) / before[-1]
    return shares


def stations(rod: Rod) -> Floats:
    """Share of the flexibility of a rod before each station, (stations,)."""
    before = np.concatenate([[0.0], np.cumsum(1 / rod.stiffness)])
    shares: Floats = before / before[-1]
    return shares
