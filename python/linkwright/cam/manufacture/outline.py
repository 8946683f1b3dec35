"""Closed outlines of arcs and lines, by vertices and bulges as drawings keep them.

The bulge is b = tan(θ/4), where θ is the angle that the arc turns, positive to the left; a line
has none. With the chord c, the arc has the length c θ/(2 sin(θ/2)) and the curvature 2 sin(θ/2)/c.

Source: Autodesk, *DXF Reference*, LWPOLYLINE, group code 42.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from linkwright.kernel.arrays import Floats, Indices

# Below this angle the area between arc and chord is taken from its series, which then errs by 3e-12 of it
# [rad].
_SMALL = 1e-2


@dataclass(frozen=True)
class Sides:
    """Arcs and lines."""

    starts: Floats  # (n, 2): where they begin [m]
    chords: Floats  # (n, 2): from there to their ends [m]
    bulges: Floats  # (n,): tan(θ/4) of each

    @property
    def turns(self) -> Floats:
        """The angle that each turns, (n,) [rad]."""
        return np.asarray(4 * np.arctan(self.bulges))

    @property
    def lengths(self) -> Floats:
        """Their lengths, (n,) [m]."""
        # sinc(x/π) = sin x / x, with its limit for lines.
        return np.asarray(np.linalg.norm(self.chords, axis=1) / np.sinc(self.turns / (2 * np.pi)))

    @property
    def areas(self) -> Floats:
        """Area between each and its chord, positive right of it, (n,) [m²]: c²(θ − sin θ)/(8 sin²(θ/2))."""
        turn = self.turns
        small = np.abs(turn) < _SMALL
        safe = np.where(small, 1.0, turn)
        series = turn / 12 * (1 + turn**2 / 30)
        share = np.where(small, series, (safe - np.sin(safe)) / (8 * np.sin(0.5 * safe) ** 2))
        return np.asarray(share * (self.chords**2).sum(axis=1))

    @property
    def along(self) -> Floats:
        """Unit vectors of the chords, (n, 2); of a chord without length the x axis."""
        length = np.linalg.norm(self.chords, axis=1, keepdims=True)
        return np.asarray(np.where(length > 0, self.chords / np.where(length > 0, length, 1), [1.0, 0.0]))

    @property
    def start_directions(self) -> Floats:
        """Unit tangents where each begins, (n, 2)."""
        return turned(self.along, -0.5 * self.turns)

    @property
    def end_directions(self) -> Floats:
        """Unit tangents where each ends, (n, 2)."""
        return turned(self.along, 0.5 * self.turns)

    def chosen(self, which: Indices) -> Sides:
        """Some of them, by number."""
        return Sides(self.starts[which], self.chords[which], self.bulges[which])

    def at(self, u: Floats) -> Floats:
        """Places on them. ``u`` (n, m): how far along each, from 0 to 1 → [m], (n, m, 2)."""
        turn = self.turns[:, None]
        # The chord to the place at u is turned by −θ(1 − u)/2 from the whole chord, and sin(uθ/2)/sin(θ/2) of
        # it.
        share = u * np.sinc(u * turn / (2 * np.pi)) / np.sinc(turn / (2 * np.pi))
        chord = turned(self.chords[:, None], -0.5 * turn * (1 - u))
        return np.asarray(self.starts[:, None] + share[..., None] * chord)

    def distances(self, places: Floats) -> Floats:
        """Distances [m] of ``places`` (n, m, 2) from the sides: to the arc, or to its nearer end."""
        from_start = places - self.starts[:, None]
        from_end = from_start - self.chords[:, None]
        after_start = dot(from_start, self.start_directions[:, None]) >= 0
        before_end = dot(from_end, self.end_directions[:, None]) <= 0
        # Beyond half a revolution the sector is what at least one of the half planes holds.
        short = np.abs(self.bulges[:, None]) <= 1
        beside = np.where(short, after_start & before_end, after_start | before_end)
        to_ends = np.minimum(np.linalg.norm(from_start, axis=-1), np.linalg.norm(from_end, axis=-1))
        return np.asarray(np.where(beside, self._off_circle(from_start), to_ends))

    def _off_circle(self, place: Floats) -> Floats:
        """Distance of places, counted from the starts, from the whole circles; for lines without loss too."""
        # With the unit normal n at its start and the curvature κ, a circle is F(p) = κ p·p/2 − p·n = 0; the
        # distance is |2F/(1 + √(1 + 2κF))|.
        length = np.linalg.norm(self.chords, axis=1)
        curvature = (2 * np.sin(0.5 * self.turns) / np.where(length > 0, length, 1.0))[:, None]
        normal = turned(self.start_directions, np.full(len(length), 0.5 * np.pi))
        value = 0.5 * curvature * dot(place, place) - dot(place, normal[:, None])
        return np.asarray(np.abs(2 * value / (1 + np.sqrt(np.maximum(1 + 2 * curvature * value, 0)))))


def dot(a: Floats, b: Floats) -> Floats:
    """Scalar products of the last axes."""
    return np.asarray((a * b).sum(axis=-1))


def cross(a: Floats, b: Floats) -> Floats:
    """Plane cross products of the last axes."""
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])


def angle_between(a: Floats, b: Floats) -> Floats:
    """Angles from vectors to others, positive to the left [rad]."""
    return np.asarray(np.arctan2(cross(a, b), dot(a, b)))


def turned(vector: Floats, angle: Floats) -> Floats:
    """Vectors turned to the left by angles [rad]."""
    cos, sin = np.cos(angle), np.sin(angle)
    x, y = vector[..., 0], vector[..., 1]
    return np.stack([cos * x - sin * y, sin * x + cos * y], axis=-1)


@dataclass(frozen=True)
class Outline:
    """Arcs and lines, one after the other and back to the start."""

    vertices: Floats  # (n, 2): where they begin [m]
    bulges: Floats  # (n,): tan(θ/4) of each, where θ is the angle that it turns; zero for a line

    @cached_property
    def sides(self) -> Sides:
        """The arcs and lines."""
        chords = np.roll(self.vertices, -1, axis=0) - self.vertices
        return Sides(self.vertices, chords, self.bulges)

    @property
    def length(self) -> float:
        """Of the whole outline [m]."""
        return float(self.sides.lengths.sum())

    @property
    def area(self) -> float:
        """Enclosed area, positive if the outline runs counter-clockwise [m²]."""
        polygon = 0.5 * cross(self.vertices, np.roll(self.vertices, -1, axis=0)).sum()
        return float(polygon + self.sides.areas.sum())

    @property
    def kinks(self) -> Floats:
        """By how much the direction jumps where each side begins, (n,) [rad]."""
        before = np.roll(self.sides.end_directions, 1, axis=0)
        return angle_between(before, self.sides.start_directions)

    def at(self, which: Indices, u: Floats) -> Floats:
        """Places [m], (k, m, 2), on sides ``which`` (k,) at shares ``u`` (k, m) of their length."""
        return self.sides.chosen(which).at(u)

    def distances(self, which: Indices, places: Floats) -> Floats:
        """Distances [m], (k, m), of ``places`` (k, m, 2) from the sides ``which`` (k,)."""
        return self.sides.chosen(which).distances(places)
