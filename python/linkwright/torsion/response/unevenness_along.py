r"""Speed fluctuation along the shaft: the measure N over the cylinders, at every disc.

From the firing of one cylinder at :math:`\varphi_i` to that of the next at :math:`\varphi_{i+1}` the speed of
a disc rises and falls by

.. math:: N_i = \frac{\max \omega - \min \omega}{\omega_m}, \qquad
    N = \frac1z \sum_{i=1}^z N_i, \qquad s = \max_i N_i - \min_i N_i

N is how unevenly the disc turns within the share of a cylinder, on average over all of them; s is how
differently they work. A healthy engine that fires evenly has one :math:`N_i` for all cylinders as long as it
is rigid. Torsional vibration makes N another number at every disc, so that cylinders cannot be judged by it
alone. As δ, N has a part of the train rotating as a rigid body, :math:`q_r = \sum J q/\sum J`, and a
torsional rest, which do not add up.

The diagnostic literature uses N without one definition of it; this one is ours.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated

import numpy as np

from linkwright.kernel.arrays import Complexes, Floats
from linkwright.kernel.errors import InputError
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.torsion.excitation.excited_train import ExcitedTrain
from linkwright.torsion.response.forced import ForcedVibration

# Points a wave of the highest order; Newton refines extremes from them.
_POINTS = 12
_NEWTON = 4

# How close waves in a cycle must be to a whole number.
_EQUAL = 1e-9


@dataclass(frozen=True)
class UnevennessAlong(Result):
    """Speed fluctuation over the cylinders at each disc, at one speed."""

    speed: Annotated[float, Label("speed of the first disc", "ω", "rad/s")]
    discs: Annotated[tuple[str, ...], About("As in `ForcedVibration`.")]
    cylinders: Annotated[tuple[str, ...], About("Cylinders in the order in which they fire.")]
    firing: Annotated[
        Floats,
        Label(
            "angle of the first disc at which each cylinder fires",
            "",
            "rad",
            "Increasing within a cycle.",
            shape="(cylinders,)",
        ),
    ]
    share: Annotated[
        Floats,
        Label(
            "speed fluctuation from each firing to the next", "N_i", "", "In all.", shape="(discs, cylinders)"
        ),
    ]
    share_rigid: Annotated[
        Floats,
        Label(
            "speed fluctuation of the rigid train from each firing to the next",
            "",
            "",
            shape="(discs, cylinders)",
        ),
    ]
    share_torsional: Annotated[
        Floats,
        Label("torsional speed fluctuation from each firing to the next", "", "", shape="(discs, cylinders)"),
    ]

    @property
    def unevenness(
        self,
    ) -> Annotated[Floats, Label("speed fluctuation over the cylinders", "N", "", shape="(discs,)")]:
        """N, shape (discs,)."""
        return _mean(self.share)

    @property
    def unevenness_rigid(
        self,
    ) -> Annotated[Floats, Label("speed fluctuation of the rigid train", "", "", shape="(discs,)")]:
        """N of the train rotating as a rigid body, shape (discs,)."""
        return _mean(self.share_rigid)

    @property
    def unevenness_torsional(
        self,
    ) -> Annotated[Floats, Label("speed fluctuation, torsional part", "", "", shape="(discs,)")]:
        """N of the rest, shape (discs,)."""
        return _mean(self.share_torsional)

    @property
    def spread(
        self,
    ) -> Annotated[Floats, Label("spread of the speed fluctuation", "s", "", shape="(discs,)")]:
        """s, largest minus smallest N_i, shape (discs,)."""
        spread: Floats = np.ptp(self.share, axis=1)
        return spread


def unevenness_along(
    at: ExcitedTrain, forced: ForcedVibration, firing: Mapping[str, float], turns: int, speed: float
) -> UnevennessAlong:
    """N at every disc, of orders that repeat with the cycle; `firing`: [rad]; `speed`: [rad/s]."""
    names, angles = _fired(firing, turns)
    column = int(np.argmin(np.abs(forced.speeds - speed)))
    waves = forced.orders * turns
    fits = (forced.offsets == 0) & (np.abs(waves - np.rint(waves)) <= _EQUAL * np.maximum(waves, 1.0))
    orders = forced.orders[fits]
    # Speed over mean speed: iν θ/n, n being that of the disc.
    relative = 1j * orders[:, None] * forced.amplitudes[fits, :, column] / at.referred.speed
    rigid = _as_a_whole(at, relative)
    parts = [_shares(orders, angle, angles, turns) for angle in (relative, rigid, relative - rigid)]
    return UnevennessAlong(float(forced.speeds[column]), forced.discs, names, angles, *parts)


def _mean(shares: Floats) -> Floats:
    mean: Floats = shares.mean(axis=1)
    return mean


def _fired(firing: Mapping[str, float], turns: int) -> tuple[tuple[str, ...], Floats]:
    if not firing:
        raise InputError("no cylinder fires: expected the firing angle of each cylinder")
    cycle = 2 * np.pi * turns
    angles = {name: float(angle) % cycle for name, angle in firing.items()}
    names = sorted(angles, key=angles.__getitem__)
    for a, b in pairwise(names):
        if angles[b] - angles[a] < 1e-6:
            where = np.degrees(angles[a])
            raise InputError(
                f"cylinders {a} and {b} fire at once, at {where:.6g}°: N has no interval between"
            )
    return tuple(names), np.array([angles[name] for name in names])


def _as_a_whole(at: ExcitedTrain, relative: Complexes) -> Complexes:
    """The same for all discs: mean of the masses by their inertia; nothing for a train that is held."""
    referred = at.referred
    if not referred.is_free:
        return np.zeros_like(relative)
    first = [int(np.argmax(referred.mass == mass)) for mass in range(len(referred.inertia))]
    mean = relative[:, first] @ referred.inertia / referred.inertia.sum()
    return np.broadcast_to(mean[:, None], relative.shape)


def _shares(orders: Floats, waves: Complexes, firing: Floats, turns: int) -> Floats:
    """Peak-to-peak value in each interval, (discs, cylinders)."""
    ends = np.append(firing[1:], firing[0] + 2 * np.pi * turns)
    swings = [_span(orders, waves, *interval) for interval in zip(firing, ends, strict=True)]
    return np.array(swings).reshape(len(firing), -1).T


def _span(orders: Floats, waves: Complexes, start: float, end: float) -> Floats:
    """Peak-to-peak value of sums of harmonics on an interval, ends included, (discs,)."""
    if not len(orders):
        return np.zeros(waves.shape[1])
    points = max(int(np.ceil((end - start) * orders.max() / (2 * np.pi) * _POINTS)), 2) + 1
    angle = np.linspace(start, end, points)
    values = _wave(orders, waves[:, :, None], angle)
    tops = []
    for sign in (1.0, -1.0):
        best = np.argmax(sign * values, axis=1)
        top = sign * values[np.arange(len(best)), best]
        # A wave that fits the interval is as high at both its ends: the extreme may be beside either.
        for start_at in (best, np.zeros_like(best), np.full_like(best, points - 1)):
            low, high = angle[np.maximum(start_at - 1, 0)], angle[np.minimum(start_at + 1, points - 1)]
            at = _flat(orders, waves, angle[start_at], low, high)
            top = np.maximum(top, sign * _wave(orders, waves, at))
        tops.append(top)
    span: Floats = tops[0] + tops[1]
    return span


def _flat(orders: Floats, waves: Complexes, x: Floats, low: Floats, high: Floats) -> Floats:
    """Stationary point next to an angle, (discs,), by Newton between two bounds."""
    for _ in range(_NEWTON):
        slope, bend = (_wave(orders, (1j * orders[:, None]) ** k * waves, x) for k in (1, 2))
        step = np.divide(slope, bend, out=np.zeros_like(slope), where=bend != 0)
        x = np.clip(x - step, low, high)
    return x


def _wave(orders: Floats, waves: Complexes, angle: Floats) -> Floats:
    """Σ Re c e^{iνφ}: of (orders, discs) at an angle each, or of (orders, discs, 1) at all angles."""
    phase = np.exp(1j * orders.reshape(-1, *[1] * (waves.ndim - 1)) * angle)
    wave: Floats = (waves * phase).real.sum(axis=0)
    return wave
