"""A closed outline of arcs and lines, by vertices and bulges as drawings keep it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from linkwright.cam.manufacture.sides import Sides, angle_between, cross

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Outline:
    """Arcs and lines, one after the other and back to the start.

    Attributes
    ----------
    vertices : ndarray, shape (n, 2)
        Where they begin [m].
    bulges : ndarray, shape (n,)
        tan(θ/4) of each, where θ is the angle that it turns; zero for a line.
    """

    vertices: Floats
    bulges: Floats

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

    def at(self, which: NDArray[np.intp], u: Floats) -> Floats:
        """Places on sides.

        Parameters
        ----------
        which : ndarray, shape (k,)
            Numbers of the sides.
        u : ndarray, shape (k, m)
            How far along each, from 0 to 1.

        Returns
        -------
        ndarray, shape (k, m, 2)
            [m].
        """
        return self.sides.chosen(which).at(u)

    def distances(self, which: NDArray[np.intp], places: Floats) -> Floats:
        """Distance of places from sides.

        Parameters
        ----------
        which : ndarray, shape (k,)
            Numbers of the sides.
        places : ndarray, shape (k, m, 2)
            For each side its places [m].

        Returns
        -------
        ndarray, shape (k, m)
            [m].
        """
        return self.sides.chosen(which).distances(places)
