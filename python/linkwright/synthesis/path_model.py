r"""Path generation as numbers: shapes whose crank turns fully, residuals, constraints.

The frame is 1. The crank r turns fully if coupler c and rocker b close at both ends of the range of the
distance that they span, 1 − r and 1 + r; so with c = (S + D)/2, b = (S − D)/2

.. math::

    S = 1 + r + e + \exp q_3, \qquad D = (|1 - r| - e) \tanh q_2

and r between e and 1 − 2e by a logistic function of q₁ for a crank-rocker, above 1 + 2e for a double crank.
The spare e keeps the linkage away from its change point. Every shape of a kind is met once, so that a search
needs no bounds for the full revolution.

Source: Grashof's condition, e.g. Hartenberg, Denavit, Kinematic Synthesis of Linkages, 1964.

In the plane of complex numbers, with the frame from 0 to 1, a coupler point is

.. math:: P = s\,A(\varphi) + z\,e^{i\chi(\varphi)} + t

so that pose and scale of the linkage (s, t) and the place of the point on its coupler (z) enter linearly, and
only the three numbers of the shape do not. A row holds these numbers, then the real and imaginary
parts of s, z, t, and with given crank angles the angle φ₀ of the crank from the frame at angle zero. All
lengths are over the size of the path, its middle at zero.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from linkwright.kernel.arrays import Bools, Complexes, Floats, Indices
from linkwright.linkages.nearest_places import TURN, disorder
from linkwright.synthesis.four_bar import FourBar, worst_transmission
from linkwright.synthesis.task import PathTask

# Minimum spare of the full revolution, over the frame: nearer to a change point the motion is not determined.
SPARE = 1e-3

# Numbers beyond this are shapes that differ from their limits by a millionth.
_FAR = 14.0


def shape(q: Floats, is_double: Bools) -> tuple[Floats, Floats]:
    """Lengths of crank, coupler and rocker over the frame.

    `q` (m, 3): the free numbers; `is_double` (m,): whether the linkage is a double crank. Returns: lengths
    (m, 3), and their derivatives by the numbers (m, 3, 3) [–].
    """
    q1, q2, q3 = np.clip(q, -_FAR, _FAR).T
    share = 1 / (1 + np.exp(-q1))
    r = np.where(is_double, 1 + 2 * SPARE + np.exp(q1), SPARE + (1 - 3 * SPARE) * share)
    r_1 = np.where(is_double, np.exp(q1), (1 - 3 * SPARE) * share * (1 - share))
    room, bent, rest = np.abs(1 - r) - SPARE, np.tanh(q2), np.exp(q3)
    total, off = 1 + r + SPARE + rest, room * bent
    off_1, off_2 = np.where(is_double, r_1, -r_1) * bent, room * (1 - bent**2)
    zero = np.zeros_like(r)
    by = np.array(
        [
            [r_1, zero, zero],
            [0.5 * (r_1 + off_1), 0.5 * off_2, 0.5 * rest],
            [0.5 * (r_1 - off_1), -0.5 * off_2, 0.5 * rest],
        ]
    )
    return np.stack([r, 0.5 * (total + off), 0.5 * (total - off)], axis=1), np.moveaxis(by, 2, 0)


def free_numbers(crank: Floats, bent: Floats, rest: Floats, is_double: Bools) -> Floats:
    """The free numbers of a crank over the frame, a share of D from −1 to 1, S beyond its minimum, (m, 3)."""
    inside = (crank - SPARE) / (1 - 3 * SPARE)
    with np.errstate(invalid="ignore", divide="ignore"):
        q1 = np.where(is_double, np.log(crank - 1 - 2 * SPARE), np.log(inside) - np.log(1 - inside))
    return np.stack([q1, np.arctanh(bent), np.log(rest)], axis=1)


def pin_and_coupler(lengths: Floats, side: Floats, phi: Floats) -> tuple[Complexes, Complexes]:
    """Crank pin and direction of the coupler, with the frame from 0 to 1.

    `lengths` (m, 3): crank, coupler, rocker over the frame; `side` (m,): +1 where the joint is to the left of
    the way from the pin to the rocker's pivot, −1 to the right; `phi` (m, n): crank angles from the frame
    [rad]. Returns: pin (m, n) over the frame, and e^{iχ} (m, n).
    """
    r, c, b = lengths.T[:, :, None]
    A = r * np.exp(1j * phi)
    D = 1 - A
    d = np.abs(D)
    cosine = np.clip((d * d + c * c - b * b) / (2 * c * d), -1, 1)
    return A, D / d * (cosine + 1j * side[:, None] * np.sqrt(1 - cosine * cosine))


def coupler_slopes(lengths: Floats, side: Floats, phi: Floats) -> tuple[Floats, Floats]:
    """Derivatives of the coupler's angle by crank, coupler, rocker (m, n, 3), by the crank angle (m, n)."""
    r, c, b = lengths.T[:, :, None]
    e = np.exp(1j * phi)
    D = 1 - r * e
    d = np.abs(D)
    cosine = np.clip((d * d + c * c - b * b) / (2 * c * d), -1, 1)
    # The angle κ between coupler and diagonal: dκ = −d(cos κ)/sin κ; the spare keeps it from 0 and π.
    by_cosine = -side[:, None] / np.sqrt(np.maximum(1 - cosine * cosine, 1e-300))
    by_d = by_cosine * (d / c - cosine)
    # The diagonal turns and grows by the logarithm of D.
    by_r, by_phi = -e / D, -1j * r * e / D
    slopes = [
        by_r.imag + by_d * by_r.real,
        by_cosine * (1 / d - cosine / c),
        by_cosine * (-b / (c * d)),
    ]
    return np.stack(slopes, axis=-1), by_phi.imag + by_d * by_phi.real


