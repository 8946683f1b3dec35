"""What a moving edge cuts of a head, by brute force: points, time steps and nothing but where the knife is.

Two ways that share no step. `is_cut` lays one parallelogram after the other, which the edge sweeps between
two instants, and asks whether a point lies in any of them. `lengths_of_points` asks for each point when the
straight line through the edge passes over it, and how long the edge has to be to reach it then. No velocity
is used, nor whether the edge advances or retreats.

x along the row in the sense of travel, y to the left; the head's centre is at (0, offset), the middle of the
edge at (v t, y(t)), its direction (sin α, cos α).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]
Law = Callable[[Floats], Floats]

# Steps of a cycle: the straightened path is off by an eighth of the stroke times the step squared.
STEPS = 192
# Points by steps at a time, so that arrays stay within the cache's reach.
CHUNK = 400_000
# The lattice is turned, by no round angle, so that no edge or chord runs along its rows.
TURN = 0.4243


@dataclass(frozen=True)
class Knife:
    """An edge and how it moves: y [m] of the phase [rad], the phase grows at the rate [rad/s]."""

    law: Law
    reach: float
    rate: float
    angle: float
    speed: float

    @property
    def direction(self) -> Floats:
        return np.array([np.sin(self.angle), np.cos(self.angle)])


@dataclass(frozen=True)
class Pass:
    """A knife that goes over a head, at this phase when its middle is abreast of the centre."""

    knife: Knife
    diameter: float
    offset: float = 0.0
    phase: float = 0.0

    @property
    def until(self) -> float:
        """The straight line through the edge meets the head only between −until and until [s]."""
        across = self.diameter / 2 + abs(self.offset) + self.knife.reach
        along = self.diameter / 2 + across * abs(np.tan(self.knife.angle))
        return float(1.01 * along / self.knife.speed)

    def across(self, t: Floats) -> Floats:
        return self.knife.law(self.phase + self.knife.rate * t)

    def instants(self, per_cycle: int = STEPS) -> Floats:
        cycles = self.knife.rate * self.until / np.pi
        return np.linspace(-self.until, self.until, max(per_cycle, int(per_cycle * cycles)) + 1)


# --- points of the head -------------------------------------------------------------------------------------


def cells(over: Pass, n: int) -> tuple[Floats, Mask]:
    """Middles of square cells, n across the diameter, (n + 2, n + 2, 2), and which lie in the head."""
    u = ((np.arange(n + 2) - 0.5) / n - 0.5) * over.diameter
    x, y = np.meshgrid(u, u, indexing="ij")
    turned = np.stack([np.cos(TURN) * x - np.sin(TURN) * y, np.sin(TURN) * x + np.cos(TURN) * y], axis=-1)
    return turned + np.array([0.0, over.offset]), np.hypot(x, y) <= over.diameter / 2


def lattice(over: Pass, n: int) -> Floats:
    """Middles of the cells in the head; (points, 2)."""
    middles, inside = cells(over, n)
    return np.asarray(middles[inside])


def rim(over: Pass, n: int) -> Floats:
    """Points of the head's circle; (n, 2)."""
    angle = 2 * np.pi * (np.arange(n) + 0.5) / n
    return over.diameter / 2 * np.stack([np.cos(angle), np.sin(angle)], axis=1) + np.array([0.0, over.offset])


def into_head(over: Pass, points: Floats) -> Floats:
    centre = np.array([0.0, over.offset])
    away = np.hypot(*(points - centre).T)
    return centre + (points - centre) * np.minimum(1.0, over.diameter / 2 / np.maximum(away, 1e-300))[:, None]


# --- swept parallelograms -----------------------------------------------------------------------------------


def _cross(a: Floats, b: Floats) -> Floats:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])


