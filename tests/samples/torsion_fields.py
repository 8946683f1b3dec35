"""Torsion solved as a field: bodies of revolution, and prisms of any section.

A body of revolution twists by ψ(r, z) with ∇·(r³∇ψ) = 0 (Michell, Föppl); the torque for ψ from 0 to 1 is
2πG ∫ r³ |∇ψ|². A prism has the torsion constant 2∫φ with ∇²φ = −2, φ = 0 outside and level over a bore
(Prandtl). Lengths are over the radius of the shaft unless said otherwise.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from plane_elements import Floats, Mesh, Region, apart, graded, grid, solved

# Length of shaft beside a step, after which sections are plane again to e⁻¹⁵.
_LONG = 3.0


def _stiffness(mesh: Mesh, held: NDArray[np.bool_], turned: NDArray[np.bool_]) -> float:
    """Torque over twist, with G = 1."""
    K, load = mesh.matrices(lambda at: at[:, 0] ** 3)
    psi = solved(K, 0 * load, held | turned, turned.astype(float))
    return float(2 * np.pi * psi @ (K @ psi))


def _polar(outer: float, inner: float = 0.0) -> float:
    return np.pi / 2 * (outer**4 - inner**4)


def _radii(bore: float, outer: float, first: float) -> Floats:
    """Places along the radius, close at r = 1."""
    return np.concatenate([np.abs(1 - graded(1 - bore, first)[::-1]), 1 + graded(outer - 1, first)[1:]])


def _with_fillet(points: Floats, fillet: float, first: float) -> Floats:
    """Points with those of a fillet in the corner at r = 1, z = 0."""
    if fillet == 0:
        return points
    t = np.linspace(0, np.pi / 2, max(12, int(2 * fillet / first)))
    arc = np.column_stack([1 + fillet * (1 - np.cos(t)), fillet * (1 - np.sin(t))])
    n = max(8, int(fillet / first))
    corner = grid(np.linspace(1, 1 + fillet, n), np.linspace(0, fillet, n))
    inside = np.hypot(corner[:, 0] - 1 - fillet, corner[:, 1] - fillet) > fillet + 0.3 * first
    return np.vstack([points, arc, corner[inside]])


def _shoulder(fillet: float) -> Region:
    """The shaft above z = 0, whatever lies below, and the fillet between them."""

    def region(at: Floats) -> NDArray[np.bool_]:
        r, z = at.T
        rounded = (r < 1 + fillet) & (z < fillet) & (np.hypot(r - 1 - fillet, z - fillet) > fillet)
        return (z < 0) | (r < 1) | rounded

    return region


def step_length(ratio: float, fillet: float = 0.0, bore: float = 0.0, first: float = 0.01) -> float:
    """Length over the thinner diameter that a step to `ratio` times the diameter adds."""
    deep = 3 * min(ratio, 4.0)
    z = np.concatenate([-graded(deep, first)[::-1], graded(_LONG, first)[1:]])
    points = grid(_radii(bore, ratio, first), z)
    points = points[(points[:, 1] <= 1e-12) | (points[:, 0] <= 1 + 1e-12)]
    mesh = Mesh(_with_fillet(points, fillet, first), _shoulder(fillet))
    z = mesh.nodes[:, 1]
    k = _stiffness(mesh, z < -deep + 1e-9, z > _LONG - 1e-9)
    return (1 / k - _LONG / _polar(1, bore) - deep / _polar(ratio, bore)) * _polar(1, bore) / 2


def flange_flexibility(
    thickness: float, circle: float, bore: float = 0.0, fillet: float = 0.0, first: float = 0.015
) -> float:
    """Twist per torque, with G = 1, from a shaft's end to the circle where its flange is held."""
    half = graded(thickness / 2, first)
    z = np.concatenate([-half, half - thickness, graded(_LONG, first)])
    points = grid(_radii(bore, circle, first), z)
    points = points[(points[:, 1] <= 1e-12) | (points[:, 0] <= 1 + 1e-12)]
    mesh = Mesh(_with_fillet(points, fillet, first), _shoulder(fillet))
    r, z = mesh.nodes.T
    k = _stiffness(mesh, (r > circle - 1e-9) & (z < 1e-9), z > _LONG - 1e-9)
    return 1 / k - _LONG / _polar(1, bore)


