"""Lines, arcs and splines of a drawing, as smooth functions of one parameter from 0 to 1.

Each is cut into spans, over which Gauss's rule of 16 points integrates what Green's theorem asks for: exactly
on lines and on splines up to degree 8, within rounding on arcs of 45°.

Source of the forms: Autodesk, *DXF Reference*, ENTITIES; of rational splines: Piegl and Tiller, *The NURBS
Book*, chapter 4.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats

# Angle of a span of an arc [rad].
_SPAN = math.pi / 4


@dataclass(frozen=True)
class Line:
    """A straight line."""

    start: Floats  # (2,)
    end: Floats

    @property
    def cuts(self) -> Floats:
        """Parameters between which it is smooth."""
        return np.array([0.0, 1.0])

    def at(self, u: Floats) -> tuple[Floats, Floats]:
        """Places and derivatives by the parameter, (n, 2) each."""
        chord = self.end - self.start
        return self.start + u[:, None] * chord, np.broadcast_to(chord, (len(u), 2))


@dataclass(frozen=True)
class Arc:
    """An arc of an ellipse, c + a cos t + b sin t; of a circle if a and b are equal in size."""

    centre: Floats  # (2,)
    a: Floats  # semi-axes, or any two conjugate radii, (2,)
    b: Floats
    first: float  # t where it begins [rad]
    sweep: float  # by how much t grows [rad]

    @property
    def cuts(self) -> Floats:
        """Parameters between which it is integrated."""
        return np.linspace(0.0, 1.0, math.ceil(abs(self.sweep) / _SPAN) + 1)

    @property
    def start(self) -> Floats:
        """Where it begins, (2,)."""
        return _place(self, 0.0)

    @property
    def end(self) -> Floats:
        """Where it ends, (2,)."""
        return _place(self, 1.0)

    @property
    def is_closed(self) -> bool:
        """Whether it is a whole circle or ellipse."""
        return abs(self.sweep) >= 2 * math.pi * (1 - 1e-12)

    @property
    def radius(self) -> float | None:
        """Of a circle; None for an ellipse."""
        one, other = math.hypot(*self.a), math.hypot(*self.b)
        return one if abs(one - other) <= 1e-9 * max(one, other) else None

    def at(self, u: Floats) -> tuple[Floats, Floats]:
        """Places and derivatives by the parameter, (n, 2) each."""
        t = self.first + self.sweep * u[:, None]
        cos, sin = np.cos(t), np.sin(t)
        return self.centre + self.a * cos + self.b * sin, self.sweep * (self.b * cos - self.a * sin)


@dataclass(frozen=True)
class Spline:
    """A rational B-spline."""

    degree: int
    knots: Floats  # (m,)
    controls: Floats  # (n, 2)
    weights: Floats  # (n,)

    @cached_property
    def domain(self) -> tuple[float, float]:
        """Parameters of the drawing where it begins and ends."""
        return float(self.knots[self.degree]), float(self.knots[-self.degree - 1])

    @property
    def cuts(self) -> Floats:
        """Parameters between which it is one polynomial, or one ratio of polynomials."""
        low, high = self.domain
        inside = np.unique(self.knots[(self.knots > low) & (self.knots < high)])
        return np.array([0.0, *((inside - low) / (high - low)), 1.0])

    @property
    def start(self) -> Floats:
        """Where it begins, (2,)."""
        return _place(self, 0.0)

    @property
    def end(self) -> Floats:
        """Where it ends, (2,)."""
        return _place(self, 1.0)

    @cached_property
    def _weighted(self) -> tuple[Any, Any]:
        """Weighted places with their weight, and the derivative of both."""
        from scipy.interpolate import BSpline

        values = np.column_stack([self.controls * self.weights[:, None], self.weights])
        spline = BSpline(self.knots, values, self.degree)
        return spline, spline.derivative()

    def at(self, u: Floats) -> tuple[Floats, Floats]:
        """Places and derivatives by the parameter, (n, 2) each."""
        low, high = self.domain
        spline, slope = self._weighted
        t = np.minimum(low + (high - low) * u, high)
        value, rate = spline(t), slope(t)
        place = value[:, :2] / value[:, 2:]
        return place, (high - low) * (rate[:, :2] - place * rate[:, 2:]) / value[:, 2:]


Curve = Line | Arc | Spline


def _place(curve: Curve, u: float) -> Floats:
    """Place at one parameter, (2,)."""
    place: Floats = curve.at(np.array([u]))[0][0]
    return place


def bulged(start: Floats, end: Floats, bulge: float) -> Curve:
    """The side of a polyline between two vertices: b = tan(θ/4), where θ is the angle of its arc."""
    if bulge == 0.0:
        return Line(start, end)
    chord = end - start
    normal = np.array([-chord[1], chord[0]])
    # From the middle of the chord the centre is c/2·cot(θ/2) to the left.
    centre = 0.5 * (start + end) + normal * (1 - bulge**2) / (4 * bulge)
    radius = start - centre
    return Arc(centre, radius, np.array([-radius[1], radius[0]]), 0.0, 4 * math.atan(bulge))


def circular(centre: Floats, radius: float, first: float, sweep: float, mirror: float = 1.0) -> Arc:
    """An arc of a circle; `mirror` −1: x counts to the other side, as in planes seen from behind."""
    return Arc(centre, np.array([mirror * radius, 0.0]), np.array([0.0, radius]), first, sweep)
