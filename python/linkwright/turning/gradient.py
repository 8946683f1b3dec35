r"""Derivatives of a turning-moment diagram by its entries.

The excess of the driver is zero, or changes its sign, where the energy is largest and smallest, so that

.. math:: \mathrm d\Delta E = \int_{\varphi_{\min}}^{\varphi_{\max}} \mathrm d(T - M)\,d\varphi

at fixed ends (envelope theorem). Torques, flywheel and rim are worked out by the formulas of the diagram
itself, in arrays of tangents.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.numerics.extreme import TIE, apart, chosen, degrees, occurs_at, off
from linkwright.kernel.numerics.tangent import Tangent, lifted, numbers, primal, variables_of
from linkwright.kernel.numerics.turn_curve import TurnCurve
from linkwright.machine.machine import Machine
from linkwright.machine.tangents import Derivatives, followed, scalars_of
from linkwright.turning.diagram import (
    DRIVER,
    EXCESS,
    TurningMomentDiagram,
    fitted_curves,
    of_fluctuation,
    of_torques,
    turning_moment,
)
from linkwright.turning.model import TurningMoment

# Degrees beyond those of the fitted series to which derivatives are integrated exactly.
_MORE = 8

# Share of the cycle beside a jump at which its sides are looked at.
_BESIDE = 1e-10

# A difference between its sides that is a larger share of the torque is a jump; a steep flank is none.
_JUMP = 1e-6


def turning_tangents(machine: Machine, variables: Sequence[str]) -> Derivatives:
    """Scalars of a turning-moment diagram by some entries. Raises what `turning_moment` raises."""
    result = turning_moment(machine, n=1)
    assert machine.turning_moment is not None
    own = [name for name in variables if name.startswith("turning_moment.")]
    work: Any = (
        _OfAreas(machine.turning_moment) if machine.turning_moment.areas else _OfCurves(machine, result)
    )
    refused = dict.fromkeys(_jump_movers(machine.turning_moment) & set(own), _MOVES_JUMP)
    own = [name for name in own if name not in refused]
    known, numbers_of = followed(machine, own, lambda along: work.scalars(along.turning_moment), refused)
    listed = tuple(name for name in variables if name not in refused)
    tangents = scalars_of(result, numbers_of, known, listed)
    made_of_energy = dict.fromkeys(_OF_ENERGY & set(tangents), work.tie) if work.tie else {}
    ties = made_of_energy | work.ties | _lost(tangents, listed)
    return Derivatives(listed, tangents, {name: ties[name] for name in tangents if name in ties}, {}, refused)


_MOVES_JUMP = "it moves the angle at which a torque jumps"


def _jump_movers(described: TurningMoment) -> set[str]:
    """Entries that move jumps, at which the work of a torque changes by more than its derivative says."""
    if described.areas:
        return set()
    ends = fitted_curves(described).ends
    aside = _BESIDE * described.cycle
    moved = set()
    for key, torque in (("driver", described.driver), ("load", described.load)):
        if torque is None:
            continue
        before, after = (
            torque.at(np.mod(ends + side, described.cycle), described.cycle) for side in (-aside, aside)
        )
        if np.abs(after - before).max() > _JUMP * max(np.abs(before).max(), np.abs(after).max()):
            moved |= {f"turning_moment.{key}.{entry}" for entry in torque.jump_movers()}
    return moved


_OF_ENERGY = {
    *(
        "energy_fluctuation",
        "energy_coefficient",
        "inertia",
        "flywheel_inertia",
        "flywheel_mass",
        "unevenness",
    ),
    *("speed_max", "speed_min", "acceleration_max", "acceleration_min", "rim_mass", "rim_area", "rim_width"),
    "rim_thickness",
}


def _lost(tangents: dict[str, Tangent], variables: Sequence[str]) -> dict[str, str]:
    """What lies on a corner of a table that an entry moves."""
    lost = {}
    for name, tangent in tangents.items():
        moved = chosen(variables, np.isnan(tangent.d))
        if moved:
            lost[name] = (
                "the extreme occurs at a corner of the torque; there is no derivative with respect to "
                f"{', '.join(moved)}"
            )
    return lost


class _OfAreas:
    """From the areas of a diagram."""

    def __init__(self, described: TurningMoment) -> None:
        # The energy at the start of the first area counts too.
        after = np.append(np.cumsum(np.asarray(described.areas)), 0.0)
        self.most, self.least = int(after.argmax()), int(after.argmin())
        span = TIE * float(after[self.most] - after[self.least])
        highest = np.flatnonzero(after >= after[self.most] - span)
        lowest = np.flatnonzero(after <= after[self.least] + span)
        self.places = {"maximum": highest, "minimum": lowest}
        self.tie, self.ties = "", dict[str, str]()

    def scalars(self, described: TurningMoment) -> dict[str, Any]:
        """All scalars, with the derivatives of the description."""
        after = np.cumsum(described.area_scale * numbers(described.areas))
        levels = np.concatenate([after, np.zeros(1)])
        slopes = lifted(levels, variables_of((levels,)) or 1).d
        self.tie = self._tie(slopes, float(np.abs(slopes).max()))
        change = levels[self.most] - levels[self.least]
        return of_fluctuation(described, change)

    def _tie(self, slopes: Floats, scale: float) -> str:
        """Where the energy has an extreme twice that entries move apart; empty if nowhere."""
        for end, places in self.places.items():
            for place in places[apart(slopes[places], scale).any(axis=1)]:
                # The level behind the last is that at the start.
                is_start, first = place == len(slopes) - 1, places[0] + 1
                where = f"area {first} and at the start" if is_start else f"areas {first} and {place + 1}"
                return f"the {end} of the energy occurs after {where}"
        return ""


class _OfCurves:
    """From torques over the angle."""

    def __init__(self, machine: Machine, result: TurningMomentDiagram) -> None:
        described = machine.turning_moment
        assert described is not None
        self.result, self.cycle = result, described.cycle
        self.curves = fitted_curves(described)
        energy = self.curves.excess(EXCESS, EXCESS, 0.0)
        self.ends = energy.extreme(+1)[1], energy.extreme(-1)[1]
        self.nodes, self.weights = _nodes(self.curves, self.ends)
        self.tie = self._tie(energy)
        self.ties: dict[str, str] = {}

    def _tie(self, energy: TurnCurve) -> str:
        """Where the energy has an extreme twice; empty if nowhere."""
        at = np.append(self.curves.crossings(EXCESS), self.ends)
        E = energy.at(at)[0]
        for word, sign, end in (("maximum", 1.0, self.ends[0]), ("minimum", -1.0, self.ends[1])):
            near = at[sign * E >= (sign * E).max() - TIE * float(np.ptp(E))]
            others = near[off(near, end, self.cycle) > TIE]
            if len(others):
                return f"the {word} of the energy occurs at {degrees(end)} and {degrees(others[0])}"
        return ""

    def scalars(self, described: TurningMoment) -> dict[str, Any]:
        """All scalars, with the derivatives of the description."""
        driver, load = self._torques(described, self.nodes)
        mean, load_mean = (np.sum(curve * self.weights) / self.cycle for curve in (driver, load))
        excess = driver - load - (mean - load_mean)
        high, low = self.ends
        # Once round from the minimum to the maximum.
        between = (self.nodes > min(high, low)) & (self.nodes < max(high, low))
        change = np.sum(excess * (self.weights * between)) * (1.0 if high > low else -1.0)
        peaks = {
            (k, sign): self._extreme(described, f"{name}_{end}", k, sign)
            for k, name in ((DRIVER, "torque_driver"), (EXCESS, "acceleration"))
            for end, sign in (("max", +1), ("min", -1))
        }
        return of_torques(described, mean, change, peaks)

    def _torques(self, described: TurningMoment, phi: Floats) -> tuple[Any, Any]:
        """Driver and load at angles; what is left out is the mean of the other."""
        torques = [
            None if torque is None else torque.at(phi, self.cycle)
            for torque in (described.driver, described.load)
        ]
        alone = described.driver if described.load is None else described.load
        assert alone is not None
        mean: Any = np.sum(alone.at(self.nodes, self.cycle) * self.weights) / self.cycle
        driver, load = (mean * np.ones(len(phi)) if torque is None else torque for torque in torques)
        return driver, load

    def _extreme(self, described: TurningMoment, name: str, k: int, sign: int) -> Any:
        """An extreme of driver or excess, at a jump from the side that has it."""
        value, angle = self.curves.extreme(sign, k)
        others = self.curves.extremes(sign, k, TIE)
        curve, at = self._beside(described, k, np.append(angle, others[others != angle]))
        # Values at the angles themselves count before those on either side.
        there = np.flatnonzero(np.abs(primal(curve) - value) <= TIE * self.curves.peak[k])
        slopes = lifted(curve, variables_of((curve,)) or 1).d[there]
        rivals = at[there][apart(slopes).any(axis=1)]
        if len(rivals):
            self.ties[name] = occurs_at((angle, rivals[0]))
        return curve[int(there[0])]

    def _beside(self, described: TurningMoment, k: int, phi: Floats) -> tuple[Any, Floats]:
        """Driver or excess at angles, and a little before and after them, with the angles."""
        aside = _BESIDE * self.cycle
        at = np.mod(np.concatenate([phi, phi - aside, phi + aside]), self.cycle)
        driver, load = self._torques(described, at)
        return (driver - load if k == EXCESS else driver), at


def _nodes(curves: TurnCurve, ends: tuple[float, float]) -> tuple[Floats, Floats]:
    """Angles and weights of Gauss–Legendre quadrature, piece by piece."""
    marks = np.unique(np.concatenate([curves.ends, ends]))
    x, w = np.polynomial.legendre.leggauss(curves.series.shape[-1] + _MORE)
    middle, half = 0.5 * (marks[1:] + marks[:-1]), 0.5 * np.diff(marks)
    return (middle[:, None] + half[:, None] * x).ravel(), (half[:, None] * w).ravel()
