r"""Torques on the discs of a train as harmonics of the angle, and what harmonics add up to in phase.

.. math:: M(t) = \bar M + \mathrm{Re} \sum_\nu M_\nu e^{i\nu\Omega t}

An order of a disc that turns n times as fast as the first is the order nν of the train.

Orders with a common base, as ½, 1, 1½, … of a four-stroke engine, repeat after as many revolutions, and their
sum has exact extremes. Orders without one, as those of a wheel with 67 teeth on one with 41, meet in nearly
every phase sooner or later. Each family of orders with a common base of its own has exact extremes over its
period, and those of the families add up: a bound, which is approached in time.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property, lru_cache
from math import lcm
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.arrays import Bools, Complexes, Floats
from linkwright.kernel.errors import require_within
from linkwright.kernel.limits import RESPONSE
from linkwright.kernel.numerics.tangent import numbers, zeros_for
from linkwright.torsion.core.response import extremes
from linkwright.torsion.model.train import Train

# Orders that differ by a smaller share are one within rounding of ratios.
_EQUAL = 1e-9


@dataclass(frozen=True)
class Torques:
    """Torques on the discs."""

    speeds: Floats  # (speeds,) of the first disc [rad/s]
    orders: Floats  # (orders,) cycles per revolution of the first disc, increasing
    harmonics: Complexes  # (orders, discs, speeds) M_ν on each disc [N m]
    mean: Floats  # (discs, speeds) driving positive; they balance unless nothing takes them off [N m]
    damping: Floats  # (discs, speeds) of the loads [N m s/rad]
    load_factor: Floats  # (speeds,) loads as they count over those given: not 1 where they follow an engine
    # (speeds,) mean torque at the first disc beyond what the loads take off, which accelerates a free train
    # [N m].
    surplus: Floats
    control: Floats  # (discs,) k_i of speed controllers, springs against the ground [N m/rad]
    # (orders,) ω₀ of lines with a fixed frequency, behind all others [rad/s]; empty for none.
    fixed: Floats = field(default_factory=lambda: np.empty(0))

    @property
    def offsets(self) -> Floats:
        """ω₀ of every line, (orders,) [rad/s]."""
        return self.fixed if len(self.fixed) else np.zeros(len(self.orders))

    @property
    def omega(self) -> Floats:
        """|νΩ + ω₀| of every line, (orders, speeds) [rad/s]."""
        return np.abs(np.outer(self.orders, self.speeds) + self.offsets[:, None])

    @property
    def together(self) -> Orders:
        """How the orders add up."""
        return orders_together(self.orders, self.offsets)

    def is_of(self, order: float) -> Bools:
        """Which lines are of an order alone, (orders,)."""
        same: Bools = (np.abs(self.orders - order) <= _EQUAL * order) & (self.offsets == 0)
        return same


@dataclass(frozen=True)
class Source:
    """Harmonics of one origin."""

    disc: int  # place of the disc
    orders: Floats  # (orders,) cycles per revolution of the first disc
    harmonics: Complexes  # (orders, speeds) [N m]
    mean: Floats | None = None  # (speeds,) driving positive [N m]
    fixed: float = 0.0  # ω₀ of all of them [rad/s]


def torques_of(
    train: Train,
    turning: Floats,
    speeds: Floats,
    sources: Iterable[Source] = (),
    damping: Floats | None = None,
    *,
    is_free: bool = True,
    has_engine: bool = False,
    loads_follow: bool = False,
) -> Torques:
    """All torques on the discs of a train.

    Without an engine the mean torques of a free train balance: the drivers give what the loads need, by
    their shares. What an engine gives beyond its loads accelerates the train, unless the loads follow: then
    they take off what it gives, in proportion to their laws. `turning`: (discs,) speed of each disc over that
    of the first; `speeds`: (speeds,) [rad/s]; `damping`: (discs, speeds) [N m s/rad].
    """
    place = {name: k for k, name in enumerate(train.discs)}
    every = [*sources, *_excitations(train, place, turning, speeds), *_joints(train, place, turning, speeds)]
    driving = [(torque.disc, torque.mean) for torque in every if torque.mean is not None]
    driving += [
        (place[driver.on], _at(driver.torque_at, turning[place[driver.on]] * speeds))
        for driver in train.drivers.values()
        if driver.torque is not None
    ]
    mean = _summed(driving, len(place), speeds)
    resistance, of_loads = _loads(train, place, turning, speeds)
    factor = np.ones(len(speeds))
    if is_free:
        # Power balances: what turns n times as fast counts n times.
        drive, needed = _powers(turning, mean), _powers(turning, resistance)
        if has_engine and loads_follow:
            factor = np.divide(drive, needed, out=factor, where=needed > 0)
            resistance, of_loads = factor * resistance, np.maximum(factor, 0.0) * of_loads
        elif not has_engine:
            given = [
                (place[on], share * (needed - drive) / turning[place[on]])
                for on, share in train.shares.items()
            ]
            mean = mean + _summed(given, len(place), speeds)
    every += _load_harmonics(train, place, turning, speeds, factor)
    own = _orders(torque.orders for torque in every if not torque.fixed)
    lines = sorted({(float(torque.orders[0]), torque.fixed) for torque in every if torque.fixed})
    orders = np.append(own, [order for order, _ in lines])
    shape = (len(orders), len(place), len(speeds))
    harmonics = zeros_for([torque.harmonics for torque in every], shape, complex)
    for torque in every:
        if torque.fixed:
            n = len(own) + lines.index((float(torque.orders[0]), torque.fixed))
            # A motion of negative frequency is the conjugate one of its size.
            back = torque.orders[0] * speeds + torque.fixed < 0
            harmonics[n, torque.disc] += np.where(back, torque.harmonics[0].conj(), torque.harmonics[0])
            continue
        at = np.abs(own[:, None] - torque.orders).argmin(axis=0)
        np.add.at(harmonics, (at, torque.disc), torque.harmonics)
    gains, control = controllers(train, place, speeds)
    damped = of_loads + gains if damping is None else of_loads + gains + damping
    surplus = _powers(turning, mean - resistance) if is_free else np.zeros(len(speeds))
    fixed = np.append(np.zeros(len(own)), [offset for _, offset in lines]) if lines else np.empty(0)
    return Torques(speeds, orders, harmonics, mean - resistance, damped, factor, surplus, control, fixed)


def _excitations(train: Train, place: dict[str, int], turning: Floats, speeds: Floats) -> list[Source]:
    sources = []
    for excitation in train.excitations.values():
        n = turning[place[excitation.on]]
        size = numbers([wave.torque * np.exp(1j * wave.phase) for wave in excitation.harmonics])
        factor = _at(excitation.factor, n * speeds)
        lines = [wave.line for wave in excitation.harmonics]
        waves = [k for k, (_, fixed) in enumerate(lines) if not fixed]
        orders = n * np.array([lines[k][0] for k in waves])
        if waves:
            sources.append(Source(place[excitation.on], orders, size[waves, None] * factor))
        for k, (order, fixed) in enumerate(lines):
            if fixed:
                alone = n * np.array([order])
                sources.append(
                    Source(place[excitation.on], alone, size[k : k + 1, None] * factor, fixed=fixed)
                )
    return sources


def _joints(train: Train, place: dict[str, int], turning: Floats, speeds: Floats) -> Iterator[Source]:
    """The orders of Hooke's joints; what they do follows from the mean torque of their shafts."""
    for shaft in train.shafts.values():
        if shaft.joint_angle is not None:
            disc, count = place[shaft.between[0]], len(shaft.joint_harmonics)
            orders = 2 * turning[disc] * np.arange(1, count + 1)
            yield Source(disc, orders, np.zeros((count, len(speeds)), complex))


