"""Quadratic triangles for ∇·(w ∇u) + q = 0 in a plane: an independent solver of the equations of torsion.

Points come as a cloud with the boundary among them; triangles of Delaunay with their middle outside are left
out.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import spsolve
from scipy.spatial import Delaunay, cKDTree

Floats = NDArray[np.float64]
Region = Callable[[Floats], NDArray[np.bool_]]

# Rule of degree 5 on a triangle (Radon): places as area coordinates, weights.
_A, _B = (6 + np.sqrt(15)) / 21, (6 - np.sqrt(15)) / 21
_PLACES = np.array(
    [[1 / 3] * 3, *(np.roll([1 - 2 * a, a, a], n) for a in (_A, _B) for n in range(3))], dtype=np.float64
)
_WEIGHTS = np.array([9 / 40, *[(155 + np.sqrt(15)) / 1200] * 3, *[(155 - np.sqrt(15)) / 1200] * 3])
_EDGES = ((0, 1), (1, 2), (2, 0))


class Mesh:
    """Triangles with nodes in their corners and in the middle of their sides."""

    def __init__(self, points: Floats, region: Region) -> None:
        points = np.unique(np.round(points, 10), axis=0)
        triangles = Delaunay(points).simplices
        triangles = triangles[region(points[triangles].mean(axis=1))]
        a, b = (points[triangles[:, n]] - points[triangles[:, 0]] for n in (1, 2))
        triangles = triangles[np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) > 1e-13]
        sides = np.sort(np.vstack([triangles[:, edge] for edge in _EDGES]), axis=1)
        unique, place, count = np.unique(sides, axis=0, return_inverse=True, return_counts=True)
        self.corners = points[triangles]
        self.nodes = np.vstack([points, points[unique].mean(axis=1)])
        self.members = np.hstack([triangles, len(points) + place.reshape(3, -1).T])
        self.outer = np.zeros(len(self.nodes), bool)
        self.outer[unique[count == 1].ravel()] = True
        self.outer[len(points) + np.flatnonzero(count == 1)] = True

    def matrices(self, weight: Callable[[Floats], Floats]) -> tuple[csr_matrix, Floats]:
        """The matrix of ∫ w ∇u·∇v, and ∫ v."""
        x = self.corners
        J = np.stack([x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]], axis=2)
        area, inverse = np.abs(np.linalg.det(J)) / 2, np.linalg.inv(J)
        flat = np.stack([-inverse.sum(axis=1), inverse[:, 0], inverse[:, 1]], axis=1)
        K = np.zeros((len(x), 6, 6))
        for place, share in zip(_PLACES, _WEIGHTS, strict=True):
            corner = (4 * place - 1)[:, None] * flat
            middle = [4 * (place[i] * flat[:, j] + place[j] * flat[:, i]) for i, j in _EDGES]
            g = np.concatenate([corner, np.stack(middle, axis=1)], axis=1)
            at = np.einsum("i,mia->ma", place, x)
            K += (share * area * weight(at))[:, None, None] * np.einsum("mia,mja->mij", g, g)
        n, members = len(self.nodes), self.members
        rows, columns = np.repeat(members, 6, axis=1).ravel(), np.tile(members, (1, 6)).ravel()
        load = np.bincount(members[:, 3:].ravel(), np.repeat(area / 3, 3), n)
        return csr_matrix((K.ravel(), (rows, columns)), shape=(n, n)), load


def solved(K: csr_matrix, load: Floats, known: NDArray[np.bool_], values: Floats) -> Floats:
    free = ~known & (K.diagonal() > 0)
    u = np.where(known, values, 0.0)
    u[free] = spsolve(K[free][:, free].tocsc(), load[free] - K[free] @ u)
    return u


def graded(length: float, first: float, largest: float = 0.2) -> Floats:
    """Places from 0 to a length, close to each other at 0 and wider away from it."""
    places, step = [0.0], first
    while places[-1] < length:
        places.append(places[-1] + step)
        step = min(1.25 * step, largest)
    return np.array(places) * length / places[-1]


def grid(x: Floats, y: Floats) -> Floats:
    return np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)


def apart(points: Floats, others: Floats, distance: float) -> Floats:
    """Those points that lie at least so far from all others."""
    near, _ = cKDTree(others).query(points)
    return points[near > distance]
