"""Synthesis at the critical speeds: the order that is critical alone, and all orders in phase.

Critical is the speed at which an order meets a natural frequency without damping. Damping, dampers above all,
and neighbouring modes have the forced response peak beside it. The peak is therefore a maximum of the forced
response to that order, in the shaft, over the speed. It belongs to the critical speed below or above it:
as many critical speeds as possible have a peak, those beyond the speeds analysed included, and among such
choices the peaks are highest. A critical speed is left without one where its peak has merged with that of a
neighbour, where damping is too strong for one, where the order does no work, or where the peak lies beyond
the speeds analysed.

Of the shafts in which the order peaks, the one that is nearest to its permitted stress there, with all
orders; where no stress is limited, the shaft that the order twists most.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Annotated, NamedTuple

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.kernel.units.kinds import PRESSURE, TORQUE, Kind
from linkwright.torsion.excitation.excited_train import ExcitedTrain
from linkwright.torsion.limits.criteria import peaks_on
from linkwright.torsion.limits.survey import Survey
from linkwright.torsion.modes.campbell import CampbellDiagram, CriticalSpeed
from linkwright.torsion.response.forced import TorsionResponse, torsion_response
from linkwright.torsion.response.stress import ShaftStress, shaft_stress, stress_per_torque

# Orders that differ by a smaller share are one.
_EQUAL = 1e-9

# Even speeds at which the response to an order is examined, and shares of the distance between two speeds of
# resonance at which it is examined from both: peaks are as narrow as modes are lightly damped.
_POINTS = 200
_SHARES = 0.5 * np.logspace(-4, 0, 16)

# Share by which a response falls between two peaks, beyond what interpolated torques make.
_DIP = 1e-6

# Rounds in which a peak is closed in on: to some 10⁻⁶ of what it is apart from the next speed examined.
_ROUNDS = 8

# Share of a shaft's largest stress or torque below which an order alone is rounding.
_ROUNDING = 1e-12

# Share of a critical speed beside it, where nothing damps a mode: at it there is no solution.
_BESIDE = 1e-6


@dataclass(frozen=True)
class CriticalResponse(Result):
    """A shaft at a critical speed."""

    order: Annotated[float, Label("excitation order of the first disc", "ν", "")]
    mode: Annotated[int, About("Row of `FreeVibration`.")]
    critical_speed: Annotated[
        float,
        Label("critical speed of the first disc", "ω", "rad/s", "Where the order meets the undamped mode."),
    ]
    speed: Annotated[
        float,
        Label(
            "speed at which the order peaks in the shaft",
            "",
            "rad/s",
            "By forced response. The critical speed where it has no peak of its own.",
        ),
    ]
    is_peak: Annotated[
        bool, About("Whether the order has a peak of its own there, among the speeds analysed.")
    ]
    shaft: Annotated[str, About("Of those in which it peaks, the shaft that is nearest to its limit there.")]
    kind: Annotated[Kind, About("Stress, or torque where none is limited.")]
    single: Annotated[
        float, About("Amplitude of the order alone; infinite at a resonance that nothing damps [SI].")
    ]
    total: Annotated[
        float, About("Half the peak-to-peak value, orders summed in phase; infinite likewise [SI].")
    ]
    permitted: Annotated[
        float | None,
        Label("stress permitted there in continuous operation", "", "Pa", "None without a limit."),
    ]


# Peaks that a choice has, their heights together, their nearness together.
_Score = tuple[int, float, float]


class _Place(NamedTuple):
    """Where a shaft is examined for a critical speed."""

    row: int  # of the shafts that count
    speed: float  # [rad/s]
    is_peak: bool
    single: float  # of the order alone [SI]


def critical_responses(seen: Survey, diagram: CampbellDiagram) -> tuple[CriticalResponse, ...]:
    """What the shafts carry at all critical speeds, by critical speed."""
    if not diagram.of_orders or not seen.found.shafts:
        return ()
    loads = _Loads(seen)
    places: dict[int, list[_Place]] = {}
    for order in dict.fromkeys(one.order for one in diagram.of_orders):
        numbers = [n for n, one in enumerate(diagram.of_orders) if one.order == order]
        of_order = _places(loads, order, [diagram.of_orders[n] for n in numbers])
        places |= dict(zip(numbers, of_order, strict=True))
    return tuple(_chosen(loads, diagram.of_orders, [places[n] for n in range(len(diagram.of_orders))]))


@dataclass(frozen=True)
class _Loads:
    """Quantity compared at critical speeds: stresses with a limit, else torques."""

    seen: Survey

    @cached_property
    def _stress(self) -> ShaftStress:
        return shaft_stress(self.seen.machine, self.seen.found, self.seen.service)

    @cached_property
    def limited(self) -> list[int]:
        rows: list[int] = np.flatnonzero(np.isfinite(self._stress.continuous).any(axis=1)).tolist()
        return rows

    @cached_property
    def shafts(self) -> tuple[str, ...]:
        if not self.limited:
            return self.seen.found.shafts
        return tuple(self._stress.shafts[row] for row in self.limited)

    @cached_property
    def rounding(self) -> Floats:
        """What is rounding in each, (shafts,)."""
        amplitudes = self.of(self.seen.found)
        largest: Floats = np.where(np.isfinite(amplitudes), amplitudes, 0.0).max(axis=1)
        return _ROUNDING * largest

    def of(self, response: TorsionResponse) -> Floats:
        """Vibratory stress or torque, (shafts, speeds); infinite where unbounded."""
        amplitudes = response.shaft_torque_vibratory
        if self.limited:
            rows = [response.shafts.index(name) for name in self.shafts]
            amplitudes = (
                stress_per_torque(self.seen.at.train.shafts, response)[self.limited] * amplitudes[rows]
            )
        return np.where(np.isfinite(amplitudes), amplitudes, np.inf)

    def together(self, speeds: Floats) -> tuple[Floats, Floats]:
        """All orders in phase, and what is permitted, (shafts, speeds)."""
        amplitudes, permitted = [], []
        for at in self.seen.parts(speeds):
            response = torsion_response(at)
            amplitudes.append(self.of(response))
            if self.limited:
                stress = shaft_stress(self.seen.machine, response, self.seen.service)
                permitted.append(stress.continuous[self.limited])
            else:
                permitted.append(np.full_like(amplitudes[-1], np.nan))
        return np.concatenate(amplitudes, axis=1), np.concatenate(permitted, axis=1)

    def alone(self, order: float) -> Survey:
        return replace(self.seen, at=_one_order(self.seen.at, order))


def _one_order(at: ExcitedTrain, order: float) -> ExcitedTrain:
    same = at.torques.is_of(order)
    harmonics = at.torques.harmonics[same].sum(axis=0, keepdims=True)
    return replace(
        at, torques=replace(at.torques, orders=np.array([order]), harmonics=harmonics, fixed=np.empty(0))
    )


def _places(loads: _Loads, order: float, critical: Sequence[CriticalSpeed]) -> list[list[_Place]]:
    """Shafts that peak at each critical speed of an order, with the peak; all if none does."""
    alone = loads.alone(order)

    def curves(speeds: Floats) -> Floats:
        parts = [loads.of(torsion_response(_one_order(at, order))) for at in alone.parts(speeds)]
        return np.concatenate(parts, axis=1)

    grid = _grid(loads.seen, order, critical)
    below, above = loads.seen.resonances_beyond(order)
    rows = range(len(loads.shafts))
    peaks = peaks_on(curves, [(row, grid) for row in rows], _DIP, _ROUNDS)
    beside = [_beside(one, grid) for one in critical]
    every = np.array([*beside, *(speed for listed in peaks for speed in listed)])
    heights = curves(every)
    listed: list[list[_Place]] = [[] for _ in critical]
    first = len(beside)
    for row, speeds in enumerate(peaks):
        sizes = heights[row, first : first + len(speeds)]
        first += len(speeds)
        real = [
            (speed, size)
            for speed, size in zip(speeds, sizes.tolist(), strict=True)
            if size > loads.rounding[row]
        ]
        owned = _owned([*below, *(one.speed for one in critical), *above], real)
        for n, peak in enumerate(owned[len(below) : len(below) + len(critical)]):
            if peak is not None:
                listed[n].append(_Place(row, *_bounded(critical[n], *real[peak])))
    return [
        peaking or [_Place(row, one.speed, False, float(heights[row, n])) for row in rows]
        for n, (one, peaking) in enumerate(zip(critical, listed, strict=True))
    ]


def _grid(seen: Survey, order: float, critical: Sequence[CriticalSpeed]) -> Floats:
    """Speeds fine enough for the peaks of an order: even, and denser about resonances."""
    run = seen.at.torques.speeds
    low, high = float(run.min()), float(run.max())
    moved, orders = seen.damped_resonances
    damped = [one.speed for one in critical if one.damping_ratio != 0]
    marks = [one.speed for one in critical] + [
        one.peak_speed for one in critical if one.peak_speed is not None
    ]
    marks += moved[np.abs(orders - order) <= _EQUAL * order].tolist()
    ends = np.unique([low, *(mark for mark in marks if low < mark < high), high])
    between = np.multiply.outer(np.diff(ends), np.concatenate([_SHARES, 1 - _SHARES])) + ends[:-1, None]
    resonant = set(marks) - {one.speed for one in critical} | set(damped)
    points = np.concatenate(
        [
            [low, high],
            np.linspace(low, high, _POINTS),
            run,
            between.ravel(),
            [x for x in resonant if low < x < high],
        ]
    )
    undamped = [one.speed for one in critical if one.damping_ratio == 0]
    apart = np.abs(points[:, None] - np.array(undamped)).min(axis=1, initial=np.inf)
    return np.unique(points[(apart > _EQUAL * points) | (points == low) | (points == high)])


def _beside(one: CriticalSpeed, grid: Floats) -> float:
    """A critical speed, or one next to it where there is no solution."""
    if one.damping_ratio != 0:
        return one.speed
    above = one.speed * (1 + _BESIDE)
    return above if above <= grid[-1] else one.speed * (1 - _BESIDE)


def _bounded(one: CriticalSpeed, speed: float, size: float) -> tuple[float, bool, float]:
    """A peak, whether it is one, and its height; unbounded where nothing damps the mode."""
    if one.damping_ratio == 0 and abs(speed - one.speed) < _BESIDE * one.speed:
        return one.speed, True, math.inf
    return speed, True, size


def _owned(critical: Sequence[float], peaks: Sequence[tuple[float, float]]) -> list[int | None]:
    """The peak, by speed and height, that belongs to each critical speed, if any."""
    # Each lies between the critical speeds next to its own. Of all such choices that with most peaks, then
    # with the highest, then with the nearest ones. The best choice so far by the last peak that it uses:
    best: dict[int, tuple[_Score, list[int | None]]] = {-1: ((0, 0.0, 0.0), [])}
    for n, speed in enumerate(critical):
        below = critical[n - 1] if n else 0.0
        above = critical[n + 1] if n + 1 < len(critical) else math.inf
        inside = [k for k, (at, _) in enumerate(peaks) if below < at < above]
        longer: dict[int, tuple[_Score, list[int | None]]] = {}
        for last, ((count, height, nearness), chosen) in best.items():
            choices: list[tuple[int, _Score, int | None]] = [(last, (count, height, nearness), None)]
            for k in inside:
                if k > last:
                    at, size = peaks[k]
                    score = (count + 1, height + _height(size), nearness - abs(math.log(at / speed)))
                    choices.append((k, score, k))
            for k, score, pick in choices:
                if k not in longer or score > longer[k][0]:
                    longer[k] = score, [*chosen, pick]
        best = longer
    return max(best.values(), key=lambda choice: choice[0])[1]


def _height(size: float) -> float:
    """Height in steps, so that nearly equal heights compare as equal."""
    return round(math.log(min(size, 1e300)), 9)


def _chosen(
    loads: _Loads, critical: Sequence[CriticalSpeed], places: Sequence[Sequence[_Place]]
) -> list[CriticalResponse]:
    if not loads.limited:
        places = [[max(listed, key=lambda place: place.single)] for listed in places]
    every = [place for listed in places for place in listed]
    amplitudes, permitted = loads.together(np.array([place.speed for place in every]))
    columns = iter(range(len(every)))
    chosen = []
    for one, listed in zip(critical, places, strict=True):
        mine = [next(columns) for _ in listed]
        ratio = [
            amplitudes[place.row, n] / permitted[place.row, n] for place, n in zip(listed, mine, strict=True)
        ]
        best = int(np.nan_to_num(ratio, nan=-1.0, posinf=np.inf).argmax())
        place, n = listed[best], mine[best]
        limit = float(permitted[place.row, n])
        total = math.inf if math.isinf(place.single) else float(amplitudes[place.row, n])
        chosen.append(
            CriticalResponse(
                order=one.order,
                mode=one.mode,
                critical_speed=one.speed,
                speed=place.speed,
                is_peak=place.is_peak,
                shaft=loads.shafts[place.row],
                kind=PRESSURE if loads.limited else TORQUE,
                single=place.single,
                total=total,
                permitted=limit if math.isfinite(limit) else None,
            )
        )
    return chosen