def _loads(train: Train, place: dict[str, int], turning: Floats, speeds: Floats) -> tuple[Floats, Floats]:
    """Mean resistance and damping of the loads, (discs, speeds) each."""
    listed = [(place[load.on], load, turning[place[load.on]] * speeds) for load in train.loads.values()]
    resistance = _summed([(disc, _at(load.resistance, at)) for disc, load, at in listed], len(place), speeds)
    damping = _summed([(disc, _at(load.damping, at)) for disc, load, at in listed], len(place), speeds)
    return resistance, damping


def controllers(train: Train, place: dict[str, int], speeds: Floats) -> tuple[Any, Any]:
    """Damping, (discs, speeds), and stiffness, (discs,), by which speed controllers act on vibration.

    A PI controller gives −(k_p + k_i/(iω)) iωθ at the disc that swings by θ (Åström and Murray 2008).
    """
    listed = [
        (place[driver.on], driver.control) for driver in train.drivers.values() if driver.control is not None
    ]
    gains = _summed([(disc, one.proportional) for disc, one in listed], len(place), speeds)
    control = zeros_for([one.integral for _, one in listed], (len(place),))
    for disc, one in listed:
        control[disc] += one.integral
    return gains, control


def _at(function: Callable[[float], Any], speeds: Floats) -> Any:
    """A number of one speed at each of some."""
    return numbers([function(speed) for speed in speeds.tolist()])


