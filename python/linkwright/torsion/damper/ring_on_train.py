r"""A ring on a disc of a train, as the other modes feel it too: its response, and the best that holds it.

The train swings under torques Jθ of one mode, which excite none other as long as there is no damper. With the
receptances α of that train and the dynamic stiffness D of the ring, a twist w is

.. math:: w = \alpha_w - \frac{\alpha_{w,on}\,D\,\alpha_{on}}{1 + \alpha_{on,on}\,D}

References
----------
.. [1] Bishop and Johnson, The Mechanics of Vibration, 1960: receptances of systems that are joined.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.errors import FindingError
from linkwright.torsion.damper.damper_rules import DamperRule, ring_stiffness
from linkwright.torsion.modes.free import FreeVibration

Floats = NDArray[np.float64]

# Frequencies at which the response is looked at, closest about that of the mode: with a light ring and a
# fluid the best peak is half as wide as the ratio of inertias, in shares of the frequency.
_POINTS, _CLOSE = 1500, 0.5

# The range over the frequency of the mode, below over that with the ring held fast to its disc; and the share
# of a neighbouring frequency from which it keeps away, where the response is that of another mode.
_LOW, _HIGH, _AWAY = 0.4, 1.6, 0.05

# A disc whose amplitude is a smaller share of the largest is at rest in the mode.
_AT_REST = 1e-6

# How far c and k are sought about what the mode alone gives, as factors, and to which share they are found:
# the response is flat there, to the square of it.
_C_RANGE, _K_RANGE, _FOUND = 8.0, 1.6, 1e-5


@dataclass(frozen=True)
class RingSupport:
    """What holds the ring."""

    damping: float
    stiffness: float
    loss_factor: float

    def scaled(self, c: float, k: float = 1.0) -> RingSupport:
        """With c, or where there is none η, and k by factors."""
        loss = self.loss_factor * (c if self.damping == 0 else 1.0)
        return RingSupport(self.damping * c, self.stiffness * k, loss)


class RingOnTrain:
    """Receptances of a train about a mode, at the frequencies of interest."""

    def __init__(self, found: FreeVibration, on: int, mode: int, ring: float) -> None:
        shape, natural = found.mode_shapes, found.angular_frequencies
        if abs(shape[mode, on]) < _AT_REST:
            raise FindingError(
                f"{found.discs[on]} is at rest in mode {mode} at {found.natural_frequencies[mode]:.6g} Hz: a "
                "damper there does nothing; put it where the amplitude is large"
            )
        shaft = int(np.argmax(found.potential_shares[mode]))
        self.watched, self.ring = found.shafts[shaft], ring
        self.modal_inertia = float(found.modal_inertia[mode] / shape[mode, on] ** 2)
        self.natural = float(natural[mode])
        self.omega = _range(natural, mode, ring / self.modal_inertia)
        pole = found.modal_inertia[:, None] * (natural[:, None] ** 2 - self.omega**2)
        self.on_on = (shape[:, on] ** 2) @ (1 / pole)
        self.watch_on = (found.twists[:, shaft] * shape[:, on]) @ (1 / pole)
        # Torques Jθ of the mode, of which the unit is taken so that the twist at rest is one.
        self.rest = found.modal_inertia[mode] * self.natural**2 / pole[mode]
        self.amplitude = shape[mode, on] / found.twists[mode, shaft]

    def holding(self, rule: DamperRule) -> RingSupport:
        """A damper of these ratios in the mode."""
        ring, omega = self.ring, self.natural
        stiffness = ring * (rule.tuning * omega) ** 2
        return RingSupport(2 * ring * omega * rule.damping_ratio, stiffness, rule.loss_factor)

    def response(self, held: RingSupport) -> Floats:
        """Twist of the watched shaft over that at rest."""
        joint = held.stiffness * (1 + 1j * held.loss_factor) + 1j * self.omega * held.damping
        D = ring_stiffness(joint, self.ring * self.omega**2)
        part = self.watch_on * D * self.amplitude / (1 + self.on_on * D)
        found: Floats = np.abs(self.rest * (1 - part))
        return found

    def peak(self, held: RingSupport) -> float:
        """Largest response, by the parabola through the highest points."""
        y = self.response(held)
        n = int(np.argmax(y))
        if n in (0, len(y) - 1):
            return float(y[n])
        x, y = self.omega[n - 1 : n + 2], y[n - 1 : n + 2]
        slopes = np.diff(y) / np.diff(x)
        bend = (slopes[1] - slopes[0]) / (x[2] - x[0])
        if bend >= 0:
            return float(y[1])
        at = 0.5 * (x[0] + x[1]) - 0.5 * slopes[0] / bend
        return float(y[0] + (at - x[0]) * (slopes[0] + bend * (at - x[1])))


def best_holding(train: RingOnTrain, first: RingSupport, *, free_loss: bool) -> RingSupport:
    """The damper with the minimum peak: c, or the loss of rubber, for each k, and k over these."""

    def damped(k: float) -> RingSupport:
        if not free_loss:
            return first.scaled(1.0, k)
        c = _least(lambda x: train.peak(first.scaled(math.exp(x), k)), math.log(_C_RANGE))
        return first.scaled(math.exp(c), k)

    if first.stiffness == 0:
        return damped(1.0)
    k = _least(lambda x: train.peak(damped(math.exp(x))), math.log(_K_RANGE))
    return damped(math.exp(k))


def _least(value: Callable[[float], float], reach: float) -> float:
    """Where a function is smallest from −reach to reach: the best of some samples, then golden section."""
    samples = np.linspace(-reach, reach, 17)
    n = int(np.argmin([value(float(x)) for x in samples]))
    low, high = float(samples[max(n - 1, 0)]), float(samples[min(n + 1, 16)])
    golden = (math.sqrt(5) - 1) / 2
    a, b = high - golden * (high - low), low + golden * (high - low)
    at_a, at_b = value(a), value(b)
    while high - low > _FOUND:
        if at_a < at_b:
            high, b, at_b = b, a, at_a
            a = high - golden * (high - low)
            at_a = value(a)
        else:
            low, a, at_a = a, b, at_b
            b = low + golden * (high - low)
            at_b = value(b)
    return 0.5 * (low + high)


def _range(natural: Floats, mode: int, mu: float) -> Floats:
    """Frequencies about that of a mode, which a ring held fast lowers by √(1 + μ); none is a natural one."""
    own = float(natural[mode])
    # Frequencies that lie together are damped together.
    below, above = natural[natural < (1 - 2 * _AWAY) * own], natural[natural > (1 + 2 * _AWAY) * own]
    low = max([_LOW * own / math.sqrt(1 + mu), *((1 + _AWAY) * below)])
    high = min([_HIGH * own, *((1 - _AWAY) * above)])
    close = _CLOSE * min(mu, 1.0) * own
    steps = np.linspace(math.asinh((low - own) / close), math.asinh((high - own) / close), _POINTS)
    omega = own + close * np.sinh(steps)
    # At a natural frequency the receptances have a pole.
    near = np.abs(omega[:, None] - natural) < 1e-9 * own
    moved: Floats = omega + np.where(near.any(axis=1), 1e-8 * own, 0.0)
    return moved
