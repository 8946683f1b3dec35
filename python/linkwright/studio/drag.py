"""Drag a joint: which lengths bring a point to a place, and where the linkage no longer closes.

The entries e of a handle are moved so that the point comes as near to the place as they allow, at the crank
angle of the drawing,

    min |p(e; φ) − p₀|²,

by secant steps that are accepted on positions alone: what is returned is the entries, and the machine that is
computed from them has no trace of how they were found. A linkage that turned over the whole revolution before
the drag still does after it: beyond, the entries stop on the straight way from where the drag began.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import LinkwrightError
from linkwright.linkages.closure import closure, closure_error
from linkwright.linkages.kinematics import motions
from linkwright.machine.address import get, replace
from linkwright.machine.machine import Machine
from linkwright.studio.document import short
from linkwright.studio.drawing import entries_of

# Steps to the place: more change nothing that is seen.
_STEPS = 8

# Ever shorter steps that are tried at once: one of them closes, however far away the pointer is.
_SHARES = 16

# Part of the drawing's size, or of a radian, by which entries are moved to learn what they do, and distance
# at which the point is there.
_PROBE = 1e-6
_NEAR = 1e-9

# Smallest size of a length over that of the drawing: shorter links cannot be caught again.
_SHORTEST = 1e-3

# Halvings on the way to the limit: a share of it that is below a pixel.
_HALVINGS = 13


@dataclass(frozen=True)
class Drag:
    """Where a drag leads."""

    entries: dict[str, float]  # address → SI value
    reason: str = ""  # why it stops before the place; empty if it does not


def drag(
    machine: Machine,
    point: str,
    place: tuple[float, float],
    angle: float,
    locked: frozenset[str] = frozenset(),
) -> Drag:
    """The entries that bring a point to a place [m], and why they stop.

    `machine`: as it was when the drag began; `angle`: of the crank in the drawing [rad]; `locked`: addresses
    that hold their values.
    """
    free = [entry for entry in entries_of(machine, point) if entry not in locked]
    if not free:
        return Drag({}, f"all entries of {point} are locked")
    before = np.array([float(get(machine, entry)) for entry in free])
    search = _Search(machine, point, np.array(place), angle, free, before, closure(machine).turns_fully)
    return search.stopped(search.nearest())


@dataclass(frozen=True)
class _Search:
    """The entries of one drag."""

    machine: Machine
    point: str
    place: Floats
    angle: float
    free: list[str]
    before: Floats
    turned: bool

    def nearest(self) -> Floats:
        """Entries with the point as near as they allow, whether or not the linkage still turns."""
        at, place = self.before, self._placed(self.before[None])[0]
        size = float(np.hypot(*self.place)) + float(np.abs(self.before).max()) or 1.0
        for _ in range(_STEPS):
            if np.hypot(*(self.place - place)) < _NEAR * size:
                break
            moved = at + _PROBE * size * np.eye(len(at))
            slopes = (self._placed(moved) - place).T / (_PROBE * size)
            step = np.linalg.lstsq(slopes, self.place - place, rcond=1e-6)[0]
            better = self._improved(at, place, step, size)
            if better is None:
                break
            at, place = better
        return at

    def _improved(self, at: Floats, place: Floats, step: Floats, size: float) -> tuple[Floats, Floats] | None:
        """The first of ever shorter steps that brings the point nearer."""
        shares = 0.5 ** np.arange(_SHARES)
        tried = self._allowed(at + shares[:, None] * step, size)
        places = self._placed(tried)
        away = np.hypot(*(places - self.place).T)
        nearer = np.flatnonzero(away < np.hypot(*(place - self.place)))
        return (tried[nearer[0]], places[nearer[0]]) if len(nearer) else None

    def _allowed(self, rows: Floats, size: float) -> Floats:
        """Rows with lengths of links kept positive."""
        for n, address in enumerate(self.free):
            if address.rsplit(".", 1)[-1] in ("radius", "rod", "coupler", "rocker", "length"):
                rows[:, n] = np.maximum(rows[:, n], _SHORTEST * size)
        return rows

    def _placed(self, rows: Floats) -> Floats:
        """Where the point is at the crank angle, a row each; NaN where the linkage does not close."""
        if self.point in self.machine.mechanism.points:
            return self._fixed(rows)
        batch = replace(self.machine, {address: rows[:, n] for n, address in enumerate(self.free)})
        placed: Floats = motions(batch, [self.angle], points=[self.point])[:, :2, 0]
        return placed

    def _fixed(self, rows: Floats) -> Floats:
        """A fixed point is where its entries say."""
        own = self.machine.mechanism.points[self.point]
        fixed = np.tile(np.array([float(own.x), float(own.y)]), (len(rows), 1))
        for n, address in enumerate(self.free):
            fixed[:, 0 if address.endswith(".x") else 1] = rows[:, n]
        return fixed

    def moved(self, row: Floats) -> Machine:
        """The machine with other entries."""
        return replace(self.machine, dict(zip(self.free, map(float, row), strict=True)))

    def stopped(self, wanted: Floats) -> Drag:
        """The wanted entries, or those at the limit of the linkage."""
        short_of = self._reason(wanted)
        if not short_of:
            return Drag(self._entries(wanted), self._out_of_reach(wanted))
        low, high = 0.0, 1.0
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            reason = self._reason(self.before + middle * (wanted - self.before))
            low, high = (low, middle) if reason else (middle, high)
            short_of = reason or short_of
        return Drag(self._entries(self.before + low * (wanted - self.before)), short_of)

    def _out_of_reach(self, wanted: Floats) -> str:
        """What holds the point, where the entries do not lead to the place."""
        place = self._placed(wanted[None])[0]
        away, size = float(np.hypot(*(place - self.place))), float(np.hypot(*self.place)) or 1.0
        if not math.isfinite(away) or away < 1e-3 * size:
            return ""
        names = " and ".join(entry.rsplit(".", 1)[-1] for entry in self.free)
        return f"{self.point} moves with {names} alone"

    def _reason(self, row: Floats) -> str:
        """Why the linkage with these entries does not move as the one before; empty if it does."""
        try:
            machine = self.moved(row)
            closed = closure(machine)
        except LinkwrightError as error:
            return str(error)
        if closed.turns_fully or not self.turned:
            return "" if closed.ranges else str(closure_error(closed, machine))
        return str(closure_error(closed, machine))

    def _entries(self, row: Floats) -> dict[str, float]:
        """Entries with the digits that the file will have."""
        return {address: float(short(value)) for address, value in zip(self.free, row, strict=True)}