def _summed(torques: Sequence[tuple[int, Any]], discs: int, speeds: Floats) -> Any:
    """Pairs of a disc and its torques over the speeds as sums on all discs, (discs, speeds)."""
    sums = zeros_for([torque for _, torque in torques], (discs, len(speeds)))
    for disc, torque in torques:
        sums[disc] += torque
    return sums


def _powers(turning: Floats, torques: Any) -> Any:
    """Power of torques on all discs over the speed of the first disc, (speeds,)."""
    return np.einsum("d,ds->s", turning, torques)


def _load_harmonics(
    train: Train, place: dict[str, int], turning: Floats, speeds: Floats, factor: Floats
) -> list[Source]:
    """Pulsation of each load: its shares times its resistance times the common load factor."""
    sources = []
    for load in train.loads.values():
        if load.harmonics:
            disc = place[load.on]
            resistance = _at(load.resistance, turning[disc] * speeds)
            size = numbers([-wave.share * np.exp(1j * wave.phase) for wave in load.harmonics])
            orders = turning[disc] * np.array([wave.order for wave in load.harmonics])
            harmonics = size[:, None] * (factor * resistance)
            sources.append(Source(disc, orders, harmonics))
    return sources


def _orders(listed: Iterable[Floats]) -> Floats:
    """All orders, those equal within rounding once."""
    every = np.sort(np.concatenate([np.empty(0), *listed]))
    apart = np.diff(every, prepend=-1.0) > _EQUAL * every
    return every[apart]


# Largest number of turns after which orders repeat, and of harmonics in that time.
_TURNS = 60
_HARMONICS = 512

# Waves of the highest order beyond which less than a revolution is examined where that will do: the work for
# extremes grows by the square of their number.
_WAVES = 128


@dataclass(frozen=True)
class Orders:
    """How orders go together."""

    values: Floats  # (orders,) cycles per revolution
    turns: float  # after which those with a common base repeat
    # (orders,) waves of each in that time; 0 of one that has no common base with the others.
    harmonic: NDArray[np.int64]
    fixed: Floats | None = None  # (orders,) frequencies that do not follow the speed; None for none [rad/s]

    @cached_property
    def together(self) -> Bools:
        """Which of them have a common base."""
        return self.harmonic > 0

    @cached_property
    def families(self) -> tuple[tuple[NDArray[np.intp], Orders], ...]:
        """Places of orders that go together, and how, the orders with a common base first."""
        main = np.flatnonzero(self.together)
        families = [(main, Orders(self.values[main], self.turns, self.harmonic[main]))] if len(main) else []
        fixed = np.zeros(len(self.values)) if self.fixed is None else self.fixed
        # Fixed frequencies without an order go together as orders do, over their own period.
        for kind, values in ((fixed == 0, self.values), (self.values == 0, np.abs(fixed))):
            rest = np.flatnonzero(kind & ~self.together)
            while len(rest):
                own = _counted(values[rest], values[rest].min())
                family = rest[own.together]
                families.append((family, Orders(values[family], own.turns, own.harmonic[own.together])))
                rest = rest[~own.together]
        return tuple(families)

    @cached_property
    def alone(self) -> Bools:
        """Lines of no family: those of an order and a fixed frequency."""
        alone = np.ones(len(self.values), bool)
        for places, _ in self.families:
            alone[places] = False
        return alone


def orders_together(values: Floats, fixed: Floats | None = None) -> Orders:
    """Common base of orders (orders,) above zero, cycles per revolution, of as many as have one.

    Lines that are `fixed` (orders,), of a frequency that does not follow the speed, have none.
    """
    if fixed is None or not fixed.any():
        return _together(tuple(values.tolist()))
    count = int((fixed == 0).sum())
    own = _together(tuple(values[:count].tolist()))
    harmonic = np.append(own.harmonic, np.zeros(len(values) - count, np.int64))
    return Orders(values, own.turns, harmonic, fixed)


