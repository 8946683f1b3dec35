r"""Derivatives of strokes, swings, time ratios and transmission angles by the entries of a machine.

The core differentiates the motion at fixed crank angles. An extreme f of a curve, at the angle φ* where its
derivative f′ is zero, has the derivative of the curve there (envelope theorem), and its angle follows from
f′ = 0:

.. math:: \frac{\mathrm d}{\mathrm dp} f(\varphi^*) = \left.\frac{\partial f}{\partial p}\right|_{\varphi^*},
   \qquad \frac{\mathrm d \varphi^*}{\mathrm dp} = -\frac{\partial f'/\partial p}{f''}

Where two extremes tie and follow an entry differently, there are only one-sided derivatives.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import FindingError
from linkwright.kernel.numerics.extreme import ALIKE, TIE, chosen, differ, occurs_at, they_differ
from linkwright.kernel.numerics.tangent import Tangent, lifted
from linkwright.kernel.quantities import shown
from linkwright.linkages.cycle import ElementMotion, examined, swept_cycle
from linkwright.linkages.dyads import transmission, transmission_channels, transmission_slope
from linkwright.linkages.sweep import Cycle, LinkageSweep, Output, ways_between
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine
from linkwright.machine.program.core import Channel
from linkwright.machine.tangents import Derivatives, Directions, directions

# A derivative by an entry doubled below this share of the largest is what rounding leaves of zero.
_ROUNDING = 1e-14

# A transmission angle that changes by less is that of a rigid triangle [rad].
_LEVEL_TO = 1e-12

_AT_AN_END = "the extreme occurs at a limit of the motion or at a change point"
_LEVEL = "it is the same at all crank angles"
_TURNS = "it is a whole number"
_REPEATS = "the motion repeats only at this value, which is or sets a gear ratio"


def linkage_tangents(machine: Machine, variables: Sequence[str]) -> Derivatives:
    """Scalars of the elements of a linkage by entries of its machine, named ``ELEMENT.quantity``.

    Raises what `linkage` raises, and FindingError: there is no link or slide to look at.
    """
    compiled, where, swept = swept_cycle(machine)
    known = examined(compiled, where, swept)
    elements = known.elements
    if not elements:
        raise FindingError(
            "the mechanism has no link or slide whose stroke, swing or transmission angle varies"
        )
    program = directions(machine, variables)
    leaving = _leaving(compiled, swept.cycle, program)
    refused = {**program.refused, **dict.fromkeys(leaving, _REPEATS)}
    program = program.only([name for name in program.variables if name not in leaving])
    found = _Found({}, {}, {}, program)
    for k, (name, element) in enumerate(zip(known.names, elements, strict=True)):
        found.of_output(name, element, _output_turns(compiled, swept, k, program), swept)
        found.of_transmission(name, element, _transmission_turns(compiled, swept, element.element, program))
        if element.turns is not None:
            found.missing[f"{name}.turns"] = _TURNS
    marks = {name: shown(ElementMotion, name.rpartition(".")[2]) for name in found.tangents}
    return Derivatives(
        *(program.variables, found.tangents, found.ties, found.missing, refused),
        words={name: f"{mark.word} of {name.rpartition('.')[0]}" for name, mark in marks.items()},
        units={name: mark.unit for name, mark in marks.items()},
    )


def _leaving(compiled: CompiledMachine, cycle: Cycle, program: Directions) -> list[str]:
    """Entries by which the motion does not repeat: after a period a link has moved otherwise than before."""
    if cycle.period is None or compiled.one_turn:
        return []
    channels: list[Channel] = [Channel.Link(link) for link in compiled.links.values()]
    angles = cycle.angles[0] + np.array([0.0, 2 * np.pi * cycle.period])
    before, after = np.moveaxis(compiled.motions_along(program.values, angles, channels), 1, 0)
    moved = np.abs(after - before) * program.sizes
    return [name for name, by in zip(program.variables, moved.T, strict=True) if by.max() > ALIKE]


@dataclass(frozen=True)
class _Turns:
    """Where a curve turns back: crank angles (m,) [rad], its heights there, and derivatives by k entries."""

    angles: Floats
    heights: Floats  # (m,) [rad or m]
    slopes: Floats  # (m, k): of the heights by the entries
    moves: Floats  # (m, k): of the angles [rad]

    @classmethod
    def of(cls, angles: Floats, heights: Any, slope: Any, bend: Floats, entries: int) -> _Turns:
        """Those of a curve with its slope, whose derivative is `bend`, (m,) each, or (1,) of a level one."""
        m, heights = len(angles), lifted(heights, entries)
        d, slopes = (np.broadcast_to(x.d, (m, entries)) for x in (heights, lifted(slope, entries)))
        with np.errstate(divide="ignore", invalid="ignore"):
            moves = -slopes / np.broadcast_to(bend, m)[:, None]
        return cls(angles, np.broadcast_to(heights.value, m), d, moves)

    def near(self, height: float, size: float) -> list[int]:
        """Which of them are as high as the extreme."""
        return np.flatnonzero(np.abs(self.heights - height) <= TIE * size).tolist()


@dataclass(frozen=True)
class _Found:
    """Tangents by name, what ties, what has no derivative."""

    tangents: dict[str, Tangent]
    ties: dict[str, str]
    missing: dict[str, str]
    program: Directions

    def of_output(self, name: str, element: ElementMotion, turns: _Turns, swept: LinkageSweep) -> None:
        """Stroke or swing, the angles of the extreme positions, the time ratio."""
        key = "stroke" if element.stroke is not None else "swing"
        size = getattr(element, key)
        if size is None:
            return
        low, high = (
            self._extreme(f"{name}.{key}", turns, value, size) for value in (element.low, element.high)
        )
        if low is not None and high is not None:
            self._keep(f"{name}.{key}", size, high - low)
        for side in ("low", "high"):
            angle = f"{side}_angle"
            self._angle(f"{name}.{angle}", turns, getattr(element, side), getattr(element, angle), size)
        if element.time_ratio is not None:
            self._time_ratio(name, element.time_ratio, turns, swept.cycle.span)

    def _time_ratio(self, name: str, value: float, turns: _Turns, span: float) -> None:
        """The slower way between the extreme positions over the quicker one."""
        key, ends = f"{name}.time_ratio", [f"{name}.{side}_angle" for side in ("low", "high")]
        if lost := [self.missing[end] for end in ends if end in self.missing]:
            self.missing[key] = lost[0]
            return
        ways = ways_between(turns.angles, turns.heights, span)
        assert ways is not None
        quick, slow = sorted(
            Tangent(way.length, turns.moves[way.ends[1]] - turns.moves[way.ends[0]]) for way in ways
        )
        is_even = slow.value - quick.value <= ALIKE * slow.value
        if is_even and self._differ(np.array([slow.d, quick.d]), 1.0).any():
            self.missing[key] = "both ways take the same crank angle"
            return
        ratio: Any = slow / quick
        self._keep(key, value, ratio.d)

    def of_transmission(self, name: str, element: ElementMotion, turns: _Turns | None) -> None:
        """Extremes of the transmission angle, their crank angles, and the worst."""
        least, most = element.transmission_angle_min, element.transmission_angle_max
        if turns is None or least is None or most is None:
            return
        ends = {"min": least, "max": most}
        size = most - least
        if size <= _LEVEL_TO:
            self.missing.update({f"{name}.transmission_angle_{end}": _LEVEL for end in (*ends, "worst")})
            return
        slopes = {}
        for end, value in ends.items():
            key = f"{name}.transmission_angle_{end}"
            slopes[end] = slope = self._extreme(key, turns, value, size)
            if slope is not None:
                self._keep(key, value, slope)
            at = getattr(element, f"transmission_angle_{end}_angle")
            self._angle(f"{key}_angle", turns, value, at, size)
        self._worst(f"{name}.transmission_angle_worst", least, math.pi - most, slopes, size)

    def _worst(self, key: str, least: float, rest: float, slopes: dict[str, Any], size: float) -> None:
        """The smaller one of μ_min and π − μ_max."""
        is_low, is_high = least <= rest + TIE * size, rest <= least + TIE * size
        sides = [slopes["min"]] * is_low + [None if slopes["max"] is None else -slopes["max"]] * is_high
        if any(side is None for side in sides):
            self.missing[key] = _AT_AN_END
            return
        differs = self._differ(np.array(sides), size)
        if differs.any():
            self.ties[key] = (
                "the minimum and the maximum deviate equally from 90°; "
                f"{they_differ(chosen(self.program.variables, differs))}"
            )
        self._keep(key, min(least, rest), np.where(differs, np.nan, sides[0]))

    def _extreme(self, key: str, turns: _Turns, value: float, size: float) -> Floats | None:
        """Derivatives of an extreme, NaN by entries that its rivals follow differently."""
        rivals = turns.near(value, size)
        if not rivals:
            self.missing[key] = _AT_AN_END
            return None
        d = turns.slopes[rivals]
        differs = self._differ(d, size)
        if differs.any():
            by = chosen(self.program.variables, differs)
            self.ties[key] = occurs_at(_in_turn(turns.angles[rivals]), by, of=_CRANK_ANGLES)
        return np.where(differs, np.nan, d[0])

    def _angle(self, key: str, turns: _Turns, value: float, angle: float, size: float) -> None:
        """The crank angle of an extreme."""
        rivals = turns.near(value, size)
        angles, moves = turns.angles[rivals], turns.moves[rivals]
        if not rivals or not np.isfinite(moves).all():
            self.missing[key] = _AT_AN_END
        elif np.abs(np.sin(0.5 * (angles - angles[0]))).max() > TIE or self._differ(moves, 1.0).any():
            self.missing[key] = occurs_at(_in_turn(angles), of=_CRANK_ANGLES)
        else:
            self._keep(key, angle, moves[0])

    def _differ(self, slopes: Floats, size: float) -> Any:
        """By which entries doubled several derivatives, (m, k), differ."""
        return differ(slopes, size / self.program.sizes)

    def _keep(self, key: str, value: float, d: Floats) -> None:
        """Take a scalar with its derivatives, without what rounding leaves of zeros."""
        sizes = np.abs(d) * self.program.sizes
        rounding = _ROUNDING * max(abs(value), float(np.nanmax(sizes, initial=0.0)))
        self.tangents[key] = Tangent(value, np.where(sizes <= rounding, 0.0, d))


_CRANK_ANGLES = "crank angles "


def _in_turn(angles: Floats) -> Floats:
    """Angles within one revolution."""
    return np.mod(angles, 2 * math.pi)


def _output_turns(compiled: CompiledMachine, swept: LinkageSweep, k: int, program: Directions) -> _Turns:
    """Where an output turns back."""
    output, angles = swept.outputs[k], swept.reversals(k)
    (rows,) = compiled.motion([output.channel], angles, program.values)
    (bend,) = compiled.motion([output.channel], angles)
    heights = swept.positions(k, angles)
    along = Tangent(heights, _slope_of(output, rows))
    return _Turns.of(angles, along, rows.d1, bend.d2, len(program.variables))


def _slope_of(output: Output, rows: Any) -> Floats:
    """Derivatives of a position, (n, k): of a unit vector e along a link dψ = e × de."""
    if output.kind == "stroke":
        along: Floats = rows.position.d
        return along
    cos, sin = rows.direction[0], rows.direction[1]
    slope: Floats = cos.value[:, None] * sin.d - sin.value[:, None] * cos.d
    return slope


def _transmission_turns(
    compiled: CompiledMachine, swept: LinkageSweep, element: str, program: Directions
) -> _Turns | None:
    """Where the transmission angle of an element turns back; None for what is no dyad."""
    k = next((k for k, dyad in enumerate(swept.dyads) if dyad.name == element), None)
    if k is None:
        return None
    dyad, angles = swept.dyads[k], swept.turns_of_transmission(k)
    channels = transmission_channels(compiled, dyad)
    rows = compiled.motion(channels, angles, program.values)
    numbers: Any = Tangent(compiled.parameters, program.values)
    mu: Any = transmission(numbers, dyad, rows)
    slope: Any = transmission_slope(numbers, dyad, rows)
    # The slope is linear in the rates: with second derivatives in place of first ones it is its derivative.
    bends = [row._replace(d1=row.d2) for row in compiled.motion(channels, angles)]
    bend = transmission_slope(compiled.parameters, dyad, bends)
    return _Turns.of(angles, mu, slope, bend, len(program.variables))
