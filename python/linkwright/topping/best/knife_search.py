"""The search for the best knife of a topper: on a grid of angles and knife speeds, then closer and closer."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.topping.best.knife_trial import Trial, Trials
from linkwright.topping.coverage import Watch
from linkwright.topping.model.topper import MemberKnife, Topper

# Grid of angles and knife speeds: for the map, for each of several forward speeds, and about the best.
MAP, _COARSE, _CLOSE = (25, 21), (13, 11), 7

# Rounds about the best; the width falls to a third each time, in the end to 1e-3 of a step of the grid. After
# a search with a part of the roots as many follow with all of them, of which the first are left out.
_ROUNDS, _SKIPPED = 6, 2

# Forward speeds that are examined, and halvings between two of them: 1e-3 of such a step.
_SPEEDS, _HALVINGS = 9, 10

_EACH = _COARSE[0] * _COARSE[1] + _ROUNDS * _CLOSE**2
_ONCE = MAP[0] * MAP[1] + (_ROUNDS - _SKIPPED) * _CLOSE**2
_ALL = {"shortest": _ONCE + _ROUNDS * _CLOSE**2, "fastest": _ONCE + (_SPEEDS + _HALVINGS) * _EACH}

# Share of the maximum speed at which the slowest knife on a mechanism is examined.
_SLOWEST = 0.01


def knife_bounds(topper: Topper) -> tuple[Floats, Floats]:
    """Minimum and maximum angle and knife speed of the best knife, (2,) each [rad, m/s]."""
    limits = topper.limits
    # A mechanism turns: its knife does not rest.
    slowest = _SLOWEST * limits.knife_speed_max if isinstance(topper.motion, MemberKnife) else 0.0
    low = np.array([limits.angle_min, max(limits.knife_speed_min, slowest)])
    return low, np.array([limits.angle_max, limits.knife_speed_max])


class KnifeGrid:
    """Knives within bounds, of which the shortest or the fastest is sought.

    ``length_max``: maximum length of the edge [m].
    """

    def __init__(self, trials: Trials, length_max: float, objective: str, watch: Watch | None) -> None:
        self.trials, self.length_max = trials, length_max
        self.is_fastest = objective == "fastest"
        self._watch, self._all = watch, _ALL[objective]
        limits = trials.topper.limits
        self._slicing = limits.slicing_min
        self.low, self.high = knife_bounds(trials.topper)
        self.speeds = (limits.forward_speed_min, limits.forward_speed_max)

    def grid(
        self, forward_speed: float, numbers: tuple[int, int], low: Floats, high: Floats
    ) -> list[list[Trial]]:
        """All knives of a grid at v [m/s]; ``low``, ``high`` (2,): ends [rad, m/s], equal for one value."""
        axes = [
            np.linspace(a, b, n if b > a else 1).tolist() for a, b, n in zip(low, high, numbers, strict=True)
        ]
        return [[self._at(angle, speed, forward_speed) for speed in axes[1]] for angle in axes[0]]

    def shortest(self, forward_speed: float, first: Sequence[Trial] | None = None) -> Trial:
        """The knife of the shortest edge at v [m/s]; nearest to the draw-cut asked for if all lack it."""
        if first is None:
            first = _listed(self.grid(forward_speed, _COARSE, self.low, self.high))
        return self._about(min(first, key=self._order), _ROUNDS)

    def refined(self, chosen: Trial) -> Trial:
        """The best about a knife that was found with a part of the roots."""
        best = self._refined_at(chosen, chosen.forward_speed)
        slow = max(self.speeds[0], chosen.forward_speed - (self.speeds[1] - self.speeds[0]) / (_SPEEDS - 1))
        if not self.is_fastest or self.keeps(best) or slow >= chosen.forward_speed:
            return best
        slower = self._refined_at(chosen, slow)
        return self._between(slower, chosen.forward_speed, lambda v: self._refined_at(chosen, v))

    def _refined_at(self, chosen: Trial, forward_speed: float) -> Trial:
        own = self._at(chosen.edge_angle, chosen.knife_speed, forward_speed)
        return self._about(own, _ROUNDS - _SKIPPED)

    def _about(self, best: Trial, rounds: int) -> Trial:
        # To the neighbours on the grid, which has at least a dozen steps.
        half = (self.high - self.low) / 12 / 3 ** (_ROUNDS - rounds)
        for _ in range(rounds):
            middle = np.array([best.edge_angle, best.knife_speed])
            low, high = np.maximum(middle - half, self.low), np.minimum(middle + half, self.high)
            close = self.grid(best.forward_speed, (_CLOSE, _CLOSE), low, high)
            best = min([best, *_listed(close)], key=self._order)
            half = half / 3
        return best

    def fastest(self) -> Trial:
        """The knife of the maximum forward speed; the one that comes closest if none keeps the limits."""
        speeds = np.linspace(*self.speeds, _SPEEDS if self.speeds[1] > self.speeds[0] else 1).tolist()
        knives = [self.shortest(speed) for speed in speeds]
        kept = [i for i, knife in enumerate(knives) if self.keeps(knife)]
        if not kept:
            return min(knives, key=self._order)
        best = knives[kept[-1]]
        if kept[-1] + 1 == len(speeds):
            return best
        return self._between(best, speeds[kept[-1] + 1], self.shortest)

    def _between(self, best: Trial, fast: float, look: Callable[[float], Trial]) -> Trial:
        """The fastest between a knife that keeps the limits and a speed at which none does."""
        slow = best.forward_speed
        for _ in range(_HALVINGS):
            middle = 0.5 * (slow + fast)
            trial = look(middle)
            if self.keeps(trial):
                slow, best = middle, trial
            else:
                fast = middle
        return best

    def keeps(self, trial: Trial) -> bool:
        """Whether a knife keeps all limits."""
        long_enough = math.isfinite(trial.length) and trial.length <= self.length_max
        return long_enough and trial.lack(self._slicing) == 0

    def _order(self, trial: Trial) -> tuple[float, float]:
        """Sort key, less is better: first the shortfall, then the length."""
        lack = trial.lack(self._slicing)
        return lack, math.inf if math.isnan(trial.length) else trial.length

    def _at(self, angle: float, speed: float, forward_speed: float) -> Trial:
        trial = self.trials.at(angle, speed, forward_speed)
        if self._watch is not None:
            self._watch(min(1.0, self.trials.count / self._all))
        return trial


def _listed(table: list[list[Trial]]) -> list[Trial]:
    return [value for row in table for value in row]
