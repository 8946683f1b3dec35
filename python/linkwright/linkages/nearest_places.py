r"""Places of closed curves that are nearest to points, in the order of the points.

A curve is known at even steps of the crank angle with two derivatives. Between them it is the polynomial of
fifth degree that has all of these at both ends (Hermite), so that its error is h⁶/46080 of the sixth
derivative: 6e-16 of it at one degree. Newton's method leads from the best step to the foot of each point,

.. math:: \operatorname{Re}\, \overline{P'} (P - w) = 0.

Where the feet do not follow one another within one revolution, in either direction, their crank angles are
those of the minimum sum of squares among all that do: by dynamic programming over coarse steps [1]_, then by
Newton's method, in which points that would pass each other share one angle [2]_.

References
----------
.. [1] Sakoe, Chiba, *Dynamic programming algorithm optimization for spoken word recognition*, IEEE Trans.
   Acoust. Speech Signal Process. 26 (1978) 43.
.. [2] Barlow, Brunk, *The isotonic regression problem and its dual*, J. Am. Stat. Assoc. 67 (1972) 140:
   pooling of adjacent violators.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from linkwright.kernel.arrays import Complexes, Floats, Indices

TURN = 2 * np.pi

# Polynomials of fifth degree on a step from 0 to 1, by powers: each has one of place, first and second
# derivative at one of both ends, and none of the others.
_HERMITE = np.array(
    [
        [1.0, 0, 0, -10, 15, -6],
        [0.0, 1, 0, -6, 8, -3],
        [0.0, 0, 0.5, -1.5, 1.5, -0.5],
        [0.0, 0, 0, 10, -15, 6],
        [0.0, 0, 0, -4, 7, -3],
        [0.0, 0, 0, 0.5, -1, 0.5],
    ]
)

# Steps of Newton's method, which converges quadratically from the nearest step, and one that ends it [rad].
_ROUNDS = 12
_RESTS = 1e-9

# Angles that differ by less follow one another: rounding, and points that are the same [rad].
_SAME = 1e-9

# Every how many steps of the curve the order is sought.
_COARSE = 4

# Coefficients by powers of the polynomials' derivatives.
_POWERS = np.arange(6)
_FIRST = np.roll(_HERMITE * _POWERS, -1, axis=1)
_SECOND = np.roll(_FIRST * _POWERS, -1, axis=1)


@dataclass(frozen=True)
class ClosedCurves:
    """Closed curves at even crank angles from 0, (rows, steps): place x + i y and two derivatives."""

    place: Complexes
    first: Complexes
    second: Complexes

    @property
    def step(self) -> float:
        """Crank angle between two of them [rad]."""
        return TURN / float(self.place.shape[1])

    def row(self, row: int) -> ClosedCurves:
        """One of the curves."""
        return ClosedCurves(*(part[row : row + 1] for part in (self.place, self.first, self.second)))

    def coarser(self) -> ClosedCurves:
        """The curves at fewer steps."""
        return ClosedCurves(*(part[:, ::_COARSE] for part in (self.place, self.first, self.second)))

    def at(self, phi: Floats) -> tuple[Complexes, Complexes, Complexes]:
        """Place and two derivatives at crank angles, (rows, n) each."""
        h, n = self.step, self.place.shape[1]
        count = np.floor(phi / h)
        low = count.astype(np.intp) % n
        ends = (low, (low + 1) % n)
        scaled = (self.place, h * self.first, h * h * self.second)
        known = np.stack([np.take_along_axis(part, end, axis=1) for end in ends for part in scaled], axis=-1)
        powers = (phi / h - count)[..., None] ** _POWERS
        place, first, second = ((known * (powers @ table.T)).sum(-1) for table in (_HERMITE, _FIRST, _SECOND))
        return place, first / h, second / h**2


def nearest_in_order(curves: ClosedCurves, targets: Complexes) -> Floats:
    """Crank angles at which curves are nearest to points in their order, (rows, n) [rad].

    `targets` (n,): the points. Within one revolution in either direction; unrolled, not reduced to it.
    """
    best = _squares(curves, targets).argmin(axis=-1)
    phi = _feet(curves, targets, best * curves.step)
    for row in np.flatnonzero(disorder(phi, TURN) > 0).tolist():
        phi[row] = _ordered(curves.row(row), targets)
    return phi


def disorder(at: Floats, turn: float) -> Floats:
    """How many revolutions too many the curve must be run through to meet its points in order, (m,).

    `at` (m, n): where on the closed curve each point is; `turn`: length of the closed curve in the same
    measure. Returns: (m,) 0 where one revolution, in either direction, meets them all.
    """
    steps = np.diff(at, axis=1, append=at[:, :1])
    forward, back = (np.mod(sign * steps + _SAME, turn) - _SAME for sign in (1, -1))
    turns = [np.round(way.sum(axis=1) / turn) for way in (forward, back)]
    return np.asarray(np.maximum(np.minimum(*turns) - 1, 0))


def _squares(curves: ClosedCurves, targets: Complexes) -> Floats:
    """Squared distances of the curves about each step from points, (rows, n, steps)."""
    off = curves.place[:, None, :] - targets[None, :, None]
    along = (np.conj(curves.first)[:, None] * off).real
    bend = np.abs(curves.first[:, None]) ** 2 + (np.conj(curves.second)[:, None] * off).real
    squares: Floats = np.abs(off) ** 2
    # To the foot within the step, by one step of Newton.
    is_near = np.abs(along) <= curves.step * bend
    return squares - np.where(is_near, along**2 / np.where(is_near & (bend > 0), bend, 1.0), 0.0)


def _feet(curves: ClosedCurves, targets: Complexes, phi: Floats) -> Floats:
    """Crank angles of the feet of points near angles, each alone, (rows, n)."""
    start = phi
    for _ in range(_ROUNDS):
        along, bend = _slope(curves, targets, phi)
        step = np.clip(-along / bend, -curves.step, curves.step)
        phi = np.clip(phi + step, start - 2 * curves.step, start + 2 * curves.step)
        if np.abs(step).max() < _RESTS:
            break
    return phi


def _slope(curves: ClosedCurves, targets: Complexes, phi: Floats) -> tuple[Floats, Floats]:
    """Derivative of half the squared distance by the crank angle, and a positive second one, (rows, n)."""
    place, first, second = curves.at(phi)
    off = place - targets
    square = np.abs(first) ** 2
    bend = square + (np.conj(second) * off).real
    # Where the distance has no minimum nearby, a step of Gauss and Newton's method leads down.
    return (np.conj(first) * off).real, np.where(bend > 0, bend, np.maximum(square, 1e-300))


def _ordered(curve: ClosedCurves, targets: Complexes) -> Floats:
    """Crank angles of the minimum sum of squares in the order of the points, of one curve, (n,)."""
    ways = []
    for way in (1, -1):
        points = targets[::way]
        start = _in_steps(_squares(curve.coarser(), points)[0]) * _COARSE * curve.step
        ways.append(_settled(curve, points, start)[::way])
    sums = [float((np.abs(curve.at(phi[None])[0][0] - targets) ** 2).sum()) for phi in ways]
    return ways[int(np.argmin(sums))]


def _in_steps(squares: Floats) -> Floats:
    """Steps (n,) that do not go back within one revolution, of the minimum sum of squares (n, m)."""
    m = squares.shape[1]
    start = np.arange(m)
    place = (start[:, None] + np.arange(m + 1)) % m
    # Sums by the step of the first point and the number of steps from it to the last of the points so far.
    least = np.broadcast_to(squares[0][:, None], (m, m + 1))
    before: list[Indices] = []
    for row in squares[1:]:
        total = row[place] + least
        least = np.minimum.accumulate(total, axis=1)
        before.append(np.maximum.accumulate(np.where(total == least, np.arange(m + 1), 0), axis=1))
    first = int(least[:, -1].argmin())
    past, steps = m, []
    for back in reversed(before):
        past = int(back[first, past])
        steps.append(past)
    return first + np.array([0, *reversed(steps)], dtype=float)


def _settled(curve: ClosedCurves, targets: Complexes, phi: Floats, rolled: int = 0) -> Floats:
    """Crank angles (n,) by Newton's method; points that would overtake each other share an angle."""
    n = len(targets)
    group = np.arange(n)
    for _ in range(n):
        phi = _together(curve, targets, phi, group)
        back = np.diff(phi, append=phi[:1] + TURN)
        passed = int(back.argmin())
        if back[passed] >= -_SAME:
            return phi
        if passed == n - 1:
            break
        group = np.where(group == group[passed + 1], group[passed], group)
        one = group == group[passed]
        phi = np.where(one, phi[one].mean(), phi)
    last = int((group == group[-1]).sum())
    if rolled >= n or last == n:
        return phi
    # The last points would pass the first one a revolution later: the revolution begins with them.
    earlier = np.maximum.accumulate(np.concatenate([phi[-last:] - TURN, phi[:-last]]))
    return np.roll(_settled(curve, np.roll(targets, last), earlier, rolled + last), -last)


def _together(curve: ClosedCurves, targets: Complexes, phi: Floats, group: Indices) -> Floats:
    """Crank angles (n,), one for each group of points, at the minimum of the group's sum of squares."""
    for _ in range(_ROUNDS):
        along, bend = (part[0] for part in _slope(curve, targets, phi[None]))
        sums = (np.bincount(group, part, minlength=len(group))[group] for part in (along, bend))
        step = np.clip(np.divide(*sums), -curve.step, curve.step)
        phi = phi - step
        if np.abs(step).max() < _RESTS:
            break
    return phi
