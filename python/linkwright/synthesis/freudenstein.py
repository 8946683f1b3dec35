"""Freudenstein's equation: four-bar linkages whose rocker angles ψ_i belong to crank angles φ_i.

    K₁ cos ψ − K₂ cos φ + K₃ = cos(φ − ψ)

    K₁ = g/r          K₂ = g/b          K₃ = (g² + r² + b² − c²)/(2 r b)

with frame g, crank r, coupler c, rocker b, and both angles from the frame's direction. With start angles φ₀,
ψ₀ given it is linear in K: three points are met exactly, more in the least-squares sense. Each start angle
left free is one more unknown and one more point that can be met exactly; the equations are then solved by the
method of Levenberg and Marquardt from a grid of start angles, all at once.

Source: F. Freudenstein, Approximate synthesis of four-bar linkages, Transactions of the ASME 77 (1955)
853–861.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from linkwright.kernel.arrays import Bools, Floats
from linkwright.kernel.numerics.least_squares import damped_step

# Start angles tried for each one that is free: every 15° where two are, every 2.5° where one is.
_GRID = {1: 144, 2: 24}

# Steps of Levenberg–Marquardt; from a good start it takes about ten.
_STEPS = 60

# A fit whose residual is smaller than this meets its points: cos of angles to rounding.
EXACT = 1e-11

# Start angles that agree to this [rad] are one solution, found from two places of the grid.
_SAME = 1e-6


@dataclass(frozen=True)
class Fit:
    """A solution of Freudenstein's equation."""

    K: Floats  # (3,): K₁, K₂, K₃ [–]
    # φ₀ and ψ₀ [rad].
    crank_start: float
    rocker_start: float
    residual: float  # root of the mean square of the equation's residuals [–]
    found_by: int = 1  # starts that ended there


def lengths(K: Floats, frame: float = 1.0) -> tuple[float, float, float] | None:
    """Crank, coupler and rocker of a solution.

    `K` (3,): K₁, K₂, K₃ [–]; `frame`: distance of the fixed pivots [m]. Returns: r, c, b [m]; r or b is
    negative where its link points against the angle that describes it. None if no such linkage exists.
    """
    if not np.isfinite(K).all() or min(abs(K[0]), abs(K[1])) < 1e-9:
        return None
    r, b = frame / K[0], frame / K[1]
    square = frame**2 + r**2 + b**2 - 2 * r * b * K[2]
    return (r, float(np.sqrt(square)), b) if square > 0 else None


def solve(
    crank: Floats, rocker: Floats, crank_start: float | None, rocker_start: float | None
) -> tuple[list[Fit], int]:
    """All solutions that are found for as many pairs of angles as there are unknowns.

    `crank`, `rocker` (n,): crank and rocker angles of the points, from their start angles [rad];
    `crank_start`, `rocker_start`: start angles from the frame [rad]; None where they are free. Returns: the
    distinct solutions, and how many starts there were.
    """
    free = np.array([crank_start is None, rocker_start is None])
    starts = _grid(crank_start, rocker_start)
    K = _linear(crank, rocker, starts)
    if free.any():
        K, starts = _positive(*_refined(crank, rocker, K, starts, free), free)
    residuals = residual(crank, rocker, K, starts)
    solutions = []
    for i in np.flatnonzero(residuals < EXACT):
        phi, psi = (float(np.angle(np.exp(1j * start))) for start in starts[i])
        solutions.append(Fit(K[i], phi, psi, float(residuals[i])))
    return _distinct(solutions), len(residuals)


def residual(crank: Floats, rocker: Floats, K: Floats, starts: Floats) -> Floats:
    """Root of the mean square of the residuals of linkages K (m, 3) with start angles (m, 2), (m,) [–]."""
    return np.asarray(np.sqrt(np.mean(_residuals(crank, rocker, K, starts)[0] ** 2, axis=1)))


def begins(
    crank: Floats, rocker: Floats, crank_start: float | None, rocker_start: float | None
) -> tuple[Floats, Floats]:
    """Where a search for something else than the minimum residual begins: all over, and at what has it.

    `crank`, `rocker` (n,): crank and rocker angles of the points, from their start angles [rad];
    `crank_start`, `rocker_start`: start angles from the frame [rad]; None where they are free. Returns: K (m,
    3) by linear least squares for start angles all round, then refined from there; the start angles (m, 2)
    [rad].
    """
    starts = _grid(crank_start, rocker_start)
    K = _linear(crank, rocker, starts)
    free = np.array([crank_start is None, rocker_start is None])
    if not free.any():
        return K, starts
    refined = _refined(crank, rocker, K, starts, free)
    K, starts = (np.concatenate(pair) for pair in zip((K, starts), refined, strict=True))
    return _positive(K, starts, free)


