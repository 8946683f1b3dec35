r"""An oscillator driven by a law in pieces, exact to rounding; where the law jumps.

.. math:: z'' + 2\zeta r z' + r^2 z = g

is a single complex equation of first order, with the pole μ = r(−ζ + i√(1−ζ²)) and q = z′ − μ̄z:

.. math:: q' = \mu q + g, \qquad
    q(x + \Delta) = e^{\mu\Delta} q(x) + \int_0^\Delta e^{\mu(\Delta - t)} g(x + t)\,dt

A step never passes a break of the law, and turns the pole by two radians at most: the integral is
Gauss–Legendre's with so many nodes that nothing but rounding is left of its error.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from linkwright.cam.laws.motion_law import Extreme, MotionLaw
from linkwright.kernel.arrays import Complexes, Floats, Indices
from linkwright.kernel.errors import FindingError, InputError
from linkwright.kernel.numerics import zeros

Value = Callable[[Indices, Floats], Floats]

# Rotation of the pole over one step [rad].
_TURN = 2.0

# Nodes for an integrand exp(t), |t| ≤ 2 over the step: what a rule of n nodes leaves over falls like 1/(2n)!,
# below rounding from 10 nodes on; two are spare.
_NODES = 12

# Samples a step, in which extremes are looked for: 6 a radian of the oscillation at least.
_SAMPLES = 12

# Distance of e^{μL} from 1 below which the answer over one revolution is rounding.
_RESONANCE = 1e-10


def pole(ratio: float, damping_ratio: float) -> complex:
    """μ = r(−ζ + i√(1−ζ²))."""
    return ratio * complex(-damping_ratio, math.sqrt(1 - damping_ratio**2))


def nodes_for(law: MotionLaw, turn: float) -> tuple[Floats, Floats, Floats, Indices]:
    """Steps of a law, and nodes and weights for each of them.

    ``turn``: rotation of the exponential over the whole law [rad] → starts: ends of the steps, (n + 1,);
    nodes, weights: over a step from 0 to 1, (k,); pieces: piece that each step is in, (n,).
    """
    starts: list[float] = []
    pieces: list[int] = []
    waves = 0.0
    for i, (low, high, piece) in enumerate(zip(law.breaks, law.breaks[1:], law.pieces, strict=False)):
        n = max(1, math.ceil(turn * (high - low) / law.length / _TURN), math.ceil(piece.waves / _TURN))
        starts += np.linspace(low, high, n, endpoint=False).tolist()
        pieces += [i] * n
        waves = max(waves, piece.waves / n)
    degree = max(len(piece.polynomial) for piece in law.pieces)
    x, w = np.polynomial.legendre.leggauss(_NODES + degree // 2 + math.ceil(waves))
    return np.array([*starts, law.end]), 0.5 * (x + 1), 0.5 * w, np.array(pieces)


def in_pieces(law: MotionLaw, pieces: Indices, x: Floats) -> Floats:
    """Values of a law on given ``pieces`` (n,), one for each row of ``x`` (n,) or (n, k)."""
    value = np.zeros_like(x)
    for i in np.unique(pieces):
        here = pieces == i
        low, high = law.breaks[i], law.breaks[i + 1]
        value[here] = law.pieces[i].at((x[here] - low) / (high - low))
    return value


@dataclass(frozen=True)
class Oscillation:
    """The answer of an oscillator."""

    drive: MotionLaw
    pole: complex
    starts: Floats  # (n + 1,): ends of the steps
    pieces: Indices  # (n,): piece of the law that each step is in
    states: Complexes  # (n,): q at the start of each step, after what jumps there
    final: complex  # q at the end, after what jumps there
    # nodes, weights: (k,): over a step from 0 to 1.
    nodes: Floats
    weights: Floats

    def at(self, steps: Indices, x: Floats) -> tuple[Floats, Floats, Floats]:
        """z, z′ and z″ at places ``x`` inside the steps of numbers ``steps``, (m,) each."""
        pieces = self.pieces[steps]
        length = x - self.starts[steps]
        inner = _integral(self.drive, self.pole, pieces, self.starts[steps], length, self.nodes, self.weights)
        q = np.exp(self.pole * length) * self.states[steps] + inner
        z = q.imag / self.pole.imag
        z_d1 = q.real + self.pole.real * z
        return z, z_d1, in_pieces(self.drive, pieces, x) + 2 * self.pole.real * z_d1 - abs(self.pole) ** 2 * z

    def find(self, x: Floats) -> Indices:
        """Numbers of the steps in which places (m,) lie; at a break the one after it."""
        step = np.searchsorted(self.starts, x, side="right") - 1
        return np.asarray(np.clip(step, 0, len(self.pieces) - 1))

    def extremes(self, value: Value, slope: Value) -> tuple[Extreme, Extreme]:
        """Minimum and maximum of a quantity that is smooth inside the steps."""
        share = np.linspace(0, 1, _SAMPLES + 1)
        x = self.starts[:-1, None] + share * np.diff(self.starts)[:, None]
        step = np.broadcast_to(np.arange(len(x))[:, None], x.shape)
        slopes = slope(step.ravel(), x.ravel()).reshape(x.shape)
        row, column = zeros.brackets(slopes)
        inner = np.zeros(0)
        if len(row):
            inner, _ = zeros.zeros(lambda places: slope(row, places), x[row, column], x[row, column + 1])
        places = np.concatenate([x[:, 0], x[:, -1], inner])
        steps = np.concatenate([step[:, 0], step[:, 0], row])
        values = value(steps, places)
        least, most = int(np.argmin(values)), int(np.argmax(values))
        sides = ["after"] * len(x) + ["before"] * len(x) + ["after"] * len(inner)
        low, high = (Extreme(float(places[k]), float(values[k]), sides[k]) for k in (least, most))  # type: ignore[arg-type]
        return low, high


def oscillation(drive: MotionLaw, pole: complex, kicks: Floats, *, periodic: bool) -> Oscillation:
    """Answer of an oscillator at rest before, or periodic; ``kicks`` (pieces + 1,): jumps of z′ at breaks."""
    starts, nodes, weights, pieces = nodes_for(drive, abs(pole) * drive.length)
    lengths = np.diff(starts)
    inner = _integral(drive, pole, pieces, starts[:-1], lengths, nodes, weights)
    first = np.flatnonzero(np.diff(pieces, prepend=-1))
    kick = np.zeros(len(pieces))
    kick[first] = kicks[:-1]
    states, final = _run(0j, np.exp(pole * lengths), inner, kick)
    final += kicks[-1]
    if periodic:
        back = 1 - np.exp(pole * drive.length)
        if abs(back) < _RESONANCE:
            order = round(pole.imag * drive.length / (2 * math.pi))
            raise FindingError(
                f"the follower train has {order} free vibrations in one revolution and no damping: it is at "
                "resonance; give a damping ratio or another speed"
            )
        # What is there at the end is there again at the start.
        states = states + final / back * np.exp(pole * (starts[:-1] - starts[0]))
        final = final / back
    return Oscillation(drive, pole, starts, pieces, states, complex(final), nodes, weights)


def _integral(
    drive: MotionLaw,
    pole: complex,
    pieces: Indices,
    low: Floats,
    length: Floats,
    nodes: Floats,
    weights: Floats,
) -> Complexes:
    """∫ exp(μ(Δ − t)) g(x + t) dt over stretches inside pieces."""
    g = in_pieces(drive, pieces, low[:, None] + length[:, None] * nodes)
    rotation = np.exp(pole * length[:, None] * (1 - nodes))
    integral: Complexes = length * ((g * rotation) @ weights)
    return integral


def _run(start: complex, growth: Complexes, inner: Complexes, kick: Floats) -> tuple[Complexes, complex]:
    states = np.empty(len(growth), dtype=complex)
    q = start
    for i, (g, f, v) in enumerate(zip(growth.tolist(), inner.tolist(), kick.tolist(), strict=True)):
        states[i] = q + v
        q = g * (q + v) + f
    return states, q


Ends = Literal["dwell", "turn"]

# Share of a derivative's own size below which a jump is rounding of the law's coefficients.
_ROUNDING = 1e-9

# Highest order of a derivative that is examined: a cam for a vibrating follower needs four.
_ORDERS = 6


def steps(law: MotionLaw, order: int, ends: Ends) -> Floats:
    """By how much a derivative jumps at each break, (pieces + 1,)."""
    first, last = float(law.at(law.start, order)), float(law.at(law.end, order, "before"))
    outer = [first - last, 0.0] if ends == "turn" else [first, -last]
    jumps = np.concatenate([outer[:1], law.jumps(order), outer[1:]])
    if ends == "dwell" and order == 0:
        # A dwell may be at any height.
        jumps[[0, -1]] = 0.0
    return np.where(np.abs(jumps) > _ROUNDING * size(law, order), jumps, 0.0)


def size(law: MotionLaw, order: int) -> float:
    """How large a derivative becomes, by itself or by what it would be for so much lift."""
    places = np.linspace(law.start, law.end, 65)
    heights = [float(np.ptp(law.at(places))) / law.length**order, float(np.abs(law.at(places, order)).max())]
    return max(heights)


def continuity(law: MotionLaw, ends: Ends) -> int:
    """The highest order, up to 6, up to which the law and all its derivatives have no jump."""
    for order in range(_ORDERS + 1):
        if steps(law, order, ends).any():
            return order - 1
    return _ORDERS


def without_steps(law: MotionLaw, ends: Ends) -> None:
    """Raise if the lift itself jumps."""
    if ends == "turn" and abs(law.length - 2 * np.pi) > 1e-9:
        raise InputError(
            f"lift: found a law over {law.length:.9g} rad, expected one revolution, {2 * np.pi:.9g} rad"
        )
    jumps = steps(law, 0, ends)
    if jumps.any():
        k = int(np.flatnonzero(jumps)[0])
        raise InputError(f"lift: found a jump by {jumps[k]:.6g} m at {law.breaks[k]:.6g} rad, expected none")