def is_cut(over: Pass, points: Floats, length: float, per_cycle: int = STEPS) -> Mask:
    """Whether the edge sweeps over each point: P = A + λ L e + μ D with λ and μ between 0 and 1."""
    t = over.instants(per_cycle)
    edge = length * over.knife.direction
    ends = np.stack([over.knife.speed * t, over.across(t)], axis=1) - edge / 2
    start, move = ends[:-1], np.diff(ends, axis=0)
    area = _cross(edge, move)
    size = max(1, CHUNK // len(t))
    parts = (points[i : i + size] for i in range(0, len(points), size))
    return np.concatenate([_in_any(part[:, None] - start, edge, move, area) for part in parts])


def _in_any(from_end: Floats, edge: Floats, move: Floats, area: Floats) -> Mask:
    with np.errstate(divide="ignore", invalid="ignore"):
        along, forth = _cross(from_end, move) / area, _cross(edge, from_end) / area
    return np.asarray(((along >= 0) & (along <= 1) & (forth >= 0) & (forth <= 1)).any(axis=1))


def length_by_bisection(over: Pass, points: Floats, rounds: int = 20) -> float:
    """Smallest length whose parallelograms hold every point."""
    low, high = 0.0, 4 * (over.diameter + abs(over.offset) + over.knife.reach) / np.cos(over.knife.angle)
    for _ in range(rounds):
        middle = (low + high) / 2
        low, high = (low, middle) if is_cut(over, points, middle).all() else (middle, high)
    return high


# --- lengths point by point ---------------------------------------------------------------------------------


def lengths_of_points(over: Pass, points: Floats, per_cycle: int = STEPS) -> Floats:
    """Smallest length whose edge crosses each point: of all passes of its line, the one nearest its middle.

    The line stands at x = v t + (Y − y) tan α beside the point (X, Y); there the point is |Y − y|/cos α
    from the middle of the edge.
    """
    which, y = passes_of_points(over, points, per_cycle)
    found = np.full(len(points), np.inf)
    np.minimum.at(found, which, 2 * np.abs(points[which, 1] - y) / np.cos(over.knife.angle))
    return found


def passes_of_points(over: Pass, points: Floats, per_cycle: int = STEPS) -> tuple[NDArray[np.int64], Floats]:
    """All passes of the line over points: which point, and y of the edge's middle."""
    t = over.instants(per_cycle)
    t = np.sort(np.concatenate([t, _turning(over, t)]))
    size = max(1, CHUNK // len(t))
    found = [_steps_over(over, points[i : i + size], t, i) for i in range(0, len(points), size)]
    which, step = (np.concatenate(each) for each in zip(*found, strict=True))
    return which, over.across(_crossing(over, points[which], t[step], t[step + 1]))


def _steps_over(over: Pass, points: Floats, t: Floats, first: int) -> tuple[NDArray[np.int64], ...]:
    """Which point, counted from the first, and the step in which the line passes over it."""
    past = _ahead(over, points[:, None], t) >= 0
    which, step = np.nonzero(past[:, 1:] != past[:, :-1])
    return which + first, step


def _turning(over: Pass, t: Floats) -> Floats:
    """Instants at which the line stops and runs the other way, between steps: a third cut off 80 times."""
    origin = np.zeros(2)
    way = _ahead(over, origin, t)
    k = 1 + np.flatnonzero((way[1:-1] - way[:-2]) * (way[2:] - way[1:-1]) < 0)
    sign, low, high = np.sign(way[k] - way[k - 1]), t[k - 1], t[k + 1]
    for _ in range(80):
        a, b = low + (high - low) / 3, high - (high - low) / 3
        rises = sign * (_ahead(over, origin, b) - _ahead(over, origin, a)) > 0
        low, high = np.where(rises, a, low), np.where(rises, high, b)
    return np.asarray((low + high) / 2)


def _ahead(over: Pass, points: Floats, t: Floats) -> Floats:
    slant = np.tan(over.knife.angle)
    return over.knife.speed * t + (points[..., 1] - over.across(t)) * slant - points[..., 0]


def _crossing(over: Pass, points: Floats, before: Floats, after: Floats) -> Floats:
    """Instant at which the line passes over the point, halving the step 40 times."""
    was = _ahead(over, points, before) >= 0
    for _ in range(40):
        middle = (before + after) / 2
        same = (_ahead(over, points, middle) >= 0) == was
        before, after = np.where(same, middle, before), np.where(same, after, middle)
    return np.asarray((before + after) / 2)


# --- the head as a whole ------------------------------------------------------------------------------------


def uncut_share(over: Pass, length: float, n: int = 90, per_cycle: int = STEPS) -> tuple[float, float]:
    """Uncut share of the head's area, and what the lattice may miss of it.

    A cell on the border of what is left counts whole or not at all. The cells of the turned lattice do so as
    if at random: the count is off by about the square root of their number.
    """
    middles, inside = cells(over, n)
    left = np.zeros_like(inside)
    left[inside] = lengths_of_points(over, middles[inside], per_cycle) > length
    of_head = inside.sum()
    return float(left.sum() / of_head), float((2 + np.sqrt(_on_border(left))) / of_head)


def _on_border(left: Mask) -> int:
    return int((left[1:] != left[:-1]).sum() + (left[:, 1:] != left[:, :-1]).sum())


def uncut_by_slices(over: Pass, length: float, slices: int = 12000) -> tuple[Floats, float]:
    """Shares left on the right of the edge, on its left and between two passes; and what they may be off.

    Points of a slice along the edge have x = X − Y tan α in common, and the line is over all of them at once;
    the edge then covers Y within L cos α / 2 of y. Half as many slices show how much they miss.
    """
    fine, coarse = _left_of_slices(over, length, slices), _left_of_slices(over, length, slices // 2)
    return fine, float(np.abs(fine - coarse).max())


def _left_of_slices(over: Pass, length: float, slices: int) -> Floats:
    slant, cos = np.tan(over.knife.angle), np.cos(over.knife.angle)
    x, widths = _slices(over, slices)
    # The chord: (x + Y tan α)² + Y² = r², seen from the centre.
    middle = over.offset - x * slant * cos**2
    half = cos**2 * np.sqrt(np.maximum(0.0, (over.diameter / 2 / cos) ** 2 - x**2))
    points = np.stack([x - over.offset * slant, np.zeros(len(x))], axis=1)
    left = _gaps(middle - half, middle + half, *passes_of_points(over, points), length * cos / 2)
    return np.asarray(left @ widths / (np.pi * over.diameter**2 / 4))


def _slices(over: Pass, n: int) -> tuple[Floats, Floats]:
    """Places x and widths: between those where the line turns back, as close at the ends as a pendulum's."""
    t = over.instants()
    turns = _ahead(over, np.array([0.0, over.offset]), _turning(over, t))
    extent = over.diameter / 2 / np.cos(over.knife.angle)
    ends = np.sort(np.concatenate([[-extent, extent], turns[np.abs(turns) < extent]]))
    each = max(50, n // (len(ends) - 1))
    u = np.pi * ((np.arange(each) + 0.5) / each - 0.5)
    middle, half = (ends[1:] + ends[:-1])[:, None] / 2, np.diff(ends)[:, None] / 2
    return (middle + half * np.sin(u)).ravel(), (half * np.cos(u) * np.pi / each).ravel()


def _gaps(low: Floats, high: Floats, which: NDArray[np.int64], y: Floats, half: float) -> Floats:
    """What intervals y ± half leave of those from low to high: below all of them, above, and between."""
    order = np.lexsort((y, which))
    which, y = which[order], y[order]
    bottom, top = np.clip(y - half, low[which], high[which]), np.clip(y + half, low[which], high[which])
    starts = np.searchsorted(which, np.arange(len(low)))
    ends = np.searchsorted(which, np.arange(len(low)), side="right") - 1
    between = np.zeros(len(low))
    again = np.flatnonzero(which[1:] == which[:-1])
    np.add.at(between, which[again], np.maximum(0, bottom[again + 1] - top[again]))
    return np.stack([bottom[starts] - low, high - top[ends], between])


def needed_length(over: Pass, n: int = 24, rounds: int = 24, per_cycle: int = STEPS) -> float:
    """Smallest length that cuts every point: the largest of a lattice and the rim, closed in upon."""
    points = np.concatenate([lattice(over, n), rim(over, 6 * n)])
    lengths = lengths_of_points(over, points, per_cycle)
    best = points[np.argsort(lengths)[-3:]]
    around = lattice(replace(over, offset=0.0), 7)
    for k in range(rounds):
        near = best[:, None] + around * (4 / n * 0.5**k)
        points = into_head(over, np.concatenate([best, near.reshape(-1, 2)]))
        lengths = lengths_of_points(over, points, per_cycle)
        best = points[np.argsort(lengths)[-3:]]
    return float(lengths.max())


def worst(knife: Knife, diameter: float, offset: float, phases: int = 12) -> tuple[float, Pass]:
    """Largest needed length over phases, at this offset to either side: a scan, then closing in."""
    scan = 2 * np.pi * np.arange(phases) / phases
    found = [_needed_at(knife, diameter, o, p) for o in (-offset, offset) for p in scan]
    for k in range(8):
        best = max(found, key=lambda each: each[0])[1]
        near = best.phase + 2 * np.pi / phases * 0.5**k * np.array([-1, -0.5, 0.5, 1])
        found += [_needed_at(knife, diameter, best.offset, phase) for phase in near]
    return max(found, key=lambda each: each[0])


def _needed_at(knife: Knife, diameter: float, offset: float, phase: float) -> tuple[float, Pass]:
    over = Pass(knife, diameter, offset, float(phase))
    return needed_length(over, n=8, rounds=6, per_cycle=STEPS // 3), over


# --- laws of the knife --------------------------------------------------------------------------------------


def one_direction(speed: float, slant: float, forward: float, extent: float) -> Knife:
    """The knife goes on at its speed, and is over the row's axis abreast of the head.

    `extent` is d/2 + |offset|: beyond it, the line through the edge no longer meets the head.
    """
    advance = abs(forward - speed * np.tan(slant))
    reach = abs(speed) * extent * (1 + abs(np.tan(slant))) / advance
    return Knife(lambda t: speed * t, reach, 1.0, slant, forward)


def to_and_fro(law: Law, stroke: float, mean_speed: float, angle: float, forward: float) -> Knife:
    """A law of amplitude 1 at a mean speed: two strokes to a cycle."""
    rate = np.pi * mean_speed / stroke
    return Knife(lambda phase: stroke / 2 * law(phase), stroke / 2, rate, angle, forward)


def triangular(phase: Floats) -> Floats:
    return np.asarray(2 / np.pi * np.arcsin(np.sin(phase)))


def slider_crank(rod: float) -> Law:
    """Central, crank radius 1: s = cos φ + √(l² − sin² φ), seen from the middle of the stroke."""
    return lambda phase: np.cos(phase) + np.sqrt(rod**2 - np.sin(phase) ** 2) - rod


def dwell_rise_dwell_return(dwell: float, rise: float) -> Law:
    """Rest at −1, cycloid up, rest at 1, cycloid down; `dwell` at each end and `rise`, shares of a cycle."""

    def law(phase: Floats) -> Floats:
        turn = (np.asarray(phase) / (2 * np.pi)) % 1.0
        up = np.clip((turn - dwell) / rise, 0.0, 1.0)
        down = np.clip((turn - 2 * dwell - rise) / (1 - 2 * dwell - rise), 0.0, 1.0)
        return 2 * (_cycloid(up) - _cycloid(down)) - 1

    return law


def _cycloid(u: Floats) -> Floats:
    return np.asarray(u - np.sin(2 * np.pi * u) / (2 * np.pi))