def _grid(crank_start: float | None, rocker_start: float | None) -> Floats:
    """Start angles to begin with, (m, 2)."""
    n = _GRID.get((crank_start is None) + (rocker_start is None), 1)
    turn = np.linspace(-np.pi, np.pi, n, endpoint=False)
    axes = [turn if start is None else np.array([start]) for start in (crank_start, rocker_start)]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 2)


def _columns(crank: Floats, rocker: Floats, starts: Floats) -> tuple[Floats, Floats]:
    """φ and ψ of all points for all starts, (m, n)."""
    return crank + starts[:, :1], rocker + starts[:, 1:]


def _linear(crank: Floats, rocker: Floats, starts: Floats) -> Floats:
    """K by linear least squares for given start angles, (m, 3)."""
    phi, psi = _columns(crank, rocker, starts)
    A = np.stack([np.cos(psi), -np.cos(phi), np.ones_like(phi)], axis=-1)
    return np.asarray(np.einsum("mkn,mn->mk", np.linalg.pinv(A), np.cos(phi - psi)))


def _residuals(crank: Floats, rocker: Floats, K: Floats, starts: Floats) -> tuple[Floats, Floats]:
    """Residuals (m, n) of the equation, and their derivatives by K₁, K₂, K₃, φ₀, ψ₀ (m, n, 5)."""
    phi, psi = _columns(crank, rocker, starts)
    K1, K2, K3 = (K[:, i : i + 1] for i in range(3))
    residual = K1 * np.cos(psi) - K2 * np.cos(phi) + K3 - np.cos(phi - psi)
    by_phi = K2 * np.sin(phi) + np.sin(phi - psi)
    by_psi = -K1 * np.sin(psi) - np.sin(phi - psi)
    columns = (np.cos(psi), -np.cos(phi), np.ones_like(phi), by_phi, by_psi)
    return residual, np.stack(columns, axis=-1)


def _refined(crank: Floats, rocker: Floats, K: Floats, starts: Floats, free: Bools) -> tuple[Floats, Floats]:
    """Levenberg–Marquardt from every start at once."""
    moving = np.concatenate([np.ones(3, dtype=bool), free])
    x = np.concatenate([K, starts], axis=1)
    damping = np.full(len(x), 1e-3)
    residual, J = _residuals(crank, rocker, x[:, :3], x[:, 3:])
    cost = np.sum(residual**2, axis=1)
    for _ in range(_STEPS):
        step = damped_step(residual, J[:, :, moving], damping)
        trial = x.copy()
        trial[:, moving] += step
        new, new_J = _residuals(crank, rocker, trial[:, :3], trial[:, 3:])
        new_cost = np.sum(new**2, axis=1)
        better = new_cost < cost
        x[better], residual[better], J[better], cost[better] = (
            trial[better],
            new[better],
            new_J[better],
            new_cost[better],
        )
        damping = np.clip(np.where(better, damping / 10, damping * 10), 1e-15, 1e15)
    return x[:, :3], x[:, 3:]


def _positive(K: Floats, starts: Floats, free: Bools) -> tuple[Floats, Floats]:
    """The same linkages with positive lengths: a free start angle turns by π instead."""
    K, starts = K.copy(), starts.copy()
    for i in (0, 1):
        turned = free[i] & (K[:, i] < 0)
        starts[turned, i] += np.pi
        # Turning φ by π changes the signs of cos φ and of the right side, hence of K₁ and K₃; ψ likewise.
        K[turned, i] *= -1
        K[turned, 2] *= -1
    return K, starts


def _distinct(fits: list[Fit]) -> list[Fit]:
    kept: list[Fit] = []
    for fit in fits:
        same = next((k for k, other in enumerate(kept) if _alike(fit, other)), None)
        if same is None:
            kept.append(fit)
        else:
            kept[same] = replace(kept[same], found_by=kept[same].found_by + 1)
    return kept


def _alike(a: Fit, b: Fit) -> bool:
    turns = np.exp(1j * np.array([a.crank_start - b.crank_start, a.rocker_start - b.rocker_start]))
    return bool(np.abs(turns - 1).max() < _SAME and np.allclose(a.K, b.K, rtol=1e-4, atol=1e-6))
