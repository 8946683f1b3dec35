r"""Speed and torque at a driver over a cycle, piece by piece, and their means over time.

Each piece is integrated for itself, with polynomials through neighbouring samples, and so are extremes found
between these: means and peaks are exact for a law of pieces. It is divided where the power changes its
sign, since losses jump there. Samples may carry tangents; their instants then move with the ends of pieces.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Any, Literal, NamedTuple, Self

import numpy as np

from linkwright.axes.model.axis_gearbox import AxisGearbox
from linkwright.kernel.arrays import Floats
from linkwright.kernel.numerics.implicit import solution_along
from linkwright.kernel.numerics.tangent import Tangent, primal, zeros_for
from linkwright.machine.program.drive_line import reverse_factor

# Share of the peak speed or torque below which a sample counts as rest, or as no load: rounding.
_REST = 1e-9

# Nodes that differ by less from even ones are even.
_EVEN = 1e-9

# Samples through which a curve is laid to integrate it over an interval.
_ORDER = 6

# Samples through which a curve is laid beside its peak, and of which it takes that many; rounds of Newton.
_STENCIL, _TURNS, _ROUNDS = 7, 4, 6

# How far a rival may seem to stay below the peak, as a share of the range, and how many are compared.
_DOUBT, _COMPARED = 1e-2, 24

# An end between two samples differs from both by this share of the interval.
_INSIDE = 1e-9


class Ends(NamedTuple):
    """Where pieces are divided: between samples, at a share of the interval, and at samples."""

    after: Any  # (m,) places of samples
    share: Any  # (m,) of the interval behind each
    own: Any  # places of samples that end a piece themselves

    def among(self, columns: list[Any]) -> list[Any]:
        """Columns with both sides of every end; between two samples values are those on straight lines."""
        at, n = self.after, len(primal(columns[0]))
        inside = np.clip(primal(self.share), _INSIDE, 1 - _INSIDE)
        place = np.concatenate([np.arange(n), np.repeat(at + inside, 2), self.own])
        order = np.argsort(place, kind="stable")
        return [
            np.concatenate([column, *self._between(column), column[self.own]])[order] for column in columns
        ]

    def _between(self, column: Any) -> list[Any]:
        """Values at the ends between samples, once for each side, in turn."""
        first = column[self.after]
        crossing = first + self.share * (column[self.after + 1] - first)
        return [crossing[np.repeat(np.arange(len(self.after)), 2)]]


def joined(ends: Sequence[Ends]) -> Ends:
    """All of several ends."""
    own = np.array(sorted({int(place) for each in ends for place in each.own}), dtype=np.intp)
    after, share = (np.concatenate([each[part] for each in ends]) for part in (0, 1))
    return Ends(after, share, own)


def sign_changes(time: Any, value: Any) -> Ends:
    """Where a value changes its sign between samples."""
    sign, step = np.sign(primal(value)), np.diff(primal(time))
    at = np.flatnonzero((sign[:-1] * sign[1:] < 0) & (step > 0))
    first, last = value[at], value[at + 1]
    return Ends(at, first / (first - last), _rests(sign, step))


def _rests(sign: Floats, step: Floats) -> Any:
    """Samples without power between two of opposite sign."""
    inner = np.arange(1, len(sign) - 1)
    own = inner[(sign[inner] == 0) & (sign[inner - 1] * sign[inner + 1] < 0)]
    return own[(step[own - 1] > 0) & (step[own] > 0)]


@dataclass(frozen=True)
class DriverCycle:
    """Speed and torque at a driver that turns, over one cycle; a time that occurs twice ends a piece.

    There, the first sample belongs to the piece before and the second to that behind, so that torques may
    jump.
    """

    time: Any  # from 0, not decreasing [s]
    speed: Any  # [rad/s]
    acceleration: Any  # [rad/s²]
    torque: Any  # that the drive gives to the driver; positive in the sense of the speed [N m]
    # Mean inertia of the mechanism at the driver; None if it is not known [kg m²].
    inertia: Any = None
    turns: bool = True  # else along a line, in m/s, N and kg: no screw or pinion is known

    @classmethod
    def of_line(
        cls,
        time: Any,
        velocity: Any,
        acceleration: Any,
        force: Any,
        per_turn: Any,
        mass: Any = None,
    ) -> Self:
        """Of a driver that moves along a line by `per_turn` [m] per revolution of its screw or pinion.

        `mass`: mean mass of the mechanism at the driver [kg].
        """
        lead = per_turn / (2 * math.pi)
        inertia = None if mass is None else mass * lead * lead
        return cls(time, velocity / lead, acceleration / lead, force * lead, inertia)

    @property
    def period(self) -> Any:
        """Time of a cycle [s]."""
        return self.time[-1] - self.time[0]

    @property
    def power_sign(self) -> Floats:
        """1 where the drive drives the mechanism, −1 where the mechanism drives it, 0 at rest."""
        speed, torque = (_without_specks(primal(values)) for values in (self.speed, self.torque))
        return np.sign(speed) * np.sign(torque)

    def ends(self) -> Ends:
        """Where the power changes its sign, and losses jump; between two samples on straight lines."""
        sign, step = self.power_sign, np.diff(primal(self.time))
        at = np.flatnonzero((sign[:-1] * sign[1:] < 0) & (step > 0))
        speed = primal(self.speed)
        turns_back = speed[at] * speed[at + 1] < 0
        first, last = (np.where(turns_back, self.speed[k], self.torque[k]) for k in (at, at + 1))
        return Ends(at, first / (first - last), _rests(sign, step))

    def divided(self, ends: Ends | None = None) -> Self:
        """The same cycle with pieces that end where the power changes its sign, or at other places."""
        columns = [self.time, self.speed, self.acceleration, self.torque]
        time, speed, acceleration, torque = (self.ends() if ends is None else ends).among(columns)
        return replace(self, time=time, speed=speed, acceleration=acceleration, torque=torque)

    def geared(self, gearbox: AxisGearbox) -> tuple[Any, Any, Any]:
        """Speed and acceleration at the motor, and the torque there that the driver asks for.

        [rad/s, rad/s², N m]; of a cycle that is `divided`.
        """
        ratio, back = gearbox.ratio, reverse_factor(gearbox)
        sign = self._side_of_power()
        factor = np.where(sign > 0, 1 / gearbox.efficiency, np.where(sign < 0, 1 / back, 1.0))
        if gearbox.locks:
            factor = np.where(sign > 0, factor, 0.0)
        return self.speed * ratio, self.acceleration * ratio, self.torque / ratio * factor

    def _side_of_power(self) -> Floats:
        """The sign of the power about each sample: at an instant of rest, that of its neighbour."""
        sign, ends = self.power_sign, np.diff(primal(self.time)) == 0
        left = np.concatenate([[0.0], np.where(ends, 0.0, sign[:-1])])
        right = np.concatenate([np.where(ends, 0.0, sign[1:]), [0.0]])
        return np.where(sign == 0, np.where(right != 0, right, left), sign)

    def weights(self) -> Any:
        """Weights of the samples in an integral over the time of a cycle [s]."""
        return integration_weights(self.time)

    def mean(self, values: Any) -> Any:
        """Mean of values over the time of a cycle."""
        return np.sum(self.weights() * values) / self.period


def _without_specks(values: Floats) -> Floats:
    """The values with zero for what is rounding beside the largest."""
    return np.where(np.abs(values) <= _REST * np.max(np.abs(values), initial=0.0), 0.0, values)


def integration_weights(time: Any) -> Any:
    """Weights of samples in an integral over time, each piece between equal times for itself.

    Over each interval the polynomial through its six nearest samples of the piece is integrated.
    """
    weights = zeros_for((time,), (len(primal(time)),))
    for _, stencil, share in _intervals(time):
        np.add.at(weights, stencil, share)
    return weights


def running_integral(time: Any, values: Any) -> Any:
    """Integral of values from the start up to each sample."""
    steps = zeros_for((time, values), (len(primal(time)),))
    for behind, stencil, share in _intervals(time):
        steps[behind] = np.sum(share * values[stencil], axis=-1)
    return np.cumsum(steps)


def _intervals(time: Any) -> Iterator[tuple[Any, Any, Any]]:
    """End of each interval of each piece, samples that its integral takes, and their weights."""
    ends = np.flatnonzero(np.diff(primal(time)) == 0) + 1
    for first, last in zip([0, *ends], [*ends, len(primal(time))], strict=True):
        n = last - first
        if n < 2:
            continue
        order = min(_ORDER, n)
        left = first + np.arange(n - 1)
        stencil = np.clip(left - order // 2 + 1, first, last - order)[:, None] + np.arange(order)
        width = time[left + 1] - time[left]
        nodes = (time[stencil] - time[left][:, None]) / width[:, None]
        yield left + 1, stencil, _shares(nodes, left - stencil[:, 0]) * width[:, None]


def _shares(nodes: Any, place: Any) -> Any:
    """Weights of samples at nodes, (n, order), in an integral from 0 to 1; `place`: of the node at 0."""
    order = nodes.shape[1]
    shares = _even_shares(order)[place]
    # Beside an end that was put between two samples these are not even.
    even = np.abs(primal(nodes) - (np.arange(order) - place[:, None])).max(axis=1) < _EVEN
    if isinstance(nodes, Tangent):
        even[:] = False
    if not even.all():
        solved = _solved_shares(nodes[~even])
        shares = solved if not even.any() else shares
        if even.any():
            shares[~even] = solved
    return shares


def _solved_shares(nodes: Any) -> Any:
    """Such weights by the integrals of powers."""
    order = nodes.shape[1]
    moments = np.broadcast_to(1 / (np.arange(order) + 1), nodes.shape)
    matrix = np.stack([nodes**power for power in range(order)], axis=1)
    share = np.linalg.solve(primal(matrix), moments[:, :, None])[:, :, 0]
    return solution_along(share, np.einsum("nij,nj->ni", matrix, share) - moments, primal(matrix))


@cache
def _even_shares(order: int) -> Floats:
    """Such weights for even nodes, by the place of the node at 0."""
    shares: Floats = _solved_shares(np.arange(float(order)) - np.arange(float(order))[:, None])
    return shares


class Place(NamedTuple):
    """Where a curve turns back."""

    time: float  # [s]
    value: Any


class Peak(NamedTuple):
    """A curve of which one value is wanted: the largest in size, the maximum or the minimum."""

    time: Any
    curve: Any
    kind: Literal["size", "max", "min"] = "size"

    @property
    def value(self) -> float:
        """The peak."""
        return float(primal(self.places(0.0)[0].value))

    def places(self, tie: float) -> list[Place]:
        """The peak, and all that is as high but for a share of the range.

        Between samples it is that of the polynomial through the nearest of its piece.
        """
        time, plain = primal(self.time), primal(self.curve)
        height = {"size": np.abs(plain), "max": plain, "min": -plain}[self.kind]
        known = np.isfinite(height)
        if not known.all():
            height = np.where(known, height, -np.inf)
        top, span = float(height.max()), float(np.ptp(height[known]))
        step = np.diff(time) > 0
        rises = np.append(True, ~step | (height[1:] >= height[:-1]))
        falls = np.append(~step | (height[:-1] >= height[1:]), True)
        high = np.flatnonzero(rises & falls & (height >= top - _DOUBT * span))
        # Of a curve that is level some places stand for all.
        high = high[np.argsort(-height[high], kind="stable")]
        high = np.append(high[:1], high[1 :: max(1, len(high) // _COMPARED)])
        places = [self._near(int(k)) for k in high]
        heights = [abs(primal(p.value)) if self.kind == "size" else primal(p.value) for p in places]
        if self.kind == "min":
            heights = [-height for height in heights]
        best = int(np.argmax(heights))
        order = sorted(range(len(places)), key=lambda k: (k != best, -heights[k]))
        return [places[k] for k in order if heights[k] >= heights[best] - tie * span]

    def _near(self, k: int) -> Place:
        """Where the curve turns back beside its sample `k`."""
        time, plain = primal(self.time), primal(self.curve)
        ends = np.flatnonzero(np.diff(time) == 0) + 1
        first = int(max(ends[ends <= k], default=0))
        last = int(min(ends[ends > k], default=len(time)))
        start = int(np.clip(k - _STENCIL // 2, first, max(first, last - _STENCIL)))
        stencil = np.arange(start, min(start + _STENCIL, last))
        sides = time[max(k - 1, first)], time[min(k + 1, last - 1)]
        if len(stencil) < _TURNS or not np.isfinite(plain[stencil]).all():
            return Place(float(time[k]), self.curve[k])
        width = (sides[1] - sides[0]) / 2
        x = (time[stencil] - time[k]) / width
        powers = np.vander(x)
        line = np.linalg.solve(powers, plain[stencil])
        slope, bends = np.polyder(line), np.polyder(line, 2)
        sense = math.copysign(1.0, plain[k]) if self.kind == "size" else 1.0 if self.kind == "max" else -1.0
        low, high = ((side - time[k]) / width for side in sides)
        at = 0.0
        for _ in range(_ROUNDS):
            bend = float(np.polyval(bends, at))
            if sense * bend >= 0:
                return Place(float(time[k]), self.curve[k])
            at -= float(np.polyval(slope, at)) / bend
        if not low < at < high or sense * np.polyval(line, at) < sense * plain[k]:
            return Place(float(time[k]), self.curve[k])
        # At a fixed time: samples that move have the slope there taken off.
        shares = np.linalg.solve(powers.T, np.vander([at], len(x))[0])
        there = self.curve[stencil]
        if isinstance(there, Tangent):
            there = there - np.polyval(slope, x) / width * (self.time[stencil] - time[stencil])
        return Place(float(time[k] + at * width), np.sum(shares * there))
