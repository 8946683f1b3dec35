r"""Torques on the discs of a train as harmonics of the angle of its first disc.

.. math:: M(t) = \bar M + \mathrm{Re} \sum_\nu M_\nu e^{i\nu\Omega t}

An order of a disc that turns n times as fast as the first is the order nν of the train.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.torsion.model.train import Train

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]

# Orders that differ by a smaller share are one but for rounding of ratios.
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


@dataclass(frozen=True)
class Source:
    """Harmonics of one origin."""

    disc: int  # place of the disc
    orders: Floats  # (orders,) cycles per revolution of the first disc
    harmonics: Complexes  # (orders, speeds) [N m]
    mean: Floats | None = None  # (speeds,) driving positive [N m]


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

    Without an engine the mean torques of a free train balance: the driver gives what the loads need. What an
    engine gives beyond its loads accelerates the train, unless the loads follow: then they take off what it
    gives, in proportion to their laws. `turning`: (discs,) speed of each disc over that of the first;
    `speeds`: (speeds,) [rad/s]; `damping`: (discs, speeds) [N m s/rad].
    """
    place = {name: k for k, name in enumerate(train.discs)}
    found = [*sources, *_excitations(train, place, turning, speeds)]
    mean = np.zeros((len(place), len(speeds)))
    for each in found:
        if each.mean is not None:
            mean[each.disc] += each.mean
    resistance, of_loads = _loads(train, place, turning, speeds)
    factor = np.ones(len(speeds))
    if is_free:
        # Power balances: what turns n times as fast counts n times.
        drive, needed = turning @ mean, turning @ resistance
        if has_engine and loads_follow:
            factor = np.divide(drive, needed, out=factor, where=needed > 0)
            resistance, of_loads = factor * resistance, np.maximum(factor, 0.0) * of_loads
        elif not has_engine:
            driver = place[train.driver or next(iter(place))]
            mean[driver] += (needed - drive) / turning[driver]
    found += _load_harmonics(train, place, turning, resistance)
    orders = _orders(each.orders for each in found)
    harmonics = np.zeros((len(orders), len(place), len(speeds)), complex)
    for each in found:
        at = np.abs(orders[:, None] - each.orders).argmin(axis=0)
        np.add.at(harmonics, (at, each.disc), each.harmonics)
    own = of_loads if damping is None else of_loads + damping
    surplus = turning @ (mean - resistance) if is_free else np.zeros(len(speeds))
    return Torques(speeds, orders, harmonics, mean - resistance, own, factor, surplus)


def _excitations(train: Train, place: dict[str, int], turning: Floats, speeds: Floats) -> list[Source]:
    """Torques that the file gives by themselves."""
    found = []
    for each in train.excitations.values():
        n = turning[place[each.on]]
        size = np.array([wave.torque * np.exp(1j * wave.phase) for wave in each.harmonics])
        factor = np.array([each.factor(n * speed) for speed in speeds.tolist()])
        orders = n * np.array([wave.order for wave in each.harmonics])
        found.append(Source(place[each.on], orders, size[:, None] * factor))
    return found


def _loads(train: Train, place: dict[str, int], turning: Floats, speeds: Floats) -> tuple[Floats, Floats]:
    """Mean resistance and damping of the loads, (discs, speeds) each."""
    resistance = np.zeros((len(place), len(speeds)))
    damping = np.zeros_like(resistance)
    for each in train.loads.values():
        n, disc = turning[place[each.on]], place[each.on]
        resistance[disc] += [each.resistance(n * speed) for speed in speeds.tolist()]
        damping[disc] += [each.damping(n * speed) for speed in speeds.tolist()]
    return resistance, damping


def _load_harmonics(train: Train, place: dict[str, int], turning: Floats, resistance: Floats) -> list[Source]:
    """Pulsation of the loads: shares of what they resist."""
    found = []
    for each in train.loads.values():
        if each.harmonics:
            disc = place[each.on]
            size = np.array([-wave.share * np.exp(1j * wave.phase) for wave in each.harmonics])
            orders = turning[disc] * np.array([wave.order for wave in each.harmonics])
            found.append(Source(disc, orders, size[:, None] * resistance[disc]))
    return found


def _orders(listed: Iterable[Floats]) -> Floats:
    """All orders, those equal but for rounding once."""
    every = np.sort(np.concatenate([np.empty(0), *listed]))
    apart = np.diff(every, prepend=-1.0) > _EQUAL * every
    return every[apart]
