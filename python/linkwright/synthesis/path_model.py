"""Path generation as numbers: which rows stand for which linkages, what they cost, what they break.

A row holds A₀ (x, y), B₀ (x, y), crank, coupler, rocker, and the coupler point along and across; where the
points have crank angles, also the crank's direction at angle zero.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from linkwright.analysis.kinematics import motions
from linkwright.machine import Machine, replace
from linkwright.synthesis.four_bar import Assembly, FourBar, turn_spare, worst_transmission
from linkwright.synthesis.task import PathTask

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]

ENTRIES = (
    "mechanism.points.A0.x",
    "mechanism.points.A0.y",
    "mechanism.points.B0.x",
    "mechanism.points.B0.y",
    "mechanism.cranks.A.radius",
    "mechanism.rockers.B.coupler",
    "mechanism.rockers.B.rocker",
    "mechanism.rigid_points.P.along",
    "mechanism.rigid_points.P.across",
    "mechanism.cranks.A.phase",
)

# Crank angles at which a curve is looked at where timing is free: chords of 5° are off by a thousandth of the
# crank, enough to choose; the refinement has exact angles.
_CHORDS = 72

# Sizes of the path within which pivots and lengths are sought if the task does not say.
_REACH = 4.0

# Least spare of the full turn, over the frame: nearer to a change point the motion is not determined.
_SPARE = 1e-3


class PathModel:
    """The search space of a task with one assembly.

    Attributes
    ----------
    task : PathTask
        The task.
    assembly : str
        Side of the joint.
    x, y : ndarray, shape (n,)
        The points [m].
    target : ndarray, shape (n,)
        The same as x + i y [m].
    size : float
        Larger side of the rectangle around them [m].
    enough : float
        Mean square of the distances at which the search may end [m²].
    low, high : ndarray, shape (k,)
        Bounds of a row.
    timed : ndarray, shape (n,), or None
        Crank angles of the points [rad].
    n_entries : int
        Numbers in a row.
    """

    def __init__(self, task: PathTask, assembly: Assembly) -> None:
        self.task = task
        self.assembly: Assembly = assembly
        self.x, self.y = np.asarray(task.x), np.asarray(task.y)
        self.target = self.x + 1j * self.y
        self.size = float(max(np.ptp(self.x), np.ptp(self.y)))
        self.enough = (task.accuracy * self.size) ** 2
        self.timed = None if task.crank_angle is None else np.asarray(task.crank_angle)
        self.n_entries = 9 if self.timed is None else 10
        self.low, self.high = self._bounds()
        self._machine = self._template()
        self._angles = np.linspace(0, 2 * np.pi, _CHORDS, endpoint=False)

    def _bounds(self) -> tuple[Floats, Floats]:
        """The box of the rows."""
        reach = _REACH * self.size
        longest = self.task.length_max or reach
        ends = []
        for key, values in (("x", self.x), ("y", self.y)):
            middle = 0.5 * (values.min() + values.max())
            box = getattr(self.task.pivots, key) if self.task.pivots else (middle - reach, middle + reach)
            ends.append(box)
        least = longest / 1000
        low = [
            ends[0][0],
            ends[1][0],
            ends[0][0],
            ends[1][0],
            least,
            least,
            least,
            -longest,
            -longest,
            -np.pi,
        ]
        high = [ends[0][1], ends[1][1], ends[0][1], ends[1][1], *(5 * [longest]), np.pi]
        return np.array(low[: self.n_entries]), np.array(high[: self.n_entries])

    def _template(self) -> Machine:
        """A machine whose entries are exchanged for those of the rows."""
        bar = FourBar(0j, 2 * self.size + 0j, self.size, 2 * self.size, 2 * self.size, self.assembly)
        return bar.machine("Path generator", points={"P": complex(self.size, 0)})

    def places(self, rows: Floats, angles: Floats, *, slopes: bool = False) -> Floats:
        """The coupler point of all rows at crank angles.

        Parameters
        ----------
        rows : ndarray, shape (m, k)
            Rows.
        angles : ndarray, shape (n,)
            Crank angles [rad].
        slopes : bool
            Whether derivatives by the crank angle are wanted too.

        Returns
        -------
        ndarray, shape (m, 2, n) or (m, 4, n)
            x, y [m], and x′, y′ [m/rad]; NaN where a row does not close.
        """
        columns = {
            address: np.ascontiguousarray(rows[:, i]) for i, address in enumerate(ENTRIES[: self.n_entries])
        }
        table = motions(replace(self._machine, columns), angles, points=["P"])
        return table[:, : 4 if slopes else 2]

    def judge(self, rows: Floats) -> tuple[Floats, Floats, Floats]:
        """Move, turn and scale each linkage to the best place for its shape, and judge it there.

        Parameters
        ----------
        rows : ndarray, shape (m, k)
            A population, computed as one batch.

        Returns
        -------
        tuple of ndarray
            The rows (m, k), moved where that keeps them in the box; mean square of the distances (m,) [m²],
            infinite where a linkage does not close; sum of violations (m,).
        """
        table = self.places(rows, self._angles if self.timed is None else self.timed)
        closed = np.asarray(np.isfinite(table).all(axis=(1, 2)))
        places = np.where(closed[:, None], table[:, 0] + 1j * table[:, 1], 0)
        rows, places = self._aligned(rows, places)
        violation = self.violation(rows) + np.where(closed, 0, 1)
        if self.timed is not None:
            cost = np.mean(np.abs(places - self.target) ** 2, axis=1)
        else:
            distances, at = self._projected(places)
            cost = np.mean(distances, axis=1)
            violation = violation + disorder(at, _CHORDS)
        return rows, np.where(closed, cost, np.inf), violation

    def _aligned(self, rows: Floats, places: Complexes) -> tuple[Floats, Complexes]:
        """The linkages moved by the similarity w = s z + t that fits their places best to the points.

        A similar linkage draws a similar curve, so s and t follow by linear least squares without computing
        it anew.
        """
        z = places if self.timed is not None else self._partners(places)
        middle = z.mean(axis=1, keepdims=True)
        spread = np.maximum(np.sum(np.abs(z - middle) ** 2, axis=1, keepdims=True), 1e-300)
        s = np.sum(np.conj(z - middle) * (self.target - self.target.mean()), axis=1, keepdims=True) / spread
        t = self.target.mean() - s * middle
        moved = rows.copy()
        for i in (0, 2):
            pivot = s[:, 0] * (rows[:, i] + 1j * rows[:, i + 1]) + t[:, 0]
            moved[:, i], moved[:, i + 1] = pivot.real, pivot.imag
        moved[:, 4:9] *= np.abs(s)
        if self.timed is not None:
            moved[:, 9] = np.angle(np.exp(1j * rows[:, 9]) * s[:, 0])
        inside = np.asarray(((moved >= self.low) & (moved <= self.high)).all(axis=1))
        new_places = np.where(inside[:, None], s * places + t, places)
        return np.where(inside[:, None], moved, rows), new_places

    def _partners(self, places: Complexes) -> Complexes:
        """The place on the curve nearest to each point, (m, n) [m]."""
        at = self._projected(places)[1]
        chord = np.floor(at).astype(int) % _CHORDS
        start = np.take_along_axis(places, chord, axis=1)
        end = np.take_along_axis(places, (chord + 1) % _CHORDS, axis=1)
        return start + (at - np.floor(at)) * (end - start)

    def violation(self, rows: Floats) -> Floats:
        """Sum of the violations of all constraints on lengths and angles, (m,)."""
        return np.asarray(np.sum([np.maximum(0, each) for each in self._violations(rows)], axis=0))

    def _violations(self, rows: Floats) -> Iterator[Floats]:
        """By how much each constraint is broken, (m,); over the frame, or in radians."""
        frame = np.maximum(np.hypot(rows[:, 2] - rows[:, 0], rows[:, 3] - rows[:, 1]), 1e-9 * self.size)
        crank, coupler, rocker = rows[:, 4], rows[:, 5], rows[:, 6]
        sizes = np.stack([frame, crank, coupler, rocker])
        yield _SPARE - turn_spare(frame, crank, coupler, rocker) / frame
        if self.task.linkage == "crank-rocker":
            yield (crank - np.minimum(frame, np.minimum(coupler, rocker))) / frame
        if self.task.linkage == "double-crank":
            yield (frame - np.minimum(crank, np.minimum(coupler, rocker))) / frame
        if self.task.transmission_angle_min > 0:
            mu = np.nan_to_num(worst_transmission(frame, crank, coupler, rocker))
            yield self.task.transmission_angle_min - mu
        yield sizes.max(axis=0) / sizes.min(axis=0) / self.task.length_ratio_max - 1
        yield (frame - (self.task.length_max or np.inf)) / frame

    def _projected(self, places: Complexes) -> tuple[Floats, Floats]:
        """Squared distance of each point from the closed curve, and where on it, in chords, (m, n)."""
        off_x = places.real[:, None, :] - self.x[None, :, None]
        off_y = places.imag[:, None, :] - self.y[None, :, None]
        corner = (off_x * off_x + off_y * off_y).argmin(axis=2)
        before, after = (self._on_chord(places, (corner + step) % _CHORDS) for step in (-1, 0))
        first = before[0] < after[0]
        return np.where(first, before[0], after[0]), np.where(first, before[1], after[1])

    def _on_chord(self, places: Complexes, chord: NDArray[np.int_]) -> tuple[Floats, Floats]:
        """Squared distance of each point from its chord, and where on the curve its foot is, (m, n)."""
        start = np.take_along_axis(places, chord, axis=1)
        along = np.take_along_axis(places, (chord + 1) % _CHORDS, axis=1) - start
        off = self.target - start
        share = np.real(np.conj(along) * off) / np.maximum(np.abs(along) ** 2, 1e-300)
        share = np.clip(share, 0, 1)
        return np.abs(off - share * along) ** 2, chord + share

    def nearest(self, row: Floats) -> Floats:
        """Crank angles at which a row with free timing is nearest to the points, (n,) [rad]."""
        if len(row) > self.n_entries:
            return np.asarray(row[self.n_entries :])
        table = self.places(row[None], self._angles)
        return np.asarray(self._projected(table[:, 0] + 1j * table[:, 1])[1][0] * (2 * np.pi / _CHORDS))


def disorder(at: Floats, turn: float) -> Floats:
    """How many turns too many the curve must be run through to meet its points in order, (m,).

    Parameters
    ----------
    at : ndarray, shape (m, n)
        Where on the closed curve each point is.
    turn : float
        Length of the closed curve in the same measure.

    Returns
    -------
    ndarray, shape (m,)
        0 where one turn, in either direction, meets them all.
    """
    steps = np.diff(at, axis=1, append=at[:, :1])
    turns = [np.round(np.mod(sign * steps, turn).sum(axis=1) / turn) for sign in (1, -1)]
    return np.asarray(np.maximum(np.minimum(*turns) - 1, 0))
