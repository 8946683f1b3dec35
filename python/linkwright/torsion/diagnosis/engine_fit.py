r"""Values of cylinders whose speed is closest to a measured one, by Gauss and Newton's method.

From first values on,

.. math:: v \leftarrow v + s\,(A^+ \left(y - f(v) + A v\right) - v), \qquad A = \partial f/\partial v

until v stays, with s = 1 halved until the speed fits no worse than before.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from linkwright.kernel.arrays import Floats, Indices
from linkwright.kernel.numerics.least_squares import Fit, least_squares
from linkwright.torsion.diagnosis.diagnosis import equations, places
from linkwright.torsion.diagnosis.engine_speed import EngineSpeed
from linkwright.torsion.diagnosis.measured_speed import MeasuredSpeed

# Steps of the method: a few, some dozens where curves of couplings bend at the operating point or where
# compression and combustion have nearly the same effect.
ROUNDS = 100
# Values have settled when they change by less than this, or than this share of their deviation.
_SETTLED, _SETTLED_SHARE = 1e-9, 1e-2
# Share of the combustion below which it has no time of its own.
_HARDLY = 0.2
# Deviations from a healthy value from which on it is examined whether it might be one, and beyond which no
# curvature makes it so.
_SUSPECT, _CERTAIN = 2.0, 12.0
# A step that fits worse by more than this share is halved, at most so often: near the best fit, what is left
# over says nothing more of the step.
_WORSE, _HALVINGS = 1e-6, 10


@dataclass(frozen=True)
class EngineFit:
    """A measurement that the values of cylinders are fitted to: combustion, or delay and compression too."""

    model: EngineSpeed
    measured: MeasuredSpeed
    # (values,) equations 0 = held · value that stand beside those of the measurement, none where it is 0.
    held: Floats | None = None

    def left(self, states: Floats) -> Floats:
        """What some states leave over, (states, equations); `states`: (values, states)."""
        orders, speed = self.model.harmonics(states)
        rows = equations(self.measured.harmonics - speed[:, places(orders, self.measured)], self.measured)
        return rows if self.held is None else np.concatenate([rows, -self.held * states.T], axis=1)

    def squares(self, states: Floats) -> Floats:
        """Sum of squares of what some states leave over, (states,)."""
        squares: Floats = (self.left(states) ** 2).sum(axis=1)
        return squares

    def about(self, values: Floats, healthy: int | None = None) -> tuple[Fit, Floats]:
        """The fit to the equations about some values, and these; `healthy`: place of a value that stays 0."""
        orders, here, slopes = self.model.about(values)
        at = places(orders, self.measured)
        A = equations(slopes[:, at], self.measured).T
        A[:, _without_delay(values, self.model.engine.n_cylinders)] = 0.0
        if healthy is not None:
            A[:, healthy] = 0.0
        y = equations(self.measured.harmonics - here[at], self.measured) + A @ values
        if self.held is not None:
            A = np.concatenate([A, np.diag(self.held)])
            y = np.concatenate([y, np.zeros(len(values))])
        return least_squares(A, y, is_known=self.measured.noise is not None), A

    def settled(
        self, values: Floats, rounds: int = ROUNDS, healthy: int | None = None
    ) -> tuple[Floats, bool]:
        """Values that fit best at their own operating point, from first ones on, and whether they settled."""
        for _ in range(rounds):
            fit, _ = self.about(values, healthy)
            step = fit.values - values
            if (np.abs(step) <= np.maximum(_SETTLED, _SETTLED_SHARE * fit.deviation)).all():
                return values, True
            values = values + self._share(values, step) * step
        return values, False

    def _share(self, values: Floats, step: Floats) -> float:
        """Step length, halved until the speed fits no worse than before."""
        shares = 0.5 ** np.arange(_HALVINGS)
        size = self.squares(values[:, None] + step[:, None] * np.append(0.0, shares))
        fits = np.flatnonzero(size[1:] <= size[0] * (1 + _WORSE))
        return float(shares[fits[0] if len(fits) else -1])

    def widened(self, values: Floats, fit: Fit) -> Fit:
        """The fit with deviations that nowhere make a value less likely to be healthy than it is.

        Intervals are those of the equations about the values; far from these, delays and couplings bend. A
        value that seems off by some deviations is held at that of a healthy cylinder and all others are
        fitted anew: the root of what the squares rise by, over the noise, is by how many it is off.
        """
        noise = 1.0 if self.measured.noise is not None else fit.misfit
        apart = np.abs(values) / np.where(fit.deviation > 0, fit.deviation, np.inf)
        least, factor = self.squares(values[:, None])[0], np.ones(len(values))
        for place in np.flatnonzero((apart > _SUSPECT) & (apart < _CERTAIN)):
            start = values.copy()
            start[place] = 0.0
            other, _ = self.settled(start, healthy=int(place))
            rise = max(self.squares(other[:, None])[0] - least, 0.0)
            factor[place] = max(apart[place] * noise / max(np.sqrt(rise), noise), 1.0)
        covariance = fit.covariance * np.outer(factor, factor)
        return fit._replace(deviation=factor * fit.deviation, covariance=covariance)

    def up_to(self, highest: float, likely: Floats) -> EngineFit | None:
        """The fit to the orders up to `highest`, held by `likely` sizes (values,); None without orders."""
        low = self.measured.orders <= highest
        if not low.any():
            return None
        noise = None if self.measured.noise is None else self.measured.noise[low]
        part = replace(
            self.measured,
            orders=self.measured.orders[low],
            harmonics=self.measured.harmonics[low],
            noise=noise,
        )
        size = np.sqrt((equations(part.harmonics, part) ** 2).mean())
        return EngineFit(self.model, part, size / likely)


def _without_delay(values: Floats, n: int) -> Indices:
    """Delays of cylinders that hardly burn: undetermined, and therefore held."""
    return n + np.flatnonzero(values[:n] < _HARDLY - 1) if len(values) > n else np.empty(0, np.intp)