# Sizes of the path within which pivots and lengths are sought if the task does not say.
_REACH = 4.0

# Step of the differences by which constraints are linearised: the root of rounding.
_STEP = 1e-8

# A limit with less to spare than this holds the linkage: sizes of the path, or a share of the limit.
_AT_LIMIT = 1e-5

# A constraint counts as broken this much before it is, so that what is found keeps it in spite of rounding.
MARGIN = 1e-9


@dataclass(frozen=True)
class Linkages:
    """Rows of one search, m linkages."""

    p: Floats  # (m, k): their numbers; see the module
    phi: Floats  # (m, n): crank angle from the frame at each point [rad]
    is_double: Bools  # (m,): whether it is a double crank, or a crank-rocker
    side: Floats  # (m,): +1 for the joint to the left, −1 to the right

    def take(self, which: Bools | Indices) -> Linkages:
        """Some of them."""
        return Linkages(self.p[which], self.phi[which], self.is_double[which], self.side[which])

    def put(self, which: Bools | Indices, others: Linkages) -> None:
        """Put others of the same kinds in the place of some."""
        self.p[which], self.phi[which] = others.p, others.phi


class PathModel:
    """A task in the size of its path.

    Attributes
    ----------
    task : PathTask
    target : ndarray of complex, shape (n,)
        The points, over the size, about their middle.
    size : float
        Larger side of the rectangle around the points [m].
    middle : complex
        Middle of it [m].
    timed : ndarray, shape (n,), or None
        Crank angles of the points [rad].
    pivots : tuple of complex, or None
        s and t, where both fixed pivots are given.
    free : ndarray of int
        Places of the numbers of a row that are sought.
    """

    def __init__(self, task: PathTask) -> None:
        self.task = task
        x, y = np.asarray(task.x), np.asarray(task.y)
        self.size = float(max(np.ptp(x), np.ptp(y)))
        self.middle = complex(0.5 * (x.min() + x.max()), 0.5 * (y.min() + y.max()))
        self.target: Complexes = (x + 1j * y - self.middle) / self.size
        self.timed = None if task.crank_angle is None else np.asarray(task.crank_angle)
        self._longest = _REACH if task.length_max is None else task.length_max / self.size
        self._frame_max = np.inf if task.length_max is None else self._longest
        self._box = [self._ends(key) for key in ("x", "y")]
        self.pivots = self._given_pivots()
        # Numbers that a search may change: scale, direction and place are fixed by given pivots.
        held = () if self.pivots is None else (3, 4, 7, 8)
        count = 9 + (self.timed is not None)
        self.free = np.array([i for i in range(count) if i not in held])

    @property
    def longest(self) -> float:
        """Longest link that is allowed, and largest offset of the coupler point [m]."""
        return self._longest * self.size

    @property
    def region(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Ends of the region of the pivots along x and y [m]."""
        middle = (self.middle.real, self.middle.imag)
        x, y = (
            (m + self.size * low, m + self.size * high)
            for m, (low, high) in zip(middle, self._box, strict=True)
        )
        return x, y

    def _given_pivots(self) -> tuple[complex, complex] | None:
        crank, rocker = self.task.crank_pivot, self.task.rocker_pivot
        if crank is None or rocker is None:
            return None
        t = (complex(crank.x, crank.y) - self.middle) / self.size
        return complex(rocker.x - crank.x, rocker.y - crank.y) / self.size, t

    def _ends(self, key: str) -> tuple[float, float]:
        """Where pivots may be along an axis."""
        if self.task.pivots is None:
            return -_REACH, _REACH
        middle = self.middle.real if key == "x" else self.middle.imag
        low, high = ((end - middle) / self.size for end in getattr(self.task.pivots, key))
        return low, high

    def places(self, rows: Linkages) -> Complexes:
        """The coupler points at the crank angles of the rows, (m, n)."""
        lengths, _ = shape(rows.p[:, :3], rows.is_double)
        A, e = pin_and_coupler(lengths, rows.side, rows.phi)
        s, z, t = self.pose(rows.p)
        places: Complexes = s * A + z * e + t
        return places

    def moving(self, rows: Linkages) -> tuple[Complexes, Complexes]:
        """The coupler points, and their derivatives by the crank angle, (m, n) each."""
        lengths, _ = shape(rows.p[:, :3], rows.is_double)
        A, e = pin_and_coupler(lengths, rows.side, rows.phi)
        _, by_phi = coupler_slopes(lengths, rows.side, rows.phi)
        s, z, t = self.pose(rows.p)
        return s * A + z * e + t, 1j * (s * A + z * e * by_phi)

    @staticmethod
    def pose(p: Floats) -> tuple[Complexes, Complexes, Complexes]:
        """s, z and t of rows, (m, 1) each."""
        s, z, t = (p[:, i : i + 1] + 1j * p[:, i + 1 : i + 2] for i in (3, 5, 7))
        return s, z, t

    def linearised(self, rows: Linkages) -> tuple[Complexes, Complexes, Complexes]:
        """Coupler points (m, n), derivatives by nine numbers (m, n, 9), and by the crank angle (m, n)."""
        lengths, by_q = shape(rows.p[:, :3], rows.is_double)
        A, e = pin_and_coupler(lengths, rows.side, rows.phi)
        turns, by_phi = coupler_slopes(lengths, rows.side, rows.phi)
        s, z, t = self.pose(rows.p)
        by_lengths = 1j * (z * e)[:, :, None] * turns
        by_lengths[:, :, 0] += s * np.exp(1j * rows.phi)
        one = np.ones_like(A)
        linear = np.stack([A, 1j * A, e, 1j * e, one, 1j * one], axis=-1)
        J = np.concatenate([np.einsum("mnl,mlq->mnq", by_lengths, by_q), linear], axis=-1)
        return s * A + z * e + t, J, 1j * (s * A + z * e * by_phi)

    def excess(self, p: Floats, is_double: Bools) -> Floats:
        """By how much each constraint is broken, negative where it is kept, (m, constraints)."""
        return np.stack([excess for _, excess in self._limits(p, is_double)], axis=1)

    def _limits(self, p: Floats, is_double: Bools) -> Iterator[tuple[str, Floats]]:
        """Each constraint by the key of the task that sets it, with its excess, (m,)."""
        lengths, _ = shape(p[:, :3], is_double)
        s, z, t = (pose[:, 0] for pose in self.pose(p))
        frame = np.maximum(np.abs(s), 1e-300)
        sizes = np.column_stack([frame, frame[:, None] * lengths])
        point = z * np.conj(s) / frame
        for pivot in (t, s + t) if self.pivots is None else ():
            for value, (low, high) in zip((pivot.real, pivot.imag), self._box, strict=True):
                yield "pivots", np.maximum(low - value, value - high)
        for length in (*sizes.T[1:], np.abs(point.real), np.abs(point.imag)):
            yield "length_max", length - self._longest
        if np.isfinite(self._frame_max) and self.pivots is None:
            yield "length_max", frame - self._frame_max
        yield "length_ratio_max", np.log(sizes.max(axis=1) / sizes.min(axis=1) / self.task.length_ratio_max)
        if self.task.transmission_angle_min > 0:
            yield "transmission_angle_min", self.task.transmission_angle_min - worst_transmission(*sizes.T)

    def binding(self, row: Linkages) -> tuple[str, ...]:
        """Keys of the limits at which a single row, which keeps all of them, stands."""
        limits = self._limits(row.p, row.is_double)
        return tuple(dict.fromkeys(key for key, excess in limits if excess[0] > -_AT_LIMIT))

    def penalties(self, p: Floats, is_double: Bools, shift: Floats) -> tuple[Floats, Floats]:
        """What is broken of constraints that are shifted, and its derivatives, (m, c) and (m, c, 9)."""
        # All steps at once: rows are few, so that what counts is how often they are examined.
        beside = np.repeat(p[None], 10, axis=0)
        for i in range(9):
            beside[i + 1, :, i] += _STEP
        margins = self.excess(beside.reshape(-1, p.shape[1]), np.tile(is_double, 10)) + MARGIN
        excess, *stepped = margins.reshape(10, len(p), -1)
        slopes = [(step - excess) / _STEP for step in stepped]
        broken = excess + shift > 0
        return np.where(broken, excess + shift, 0.0), np.stack(slopes, axis=-1) * broken[:, :, None]

    def violation(self, rows: Linkages) -> Floats:
        """Sum of what is broken of all constraints, the order of the points among them, (m,)."""
        broken = np.maximum(self.excess(rows.p, rows.is_double), 0.0).sum(axis=1)
        return broken if self.timed is not None else np.asarray(broken + disorder(rows.phi, TURN))

    def errors(self, rows: Linkages) -> Floats:
        """Root of the mean square of the distances, over the size of the path, (m,)."""
        return np.asarray(np.sqrt((np.abs(self.places(rows) - self.target) ** 2).mean(axis=1)))

    def linkage(self, row: Linkages) -> tuple[FourBar, complex, Floats]:
        """Linkage, coupler point [m] and crank angles of the points [rad] of a single row."""
        lengths, _ = shape(row.p[:, :3], row.is_double)
        s, z, t = (complex(number[0, 0]) * self.size for number in self.pose(row.p))
        A0 = t + self.middle
        crank, coupler, rocker = (abs(s) * float(length) for length in lengths[0])
        way = float(np.angle(s))
        turned = 0.0 if self.timed is None else float(np.angle(np.exp(1j * (row.p[0, 9] + way))))
        bar = FourBar(A0, A0 + s, crank, coupler, rocker, "left" if row.side[0] > 0 else "right", turned)
        angles = self.timed if self.timed is not None else row.phi[0] + way
        return bar, z * s.conjugate() / abs(s), angles
