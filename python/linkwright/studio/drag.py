r"""Drag a joint or a point of a curve: which entries bring it to a place, and where the linkage stops.

The entries e of a handle, or those that were chosen, are moved so that the point comes as near to the place
as they allow, at the crank angle of the drawing. Each step is the smallest of Gauss–Newton in the ranges s
of the entries,

.. math:: \Delta e = s (J s)^+ (p_0 - p(e; \varphi)), \qquad J = \frac{\partial p}{\partial e}

with exact derivatives; an entry at its limit is held there (Nocedal and Wright, *Numerical Optimization*,
chapters 10 and 16). A step is accepted on positions alone. A linkage that turned over the whole revolution
before the drag still does after it: beyond, the entries stop on the straight way from where the drag began.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from dataclasses import replace as replaced
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.place import split
from linkwright.kernel.description.schema_walk import annotation_at, mark_of
from linkwright.kernel.errors import InputError, LinkwrightError
from linkwright.kernel.units.marks import Quantity
from linkwright.linkages.closure import Closure, closure, closure_error
from linkwright.linkages.kinematics import kinematics_along, motions
from linkwright.machine.address import get, replace
from linkwright.machine.machine import Machine
from linkwright.machine.tangents import directions
from linkwright.studio.document import short
from linkwright.studio.drawing import entries_of

Limits = Mapping[str, tuple[float, float]]
Ranges = tuple[tuple[float, float], ...]

# Steps to the place: more change nothing that is seen.
_STEPS = 12

# Ever shorter steps that are tried at once: one of them closes, however far away the pointer is.
_SHARES = 16

# Distance over the drawing's size at which the point is there, and at which it is seen not to be.
_NEAR, _SEEN = 1e-9, 1e-3

# Part of the drawing's size, or of a radian, by which an entry without an exact derivative is moved.
_PROBE = 1e-6

# Smallest size of a length over that of the drawing: shorter links cannot be caught again.
_SHORTEST = 1e-3

# Halvings on the way to the limit: a share of it that is below a pixel.
_HALVINGS = 13


@dataclass(frozen=True)
class Drag:
    """Where a drag leads."""

    entries: dict[str, float]  # address → SI value
    reason: str = ""  # why it stops before the place; empty if it does not
    limit: float | None = (
        None  # crank angle at which the linkage is at its limit there [rad]; None if at none
    )
    # Address → change of the entry that moves the point by a pixel [SI], with the value where it began.
    worth: dict[str, tuple[float, float]] = field(default_factory=dict)
    value: float | None = None  # of the result that was pulled [SI]


def drag(
    machine: Machine,
    point: str,
    place: tuple[float, float],
    angle: float,
    locked: frozenset[str] = frozenset(),
    limits: Limits | None = None,
    pixel: float = 0.0,
) -> Drag:
    """The entries that bring a point to a place [m], and why they stop.

    `machine`: as it was when the drag began; `angle`: of the crank in the drawing [rad]; `locked`: addresses
    that hold their values; `limits`: entries that follow with their limits [SI], without them those of the
    handle; `pixel`: size of one in the drawing [m].
    """
    known = {*machine.mechanism.points, *machine.linkage.moving_points()}
    if point not in known:
        raise InputError(f"{point}: no point of this machine")
    free = [entry for entry in (limits or entries_of(machine, point)) if entry not in locked]
    if not free:
        is_locked = any(entry in locked for entry in entries_of(machine, point))
        return Drag({}, f"all entries of {point} are locked" if is_locked else f"no entry places {point}")
    before = np.array([float(get(machine, entry)) for entry in free])
    size = float(np.hypot(*place)) + float(np.abs(before).max()) or 1.0
    ends = [_limits(machine, entry, size, limits) for entry in free]
    low, high = np.minimum(before, np.array(ends).T[0]), np.maximum(before, np.array(ends).T[1])
    search = _Search(machine, point, np.array(place), angle, free, before, low, high, size, closure(machine))
    pull = search.stopped(search.nearest())
    return replaced(pull, worth=search.worth(pull.entries, pixel)) if pixel else pull


def _limits(machine: Machine, entry: str, size: float, limits: Limits | None) -> tuple[float, float]:
    """What was given, within what is declared: lengths of links stay positive."""
    low, high = (-math.inf, math.inf) if limits is None else limits[entry]
    mark = mark_of(annotation_at(Machine, split(entry), machine))
    is_positive = isinstance(mark, Quantity) and mark.bound.schema.get("exclusiveMinimum") == 0
    return (max(low, _SHORTEST * size) if is_positive else low), high


@dataclass(frozen=True)
class _Search:
    machine: Machine
    point: str
    place: Floats
    angle: float
    free: list[str]
    before: Floats
    low: Floats
    high: Floats
    size: float
    closed: Closure
    range: Floats = field(init=False)

    def __post_init__(self) -> None:
        """Ranges that steps are measured in: of the limits, and without them one metre and one radian."""
        width = self.high - self.low
        object.__setattr__(self, "range", np.where(np.isfinite(width), width, 1.0))

    def nearest(self) -> Floats:
        """Entries with the point as near as they allow, even if the linkage no longer turns."""
        at, place = self.before, self._placed(self.before[None])[0]
        for _ in range(_STEPS):
            if np.hypot(*(self.place - place)) < _NEAR * self.size:
                break
            better = self._improved(at, place, self._step(at, place))
            if better is None:
                break
            at, place = better
        return at

    def _step(self, at: Floats, place: Floats) -> Floats:
        """The smallest step to the place, without entries that would violate their limits."""
        pull, is_free = self._slopes(at, place) * self.range, np.ones(len(at), dtype=bool)
        while True:
            step: Floats = self.range * np.linalg.lstsq(pull * is_free, self.place - place, rcond=1e-6)[0]
            is_pressed = is_free & (((at >= self.high) & (step > 0)) | ((at <= self.low) & (step < 0)))
            if not is_pressed.any():
                return step
            is_free &= ~is_pressed

    def _slopes(self, at: Floats, place: Floats) -> Floats:
        """Derivatives of the point by the entries, (2, n); by a secant where an entry has no exact one."""
        machine = self.moved(at)
        exact = directions(machine, self.free)
        slopes = np.zeros((2, len(at)))
        if self.point in self.machine.mechanism.points:
            slopes[:] = [
                [address == f"mechanism.points.{self.point}.{axis}" for address in self.free] for axis in "xy"
            ]
            return slopes
        if exact.variables:
            angles = np.array([self.angle])
            along: Any = kinematics_along(machine, angles, exact.values).points[self.point].position
            slopes[:, [self.free.index(name) for name in exact.variables]] = along.d[0]
        for n, address in enumerate(self.free):
            if address in exact.refused:
                probe = at + _PROBE * self.size * np.eye(len(at))[n]
                slopes[:, n] = (self._placed(probe[None])[0] - place) / (_PROBE * self.size)
        return np.where(np.isfinite(slopes), slopes, 0.0)

    def _improved(self, at: Floats, place: Floats, step: Floats) -> tuple[Floats, Floats] | None:
        """The first of ever shorter steps that brings the point nearer."""
        shares = 0.5 ** np.arange(_SHARES)
        tried = np.clip(at + shares[:, None] * step, self.low, self.high)
        places = self._placed(tried)
        away = np.hypot(*(places - self.place).T)
        nearer = np.flatnonzero(away < np.hypot(*(place - self.place)))
        return (tried[nearer[0]], places[nearer[0]]) if len(nearer) else None

    def _placed(self, rows: Floats) -> Floats:
        """Where the point is at the crank angle, a row each; NaN where the linkage does not close."""
        if self.point in self.machine.mechanism.points:
            return self._fixed(rows)
        batch = replace(self.machine, {address: rows[:, n] for n, address in enumerate(self.free)})
        placed: Floats = motions(batch, [self.angle], points=[self.point])[:, :2, 0]
        return placed

    def _fixed(self, rows: Floats) -> Floats:
        own = self.machine.mechanism.points[self.point]
        fixed = np.tile(np.array([float(own.x), float(own.y)]), (len(rows), 1))
        for n, address in enumerate(self.free):
            for column, axis in enumerate("xy"):
                if address == f"mechanism.points.{self.point}.{axis}":
                    fixed[:, column] = rows[:, n]
        return fixed

    def moved(self, row: Floats) -> Machine:
        return replace(self.machine, dict(zip(self.free, map(float, row), strict=True)))

    def stopped(self, wanted: Floats) -> Drag:
        reason, ranges = self._obstacle(wanted)
        if not reason:
            return Drag(self._entries(wanted), self._out_of_reach(wanted))
        low, high = self.before, wanted
        within = self.closed.ranges
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            stops, moving = self._obstacle(middle)
            if stops:
                high, reason, ranges = middle, stops, moving
            else:
                low, within = middle, moving
        return Drag(self._entries(low), reason, self._limit(within, ranges))

    def _limit(self, within: Ranges, beyond: Ranges) -> float | None:
        """Crank angle in the middle of the widest gap just beyond the limit, or of the last range before."""
        if not beyond:
            return None if self.closed.turns_fully or not within else float(np.mean(within[0]))
        starts = [low for low, _ in beyond[1:]] + [beyond[0][0] + 2 * np.pi]
        width, end = max((start - end, end) for (_, end), start in zip(beyond, starts, strict=True))
        return float((end + 0.5 * width) % (2 * np.pi))

    def _out_of_reach(self, wanted: Floats) -> str:
        """What holds the point where the entries cannot reach the place."""
        place = self._placed(wanted[None])[0]
        away, size = float(np.hypot(*(place - self.place))), float(np.hypot(*self.place)) or 1.0
        if not math.isfinite(away) or away < _SEEN * size:
            return ""
        is_held = (wanted <= self.low) | (wanted >= self.high)
        if is_held.any():
            held = [name for name, is_it in zip(self.free, is_held, strict=True) if is_it]
            return "at the limits of " + ", ".join(".".join(split(name)[-2:]) for name in held)
        names = " and ".join(split(entry)[-1] for entry in self.free)
        return f"{self.point} moves with {names} alone"

    def _obstacle(self, row: Floats) -> tuple[str, Ranges]:
        """Why the linkage with these entries does not move as the one before, and where it closes."""
        try:
            machine = self.moved(row)
            closed = closure(machine)
        except LinkwrightError as error:
            return str(error), ()
        moves = closed.turns_fully or (bool(closed.ranges) and not self.closed.turns_fully)
        return "" if moves else str(closure_error(closed, machine)), closed.ranges

    def worth(self, entries: Mapping[str, float], pixel: float) -> dict[str, tuple[float, float]]:
        at = np.array([entries[name] for name in self.free])
        slopes = np.hypot(*self._slopes(at, self._placed(at[None])[0]))
        pairs = zip(self.free, slopes, self.before, strict=True)
        return {name: (pixel / float(slope), float(start)) for name, slope, start in pairs if slope > 0}

    def _entries(self, row: Floats) -> dict[str, float]:
        return {address: float(short(value)) for address, value in zip(self.free, row, strict=True)}
