r"""Least squares of the structural error itself, for many linkages of a function at once.

With the frame from 0 to 1, the crank pin A = r e^{iφ} is D = 1 − A away from the rocker's pivot, and the
rocker stands at the angle β from the way back,

.. math:: \cos\beta = \frac{d^2 + b^2 - c^2}{2 d b}, \qquad \varepsilon = \arg(-D) \mp \beta - \psi

ε is made small at all points by the method of Levenberg and Marquardt, from every start. Logarithms of the
lengths keep these positive, and make the ratio of any two of them a linear constraint. The transmission angle
is extreme at the ends of the range and where crank and frame are in line, so it is kept in the range by being
kept there. A constraint that is broken by g is the residual w (g + λ); λ grows by what is left of g, until
nothing is.

Source: as for `damped_step` and `path_search`; extremes of the transmission angle: VDI 2127; minimum largest
errors: C. L. Lawson, Contributions to the theory of linear least maximum approximation, UCLA 1961.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import permutations

import numpy as np

from linkwright.kernel.arrays import Bools, Floats, Indices
from linkwright.kernel.numerics.least_squares import damped_step

# Steps at most, and those after which the shifts of the constraints grow and rest is looked for.
_STEPS, _ROUND = 400, 20

# A sum of squares that falls by a smaller share in a round is at rest, if constraints are kept to the next.
_REST = 1e-9
_KEPT = 1e-9

# Weight of broken constraints beside errors in radians: errors are some 1e-4, constraints of the size of one,
# and a small weight lets linkages move along them.
_WEIGHT = 1e-2

# What is left of broken constraints falls to this share from round to round, else their weight is doubled.
_FALLS = 0.5

# What constraints are kept by, so that what is found keeps them in spite of rounding.
_MARGIN = 1e-8

# Damping at the beginning, what it is multiplied by after a failure and divided by after a success.
_DAMPING, _HARDER, _EASIER = 1e-2, 3.0, 5.0

# Rounds of Lawson's method, which converges linearly, and steps of a round; what a weight keeps at least, so
# that an error that happens to be zero is seen again.
_LEVELLINGS, _STEPS_OF_LEVELLING = 40, 20
_NEVER_NONE = 1e-3

# Pairs of the four lengths, frame first.
_PAIRS = np.array(list(permutations(range(4), 2)))


@dataclass(frozen=True)
class Rows:
    """Many linkages for one function, m of them."""

    x: Floats  # (m, 5): logarithms of crank, coupler and rocker over the frame; start angles φ₀ and ψ₀ [rad]
    # (m,): +1 for the joint to the left of the way from the pin to the rocker's pivot, −1 to the right.
    side: Floats
    turned: Bools  # (m, 2): whether crank and rocker point against the angles that describe them

    def take(self, which: Indices | Bools) -> Rows:
        """Some of them."""
        return Rows(self.x[which], self.side[which], self.turned[which])


@dataclass(frozen=True)
class FunctionModel:
    """What the linkages shall do, and keep."""

    # (n,): crank and rocker angles of the points, from their start angles [rad].
    crank: Floats
    rocker: Floats
    span: float  # crank angle of the whole range, signed [rad]
    free: Bools  # (5,): which numbers of a row may change
    ratio_max: float  # maximum ratio of longest to shortest link
    transmission_min: float  # minimum transmission angle over the range [rad]

    def over(self, crank: Floats, rocker: Floats) -> FunctionModel:
        """The same limits at other points."""
        return replace(self, crank=crank, rocker=rocker)

    def errors(self, rows: Rows) -> tuple[Floats, Floats]:
        """Structural errors ε at the points [rad], (m, n), and their derivatives, (m, n, 5)."""
        (r, c, b), phi, psi = self._lengths(rows), rows.x[:, 3:4] + self.crank, rows.x[:, 4:] + self.rocker
        A = np.where(rows.turned[:, :1], -r, r) * np.exp(1j * phi)
        D, d = 1 - A, np.abs(1 - A)
        cosine = (d * d + b * b - c * c) / (2 * d * b)
        inside = np.clip(cosine, -1, 1)
        # To the left of the way from the pin to the pivot is to the right of the way back.
        sign = -rows.side[:, None]
        beta = sign * np.arccos(inside)
        flip = np.where(rows.turned[:, 1:], np.pi, 0.0)
        # Beyond its reach the joint is missed by what the cosine lacks; the sum keeps the error steady.
        epsilon = _wrapped(np.angle(-D) + beta - psi - flip) + sign * (inside - cosine)
        slope = -sign / np.maximum(np.sqrt(1 - inside * inside), 1e-6)
        by_d = slope * (1 / b - cosine / d)
        along, across = -A / D, -1j * A / D
        columns = (
            along.imag + by_d * d * along.real,
            slope * (-c * c / (d * b)),
            slope * (b / d - cosine),
            across.imag + by_d * d * across.real,
            np.full_like(d, -1.0),
        )
        return epsilon, np.stack(columns, axis=-1)

    def excess(self, rows: Rows) -> tuple[Floats, Floats]:
        """By how much each constraint is broken, negative where it is kept, (m, k), and by x (m, k, 5)."""
        logs = np.column_stack([np.zeros(len(rows.x)), rows.x[:, :3]])
        ratio = logs[:, _PAIRS[:, 0]] - logs[:, _PAIRS[:, 1]] - np.log(self.ratio_max) + _MARGIN
        units = np.vstack([np.zeros(5), np.eye(5)[:3]])
        by_ratio = np.broadcast_to(units[_PAIRS[:, 0]] - units[_PAIRS[:, 1]], (len(rows.x), len(_PAIRS), 5))
        cosine, by = self._transmission(rows)
        most = np.cos(self.transmission_min) - _MARGIN
        excess = np.concatenate([ratio, cosine - most, -cosine - most], axis=1)
        return excess, np.concatenate([by_ratio, by, -by], axis=1)

    def _transmission(self, rows: Rows) -> tuple[Floats, Floats]:
        """cos μ where it may be extreme, (m, 4), and its derivatives, (m, 4, 5)."""
        r, c, b = self._lengths(rows)
        phi, moves = self._extreme_angles(rows)
        A = np.where(rows.turned[:, :1], -r, r) * np.exp(1j * phi)
        D, d = 1 - A, np.abs(1 - A)
        cosine = (c * c + b * b - d * d) / (2 * c * b)
        by_log_d = -d * d / (c * b)
        along, across = -A / D, -1j * A / D
        zero = np.zeros_like(d)
        columns = (
            by_log_d * along.real,
            c / b - cosine,
            b / c - cosine,
            np.where(moves, by_log_d * across.real, 0.0),
            zero,
        )
        return cosine, np.stack(columns, axis=-1)

    def _extreme_angles(self, rows: Rows) -> tuple[Floats, Bools]:
        """Ends of the range, and where crank and frame are in line within it, else its start, (m, 4)."""
        start = rows.x[:, 3:4]
        ends = np.hstack([start, start + self.span])
        low = ends.min(axis=1, keepdims=True)
        line = low + (np.array([0.0, np.pi]) - low) % (2 * np.pi)
        within = line <= ends.max(axis=1, keepdims=True)
        angles = np.hstack([ends, np.where(within, line, start)])
        return angles, np.hstack([np.ones_like(within), ~within])

    @staticmethod
    def _lengths(rows: Rows) -> tuple[Floats, Floats, Floats]:
        """Crank, coupler and rocker over the frame, (m, 1) each."""
        r, c, b = (np.exp(np.clip(rows.x[:, i : i + 1], -30, 30)) for i in range(3))
        return r, c, b


def refine(
    model: FunctionModel, rows: Rows, weights: Floats | None = None, steps: int = _STEPS
) -> tuple[Rows, Floats, Floats]:
    """Make the structural error at the points small in the least-squares sense, from every row.

    `rows`: where to begin, m linkages; `weights` (m, n): of the errors of each linkage; without them, all are
    one. Returns: the linkages, the root of the mean square of their errors (m,) [rad], and by how much they
    break the worst constraint (m,); zero or less where all are kept.
    """
    x = rows.x.copy()
    weights = np.ones((len(x), len(model.crank))) if weights is None else weights
    active = np.arange(len(x))
    damping = np.full(len(x), _DAMPING)
    limits = _Limits.of(np.zeros_like(model.excess(rows)[0]))
    before = np.full(len(x), np.inf)
    for number in range(1, steps + 1):
        here = Rows(x[active], rows.side[active], rows.turned[active])
        residual, J = _residuals(model, here, weights[active], limits.take(active))
        step = np.zeros_like(here.x)
        step[:, model.free] = damped_step(
            residual, J[:, :, model.free], np.clip(damping[active], 1e-15, None)
        )
        trial = Rows(here.x + np.clip(step, -1, 1), here.side, here.turned)
        better = _cost(model, trial, weights[active], limits.take(active)) < (residual**2).sum(axis=1)
        x[active[better]] = trial.x[better]
        damping[active] = np.clip(damping[active] * np.where(better, 1 / _EASIER, _HARDER), 1e-15, 1e12)
        if number % _ROUND == 0:
            here = Rows(x[active], rows.side[active], rows.turned[active])
            moved = limits.adapt(active, model.excess(here)[0])
            squares = ((weights[active] * model.errors(here)[0]) ** 2).sum(axis=1)
            rests = (np.abs(squares - before[active]) <= _REST * squares) & (moved <= _KEPT)
            before[active] = squares
            damping[active] = np.minimum(damping[active], _DAMPING)
            active = active[~rests]
        if not len(active):
            break
    refined = Rows(x, rows.side, rows.turned)
    rms = np.sqrt((model.errors(refined)[0] ** 2).mean(axis=1))
    return refined, rms, model.excess(refined)[0].max(axis=1) - _MARGIN


def level(model: FunctionModel, rows: Rows) -> tuple[Rows, Floats]:
    """Make the largest structural error small, by Lawson's method: weights grow with the errors they meet.

    `model`: the function over its whole range, and the constraints; `rows`: where to begin, m linkages that
    keep the constraints. Returns: the linkages, and their largest errors, (m,) [rad]; those of the start
    where nothing was gained.
    """
    errors = np.abs(model.errors(rows)[0])
    best, least = rows.x.copy(), errors.max(axis=1)
    squares = np.ones_like(errors)
    for _ in range(_LEVELLINGS):
        squares = squares * (errors / np.maximum(errors.mean(axis=1, keepdims=True), 1e-300) + _NEVER_NONE)
        squares /= squares.mean(axis=1, keepdims=True)
        rows, _, broken = refine(model, rows, np.sqrt(squares), _STEPS_OF_LEVELLING)
        errors = np.abs(model.errors(rows)[0])
        gained = (broken <= 0.0) & (errors.max(axis=1) < least)
        best[gained], least[gained] = rows.x[gained], errors.max(axis=1)[gained]
    return Rows(best, rows.side, rows.turned), least


@dataclass(frozen=True)
class _Limits:
    """Shifts λ (m, k), weights w (m, 1) of constraints, and how far shifts moved in the last round (m,)."""

    shift: Floats
    weight: Floats
    left: Floats

    @classmethod
    def of(cls, shift: Floats) -> _Limits:
        """With the weights of the beginning."""
        return cls(shift, np.full((len(shift), 1), _WEIGHT), np.full(len(shift), np.inf))

    def take(self, which: Indices) -> _Limits:
        return _Limits(self.shift[which], self.weight[which], self.left[which])

    def adapt(self, which: Indices, excess: Floats) -> Floats:
        """Increase shifts by the violation left; double the weight where it does not fall."""
        broken = np.maximum(excess + self.shift[which], 0.0)
        moved = np.abs(broken - self.shift[which]).max(axis=1)
        grow = np.where((moved > _KEPT) & (moved > _FALLS * self.left[which]), 2.0, 1.0)[:, None]
        # Twice the weight is a quarter of the shift: the force of the constraint stays.
        self.weight[which] *= grow
        self.shift[which], self.left[which] = broken / grow**2, moved
        return np.asarray(moved)


def _residuals(model: FunctionModel, rows: Rows, weights: Floats, limits: _Limits) -> tuple[Floats, Floats]:
    """Weighted errors and violations of constraints, with derivatives."""
    errors, by = model.errors(rows)
    excess, slopes = model.excess(rows)
    broken = excess + limits.shift
    below = limits.weight * np.maximum(broken, 0.0)
    by_below = limits.weight[:, :, None] * slopes * (broken > 0)[:, :, None]
    return np.hstack([weights * errors, below]), np.hstack([weights[:, :, None] * by, by_below])


def _cost(model: FunctionModel, rows: Rows, weights: Floats, limits: _Limits) -> Floats:
    """Sum of squares, (m,); infinite where a step went too far."""
    with np.errstate(over="ignore", invalid="ignore"):
        errors, excess = model.errors(rows)[0], model.excess(rows)[0]
        below = limits.weight * np.maximum(excess + limits.shift, 0.0)
        cost = ((weights * errors) ** 2).sum(axis=1) + (below**2).sum(axis=1)
    return np.where(np.isfinite(cost), cost, np.inf)


def _wrapped(angle: Floats) -> Floats:
    """Angles between −π and π."""
    return np.asarray((angle + np.pi) % (2 * np.pi) - np.pi)
