"""The distance of two curves by very many samples and a tree: slow, and nothing of the product in it."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from cam_outlines import Cam
from numpy.typing import NDArray
from scipy.spatial import cKDTree

Floats = NDArray[np.float64]


def samples(cam: Cam, n: int) -> Floats:
    """Places of a cam at equal steps and at its breaks, once round, (m, 2)."""
    phi = np.unique(np.concatenate([np.linspace(0, 2 * math.pi, n), cam.breaks]))
    return cam.points(phi[:-1])


def distances(places: Floats, polygon: Floats) -> Floats:
    """Distance of places from a closed polygon of short sides: from both sides at its nearest corner."""
    _, i = cKDTree(polygon).query(places)
    n = len(polygon)
    return np.minimum(
        _from_segment(places, polygon[i - 1], polygon[i]),
        _from_segment(places, polygon[i], polygon[(i + 1) % n]),
    )


def _from_segment(p: Floats, a: Floats, b: Floats) -> Floats:
    v = b - a
    u = np.clip(((p - a) * v).sum(axis=1) / (v**2).sum(axis=1), 0, 1)
    return np.linalg.norm(p - a - u[:, None] * v, axis=1)


def quadrature(cam: Cam, integrand: Callable[[Floats, Floats], Floats]) -> float:
    """∫ f(p, p′) dφ over the revolution, by Gauss–Legendre on eight parts of each stretch."""
    x, w = np.polynomial.legendre.leggauss(40)
    total = 0.0
    for a, b in zip(cam.breaks, cam.breaks[1:], strict=False):
        for low, high in zip(*(np.linspace(a, b, 9)[k : 8 + k] for k in (0, 1)), strict=True):
            phi = 0.5 * (low + high) + 0.5 * (high - low) * x
            total += 0.5 * (high - low) * float(w @ integrand(cam.points(phi), cam.tangents(phi)))
    return total


def area(cam: Cam) -> float:
    """½ ∫ (x y′ − y x′) dφ."""
    return quadrature(cam, lambda p, t: 0.5 * (p[:, 0] * t[:, 1] - p[:, 1] * t[:, 0]))


def length(cam: Cam) -> float:
    """∫ |p′| dφ."""
    return quadrature(cam, lambda p, t: np.linalg.norm(t, axis=1))
