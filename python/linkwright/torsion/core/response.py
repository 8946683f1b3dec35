r"""Forced vibration of a train: amplitudes at every order and speed, and what they add up to.

The core takes trees; a train with loops, or with damping ratios of its modes, is solved from its matrices,

.. math:: (-\omega^2 J + i\omega C + K + i\,\mathrm{Im}K)\,q = M
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from linkwright import _core
from linkwright.kernel.arrays import Complexes, Floats, Integers
from linkwright.torsion.core.distributed import dynamic
from linkwright.torsion.core.train import HELD, ReferredTrain

# Numbers in a block of matrices that are solved at once: some 30 MB.
_BLOCK = 2_000_000


def by_columns(values: Floats) -> Floats:
    """Numbers of a train, (n,), or of a train at each column, (n, columns), by columns."""
    return values[:, None] if values.ndim == 1 else values


@dataclass(frozen=True)
class Tree:
    """Masses in an order in which each hangs on an earlier one."""

    order: Integers  # (masses,) the masses
    parent: Integers  # (masses,) place in the order of the mass that each hangs on; of the first, its own
    # (shafts,) place in the order of the mass that each shaft holds; the number of masses if it joins one
    # with itself.
    row: Integers

    @property
    def is_in_order(self) -> bool:
        """Whether each mass comes at its own place."""
        return bool((self.order[1:] > self.order[:-1]).all())


def in_order(tree: Tree, rows: NDArray[Any]) -> NDArray[Any]:
    """A copy of the rows of the masses, (…, masses, speeds), in the order of the tree."""
    return rows.copy() if tree.is_in_order else np.take(rows, tree.order, axis=1)


def tree_of(referred: ReferredTrain) -> Tree | None:
    """The masses as a tree, parallel shafts taken together; None with loops, or with gears on carriers."""
    if referred.twist is not None:
        return None
    ends = [tuple(sorted(pair)) for pair in referred.ends.tolist()]
    about: dict[int, list[int]] = {n: [] for n in range(HELD, len(referred.inertia))}
    for a, b in dict.fromkeys(ends):
        if a != b:
            about[a].append(b)
            about[b].append(a)
    held = about[HELD]
    if len(held) > 1 or sum(map(len, about.values())) // 2 - len(held) != len(referred.inertia) - 1:
        return None
    root = held[0] if held else 0
    order, parent, place = [root], [0], {root: 0, HELD: 0}
    for at in order:
        for below in about[at]:
            if below not in place:
                place[below] = len(order)
                order.append(below)
                parent.append(place[at])
    # Of the two ends of a shaft the one that hangs comes later.
    row = [max(place[a], place[b]) if a != b else len(order) for a, b in ends]
    return Tree(np.array(order, np.int32), np.array(parent, np.int32), np.array(row, np.int32))


@dataclass(frozen=True)
class OperatingState:
    """What a train is at some speeds, referred to that of its first disc."""

    speeds: Floats  # (speeds,) Ω of the first disc [rad/s]
    stiffness: Floats  # (shafts, speeds) about the mean torque [N m/rad]
    disc_damping: Floats  # (masses, speeds) Viscous, against the ground, with that of loads [N m s/rad]
    modal: ModalLosses | None = None  # of given damping ratios
    # (masses,) against the ground, of speed controllers with an integral gain; None for none [N m/rad].
    disc_stiffness: Floats | None = None


@dataclass(frozen=True)
class ModalLosses:
    """Damping of given ratios, with the modes that a train has at each speed."""

    matrices: Floats  # (kinds, masses, masses) C [N m s/rad]
    kind: Integers  # (speeds,) matrix of each speed

    def torques(self, velocity: Complexes) -> Complexes:
        """C q̇, (orders, masses, speeds) [N m]. `velocity`: likewise [rad/s]."""
        torques: Complexes = np.einsum("wij,ojw->oiw", self.matrices[self.kind], velocity)
        return torques

    def repeated(self, times: int) -> ModalLosses:
        """With each speed as often."""
        return ModalLosses(self.matrices, np.repeat(self.kind, times))


def modal_losses(referred: ReferredTrain, stiffness: Floats) -> ModalLosses | None:
    """Damping of the modes of given ratios; None without any. `stiffness`: (shafts, speeds) [N m/rad]."""
    if not referred.ratios.any():
        return None
    columns, kind = np.unique(stiffness, axis=1, return_inverse=True)
    trains = (replace(referred, stiffness=np.ascontiguousarray(column)) for column in columns.T)
    return ModalLosses(np.array([train.modal_damping for train in trains]), kind.ravel().astype(np.int32))


def respond(
    referred: ReferredTrain,
    at: OperatingState,
    orders: Floats,
    torques: Complexes,
    fixed: Floats | None = None,
) -> Complexes:
    """Amplitudes of the masses, (orders, masses, speeds).

    q [rad]; not finite at a resonance without any damping. `orders`: (orders,) cycles per revolution of the
    first disc; `torques`: (orders, masses, speeds) referred [N m]; `fixed`: (orders,) ω₀ of a frequency that
    adds to that of the order [rad/s].
    """
    if fixed is not None and fixed.any():
        own = int((fixed == 0).sum())
        parts = [respond(referred, at, orders[:own], torques[:own])]
        for n in range(own, len(orders)):
            # A line as the first order of a train that turns as fast, with what it is at the speed.
            turning = replace(at, speeds=np.abs(orders[n] * at.speeds + fixed[n]))
            parts.append(respond(referred, turning, np.ones(1), torques[n : n + 1]))
        return np.concatenate(parts)
    tree = tree_of(referred)
    if tree is None or at.modal is not None:
        return _whole(referred, at, orders, torques)
    if referred.rods or at.disc_stiffness is not None:
        return _distributed(
            tree, at, dynamic_orders(referred, at, np.outer(orders, at.speeds)), orders, torques
        )
    n, speeds = len(referred.inertia), len(at.speeds)

    def table(values: Floats) -> Floats:
        summed = np.zeros((n + 1, speeds))
        np.add.at(summed, tree.row, values)
        return summed[:n]

    damping = np.broadcast_to(referred.damping[:, None], at.stiffness.shape)
    loss = referred.loss_factor[:, None] * at.stiffness
    ground = np.ascontiguousarray(at.disc_damping[tree.order])
    q = in_order(tree, torques)
    _core.torsion_forced(
        parent=tree.parent,
        inertia=np.ascontiguousarray(referred.inertia[tree.order]),
        speeds=at.speeds,
        stiffness=table(at.stiffness),
        damping=table(damping),
        loss=table(loss),
        disc_damping=ground,
        orders=orders,
        torques=q,
    )
    return q if tree.is_in_order else np.take(q, np.argsort(tree.order), axis=1)


class DynamicOrders(NamedTuple):
    """A train with distributed inertia at each order and speed."""

    stiffness: Complexes  # (orders, shafts, speeds) of springs, with losses [N m/rad]
    inertia: Complexes  # (orders, masses, speeds) [kg m²]
    # `first`, `second`: (orders, rods, speeds) inertia of each rod at its ends [kg m²].
    first: Complexes
    second: Complexes


def dynamic_orders(referred: ReferredTrain, at: OperatingState, omega: Floats) -> DynamicOrders:
    """What a train with distributed inertia is where orders excite it; `omega`: (orders, speeds) [rad/s]."""
    shape = (-1, *omega.shape)
    stiffness = np.tile(at.stiffness, len(omega))
    there = dynamic(referred, stiffness, omega.ravel())

    def by_order(rows: Complexes) -> Complexes:
        return np.ascontiguousarray(rows.reshape(shape).transpose(1, 0, 2))

    first, second = (np.array([getattr(one, name) for one in there.rods]) for name in ("first", "second"))
    return DynamicOrders(*map(by_order, (there.stiffness, there.inertia, first, second)))


# Amplitudes at a resonance without damping are not finite.
@np.errstate(divide="ignore", invalid="ignore", over="ignore")
def _distributed(
    tree: Tree, at: OperatingState, there: DynamicOrders, orders: Floats, torques: Complexes
) -> Complexes:
    """Amplitudes of the masses of a tree with distributed inertia, all orders and speeds at once."""
    omega = orders[:, None, None] * at.speeds
    own = -(omega**2) * there.inertia + 1j * omega * at.disc_damping
    if at.disc_stiffness is not None:
        own += at.disc_stiffness[:, None]
    own, f = np.take(own, tree.order, axis=1), np.take(torques, tree.order, axis=1)
    n = len(tree.order)
    k = np.zeros((len(orders), n + 1, len(at.speeds)), complex)
    for s, row in enumerate(tree.row.tolist()):
        k[:, row] += there.stiffness[:, s]
    k = k[:, :n]
    q, is_held = _eliminated(tree.parent, own, k, f)
    for _ in range(_CORRECTIONS if is_held else 0):
        q += _eliminated(tree.parent, own, k, f - _balance(tree.parent, own, k, q))[0]
    return np.take(q, np.argsort(tree.order), axis=1)


# As in the core: share of a shaft's stiffness below which what hangs on it counts as in tune with the order.
_IN_TUNE = 1e-8

# Corrections then, as in the core.
_CORRECTIONS = 3


def _eliminated(parent: Integers, own: Complexes, k: Complexes, f: Complexes) -> tuple[Complexes, bool]:
    """Amplitudes of a tree, (orders, masses, speeds), and whether a divisor was kept from zero."""
    # Masses in tune hold the one that they hang on still: that is no resonance, but divides by zero.
    own, f, is_held = own.copy(), f.copy(), False
    for row in range(len(parent) - 1, 0, -1):
        pivot = own[:, row] + k[:, row]
        in_tune = np.abs(pivot) < _IN_TUNE * np.abs(k[:, row])
        is_held |= bool(in_tune.any())
        pivot = np.where(in_tune, _IN_TUNE * k[:, row], pivot)
        # What hangs on a shaft is a spring k behind which a stiffness d lies, k d/(k + d).
        share = k[:, row] / pivot
        f[:, parent[row]] += share * f[:, row]
        own[:, parent[row]] += share * own[:, row]
        own[:, row] = pivot
    q = np.empty_like(f)
    q[:, 0] = f[:, 0] / (own[:, 0] + k[:, 0])
    for row in range(1, len(parent)):
        q[:, row] = (f[:, row] + k[:, row] * q[:, parent[row]]) / own[:, row]
    return q, is_held


def _balance(parent: Integers, own: Complexes, k: Complexes, q: Complexes) -> Complexes:
    """Torques that hold given amplitudes, (orders, masses, speeds)."""
    torques = own * q
    torques[:, 0] += k[:, 0] * q[:, 0]
    for row in range(1, len(parent)):
        carried = k[:, row] * (q[:, row] - q[:, parent[row]])
        torques[:, row] += carried
        torques[:, parent[row]] -= carried
    return torques


def shaft_torques(
    referred: ReferredTrain, stiffness: Complexes, q: Complexes, forces: Complexes, size: Floats
) -> Complexes:
    """Torques of the shafts: stiffness times twist, or, in shafts practically rigid, by equilibrium.

    Rounding of the amplitudes times the stiffness is a torque, and so is that of the forces on one side of
    the shaft. Of both ways the one is taken that has less of it.

    (orders, shafts, speeds): Positive if the first end drives the second, referred [N m]. `stiffness`:
    (orders, shafts, speeds) k(1 + iη) + iωc [N m/rad]; `q`: (orders, masses, speeds) amplitudes [rad];
    `forces`: (orders, masses, speeds) [N m]; `size`: (orders, masses, speeds) sum of the sizes of their parts
    [N m].
    """
    torques = np.empty(stiffness.shape, complex)
    tree = tree_of(referred)
    # Amplitudes at a resonance without damping are not finite, nor are torques. Shafts one by one stay
    # in the cache.
    with np.errstate(invalid="ignore", over="ignore"):
        if referred.twist is not None:
            of_meshes: Complexes = stiffness * np.einsum("sm,omw->osw", referred.joins, q)
            return of_meshes
        for s, (first, second) in enumerate(referred.ends.tolist()):
            twist = (q[:, first] if first != HELD else 0.0) - (q[:, second] if second != HELD else 0.0)
            np.multiply(stiffness[:, s], twist, out=torques[:, s])
        if tree is None:
            return torques
        amplitude, below, bound = np.abs(q), _below(tree, forces), _below(tree, size)
        for s, (first, second) in enumerate(referred.ends.tolist()):
            if tree.row[s] == len(tree.order):
                continue
            ends = sum(amplitude[:, end] for end in (first, second) if end != HELD)
            share = _share(referred, tree, stiffness, s)
            is_rigid = np.abs(share) * bound[:, tree.row[s]] < np.abs(stiffness[:, s]) * ends
            np.copyto(torques[:, s], share * below[:, tree.row[s]], where=is_rigid)
    return torques


def by_equilibrium(
    referred: ReferredTrain, tree: Tree, stiffness: Complexes, forces: Complexes | Floats
) -> Complexes:
    """Torques of the shafts of a tree from what acts on one side of each; parallel ones share by stiffness.

    (orders, shafts, speeds): Positive if the first end drives the second, referred [N m]. `stiffness`:
    (orders, shafts, speeds) [N m/rad]; `forces`: (orders, masses, speeds) on each mass but for its shafts
    [N m].
    """
    below = _below(tree, forces)
    carried = np.zeros(stiffness.shape, complex)
    for s, row in enumerate(tree.row.tolist()):
        if row < len(tree.order):
            np.multiply(_share(referred, tree, stiffness, s), below[:, row], out=carried[:, s])
    return carried


def _below(tree: Tree, forces: NDArray[Any]) -> NDArray[Any]:
    """Sums of the forces on each mass and on its subtree, in the order of the tree."""
    below = in_order(tree, forces)
    for row in range(len(tree.order) - 1, 0, -1):
        below[:, tree.parent[row]] += below[:, row]
    return below


def _share(referred: ReferredTrain, tree: Tree, stiffness: Complexes, s: int) -> Complexes | Floats:
    """Share of a shaft in what it holds, (orders, speeds): positive if the first end drives the second."""
    row = tree.row[s]
    # Of the two ends of a shaft the one that hangs is that of its row; the ground is no mass.
    sign = 1.0 if referred.ends[s, 0] == tree.order[row] else -1.0
    parallel = tree.row == row
    share: Complexes | Floats
    if parallel.sum() == 1:
        share = sign * (stiffness[:, s] != 0)
        return share
    together = stiffness[:, parallel].sum(axis=1)
    share = sign * np.divide(stiffness[:, s], together, out=np.zeros_like(together), where=together != 0)
    return share


def _whole(referred: ReferredTrain, at: OperatingState, orders: Floats, torques: Complexes) -> Complexes:
    """Amplitudes from the matrices, for trains with loops; not finite where they are singular."""
    n, speeds = len(referred.inertia), len(at.speeds)
    q = np.empty((len(orders), n, speeds), complex)
    step, diagonal = max(1, _BLOCK // (n * n)), np.arange(n)
    for first in range(0, speeds, step):
        part = slice(first, first + step)
        stiffness = at.stiffness[:, part] * (1 + 1j * referred.loss_factor[:, None])
        K = _between(referred, stiffness)
        C = _between(referred, np.broadcast_to(referred.damping[:, None], stiffness.shape))
        if referred.rods:
            C = np.zeros_like(C)
        C[:, diagonal, diagonal] += at.disc_damping[:, part].T
        if at.modal is not None:
            C = C + at.modal.matrices[at.modal.kind[part]]
        for m, order in enumerate(orders):
            omega = order * at.speeds[part]
            inertia: Floats | Complexes = referred.inertia
            if referred.rods:
                # Losses of the shafts are in their springs.
                there = dynamic(referred, at.stiffness[:, part], omega)
                K, inertia = _between(referred, there.stiffness), there.inertia.T
            matrix = K + 1j * omega[:, None, None] * C
            matrix[:, diagonal, diagonal] -= omega[:, None] ** 2 * inertia
            if at.disc_stiffness is not None:
                matrix[:, diagonal, diagonal] += at.disc_stiffness
            q[m, :, part] = _solved(matrix, torques[m, :, part].T).T
    return q


def _between(referred: ReferredTrain, of_shafts: Complexes | Floats) -> Complexes:
    """Matrix of what acts in each shaft, (speeds, masses, masses). `of_shafts`: (shafts, speeds)."""
    return np.asarray((referred.joins.T * of_shafts.T[:, None, :]) @ referred.joins, complex)


def _solved(matrix: Complexes, torque: Complexes) -> Complexes:
    """Solve one by one if a matrix of the batch is singular."""
    try:
        solution: Complexes = np.linalg.solve(matrix, torque[..., None])[..., 0].astype(complex, copy=False)
        return solution
    except np.linalg.LinAlgError:
        if len(matrix) == 1:
            return np.full(torque.shape, np.inf + 0j)
        return np.concatenate([_solved(matrix[k : k + 1], torque[k : k + 1]) for k in range(len(matrix))])


def extremes(coefficients: Complexes) -> Floats:
    """Maximum value, its place, minimum value, its place of sums of harmonics, (4, ...).

    Places as τ, 0 to 2π; NaN of a wave that is not finite. `coefficients`: (harmonics, ...) c_h of Σ Re c_h
    e^{ihτ}, from h = 0 on.
    """
    flat = np.ascontiguousarray(coefficients, complex).reshape(len(coefficients), coefficients[0].size)
    extrema = _core.torsion_waves(flat)
    rows = np.stack([extrema.greatest, extrema.greatest_at, extrema.least, extrema.least_at])
    return rows.reshape(4, *coefficients.shape[1:])