@lru_cache(maxsize=32)
def _together(listed: tuple[float, ...]) -> Orders:
    """Cached: computed once for all speeds of a train."""
    values = np.array(listed)
    of_revolution = _counted(values, 1.0)
    # Orders behind a gear stage go by its ratio, which need be no fraction, and may be far above one wave per
    # revolution: they are counted by the lowest.
    by_lowest = _counted(values, values.min()) if len(values) else of_revolution
    gained = int(by_lowest.together.sum()) - int(of_revolution.together.sum())
    is_long = int(of_revolution.harmonic.max(initial=0)) > _WAVES
    return by_lowest if gained > 0 or (gained == 0 and is_long) else of_revolution


def _counted(values: Floats, unit: float) -> Orders:
    share = (values / unit).tolist()
    fractions = [Fraction(value).limit_denominator(_TURNS) for value in share]
    close = [abs(f - v) <= _EQUAL * v for f, v in zip(fractions, share, strict=True)]
    turns, highest = 1, max(share, default=0.0)
    for f, fits in sorted(zip(fractions, close, strict=True), key=lambda torque: torque[0].denominator):
        more = lcm(turns, f.denominator)
        if fits and more <= _TURNS and more * highest <= _HARMONICS:
            turns = more
    # One of far more waves than the others would ask for as many harmonics: it stands alone.
    within = [value * turns <= _HARMONICS for value in share]
    fits_base = [
        ok and few and turns % f.denominator == 0 for f, ok, few in zip(fractions, close, within, strict=True)
    ]
    harmonic = np.where(fits_base, np.rint(np.array(share) * turns), 0).astype(np.int64)
    return Orders(values, turns / unit, harmonic)


def line_words(order: float, fixed: float) -> str:
    """An order as a number, a line of a fixed frequency [rad/s] with it."""
    if not fixed:
        return f"{order:.4g}"
    frequency = f"{abs(fixed) / (2 * math.pi):.4g} Hz"
    if not order:
        return frequency
    return f"{order:.4g} {'−' if fixed < 0 else '+'} {frequency}"


def line_name(order: float, fixed: float) -> str:
    """The same as a name, "order 2" or "50 Hz"."""
    words = line_words(order, fixed)
    return f"order {words}" if order else words


def span(orders: Orders, amplitudes: Complexes, mean: Floats | float = 0.0) -> tuple[Floats, Floats]:
    """Maximum and minimum value of what harmonics add up to.

    Gives `greatest`, `least`: of each family of orders, added up.
    `amplitudes`: (orders, ...). A wave that is not finite has no extremes: NaN.
    """
    top = bottom = np.broadcast_to(np.asarray(mean, float), amplitudes.shape[1:])
    for places, family in orders.families:
        if len(places) == 1:
            size = np.abs(amplitudes[places[0]])
            # A wave alone that is not finite has no extremes; beside others it has no bound.
            high = np.where(np.isfinite(size), size, np.nan) if len(amplitudes) == 1 else size
            low = -high
        else:
            high, _, low, _ = extremes(coefficients(family, amplitudes[places]))
        top, bottom = top + high, bottom + low
    rest = np.abs(amplitudes[orders.alone]).sum(axis=0)
    return top + rest, bottom - rest


def coefficients(orders: Orders, amplitudes: Complexes, mean: Floats | float = 0.0) -> Complexes:
    """Harmonics 0, 1, 2, … of the period of the orders, (harmonics, ...), by amplitudes (orders, ...)."""
    count = int(orders.harmonic.max(initial=0)) + 1
    remedy = "lower the highest order, or train.run.points"
    require_within(RESPONSE, count * math.prod(amplitudes.shape[1:]), "forced response", remedy)
    c = np.zeros((count, *amplitudes.shape[1:]), complex)
    c[orders.harmonic[orders.together]] = amplitudes[orders.together]
    c[0] = mean
    return c


def waveform(orders: Orders, amplitudes: Complexes, mean: Floats | float = 0.0, points: int = 1440) -> Floats:
    """Sum of harmonics (orders, ...) over the `Orders.turns` in which they repeat, (points, ...)."""
    harmonic = coefficients(orders, amplitudes, mean)
    phase = 2j * np.pi * np.outer(np.arange(points) / points, np.arange(len(harmonic)))
    wave: Floats = np.tensordot(np.exp(phase), harmonic, axes=1).real
    return wave
