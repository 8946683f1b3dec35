"""A linkage swept over its cycle: crank angles, curves, exact extremes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import FindingError
from linkwright.kernel.numerics.zeros import brackets, zeros
from linkwright.linkages.closure import Closure
from linkwright.linkages.dyads import Dyad, dyads_of, transmission, transmission_channels, transmission_slope
from linkwright.linkages.model.mechanism import Mechanism
from linkwright.machine.program.compiled import CompiledMachine
from linkwright.machine.program.core import Channel, Element
from linkwright.machine.program.motion import LinkRows, PointRows, Rows
from linkwright.machine.program.places import length_name

# Intervals of a revolution between which at most one extreme of a kind is expected: a degree.
_INTERVALS = 360

# Where the sweep begins, off the angles at which symmetric linkages have their extremes.
_OFFSET = 0.0123

# Part of its range at each end that the curves of a linkage with limits keep clear of: rates have no limit
# there [rad].
_MARGIN = 1e-7

# Share of the travel by which extreme positions of different turns may differ and be the same.
_EQUAL = 1e-9

# A derivative below this share of the maximum of its kind is rounding of zero.
_FLAT = 1e-11


@dataclass(frozen=True)
class Cycle:
    """The crank angles that are examined."""

    angles: Floats  # (n,): [rad]
    ends: Floats  # (2,): the first and the last; of a linkage with limits those themselves [rad]
    period: int | None  # revolutions after which the motion repeats; None if it does not, or has limits

    @classmethod
    def of(cls, where: Closure, period: int | None) -> Cycle:
        """A period, a revolution where there is none, or the first range in which the mechanism closes."""
        if where.turns_fully:
            turns = period or 1
            angles = np.linspace(_OFFSET, _OFFSET + 2 * np.pi * turns, _INTERVALS * turns + 1)
            return cls(angles, angles[[0, -1]], period)
        low, high = where.ranges[0]
        margin = min(_MARGIN, 0.01 * (high - low))
        angles = np.linspace(low + margin, high - margin, _INTERVALS + 1)
        return cls(angles, np.array([low, high]), None)

    @property
    def repeats(self) -> bool:
        """Whether the motion at the last is that at the first."""
        return self.period is not None

    @property
    def has_limits(self) -> bool:
        """Whether the mechanism closes between its ends alone."""
        return bool(self.ends[0] < self.angles[0])

    @property
    def span(self) -> float:
        """From the first angle to the last [rad]."""
        return float(self.angles[-1] - self.angles[0])

    def named(self, angle: float) -> float:
        """An angle as readers count it: within one revolution, as it is in a longer cycle or range [rad]."""
        return float(angle % (2 * np.pi) if self.span < 2 * np.pi * 1.01 else angle)


@dataclass(frozen=True)
class Travel:
    """Extreme positions of an output [rad or m], the crank angles there, turns, time ratio."""

    low: float
    high: float
    low_angle: float
    high_angle: float
    turns: float | None
    time_ratio: float | None


class LinkageSweep:
    """Curves and located zeros of a sweep.

    Attributes
    ----------
    dyads, outputs : list
        What was swept.
    mu : ndarray, shape (dyads, n)
        Transmission angles.
    position, d1 : ndarray, shape (outputs, n)
        Of the outputs; links with continuous angles.
    """

    def __init__(self, compiled: CompiledMachine, mechanism: Mechanism, cycle: Cycle) -> None:
        self.compiled, self.cycle = compiled, cycle
        self.dyads: list[Dyad] = [dyad for dyad in dyads_of(compiled) if dyad.kind != "group"]
        self.outputs: list[Output] = outputs_of(compiled, mechanism)
        channels = [transmission_channels(compiled, dyad) for dyad in self.dyads]
        self._ends = np.cumsum([0, *(len(channel) for channel in channels)])
        self._channels = [channel for part in channels for channel in part]
        self._channels += [output.channel for output in self.outputs]
        self.mu, self.position, slopes = self._at(cycle.angles)
        for k, output in enumerate(self.outputs):
            if output.kind == "swing":
                self.position[k] = np.unwrap(self.position[k])
        self.d1 = slopes[len(self.dyads) : len(self.dyads) + len(self.outputs)]
        self._zeros = self._locate(slopes)
        # All extremes and ends are examined once for all outputs.
        changes = [np.array(dyad.change_points) for dyad in self.dyads]
        spots: list[Floats] = [*self._zeros, *changes, cycle.ends, cycle.angles[[0, -1]]]
        self._spots = np.array(sorted(set(np.concatenate(spots).tolist())))
        self._there = self._at(self._spots)

    def _seen(self, angles: Floats) -> tuple[Floats, Floats, Floats]:
        """The same as `_at` at some of the spots."""
        k = self._spots.searchsorted(angles)
        return self._there[0][:, k], self._there[1][:, k], self._there[2][:, k]

    def _at(self, angles: Floats) -> tuple[Floats, Floats, Floats]:
        """μ, positions, and what changes sign at extremes, as `_slopes`."""
        values = self.compiled.motion(self._channels, angles)
        mu, place = np.empty((len(self.dyads), len(angles))), np.empty((len(self.outputs), len(angles)))
        for k, (dyad, part) in enumerate(self._by_dyad(values)):
            mu[k] = transmission(self.compiled.parameters, dyad, part)
        for k, rows in enumerate(values[self._ends[-1] :]):
            assert not isinstance(rows, PointRows)
            place[k] = np.arctan2(*rows.direction[::-1]) if isinstance(rows, LinkRows) else rows.position
        return mu, place, self._slopes_of(values, len(angles))

    def _slopes(self, angles: Floats) -> Floats:
        """What changes sign at extremes: dμ/dφ, then d1, then d2 of the outputs, (…, n)."""
        return self._slopes_of(self.compiled.motion(self._channels, angles), len(angles))

    def _slopes_of(self, values: list[Rows], n: int) -> Floats:
        dyads, outputs = len(self.dyads), len(self.outputs)
        slopes = np.empty((dyads + 2 * outputs, n))
        for k, (dyad, part) in enumerate(self._by_dyad(values)):
            slopes[k] = transmission_slope(self.compiled.parameters, dyad, part)
        for k, rows in enumerate(values[self._ends[-1] :]):
            assert not isinstance(rows, PointRows)
            slopes[dyads + k], slopes[dyads + outputs + k] = rows.d1, rows.d2
        return slopes

    def _by_dyad(self, values: list[Rows]) -> Iterator[tuple[Dyad, list[Rows]]]:
        for k, dyad in enumerate(self.dyads):
            yield dyad, values[self._ends[k] : self._ends[k + 1]]

    def _locate(self, slopes: Floats) -> list[Floats]:
        largest = np.nan_to_num(np.abs(slopes)).max(axis=1, initial=0.0)
        kinds = ["angle"] * len(self.dyads) + [output.kind for output in self.outputs] * 2
        sizes = {kind: max(x for x, k in zip(largest, kinds, strict=True) if k == kind) for kind in kinds}
        moves = np.array([x > _FLAT * sizes[k] for x, k in zip(largest, kinds, strict=True)], dtype=bool)
        row, column = brackets(np.where(moves[:, None], slopes, 1.0))
        if not len(row):
            return [np.empty(0) for _ in slopes]
        angles, every = self.cycle.angles, np.arange(len(row))
        near, _ = zeros(lambda x: self._slopes(x)[row, every], angles[column], angles[column + 1])
        return [near[row == k] for k in range(len(slopes))]

    # -- what was found ----------------------------------------------------------------------------------

    def reversals(self, k: int) -> Floats:
        """Crank angles at which an output turns back."""
        return self._zeros[len(self.dyads) + k]

    def turns_of_transmission(self, k: int) -> Floats:
        """Crank angles at which the transmission angle of a dyad turns back."""
        return self._zeros[k]

    def travel(self, k: int) -> Travel:
        """Extreme positions of an output."""
        place, cycle, output = self.position[k], self.cycle, self.outputs[k]
        total = abs(place[-1] - place[0])
        if output.kind == "swing" and cycle.repeats and total > np.pi:
            low, high = sorted((float(place[0]), float(place[-1])))
            ends = cycle.angles[[0, -1]] if place[-1] > place[0] else cycle.angles[[-1, 0]]
            return Travel(low, high, float(ends[0]), float(ends[1]), float(total / (2 * np.pi)), None)
        at = self.reversals(k)
        if not len(at) or not cycle.repeats:
            at = np.concatenate([at, cycle.ends, cycle.angles[[0, -1]]])
        values = self.positions(k, at)
        if np.isnan(values).all():
            raise FindingError(
                f"{output.name} moves over no angle: its mechanism closes within a range as narrow as "
                "rounding; change its lengths"
            )
        low, high = int(np.nanargmin(values)), int(np.nanargmax(values))
        ratio = time_ratio(at, values, cycle.span) if cycle.repeats else None
        angles = self.cycle.named(at[low]), self.cycle.named(at[high])
        return Travel(float(values[low]), float(values[high]), *angles, None, ratio)

    def positions(self, k: int, at: Floats) -> Floats:
        """Positions of an output at angles; of a link on the revolution that the sweep has there."""
        values = self._seen(at)[1][k]
        if self.outputs[k].kind == "swing":
            near = np.interp(at, self.cycle.angles, self.position[k])
            values = near + (values - near + np.pi) % (2 * np.pi) - np.pi
        positions: Floats = values
        return positions

    def ratios(self, k: int) -> tuple[float, float] | tuple[None, None]:
        """Extremes of the output's speed over the crank's; None where a limit lets them grow."""
        if self.cycle.has_limits:
            return None, None
        at = self._zeros[len(self.dyads) + len(self.outputs) + k]
        at = np.concatenate([at, self.cycle.angles[[0, -1]]])
        values = self._seen(at)[2][len(self.dyads) + k]
        return float(values.min()), float(values.max())

    def transmission(self, element: str) -> tuple[float, float, float, float] | None:
        """Minimum and maximum μ of a dyad, and their crank angles."""
        k = next((k for k, dyad in enumerate(self.dyads) if dyad.name == element), None)
        if k is None:
            return None
        at = np.concatenate(
            [self._zeros[k], self.dyads[k].change_points, self.cycle.ends, self.cycle.angles[:1]]
        )
        values = self._seen(at)[0][k]
        low, high = int(np.nanargmin(values)), int(np.nanargmax(values))
        angles = self.cycle.named(at[low]), self.cycle.named(at[high])
        return float(values[low]), float(values[high]), *angles


def time_ratio(at: Floats, values: Floats, span: float) -> float | None:
    """Crank angle of the slower way between the extreme positions over that of the quicker one."""
    ways = ways_between(at, values, span)
    if ways is None:
        return None
    up, down = ways[0][1], ways[1][1]
    return max(up, down) / min(up, down)


class Way(NamedTuple):
    """A way between two extreme positions: places among the extremes where it ends, length [rad]."""

    ends: tuple[int, int]
    length: float


def ways_between(at: Floats, values: Floats, span: float) -> tuple[Way, Way] | None:
    """From a lowest position to the next highest, and on to the next lowest; None where there are none.

    `at` (n,): crank angles of the extremes [rad]; `values` (n,); `span`: length of the cycle [rad]. Over
    several revolutions an output may come to its extremes several times.
    """
    same = _EQUAL * np.ptp(values)
    lows = np.flatnonzero(values <= values.min() + same)
    highs = np.flatnonzero(values >= values.max() - same)
    start = int(lows[0])
    to_highs = (at[highs] - at[start]) % span
    up = int(to_highs.argmin())
    to_lows = (at[lows] - at[start] - to_highs[up]) % span
    down = int(to_lows.argmin())
    if not 0 < to_highs[up] < span or not to_lows[down] > 0:
        return None
    return (
        Way((start, int(highs[up])), float(to_highs[up])),
        Way((int(highs[up]), int(lows[down])), float(to_lows[down])),
    )


def sweep(compiled: CompiledMachine, mechanism: Mechanism, cycle: Cycle) -> LinkageSweep:
    """Sweep a mechanism over a cycle.

    `cycle`: where it is examined.
    """
    return LinkageSweep(compiled, mechanism, cycle)


class Output(NamedTuple):
    """One coordinate that is moved."""

    element: str  # name of the element, or of a joint held by bars
    name: str  # name of the link or slide
    kind: Literal["swing", "stroke"]  # `"swing"` of a link or `"stroke"` along a guide
    channel: Channel  # what the core calls it


def outputs_of(compiled: CompiledMachine, mechanism: Mechanism) -> list[Output]:
    """The outputs of a machine in build order, without drivers; for a rocker its link on the pivot."""
    names = _Names(compiled, mechanism)
    return [name for element in compiled.elements for name in names.of(element)]


class _Names:
    def __init__(self, compiled: CompiledMachine, mechanism: Mechanism) -> None:
        self.compiled, self.mechanism = compiled, mechanism
        self.links = {index: name for name, index in compiled.links.items()}
        self.slides = {index: name for name, index in compiled.slides.items()}
        self.grounds = {fixed.point for fixed in compiled.ground}
        cylinders = mechanism.cylinders
        # Of a cylinder the barrel counts; its rod swings and moves with it.
        self.rods = {f"{name}.rod" for name in cylinders}
        self.driven = {*mechanism.linear_drivers, *map(length_name, cylinders)}

    def of(self, element: Element) -> Iterator[Output]:
        dyads = self.compiled.dyads
        match element:
            case Element.SliderRod() | Element.GuidedRod():
                yield self._stroke(dyads[element.dyad], element.slide)
            case Element.Rocker():
                yield self._swing(dyads[element.dyad], self._hung(element))
            case Element.SlottedLever() if dyads[element.dyad] not in self.rods:
                yield self._swing(dyads[element.dyad], element.link)
                yield self._stroke(dyads[element.dyad], element.slide)
            case Element.Crossing():
                yield from (self._stroke(dyads[element.dyad], slide) for slide in element.slides)
            case Element.Runner(slide=slide) if self.slides[slide] not in self.driven:
                yield self._stroke(self.slides[slide], slide)
            case Element.Turn(link=link) if self.links[link] in self.mechanism.gears:
                yield self._swing(self.links[link], link)
            case Element.Group():
                yield from self._group(dyads[element.dyad])

    def _stroke(self, element: str, slide: int) -> Output:
        return Output(element, self.slides[slide], "stroke", Channel.Slide(slide))

    def _swing(self, element: str, link: int) -> Output:
        name = self.links[link].removesuffix(" reversed")
        return Output(element, name, "swing", Channel.Link(self.compiled.links[name]))

    def _hung(self, dyad: Element.Rocker) -> int:
        """The link of an RRR dyad that is on a fixed pivot, the second if both or none are."""
        first = dyad.pin in self.grounds and dyad.pivot not in self.grounds
        return dyad.coupler_link if first else dyad.rocker_link

    def _group(self, dyad: str) -> Iterator[Output]:
        joints = dyad.split(" and ")
        fixed = self.mechanism.fixed_points()
        for name, bar in self.mechanism.bars.items():
            ends = (bar.start, bar.end)
            if any(end in joints for end in ends) and any(end in fixed for end in ends):
                yield self._swing(name, self.compiled.links[name])
        for joint in joints:
            if joint in self.compiled.slides:
                yield self._stroke(joint, self.compiled.slides[joint])
