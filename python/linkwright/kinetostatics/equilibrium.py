"""Equilibrium of all members at all crank angles: one linear system an angle, and Newton over friction.

With the unknowns x of all pairs and drives and their wrenches as the columns of A,

    A(x) x + b = 0        b: inertia and loads, a column for each

A depends on x through friction and the pressure of teeth alone. The size of a pin's force is homogeneous of
degree one, R = x·x/R, so solving with the direction of the last x is a step of Newton, and once it has
converged the columns of b still add up.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Bools, Floats, Indices
from linkwright.kernel.errors import FindingError
from linkwright.kernel.limits import FORCES, grouped
from linkwright.kernel.numerics.tangent import primal
from linkwright.kinetostatics.pairs import PairModel
from linkwright.kinetostatics.places import Scene
from linkwright.kinetostatics.wrench import Wrenches
from linkwright.linkages.model.structure import FRAME, Structure
from linkwright.machine.program.core import solve_systems

# Relative change of the forces at which the iteration over friction ends.
_SETTLED = 1e-11

# Steps of Newton before friction is brought in bit by bit, and then for each bit.
_STEPS = 25

# Bits in which friction is brought in where Newton fails from no friction.
_BITS = 20

# Growth of a unit load that counts as unbounded: beyond it fewer than four digits are left.
_UNBOUNDED = 1e12

# Load cases of no meaning that show whether forces are unbounded for some load.
_PROBES = 3


@dataclass
class Solution:
    """The unknowns, and where there are none."""

    # (n, unknowns, sources): share of each source in each unknown [N, N m]; NaN where there is no answer.
    x: Floats
    slopes: Floats  # (n, unknowns): extra force of its pair by each unknown
    # (n,): where forces are unbounded or not determined; where friction lets nothing move.
    singular: Bools
    locked: Bools
    iterations: int  # linear systems solved at each angle, at most


class Equilibrium:
    """The system of a scene.

    Parameters
    ----------
    scene : Scene
        The machine and its motion.
    models : list of PairModel
        Its pairs and drives.
    loads : list of ndarray, shape (n, members + 1, 3)
        Forces and moments on the members from each source.

    Notes
    -----
    Of what carries derivatives, the system has the values.
    """

    def __init__(self, scene: Scene, models: list[PairModel], loads: list[Floats]) -> None:
        self.models = models
        self.rows, self.row_scale = _rows(scene)
        sizes = [len(model.unknowns) for model in models]
        self.spans = [slice(end - size, end) for size, end in zip(sizes, np.cumsum(sizes), strict=True)]
        moments = np.array([moment for model in models for moment in model.moments])
        self.column_scale = np.where(moments, scene.size, 1.0)
        _require_room(scene.n, len(self.rows), len(moments))
        self.base = self._matrix(scene, [unknown for model in models for unknown in model.unknowns])
        self.base *= self.column_scale
        self.extras = [
            None if model.extra is None or not model.is_nonlinear else self._matrix(scene, [model.extra])
            for model in models
        ]
        self.b = np.stack([self.equations(primal(load)) for load in loads], axis=-1)

    def equations(self, wrenches: Any) -> Any:
        """Of forces and moments (n, members + 1, 3) those that must balance, (n, equations)."""
        return wrenches.reshape(len(wrenches), -1)[:, self.rows] * self.row_scale

    def _matrix(self, scene: Scene, columns: list[Wrenches]) -> Floats:
        """Wrenches as columns, (n, equations, columns); in memory all angles follow each other."""
        # The equations of a member follow each other: two forces, and a moment if it turns.
        members = {name: 3 * i for name, i in scene.index.items() if name != FRAME}
        starts = self.rows.searchsorted([[at, at + 3] for at in members.values()]).tolist()
        spans = dict(zip(members, starts, strict=True))
        matrix = np.zeros((len(columns), len(self.rows), scene.n))
        for j, column in enumerate(columns):
            for member, wrench in column.on.items():
                if member != FRAME:
                    first, last = spans[member]
                    matrix[j, first:last] = primal(wrench)[:, : last - first].T
        matrix *= self.row_scale[:, None]
        return matrix.T

    def solve(self) -> Solution:
        """Solve at all angles."""
        n, m = self.base.shape[0], self.base.shape[2]
        everywhere = np.ones(n, dtype=bool)
        slopes = np.zeros((n, m))
        x, singular = self._linear(slopes, self.b, everywhere)
        locked, iterations = np.zeros(n, dtype=bool), 1
        if any(model.is_nonlinear for model in self.models):
            slopes, locked, iterations = self._iterate(x.sum(axis=-1), singular)
            x, also = self._linear(slopes, self.b, everywhere)
            singular = singular | (also & ~locked)
        x[singular | locked] = np.nan
        return Solution(x, slopes, singular, locked, iterations)

    # -- friction ----------------------------------------------------------------------------------------

    def _iterate(self, x: Floats, singular: Bools) -> tuple[Floats, Bools, int]:
        """Slopes at which x repeats itself, where there are none, and the steps taken."""
        slopes, open_, steps = self._newton(x, ~singular, 1.0)
        if open_.any():
            # Friction that grows from nothing leads to the solution that belongs to it.
            near, still = x.copy(), open_.copy()
            for share in np.arange(1, _BITS + 1) / _BITS:
                part, failed, more = self._newton(near, still, float(share))
                steps += more
                still = still & ~failed
                again, _ = self._linear(part, self.b, still)
                near[still] = again.sum(axis=-1)[still]
                slopes[still] = part[still]
            open_ = open_ & ~still
        return slopes, open_, steps

    def _newton(self, x: Floats, where: Bools, share: float) -> tuple[Floats, Bools, int]:
        """Newton with a share of the friction; slopes, and where it has not settled."""
        x, open_ = x.copy(), where.copy()
        slopes = self._slopes(x) * share
        step = 0
        while open_.any() and step < _STEPS:
            step += 1
            total = self.b.sum(axis=-1, keepdims=True)
            new, bad = self._linear(slopes, total, open_)
            change = np.abs(new[..., 0] - x).max(axis=1)
            size = np.abs(new[..., 0]).max(axis=1)
            x[open_] = new[open_, :, 0]
            after = self._slopes(x) * share
            # What the slopes that follow from x would change, against what is there.
            effect = np.abs((after - slopes) * x).max(axis=1)
            settled = (np.maximum(change, effect) <= _SETTLED * size) & ~bad
            open_ = open_ & ~settled
            slopes[open_] = after[open_]
        return slopes, open_, step

    def _slopes(self, x: Floats) -> Floats:
        slopes: Floats = primal(self.slopes_along(x))
        return slopes

    def slopes_along(self, x: Floats) -> Any:
        """Extra force of its pair by each unknown, (n, unknowns), with derivatives if the system has some."""
        return np.concatenate(
            [model.slopes(x[:, span]) for model, span in zip(self.models, self.spans, strict=True)], axis=1
        )

    # -- the linear system -------------------------------------------------------------------------------

    def matrix(self, slopes: Floats) -> Floats:
        """A, (n, equations, unknowns), for unknowns over their scale."""
        if all(extra is None for extra in self.extras):
            return self.base
        A, slopes = self.base.copy(order="K"), slopes * self.column_scale
        for extra, span in zip(self.extras, self.spans, strict=True):
            if extra is not None:
                A[:, :, span] += extra * slopes[:, None, span]
        return A

    def _linear(self, slopes: Floats, b: Floats, where: Bools) -> tuple[Floats, Bools]:
        """x of A x = −b at some angles, (n, unknowns, sources), and where it is unbounded."""
        A = self.matrix(slopes)
        is_everywhere = bool(where.all())
        if not is_everywhere:
            A, b = A[where], b[where]
        sides = b.shape[-1]
        right = np.empty((sides + _PROBES, A.shape[1], len(A)))
        np.negative(b.T, out=right[:sides])
        # Numbers without any pattern that a mechanism could have: squares of whole numbers, in radians.
        probes = np.cos(np.arange(1.0, A.shape[1] * _PROBES + 1) ** 2).reshape(-1, _PROBES)
        right[sides:] = probes.T[..., None]
        solve_systems(np.ascontiguousarray(A.T), right)
        # Where the mechanism has no motion there are no forces either.
        singular = ~(np.abs(right[sides:]).max(axis=(0, 1)) < _UNBOUNDED)
        right[..., singular] = 0.0
        scaled = (right[:sides] * self.column_scale[:, None]).T
        if is_everywhere:
            return scaled, singular
        x = np.zeros((len(where), A.shape[1], b.shape[-1]))
        x[where] = scaled
        everywhere = np.zeros(len(where), dtype=bool)
        everywhere[where] = singular
        return x, everywhere


def require_room(structure: Structure, n: int) -> None:
    """Raise if the matrices of `n` angles are too large even with no more unknowns than equations."""
    equations = sum(3 if member.turns else 2 for member in structure.members.values())
    _require_room(n, equations, equations)


def _require_room(n: int, equations: int, unknowns: int) -> None:
    if n * equations * unknowns > FORCES.most:
        raise FindingError(
            f"forces: found {grouped(n)} crank angles, {equations} equations and {unknowns} unknowns, "
            f"expected {FORCES.words}; use fewer angles, or describe a part of the machine"
        )


def _rows(scene: Scene) -> tuple[Indices, Floats]:
    """Equations among all components of the members, and their scale; the frame has none."""
    rows, scale = [], []
    for i, member in enumerate(scene.structure.members.values()):
        for component in range(3 if member.turns else 2):
            rows.append(3 * i + component)
            scale.append(1.0 if component < 2 else 1.0 / scene.size)
    return np.array(rows), np.array(scale)
