"""A train examined closely: at the speeds of its run, at its resonances and peaks, and at any speed between.

Torques of an engine or of a mechanism take long to find and change little from speed to speed. Between the
speeds of the run they are interpolated, by cubics through the four speeds about; the response to them is that
of the speed itself.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Annotated, NamedTuple, TypeVar

import numpy as np

from linkwright.kernel.arrays import Complexes, Floats, Indices
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.machine.machine import Machine
from linkwright.torsion.core.distributed import frequencies_below
from linkwright.torsion.excitation.excited_train import ExcitedTrain, excited_train, loaded
from linkwright.torsion.limits.criteria import Criterion, Exceedance, criteria, exceedances, peaks_between
from linkwright.torsion.modes.damped import damped_modes, in_pieces
from linkwright.torsion.response.forced import TorsionResponse, torsion_response
from linkwright.torsion.response.stress import service_speed

# Share of the largest ω² below which a motion is without stiffness.
_FREE = 1e-13


class Resonance(NamedTuple):
    """A speed at which an order meets a natural frequency."""

    speed: float  # of the first disc [rad/s]
    order: float  # cycles per revolution of the first disc
    mode: int  # of the natural frequencies in increasing order, from 0


def resonances(at: ExcitedTrain) -> tuple[Resonance, ...]:
    """Undamped resonances of all orders between the lowest and the highest speed, by speed."""
    speeds = np.sort(at.torques.speeds)
    omega = _frequencies(at)[np.argsort(at.torques.speeds)]
    crossings = []
    for mode in range(omega.shape[1]):
        for order, fixed in zip(at.torques.orders.tolist(), at.torques.offsets.tolist(), strict=True):
            gap = omega[:, mode] - np.abs(order * speeds + fixed)
            crossings += [Resonance(speed, order, mode) for speed in _zeros(speeds, gap)]
    return tuple(sorted(crossings))


def _frequencies(at: ExcitedTrain) -> Floats:
    """Natural frequencies above zero at every speed, (speeds, modes) [rad/s]."""
    # Rings in a fluid hang on nothing elastic: LAPACK takes what is no train in pieces.
    columns, place = np.unique(at.operating.stiffness, axis=1, return_inverse=True)
    if at.referred.rods:
        trains = (
            replace(at.referred, stiffness=np.ascontiguousarray(column)).on_springs(
                at.operating.disc_stiffness
            )
            for column in columns.T
        )
        highest = float(at.torques.omega.max(initial=at.torques.speeds.max()))
        listed = [
            np.where(low > 0, low, 0.0) for low in (frequencies_below(train, highest) for train in trains)
        ]
        count = min(map(len, listed))
        exact = np.array([low[:count] for low in listed])
        return exact[place.ravel()][:, exact.min(axis=0) > 0]
    scale = 1.0 / np.sqrt(at.referred.inertia)
    matrices = np.array([replace(at.referred, stiffness=column).stiffness_matrix for column in columns.T])
    if at.operating.disc_stiffness is not None:
        matrices += np.diag(at.operating.disc_stiffness)
    square = np.linalg.eigvalsh(scale[:, None] * matrices * scale)
    # Rounding leaves some 10⁻¹⁵ of the largest where a part turns freely.
    moving = square.min(axis=0) > _FREE * square.max(initial=0.0)
    frequencies: Floats = np.sqrt(square[place.ravel()][:, moving])
    return frequencies


def damped_resonances(at: ExcitedTrain) -> tuple[Floats, Floats]:
    """Speeds at which orders meet damped natural frequencies far from those without damping, and the orders.

    (n,) each [rad/s], cycles per revolution of the first disc.

    A strong damper holds its ring, so that a train resonates where it does not without damping. Natural
    frequencies are those of some speeds, each taken to hold halfway to the next.
    """
    if not _has_viscous_damping(at):
        return np.empty(0), np.empty(0)
    speeds, undamped = at.torques.speeds, _frequencies(at)
    changing = np.concatenate([at.operating.stiffness, at.operating.disc_damping])
    size = 2 * len(at.referred.inertia)
    count = int(np.clip(_EIGENVALUE_WORK / size**3, *_COLUMNS)) if np.ptp(changing, axis=1).any() else 1
    places = np.unique(np.linspace(0, len(speeds) - 1, min(count, len(speeds))).round().astype(int))
    halfway = 0.5 * (speeds[places[:-1]] + speeds[places[1:]])
    ends = np.concatenate([speeds[:1], halfway, speeds[-1:]])
    listed, of_orders = [np.empty(0)], [np.empty(0)]
    for place, low, high in zip(places, ends[:-1], ends[1:], strict=True):
        moved = _moved(at, place, undamped[place])
        with np.errstate(divide="ignore", invalid="ignore"):
            crossings = np.subtract.outer(moved, at.torques.offsets) / at.torques.orders
        inside = (crossings >= low) & (crossings <= high)
        listed.append(crossings[inside])
        of_orders.append(np.broadcast_to(at.torques.orders, crossings.shape)[inside])
    return np.concatenate(listed), np.concatenate(of_orders)


def _has_viscous_damping(at: ExcitedTrain) -> bool:
    return bool(at.referred.damping.any() or at.operating.disc_damping.any() or at.referred.ratios.any())


def _moved(at: ExcitedTrain, place: int, undamped: Floats) -> Floats:
    """Damped natural frequencies [rad/s] farther from the undamped ones than their peaks are wide."""
    stiffness, damping = at.operating.stiffness[:, place], at.operating.disc_damping[:, place]
    train = replace(at.referred, stiffness=np.ascontiguousarray(stiffness), disc_damping=damping)
    train = train.on_springs(at.operating.disc_stiffness)
    if train.rods:
        train = replace(in_pieces(train, len(undamped)), rods=())
    ((eigenvalues, _),) = damped_modes([train])
    s = eigenvalues[eigenvalues.imag > 0]
    nearest = np.abs(np.subtract.outer(s.imag, undamped)).min(axis=1, initial=np.inf)
    # Half the width of a peak is σ.
    moved: Floats = s.imag[nearest > -s.real]
    return moved


def _zeros(x: Floats, y: Floats) -> list[float]:
    n = np.flatnonzero(y[:-1] * y[1:] < 0)
    share = y[n] / (y[n] - y[n + 1])
    between: list[float] = (x[n] + share * (x[n + 1] - x[n])).tolist()
    return [*between, *x[y == 0].tolist()]


Values = TypeVar("Values", Floats, Complexes)

# Speeds that differ by a smaller share are one.
_EQUAL = 1e-9

# Share of a limit from which on a peak between the speeds might be above it.
_NEAR = 0.8

# Speeds whose damped natural frequencies are found, and cubes of sizes of their matrices: some 0.1 s.
_COLUMNS, _EIGENVALUE_WORK = (3, 32), 3e6

# Speeds that are examined in one piece.
_AT_ONCE = 256

# Rounds in which a valley is closed in on, where two flanks meet: to 4⁻⁶ of what a limit changes by from
# speed to speed. A dip below the limit by less than that is no range to run in.
_VALLEY_ROUNDS = 6

# Speeds about a speed, through which a cubic goes.
_ABOUT = 4


@dataclass(frozen=True)
class Survey:
    """A train at its speeds and between them."""

    machine: Machine  # with a train that something excites
    at: ExcitedTrain  # at the speeds of its run, increasing
    found: TorsionResponse  # what its shafts carry there

    @cached_property
    def resonances(self) -> tuple[Resonance, ...]:
        """Resonances between the lowest and the highest speed."""
        return resonances(self.at)

    @cached_property
    def _end_frequencies(self) -> tuple[Floats, Floats]:
        """Natural frequencies above zero at the lowest and at the highest speed [rad/s]."""
        speeds, omega = self.at.torques.speeds, _frequencies(self.at)
        return omega[int(np.argmin(speeds))], omega[int(np.argmax(speeds))]

    def resonances_beyond(self, order: float) -> tuple[list[float], list[float]]:
        """Speeds below and above all speeds at which an order meets the frequencies of the ends [rad/s]."""
        speeds = self.at.torques.speeds
        low, high = (np.sort(omega / order) for omega in self._end_frequencies)
        return low[low < speeds.min()].tolist(), high[high > speeds.max()].tolist()

    @cached_property
    def service(self) -> float:
        """Speed of the first disc that λ = 1 stands for [rad/s]."""
        return service_speed(self.machine, self.at.torques.speeds)

    @cached_property
    def speeds(self) -> Floats:
        """Those of the run, of the resonances and of peaks of what limits ask for, shape (n,) [rad/s]."""
        return self._with_peaks[0]

    @cached_property
    def criteria(self) -> list[Criterion]:
        """All limits at these speeds."""
        return self._with_peaks[1]

    @cached_property
    def _with_peaks(self) -> tuple[Floats, list[Criterion]]:
        """Speeds and limits, once peaks are found: damping has them beside the resonances."""
        speeds, limits = self._joined(
            self.at.torques.speeds,
            criteria(self.machine, self.at, self.found, self.service),
            self.resonant_speeds,
        )
        places = [(n, k) for n, limit in enumerate(limits) for k in _highest(limit.ratio)]
        peaks = peaks_between(
            self._ratios,
            [(n, speeds[max(k - 1, 0)], speeds[min(k + 1, len(speeds) - 1)]) for n, k in places],
            [(speeds[k], limits[n].ratio[k]) for n, k in places],
        )
        speeds, limits = self._joined(speeds, limits, np.setdiff1d(peaks, speeds))
        return self._joined(speeds, limits, np.setdiff1d(self._valleys(speeds, limits, peaks), speeds))

    def _valleys(self, speeds: Floats, limits: list[Criterion], peaks: list[float]) -> list[float]:
        """Speeds of the minima between peaks where a limit is exceeded throughout."""
        tops = np.unique(np.concatenate([self.resonant_speeds, peaks]))
        places = np.searchsorted(speeds, tops[(tops >= speeds[0]) & (tops <= speeds[-1])])
        spans = [(low, high) for low, high in itertools.pairwise(places.tolist()) if low < high]
        high = [
            (n, *span) for n, limit in enumerate(limits) for span in spans if _is_above(limit.ratio, *span)
        ]
        least = [low + int(np.argmin(limits[n].ratio[low : up + 1])) for n, low, up in high]
        return peaks_between(
            lambda at: -self._ratios(at),
            [
                (n, speeds[max(k - 1, low)], speeds[min(k + 1, up)])
                for (n, low, up), k in zip(high, least, strict=True)
            ],
            [(speeds[k], -limits[n].ratio[k]) for (n, _, _), k in zip(high, least, strict=True)],
            _VALLEY_ROUNDS,
        )

    def _joined(
        self, speeds: Floats, limits: list[Criterion], added: Floats
    ) -> tuple[Floats, list[Criterion]]:
        if not len(limits) or not len(added):
            return np.sort(np.concatenate([speeds, added])), limits
        every = np.concatenate([speeds, added])
        order = np.argsort(every)
        return every[order], [
            one._replace(
                found=np.append(one.found, other.found)[order],
                permitted=np.append(one.permitted, other.permitted)[order],
            )
            for one, other in zip(limits, self.criteria_at(added), strict=True)
        ]

    def _ratios(self, speeds: Floats) -> Floats:
        """Utilisation, value over limit, at any speeds, (limits, speeds)."""
        return np.array([criterion.ratio for criterion in self.criteria_at(speeds)])

    @cached_property
    def exceeded(self) -> list[Exceedance]:
        """Ranges in which limits are not kept, by their place among the criteria."""
        ratios = np.array([criterion.ratio for criterion in self.criteria]).reshape(-1, len(self.speeds))
        return exceedances(self._ratios, self.speeds, ratios)

    def criteria_at(self, speeds: Floats) -> list[Criterion]:
        """All limits, in one order, at `speeds` (n,) [rad/s] between the lowest and the highest."""
        parts = [criteria(self.machine, at, torsion_response(at), self.service) for at in self.parts(speeds)]
        return in_a_row(parts)

    def carried_at(self, speeds: Floats) -> TorsionResponse:
        """What the shafts carry at a few `speeds` (n,) [rad/s] between the lowest and the highest."""
        return torsion_response(between(self.machine, self.at, speeds))

    def vibratory_at(self, speeds: Floats) -> Floats:
        """Vibratory torque of each shaft at any speeds in the range, (shafts, n) [N m]."""
        parts = [torsion_response(at).shaft_torque_vibratory for at in self.parts(speeds)]
        return np.concatenate(parts, axis=1)

    def parts(self, speeds: Floats) -> Iterator[ExcitedTrain]:
        """The train at any speeds, some at a time: all orders of all shafts at once may be too many."""
        for first in range(0, max(len(speeds), 1), _AT_ONCE):
            yield between(self.machine, self.at, speeds[first : first + _AT_ONCE])

    @cached_property
    def damped_resonances(self) -> tuple[Floats, Floats]:
        """Speeds of resonances that damping has moved far, with their orders."""
        return damped_resonances(self.at)

    @cached_property
    def resonant_speeds(self) -> Floats:
        """Speeds of resonances, without damping and with it, that the run does not have."""
        run = self.at.torques.speeds
        undamped = [resonance.speed for resonance in self.resonances]
        every = np.unique(np.concatenate([undamped, self.damped_resonances[0]]))
        every = every[np.diff(every, prepend=-1.0) > _EQUAL * every]
        apart = np.abs(every[:, None] - run).min(axis=1, initial=np.inf) > _EQUAL * every
        speeds: Floats = every[apart]
        return speeds


def in_a_row(parts: Sequence[list[Criterion]]) -> list[Criterion]:
    """Limits whose speeds were examined in pieces."""
    return [
        first._replace(
            found=np.concatenate([criterion.found for criterion in (first, *rest)]),
            permitted=np.concatenate([criterion.permitted for criterion in (first, *rest)]),
        )
        for first, *rest in zip(*parts, strict=True)
    ]


def _highest(ratio: Floats) -> list[int]:
    """Indices of the maximum, and of all maxima that might exceed the limit between the speeds."""
    inside = np.concatenate([[False], (ratio[1:-1] >= ratio[:-2]) & (ratio[1:-1] >= ratio[2:]), [False]])
    near = np.flatnonzero(inside & (ratio > _NEAR)).tolist()
    return sorted({int(np.argmax(ratio)), *near}) if ratio.max(initial=0.0) > 0 else []


def _is_above(ratio: Floats, low: int, high: int) -> bool:
    return bool((ratio[low : high + 1] > 1).all())


def survey(
    machine: Machine, at: ExcitedTrain | None = None, response: TorsionResponse | None = None
) -> Survey:
    """Look at a train closely. Nothing of it is computed before it is asked for."""
    at = excited_train(machine) if at is None else at
    return Survey(machine, at, torsion_response(at) if response is None else response)


def between(machine: Machine, at: ExcitedTrain, speeds: Floats) -> ExcitedTrain:
    """A train at other speeds between those at which it has been prepared.

    At these. Torques of the file itself are exact, as are all where fewer than four speeds are known.
    `speeds`: (n,) between them [rad/s].
    """
    exact = machine.train is not None and not machine.train.installed
    if exact or len(at.torques.speeds) < _ABOUT:
        return excited_train(machine, speeds)
    about, weights = _about(at.torques.speeds, speeds)

    def there(values: Values) -> Values:
        value: Values = sum(w * values[..., n] for n, w in zip(about, weights, strict=True))
        return value

    torques = replace(
        at.torques,
        speeds=speeds,
        harmonics=there(at.torques.harmonics),
        mean=there(at.torques.mean),
        damping=there(at.torques.damping),
    )
    return loaded(machine, at.train, at.referred, torques)


def _about(known: Floats, wanted: Floats) -> tuple[Indices, Floats]:
    """Indices of four known speeds about each wanted one, and their Lagrange weights, (4, wanted)."""
    first = np.clip(np.searchsorted(known, wanted) - _ABOUT // 2, 0, len(known) - _ABOUT)
    about = first + np.arange(_ABOUT)[:, None]
    x = known[about]
    weights = np.ones_like(x)
    for n in range(_ABOUT):
        for k in range(_ABOUT):
            if k != n:
                weights[n] *= (wanted - x[k]) / (x[n] - x[k])
    return about, weights


@dataclass(frozen=True)
class TorquePeaks(Result):
    """Where each shaft swings most."""

    shafts: Annotated[tuple[str, ...], About("As in `ForcedVibration`.")]
    vibratory: Annotated[
        Floats,
        Label(
            "vibratory torque in each shaft",
            "",
            "N m",
            "Half the peak-to-peak torque; infinite at a resonance that nothing damps.",
            shape="(shafts,)",
        ),
    ]
    speed: Annotated[Floats, Label("speed of the first disc there", "ω", "rad/s", shape="(shafts,)")]


def torque_peaks(seen: Survey) -> TorquePeaks:
    """Largest vibratory torques over a run and the resonances between its speeds, with their peaks."""
    resonant = seen.resonant_speeds
    every, vibratory = seen.at.torques.speeds, seen.found.shaft_torque_vibratory
    if len(resonant):
        every = np.concatenate([every, resonant])
        vibratory = np.concatenate([vibratory, seen.vibratory_at(resonant)], axis=1)
    order = np.argsort(every)
    every, size = every[order], _finite(vibratory[:, order])
    worst = size.argmax(axis=1)
    about = np.clip(worst[:, None] + [-1, 1], 0, len(every) - 1)
    speed = np.array(
        peaks_between(
            lambda at: _finite(seen.vibratory_at(at)),
            [(row, *every[pair].tolist()) for row, pair in enumerate(about)],
            [(float(every[k]), float(size[row, k])) for row, k in enumerate(worst)],
        )
    )
    rows = np.arange(len(size))
    return TorquePeaks(seen.found.shafts, _finite(seen.vibratory_at(speed))[rows, rows], speed)


def _finite(torque: Floats) -> Floats:
    """Torques; infinite at an undamped resonance."""
    return np.where(np.isfinite(torque), torque, np.inf)
