r"""Shapes of four-bar linkages whose crank turns round, as three numbers without bounds.

The frame is 1. The crank r turns fully if coupler c and rocker b close at both ends of the range of the
distance that they span, 1 − r and 1 + r; so with c = (S + D)/2, b = (S − D)/2

.. math::

    S = 1 + r + e + \exp q_3, \qquad D = (|1 - r| - e) \tanh q_2

and r between e and 1 − 2e by a logistic function of q₁ for a crank-rocker, above 1 + 2e for a double crank.
The spare e keeps the linkage away from its change point. Every shape of a kind is met once, so that a search
needs no bounds for the full revolution.

Source: Grashof's condition, e.g. Hartenberg, Denavit, Kinematic Synthesis of Linkages, 1964.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]
Bools = NDArray[np.bool_]

# Minimum spare of the full revolution, over the frame: nearer to a change point the motion is not determined.
SPARE = 1e-3

# Numbers beyond this are shapes that differ from their limits by a millionth.
_FAR = 14.0


def shape(q: Floats, is_double: Bools) -> tuple[Floats, Floats]:
    """Lengths of crank, coupler and rocker over the frame.

    `q` (m, 3): the free numbers; `is_double` (m,): whether the linkage is a double crank. Returns: lengths
    (m, 3), and their derivatives by the numbers (m, 3, 3) [–].
    """
    q1, q2, q3 = np.clip(q, -_FAR, _FAR).T
    share = 1 / (1 + np.exp(-q1))
    r = np.where(is_double, 1 + 2 * SPARE + np.exp(q1), SPARE + (1 - 3 * SPARE) * share)
    r_1 = np.where(is_double, np.exp(q1), (1 - 3 * SPARE) * share * (1 - share))
    room, bent, rest = np.abs(1 - r) - SPARE, np.tanh(q2), np.exp(q3)
    total, off = 1 + r + SPARE + rest, room * bent
    off_1, off_2 = np.where(is_double, r_1, -r_1) * bent, room * (1 - bent**2)
    zero = np.zeros_like(r)
    by = np.array(
        [
            [r_1, zero, zero],
            [0.5 * (r_1 + off_1), 0.5 * off_2, 0.5 * rest],
            [0.5 * (r_1 - off_1), -0.5 * off_2, 0.5 * rest],
        ]
    )
    return np.stack([r, 0.5 * (total + off), 0.5 * (total - off)], axis=1), np.moveaxis(by, 2, 0)


def free_numbers(crank: Floats, bent: Floats, rest: Floats, is_double: Bools) -> Floats:
    """The free numbers of a crank over the frame, a share of D from −1 to 1, S beyond its minimum, (m, 3)."""
    inside = (crank - SPARE) / (1 - 3 * SPARE)
    with np.errstate(invalid="ignore", divide="ignore"):
        q1 = np.where(is_double, np.log(crank - 1 - 2 * SPARE), np.log(inside) - np.log(1 - inside))
    return np.stack([q1, np.arctanh(bent), np.log(rest)], axis=1)


def pin_and_coupler(lengths: Floats, side: Floats, phi: Floats) -> tuple[Complexes, Complexes]:
    """Crank pin and direction of the coupler, with the frame from 0 to 1.

    `lengths` (m, 3): crank, coupler, rocker over the frame; `side` (m,): +1 where the joint is to the left of
    the way from the pin to the rocker's pivot, −1 to the right; `phi` (m, n): crank angles from the frame
    [rad]. Returns: pin (m, n) over the frame, and e^{iχ} (m, n).
    """
    r, c, b = lengths.T[:, :, None]
    A = r * np.exp(1j * phi)
    D = 1 - A
    d = np.abs(D)
    cosine = np.clip((d * d + c * c - b * b) / (2 * c * d), -1, 1)
    return A, D / d * (cosine + 1j * side[:, None] * np.sqrt(1 - cosine * cosine))


def coupler_slopes(lengths: Floats, side: Floats, phi: Floats) -> tuple[Floats, Floats]:
    """Derivatives of the coupler's angle by crank, coupler, rocker (m, n, 3), by the crank angle (m, n)."""
    r, c, b = lengths.T[:, :, None]
    e = np.exp(1j * phi)
    D = 1 - r * e
    d = np.abs(D)
    cosine = np.clip((d * d + c * c - b * b) / (2 * c * d), -1, 1)
    # The angle κ between coupler and diagonal: dκ = −d(cos κ)/sin κ; the spare keeps it from 0 and π.
    by_cosine = -side[:, None] / np.sqrt(np.maximum(1 - cosine * cosine, 1e-300))
    by_d = by_cosine * (d / c - cosine)
    # The diagonal turns and grows by the logarithm of D.
    by_r, by_phi = -e / D, -1j * r * e / D
    slopes = [
        by_r.imag + by_d * by_r.real,
        by_cosine * (1 / d - cosine / c),
        by_cosine * (-b / (c * d)),
    ]
    return np.stack(slopes, axis=-1), by_phi.imag + by_d * by_phi.real