def _torsion_constant(outline: Floats, inside: Region, size: float, bore: float) -> float:
    """Of a prism of radius 1, over that of a circle."""
    n = int(2.1 / size)
    cloud = grid(np.linspace(-1.05, 1.05, n), np.linspace(-1.05, 1.05, n))
    cloud = apart(cloud[inside(cloud)], outline, 0.6 * size)
    points = [outline, cloud]
    if bore:
        t = np.arange(0, 2 * np.pi, size / 2 / bore)
        ring = bore * np.column_stack([np.cos(t), np.sin(t)])
        points = [outline, apart(cloud, ring, 0.5 * size), ring]
    mesh = Mesh(np.vstack(points), inside)
    # A level field over the bore: there it resists as good as infinitely.
    K, load = mesh.matrices(lambda at: np.where(np.hypot(*at.T) < bore, 1e7, 1.0))
    phi = solved(K, 2 * load, mesh.outer, np.zeros(len(load)))
    return float(2 * phi @ load / _polar(1))


def _line(start: tuple[float, float], end: tuple[float, float], size: float) -> Floats:
    n = max(3, int(np.hypot(end[0] - start[0], end[1] - start[1]) / size))
    return np.array(start) + np.linspace(0, 1, n, endpoint=False)[:, None] * (np.array(end) - start)


def keyed_constant(
    width: float, depth: float, keyways: int = 1, bore: float = 0.0, size: float = 0.04
) -> float:
    """Torsion constant of a shaft with keyways, sizes over the diameter, over that of the circle."""
    y, bottom = width, 1 - 2 * depth
    edge = np.sqrt(1 - y * y)

    def cut(at: Floats) -> NDArray[np.bool_]:
        x = np.abs(at[:, 0]) if keyways == 2 else at[:, 0]
        return (np.abs(at[:, 1]) < y) & (x > bottom)

    corners = [(edge, -y), (bottom, -y), (bottom, y), (edge, y)]
    walls = [_line(a, b, size / 2) for a, b in pairwise(corners)]
    slot = np.vstack([*walls, corners[-1:]])
    slots = np.vstack([slot, -slot]) if keyways == 2 else slot
    t = np.arange(0, 2 * np.pi, size / 2)
    circle = np.column_stack([np.cos(t), np.sin(t)])
    circle = apart(circle[~cut(circle)], slots, size / 6)
    return _torsion_constant(
        np.vstack([circle, slots]), lambda at: (np.hypot(*at.T) < 1) & ~cut(at), size, bore
    )


def spline_constant(teeth: int, root: float, tooth: float, size: float = 0.04) -> float:
    """Torsion constant of a shaft with straight teeth, sizes over the outside diameter, over the circle's."""
    pitch, half = 2 * np.pi / teeth, tooth

    def inside(at: Floats) -> NDArray[np.bool_]:
        r, t = np.hypot(*at.T), np.arctan2(at[:, 1], at[:, 0])
        t = t - np.round(t / pitch) * pitch
        return (r < root) | ((r < 1) & (np.abs(r * np.sin(t)) < half))

    low, high = np.sqrt(root**2 - half**2), np.sqrt(1 - half**2)
    on_root, on_tip = np.arcsin(half / root), np.arcsin(half)
    tip = np.linspace(-on_tip, on_tip, max(3, int(4 * on_tip / size)), endpoint=False)
    gap = np.linspace(on_root, pitch - on_root, max(3, int(2 * (pitch - 2 * on_root) / size)), endpoint=False)
    one = np.vstack(
        [
            _line((low, -half), (high, -half), size / 2),
            np.column_stack([np.cos(tip), np.sin(tip)]),
            _line((high, half), (low, half), size / 2),
            root * np.column_stack([np.cos(gap), np.sin(gap)]),
        ]
    )
    turns = [np.array([[np.cos(a), np.sin(a)], [-np.sin(a), np.cos(a)]]) for a in pitch * np.arange(teeth)]
    return _torsion_constant(np.vstack([one @ turn for turn in turns]), inside, size, 0.0)
