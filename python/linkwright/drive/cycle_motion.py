r"""Motion of every point, link and slide over the cycle of a machine, with its extremes.

.. math:: \dot p = p' \omega, \qquad \ddot p = p'' \omega^2 + p' \varepsilon

Speed ω and acceleration ε of the crank are those of steady motion, else those of a constant speed. Extremes
are sought among samples and on both sides of every kink, and located between their neighbours until two
rounds agree: values are those of the exact motion there, not of an interpolation.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Annotated, Any

import numpy as np

from linkwright.drive.crank_speed import crank_speed
from linkwright.drive.steady_state import SteadyState, steady_state
from linkwright.kernel.arrays import Bools, Floats, Indices
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About
from linkwright.kernel.result import Record
from linkwright.linkages.closure import driver_word
from linkwright.linkages.cycle import Linkage, linkage
from linkwright.linkages.motion import Motion, motion_along
from linkwright.linkages.whole_cycle import over_whole_cycle, over_whole_motion
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine, compile_machine
from linkwright.machine.program.core import SteadyMotion

# Crank angles → time, speed, acceleration of the crank.
CrankMotion = Callable[[Floats], tuple[Floats, Floats, Floats]]

# Intervals of a revolution: of the curves, a degree each, which no line can resolve; of the search.
_DRAWN, _SEARCHED = 360, 1440

# Distance from a kink at which each of its sides is examined [rad]: of a smooth curve, 1e-9 of its slope.
_BESIDE = 1e-9

# A peak lower than another by more than this share of the span is not it: between samples a quarter of a
# degree apart, the hundredth harmonic of the crank rises above them by less.
_NEAR = 0.03

# Points in the neighbourhood of a peak in each round, and rounds at most: each narrows it to a quarter.
_POINTS, _ROUNDS = 9, 12

# Two rounds agree when the peak changes by less than this share of the span.
_AGREE = 1e-12

# What changes less than this share of its size, or of those of its kind, is constant within rounding;
# accelerations beside a change point are known to some 1e-10.
_CONSTANT, _CONSTANT_RATE = 1e-12, 1e-9

# Near a limit of crank rotation rates grow with one over the root of the distance: at distances of these
# shares of the range they differ by a factor of 100, and by about 1 where they are bounded.
_LIMIT_FAR, _LIMIT_NEAR, _GROWS = 1e-4, 1e-8, 10.0

# A position at a limit follows from the root of a radicand that is zero but for some rounding errors: below
# this share of the span it is zero.
_ROOT_OF_ROUNDING = 1e-7

# Doublings of a unit in the last place within which the links meet behind a limit that is good to rounding.
_ULPS = 20


@dataclass(frozen=True)
class Extremes(Record):
    """Extremes of one quantity over the cycle; None where it grows without limit or goes on and on."""

    minimum: Annotated[float | None, About("Minimum [SI].")]
    minimum_angle: Annotated[float | None, About("Crank angle of the minimum [rad].")]
    maximum: Annotated[float | None, About("Maximum [SI].")]
    maximum_angle: Annotated[float | None, About("Crank angle of the maximum [rad].")]


_NONE = Extremes(None, None, None, None)


@dataclass(frozen=True)
class CycleMotion(Motion):
    """A mechanism over its cycle, in steady motion or at constant speed of the crank."""

    is_steady: Annotated[bool, About("Whether the crank moves as in steady motion, not at constant speed.")]
    speed_source: Annotated[str, About("Source of the crank speed.")]
    extremes: Annotated[dict[str, Extremes], About("By name of the curve; without what is at rest.")]
    driver: Annotated[str, About('``"crank"``, or ``"drive"`` where only screws move the machine.')]
    coupler_points: Annotated[
        tuple[str, ...], About("Points of links, without those whose paths are circles about fixed points.")
    ]
    followers: Annotated[
        tuple[str, ...], About("Links that a cam swings about a pivot, or that follow a law of the crank.")
    ]

    def curves(self) -> dict[str, np.ndarray]:
        """Those of `Motion`, and speed and size of the acceleration of points: ``K.velocity``, ….

        A slide has a point of its own, and its velocity is that along the guide.
        """
        curves = super().curves()
        for name, path in self.points.items():
            if name not in self.slides:
                curves[f"{name}.velocity"] = np.hypot(*path.velocity.T)
                curves[f"{name}.acceleration"] = np.hypot(*path.acceleration.T)
        return curves

    def element(self, name: str) -> Extremes:
        """Extremes of a curve by its name; none of what is at rest."""
        return self.extremes.get(name, _NONE)

    @public
    def unit_of(self, name: str) -> str:
        """SI unit of an attribute or a column by its name."""
        of, _, last = name.rpartition(".")
        return _SIZES[last] if of in self.points and last in _SIZES else super().unit_of(name)

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """Extremes by name of the curve, and where the speed comes from. Returns: plain numbers in SI."""
        results: dict[str, Any] = {
            "is_steady": self.is_steady,
            "speed_source": self.speed_source,
            "extremes": {name: asdict(extremes) for name, extremes in self.extremes.items()},
        }
        columns = {name: curve.tolist() for name, curve in self.curves().items()} if curves else {}
        return super().to_dict(curves=curves) | columns | results


_SIZES = {"velocity": "m/s", "acceleration": "m/s²"}


@public
def cycle_motion(machine: Machine, *, accuracy: float = 1e-10) -> CycleMotion:
    """Motion of every point, link and slide over the cycle, with exact extremes.

    Parameters
    ----------
    machine : Machine
        The machine; of a batch, the first. With a motor it is in steady motion; else its crank turns at the
        design speed, or at 1 rad/s where there is none.
    accuracy : float
        Relative accuracy of the steady speed, 1e-13 to 1e-2.

    Returns
    -------
    CycleMotion
        Over the period, or over the range in which the mechanism closes: curves by name, such as
        ``ram.place.velocity``, and their extremes.

    Raises
    ------
    AssemblyError
        The mechanism closes nowhere.
    SteadyStateError
        There is a motor, and no steady motion.

    Examples
    --------
    >>> import linkwright as lw
    >>> found = lw.cycle_motion(lw.read("press_with_flywheel"))
    >>> round(found.extremes["ram.place.velocity"].maximum, 4)
    0.5705
    """
    has_motor = machine.drive is not None and machine.drive.motor is not None
    steady = steady_state(machine, accuracy=accuracy) if has_motor else None
    return cycle_motion_of(machine, linkage(machine), steady, accuracy)


def cycle_motion_of(
    machine: Machine, known: Linkage, steady: SteadyState | None, accuracy: float = 1e-10
) -> CycleMotion:
    """`cycle_motion` of a known linkage and steady motion; without the latter, at constant speed."""
    compiled = compile_machine(machine).first()
    turns = known.period_turns or 1
    if steady is None:
        low, high = _cycle(known)
        speed, source = crank_speed(machine, None)
        crank = _at_constant_speed(speed, low)
    else:
        turns = math.lcm(steady.turns, known.period_turns or 1)
        low, high, source = 0.0, 2 * np.pi * turns, "steady motion"
        crank = _in_steady_motion(compiled, steady, accuracy)
    drawn = np.linspace(low, high, _DRAWN * turns + 1)
    motion = _along(machine, crank, drawn)
    cycle = CycleMotion(
        **vars(motion),
        is_steady=steady is not None,
        speed_source=source,
        extremes={},
        driver=driver_word(machine),
        coupler_points=_coupler_points(machine),
        followers=_followers(machine),
    )
    search = _Search(machine, crank, list(cycle.curves())[len(_CRANK) :])
    looked = _looked_at(compiled, low, high, turns)
    extremes = search.extremes(looked, None if known.closure.turns_fully else (low, high))
    if not (known.closure.turns_fully or cycle.is_steady):
        extremes |= _with_limits(machine, compiled, extremes, np.array(known.closure.ranges[0]))
    return CycleMotion(**{**vars(cycle), "extremes": extremes})


def _with_limits(
    machine: Machine, compiled: CompiledMachine, extremes: dict[str, Extremes], ends: Floats
) -> dict[str, Extremes]:
    """Extremes of positions with those at the limits themselves, which the search avoids."""
    still, inside = np.zeros(2), _inside(compiled, ends)
    if inside is None:
        return {}
    with np.errstate(invalid="ignore"):
        # Rates have no limit there.
        curves = motion_along(machine, still, inside, still, still).curves()
    places = {name: curves[name] for name in extremes if name.endswith((".x", ".y", ".place"))}
    return {
        name: _with_ends(extremes[name], ends, curve)
        for name, curve in places.items()
        if extremes[name].minimum is not None and np.isfinite(curve).all()
    }


def _inside(compiled: CompiledMachine, ends: Floats) -> Floats | None:
    """The first angles behind both limits at which the mechanism closes to the last digit."""
    inside, step = ends.copy(), np.array([1.0, -1.0]) * np.spacing(np.abs(ends).max())
    for _ in range(_ULPS):
        closes = (compiled.gaps(inside) >= 0).all(axis=0)
        if closes.all():
            return inside
        inside = np.where(closes, inside, inside + step)
        step *= 2
    return None


def _with_ends(inside: Extremes, ends: Floats, values: Floats) -> Extremes:
    assert inside.minimum is not None
    assert inside.maximum is not None
    span = max(inside.maximum, *values) - min(inside.minimum, *values)
    values = np.where(np.abs(values) < _ROOT_OF_ROUNDING * span, 0.0, values)
    places = [
        (inside.minimum, inside.minimum_angle),
        (inside.maximum, inside.maximum_angle),
        *zip(values.tolist(), ends.tolist(), strict=True),
    ]
    return Extremes(*min(places, key=lambda place: place[0]), *max(places, key=lambda place: place[0]))


# An angle that is past the end of a cycle by less than this share of it is the end.
_AT_END = 1e-12

# Columns that are the crank's own, first in `curves`.
_CRANK = ("time", "crank_angle", "speed", "acceleration")


def _cycle(known: Linkage) -> tuple[float, float]:
    """First and last crank angle of the cycle [rad]: of a crank that rotates fully, from zero on."""
    low, high = float(known.crank_angle[0]), float(known.crank_angle[-1])
    is_round = known.closure.turns_fully and known.closure.change_point is None
    return (0.0, high - low) if is_round else (low, high)


def _at_constant_speed(speed: float, start: float) -> CrankMotion:
    return lambda phi: ((phi - start) / speed, np.full_like(phi, speed), np.zeros_like(phi))


def _in_steady_motion(compiled: CompiledMachine, steady: SteadyState, accuracy: float) -> CrankMotion:
    """The same solution at any angles; a motor of constant speed needs none."""
    if steady.method != "collocation":
        return _at_constant_speed(steady.speed_max, 0.0)
    compiled = over_whole_cycle(compiled)
    motion = compiled.steady(np.empty(0), accuracy)
    assert isinstance(motion, SteadyMotion)

    def at(phi: Floats) -> tuple[Floats, Floats, Floats]:
        # The end of a cycle is not the start of the next, which would be back at its time zero.
        done = np.maximum(np.ceil(phi / compiled.cycle - _AT_END) - 1, 0)
        within = np.clip(phi - done * compiled.cycle, 0.0, compiled.cycle)
        order = np.argsort(within, kind="stable")
        curves = motion.solution.curves(within[order])
        back = np.argsort(order, kind="stable")
        return done * motion.period + curves.time[back], curves.speed[back], curves.acceleration[back]

    return at


def _coupler_points(machine: Machine) -> tuple[str, ...]:
    links, fixed = machine.linkage.links(), machine.linkage.fixed_points()
    parts = machine.linkage.rigid_points.items()
    return tuple(name for name, part in parts if links[part.link].start not in fixed)


def _followers(machine: Machine) -> tuple[str, ...]:
    cranks = machine.linkage.cranks.items()
    return tuple(name for name, crank in cranks if crank.follows() is not None or crank.law is not None)


def _along(machine: Machine, crank: CrankMotion, phi: Floats) -> Motion:
    time, speed, acceleration = crank(phi)
    return motion_along(machine, time, phi, speed, acceleration)


def _looked_at(compiled: CompiledMachine, low: float, high: float, turns: int) -> Floats:
    """First angles of the search for extremes: even, and on both sides of every kink."""
    even = np.linspace(low, high, _SEARCHED * turns + 1)
    compiled = over_whole_motion(compiled) or compiled
    first, last = np.floor(np.array([low, high]) / compiled.cycle).astype(int)
    every = [compiled.kinks() + compiled.cycle * n for n in range(first, last + 1)]
    kinks = np.concatenate(every)
    angles = np.sort(np.concatenate([even, kinks - _BESIDE, kinks + _BESIDE]))
    # `np.unique` would import masked arrays, which takes longer than all that is computed here.
    angles = angles[np.append(True, np.diff(angles) > 0)]
    inside: Floats = angles[(angles >= low) & (angles <= high)]
    return inside


@dataclass(frozen=True)
class _Search:
    """The search for the extremes of all columns of a motion at once."""

    machine: Machine
    crank: CrankMotion
    names: list[str]

    def values(self, phi: Floats) -> Floats:
        """All columns at crank angles, (k, n)."""
        motion = _along(self.machine, self.crank, phi)
        curves = CycleMotion(
            **vars(motion),
            is_steady=False,
            speed_source="",
            extremes={},
            driver="",
            coupler_points=(),
            followers=(),
        ).curves()
        return np.array([curves[name] for name in self.names]).reshape(len(self.names), len(phi))

    def extremes(self, looked: Floats, limit: tuple[float, float] | None) -> dict[str, Extremes]:
        values = self.values(looked)
        span = np.ptp(values, axis=1)
        known = [_CONSTANT_RATE if name.endswith(".acceleration") else _CONSTANT for name in self.names]
        moves = span > known * np.maximum(np.abs(values).max(axis=1), self._scales(values))
        rise = values[:, -1] - values[:, 0]
        endless = self._unlimited(limit) | [
            self._turns_on(name, float(x)) for name, x in zip(self.names, rise, strict=True)
        ]
        sought = np.flatnonzero(moves & ~endless)
        extremes: dict[str, Extremes] = {self.names[k]: _NONE for k in np.flatnonzero(endless)}
        if len(sought):
            parts = self._of([self.names[k] for k in sought])._peaks(looked, values[sought], span[sought])
            for k, *numbers in zip(sought, *parts, strict=True):
                extremes[self.names[k]] = Extremes(*(float(x) for x in numbers))
        return {name: extremes[name] for name in self.names if name in extremes}

    def _of(self, names: list[str]) -> _Search:
        return _Search(self.machine, self.crank, names)

    def _scales(self, values: Floats) -> Floats:
        """Peak absolute value of all columns of one kind: rounding of one is rounding beside another."""
        kinds = [name.rpartition(".")[2] for name in self.names]
        peak = np.abs(values).max(axis=1)
        return np.array([max(p for p, other in zip(peak, kinds, strict=True) if other == k) for k in kinds])

    @staticmethod
    def _turns_on(name: str, rise: float) -> bool:
        """Whether it is the angle of a link that rotates on from one cycle to the next."""
        return name.endswith(".angle") and abs(rise) > np.pi and abs(np.sin(rise / 2)) < _NEAR

    def _unlimited(self, limit: tuple[float, float] | None) -> Bools:
        """Which columns grow without limit towards the ends of a range of the crank."""
        if limit is None:
            return np.zeros(len(self.names), dtype=bool)
        low, high = limit
        inwards = np.array([_LIMIT_FAR, _LIMIT_NEAR, -_LIMIT_FAR, -_LIMIT_NEAR]) * (high - low)
        at = np.where(inwards > 0, low, high) + inwards
        far, near = (np.abs(self.values(np.sort(at)))[:, pair].max(axis=1) for pair in ([1, 2], [0, 3]))
        unlimited: Bools = near > _GROWS * np.maximum(far, np.finfo(float).tiny)
        return unlimited

    def _peaks(self, looked: Floats, values: Floats, span: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        """Minima of all columns, their crank angles, maxima, their crank angles; (k,) each."""
        # What is sought are maxima, of the columns with the other sign first.
        signed = np.where(np.isfinite(values), np.array([-1.0, 1.0])[:, None, None] * values, -np.inf)
        signed = signed.reshape(-1, len(looked))
        row, column = _candidates(signed, np.tile(span, 2))
        sign, of = np.where(row < len(span), -1.0, 1.0), row % len(span)
        is_angle = np.array([name.endswith(".angle") for name in self.names])
        best, best_at = signed[row, column], looked[column]
        low = looked[np.maximum(column - 1, 0)]
        high = looked[np.minimum(column + 1, len(looked) - 1)]
        for _ in range(_ROUNDS):
            x = low[:, None] + (high - low)[:, None] * np.linspace(0, 1, _POINTS)
            y = self.values(x.ravel())[np.repeat(of, _POINTS), np.arange(x.size)].reshape(x.shape)
            y = np.where(np.isfinite(y), sign[:, None] * y, -np.inf)
            # Angles of links are continued from sample to sample: here they are those beside the best one.
            turns = np.where(np.isfinite(y), np.rint((best[:, None] - y) / (2 * np.pi)), 0.0)
            y = y + 2 * np.pi * np.where(is_angle[of][:, None], turns, 0.0)
            top = y.argmax(axis=1)
            every = np.arange(len(row))
            x_top, y_top = _vertex(x, y, top)
            better = y[every, top] > best
            rise = np.where(better, y[every, top] - best, 0.0)
            best, best_at = np.where(better, y[every, top], best), np.where(better, x[every, top], best_at)
            # The parabola through the best three says how much there is still to gain.
            left = np.maximum(y_top - best, 0.0)
            if (np.maximum(rise, left) <= _AGREE * span[of]).all():
                break
            width = np.where(left > 0, 0.25, 0.125) * (high - low)
            centre = np.where(left > 0, x_top, best_at)
            low, high = np.maximum(centre - width, low), np.minimum(centre + width, high)
        order = np.lexsort((-best_at, best, row))
        last = order[np.append(np.diff(row[order]) > 0, True)]
        (low, high), (low_at, high_at) = (peak[last].reshape(2, -1) for peak in (sign * best, best_at))
        return low, low_at, high, high_at


def _candidates(signed: Floats, span: Floats) -> tuple[Indices, Indices]:
    before = np.concatenate([np.full((len(signed), 1), -np.inf), signed[:, :-1]], axis=1)
    after = np.concatenate([signed[:, 1:], np.full((len(signed), 1), -np.inf)], axis=1)
    is_local = (signed >= before) & (signed > after)
    most = signed.max(axis=1, keepdims=True)
    # Where a row is flat, its first sample stands for all.
    is_local[np.arange(len(signed)), signed.argmax(axis=1)] = True
    beside = np.minimum(_NEAR * span[:, None], 4 * (2 * signed - before - after))
    row, column = np.nonzero(is_local & (signed + np.where(np.isfinite(beside), beside, 0.0) >= most))
    return row, column


def _vertex(x: Floats, y: Floats, top: Indices) -> tuple[Floats, Floats]:
    """Place and value of the vertex of the parabola through three points about the best one."""
    # The speed of a point that comes to rest has a corner there, where two lines meet.
    row = np.arange(len(x))
    middle = np.clip(top, 2, x.shape[1] - 3)
    before, a, b, c, after = (y[row, middle + k] for k in (-2, -1, 0, 1, 2))
    step = x[row, middle] - x[row, middle - 1]
    rise, fall = a - before, after - c
    with np.errstate(all="ignore"):
        share = np.where(a - 2 * b + c < 0, 0.5 * (a - c) / (a - 2 * b + c), 0.0)
        share = np.where(np.isfinite(share), np.clip(share, -1, 1), 0.0)
        value = b - 0.25 * (a - c) * share
        # All three bends of a parabola are alike; of a corner, that of the side away from it is none.
        straight = np.minimum(np.abs(before - 2 * a + b), np.abs(b - 2 * c + after))
        at_corner = (c - a - rise - fall) / (rise - fall)
        is_corner = (straight < 0.1 * (rise - fall)) & (np.abs(at_corner) <= 1)
        share = np.where(is_corner, at_corner, share)
        value = np.where(is_corner, a + rise * (at_corner + 1), value)
    return x[row, middle] + share * step, np.where(np.isfinite(value), value, b)
