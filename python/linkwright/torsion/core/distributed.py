r"""A train with shafts of distributed inertia at any frequency: what it is there; its natural
frequencies.

At a frequency ω each such shaft is a spring and two inertias at its ends (`rod`). A natural frequency is
where the count of those below steps up, :math:`N(\omega) = N_{held}(\omega) + s^-(K(\omega) - \omega^2
J(\omega))`, with :math:`s^-` the number of negative eigenvalues. It is found by halving, so that none is
missed, not even where discs are at rest, and two that coincide are two. Shapes follow from the train cut into
pieces so short that none of them can swing between its ends.

References
----------
.. [1] Wittrick and Williams, A general algorithm for computing natural frequencies of elastic structures,
   Quarterly Journal of Mechanics and Applied Mathematics 24 (1971) 263-284.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import lru_cache
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.arrays import Complexes, Floats
from linkwright.torsion.core.rod import Ends, Rod, ends, energies
from linkwright.torsion.core.train import HELD, ReferredTrain

# Largest β of a piece of which a shape is made: a quarter of that at which it could swing between its ends.
SHAPE = math.pi / 8

# Halvings of a bracket whose ends are at most a factor of 2 apart, down to rounding.
_HALVINGS = 52

# Rounding of an eigenvalue as a share of the largest.
_ROUNDING = 1e-15

# Frequencies that differ by a smaller share are one, with as many shapes.
_EQUAL = 1e-9


class Dynamic(NamedTuple):
    """What a train is at some frequencies, one for each."""

    stiffness: Complexes  # (shafts, n) of springs between masses, with losses [N m/rad]
    inertia: Complexes  # (masses, n) [kg m²]
    rods: tuple[Ends, ...]  # in the order of the train


def dynamic(referred: ReferredTrain, stiffness: Floats, omega: Floats | Complexes) -> Dynamic:
    """A train at some frequencies. `stiffness`: (shafts, n) [N m/rad]; `omega`: (n,) [rad/s]."""
    lossy = 1 + 1j * referred.loss_factor[:, None]
    k = np.asarray(stiffness * lossy + 1j * omega * referred.damping[:, None], complex)
    J = np.repeat(referred.inertia[:, None].astype(complex), len(omega), axis=1)
    shafts = [rod.shaft for rod in referred.rods]
    stiffnesses = ends(referred.rods, omega, k[shafts] / stiffness[shafts])
    for rod, one in zip(referred.rods, stiffnesses, strict=True):
        n = rod.shaft
        k[n] = one.spring
        for mass, J_end, lumped in zip(referred.ends[n], (one.first, one.second), rod.ends, strict=True):
            if mass != HELD:
                J[mass] += J_end - lumped
    return Dynamic(k, J, tuple(stiffnesses))


def lossless(referred: ReferredTrain, omega: Floats) -> Dynamic:
    """Without damping."""
    n = len(referred.shafts)
    lossless = replace(referred, damping=np.zeros(n), loss_factor=np.zeros(n))
    return dynamic(lossless, np.repeat(referred.stiffness[:, None], len(omega), axis=1), omega)


def matrices(referred: ReferredTrain, at: Dynamic, omega: Floats) -> Floats:
    """K − ω² J of the masses without losses, (n, masses, masses) [N m/rad]."""
    D = (referred.joins.T * at.stiffness.real.T[:, None, :]) @ referred.joins
    diagonal = np.arange(len(referred.inertia))
    D[:, diagonal, diagonal] -= (omega**2 * at.inertia.real).T
    return D


def below(referred: ReferredTrain, omega: Floats) -> NDArray[np.int64]:
    """How many natural frequencies lie below each frequency, (n,). `omega`: (n,) above 0 [rad/s]."""
    at = lossless(referred, omega)
    D = matrices(referred, at, omega)
    # Rows are brought to one size: rounding of a stiff shaft hides no soft one.
    size = 1 / np.sqrt(np.maximum(np.abs(D).max(axis=2), np.finfo(float).tiny))
    count = (np.linalg.eigvalsh(size[:, :, None] * D * size[:, None, :]) < 0).sum(axis=1)
    return np.asarray(count + sum(rod.held for rod in at.rods), np.int64)


@dataclass(frozen=True)
class _Same:
    """Key of a cache: the numbers that determine the modes of a train."""

    key: tuple[bytes, ...]
    referred: ReferredTrain = field(compare=False)


def _same(referred: ReferredTrain) -> _Same:
    arrays: list[NDArray[Any]] = [referred.ends, referred.inertia, referred.stiffness]
    for rod in referred.rods:
        arrays += [rod.stiffness, rod.inertia]
    return _Same(tuple(array.tobytes() for array in arrays), referred)


def natural_frequencies(referred: ReferredTrain, count: int) -> Floats:
    """The lowest natural frequencies, (count,) [rad/s]; motions without stiffness have 0."""
    return _natural_frequencies(_same(referred), count)


@lru_cache(maxsize=16)
def _natural_frequencies(same: _Same, count: int) -> Floats:
    """Cached: computed once for all that need the modes of a train."""
    referred = same.referred
    # Distributed or not, what turns without twisting anything is the same.
    lumped = referred.modes()[0]
    free = int(np.count_nonzero(lumped == 0))
    wanted = np.arange(free, count)
    if not len(wanted):
        return np.zeros(count)
    start = float(lumped[free]) if free < len(lumped) else 1.0
    low, high = np.full(len(wanted), start), np.full(len(wanted), start)
    while (short := below(referred, high) <= wanted).any():
        low, high = np.where(short, high, low), np.where(short, 2 * high, high)
    while (over := below(referred, low) > wanted).any():
        low, high = np.where(over, low / 2, low), np.where(over, low, high)
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        above = below(referred, middle) > wanted
        low, high = np.where(above, low, middle), np.where(above, middle, high)
    return np.concatenate([np.zeros(free), (low + high) / 2])


def frequencies_below(referred: ReferredTrain, highest: float) -> Floats:
    """All natural frequencies below one, and one more [rad/s]. `highest`: [rad/s]."""
    return natural_frequencies(referred, int(below(referred, np.array([highest]))[0]) + 1)


class RodShape(NamedTuple):
    """How a shaft with distributed inertia swings in a mode."""

    rod: Rod  # in pieces as fine as the shape
    angles: Floats  # (stations,) referred to the first disc of the train [rad]


class ExactMode(NamedTuple):
    """A natural frequency with its shape; the kinetic energy of all is ½ ω²."""

    omega: float  # [rad/s]
    masses: Floats  # (masses,) angles
    rods: tuple[RodShape, ...]


def exact_modes(referred: ReferredTrain, count: int) -> tuple[ExactMode, ...]:
    """The lowest modes."""
    return _exact_modes(_same(referred), count)


@lru_cache(maxsize=16)
def _exact_modes(same: _Same, count: int) -> tuple[ExactMode, ...]:
    """Cached: computed once for all that need the modes of a train."""
    referred, modes = same.referred, list[ExactMode]()
    omega = natural_frequencies(referred, count)
    rigid = iter(referred.modes()[1])
    first = 0
    while first < count:
        if omega[first] == 0:
            modes.append(_normal(referred, 0.0, next(rigid), list(referred.rods))[0])
            first += 1
            continue
        last = first + 1
        while last < count and omega[last] - omega[first] <= _EQUAL * omega[first]:
            last += 1
        modes += _shapes(referred, float(omega[first:last].mean()), last - first)
        first = last
    return tuple(modes)


def _shapes(referred: ReferredTrain, omega: float, count: int) -> Iterator[ExactMode]:
    fine = [rod.refined(omega, SHAPE)[0] for rod in referred.rods]
    cut = cut_up(referred, [rod.parts() for rod in fine])
    at = lossless(cut, np.array([omega]))
    D = matrices(cut, at, np.array([omega]))[0]
    nearest = null_vectors(D, at.inertia.real[:, 0], count)
    for value, vector in zip(nearest.values.tolist(), nearest.vectors.T, strict=True):
        mode, size = _normal(referred, omega, vector, fine)
        # Rods whose ends move alike leave the count unsure by the root of rounding: Newton on the shape.
        polished = math.sqrt(max(omega**2 + value * size**2, 0.0))
        rounding = _ROUNDING * nearest.largest / omega
        unsure = abs(polished - omega) > rounding
        yield mode._replace(omega=polished) if unsure else mode


class NullVectors(NamedTuple):
    """Vectors that a dynamic stiffness takes to next to nothing."""

    values: Floats  # (modes,) eigenvalues with unit inertia
    vectors: Floats  # (nodes, modes)
    largest: float  # of all eigenvalues


def null_vectors(D: Floats, inertia: Floats, count: int) -> NullVectors:
    """As many vectors as have the eigenvalues next to zero. `inertia`: (nodes,) [kg m²]."""
    scale = 1 / np.sqrt(inertia)
    values, vectors = np.linalg.eigh(scale[:, None] * D * scale)
    nearest = np.argsort(np.abs(values), kind="stable")[:count]
    rough = scale[:, None] * vectors[:, nearest]
    # Beside short pieces, or stiff shafts, eigenvectors have lost digits that the rows of D still have.
    border = inertia[:, None] * rough
    refined = bordered(D, border, np.zeros_like(rough), border.T @ rough)
    return NullVectors(values[nearest], refined, float(np.abs(values).max()))


def bordered(D: Floats, border: Floats, right: Floats, along: Floats) -> Floats:
    """Solution x of D x = `right` but for multiples of the border, with borderᵀ x = `along`."""
    r = border.shape[1]
    matrix = np.block([[D, border], [border.T, np.zeros((r, r))]])
    solution: Floats = solved(matrix, np.concatenate([right, along]))[: len(D)]
    return solution


def solved(matrix: NDArray[Any], columns: NDArray[Any]) -> NDArray[Any]:
    """Solution of a system with rows and columns brought to one size, as stiff and soft shafts ask for."""
    size = 1 / np.sqrt(np.maximum(np.abs(matrix).max(axis=1, initial=0.0), np.finfo(float).tiny))
    scaled = size[:, None] * matrix * size
    solution: NDArray[Any] = size[:, None] * np.linalg.solve(scaled, size[:, None] * columns)
    return solution


def _normal(
    referred: ReferredTrain, omega: float, angles: Floats, fine: list[Rod]
) -> tuple[ExactMode, float]:
    """Normalise a mode of masses and stations; also gives the factor."""
    masses, after = angles[: len(referred.inertia)], len(referred.inertia)
    shapes, kinetic = [], float(bare_inertia(referred) @ masses**2)
    for rod in fine:
        first, second = (0.0 if end == HELD else masses[end] for end in referred.ends[rod.shaft])
        inner = len(rod.stiffness) - 1
        # A train that rotates as a rigid body has no stations of its own.
        inside = angles[after : after + inner] if omega else np.full(inner, first)
        shapes.append(RodShape(rod, np.concatenate([[first], inside, [second]])))
        kinetic += float(energies(rod, omega, shapes[-1].angles).kinetic.sum())
        after += inner
    size = 1 / math.sqrt(kinetic)
    rods = tuple(one._replace(angles=size * one.angles) for one in shapes)
    return ExactMode(omega, size * masses, rods), size


def bare_inertia(referred: ReferredTrain) -> Floats:
    """Inertia of the masses without that of shafts that have it distributed, (masses,) [kg m²]."""
    J = referred.inertia.copy()
    for rod in referred.rods:
        for mass, lumped in zip(referred.ends[rod.shaft], rod.ends, strict=True):
            if mass != HELD:
                J[mass] -= lumped
    return np.maximum(J, 0.0)


def cut_up(referred: ReferredTrain, parts: list[list[Rod]]) -> ReferredTrain:
    """A train whose rods are cut into parts that are rods, and the stations between them further masses.

    Lumped, each part gives half of its inertia to each of its ends. Exact as the train itself is.
    """
    springs = [n for n in range(len(referred.shafts)) if n not in {rod.shaft for rod in referred.rods}]
    J, links, rods = list(bare_inertia(referred)), [referred.ends[n].tolist() for n in springs], list[Rod]()
    k = [float(referred.stiffness[n]) for n in springs]
    of = [*springs, *(rod.shaft for row in parts for rod in row)]
    for row in parts:
        first, second = referred.ends[row[0].shaft].tolist()
        inner = list(range(len(J), len(J) + len(row) - 1))
        J += [0.0] * len(inner)
        stations = [first, *inner, second]
        for rod, pair in zip(row, pairwise(stations), strict=True):
            rods.append(replace(rod, shaft=len(k)))
            links.append([*pair])
            k.append(1 / float((1 / rod.stiffness).sum()))
            for mass, lumped in zip(pair, rod.ends, strict=True):
                if mass != HELD:
                    J[mass] += lumped
    # Losses of a piece are to its stiffness as those of the shaft are.
    share = np.array(k) / np.where(referred.stiffness[of] > 0, referred.stiffness[of], 1.0)
    share[: len(springs)] = 1.0
    return ReferredTrain(
        discs=referred.discs,
        shafts=tuple(referred.shafts[n] for n in of),
        speed=referred.speed,
        mass=referred.mass,
        ends=np.array(links, np.int32).reshape(-1, 2),
        tip=referred.tip[of],
        inertia=np.array(J),
        stiffness=np.array(k),
        disc_damping=np.concatenate([referred.disc_damping, np.zeros(len(J) - len(referred.inertia))]),
        damping=share * referred.damping[of],
        loss_factor=referred.loss_factor[of],
        ratios=referred.ratios,
        rods=tuple(rods),
        # There are no rods in a train with gears on a carrier.
        twist=referred.twist,
    )
