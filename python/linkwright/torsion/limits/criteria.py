"""What is asked of the parts of a train, found against permitted, and where over the speed it is exceeded.

| part | what | permitted by |
| --- | --- | --- |
| shaft | vibratory stress, continuous and in transient passage, maximum stress, torques | its `limit` |
| coupling | torque, vibratory torque, heat | its own entries |
| damper | heat | `heat_permitted` |
| pendulum | swing | `swing_permitted` |
| gear stage | drop of the torque below its mean | the mean: beyond it teeth part |
| gear stage | torque | its `torque_permitted` |

Found over permitted is known at some speeds and can be asked for at any other; many are asked for at once.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.arrays import Bools, Floats
from linkwright.kernel.units.kinds import ANGLE, POWER, PRESSURE, TORQUE, Kind
from linkwright.machine.machine import Machine
from linkwright.torsion.excitation.excited_train import ExcitedTrain
from linkwright.torsion.excitation.harmonics import span
from linkwright.torsion.model.coupling import Coupling, Damper, Pendulum
from linkwright.torsion.model.shaft_limit import ShaftLimit
from linkwright.torsion.model.train import Shaft, Train
from linkwright.torsion.response.forced import TorsionResponse
from linkwright.torsion.response.mesh_torque import MeshTorque, meshed
from linkwright.torsion.response.stress import ShaftStress, shaft_stress

VIBRATORY_STRESS = "vibratory stress"
PASSING_STRESS = "vibratory stress in transient passage"
CONTACT = "drop of torque below its mean"


class Criterion(NamedTuple):
    """One thing that a part bears, over the speeds."""

    part: str  # name of the shaft, coupling, damper, pendulum or gear stage
    what: str  # in words
    kind: Kind  # the quantity
    found: Floats  # (speeds,) SI
    permitted: Floats  # (speeds,) SI; NaN where nothing is said

    @property
    def ratio(self) -> Floats:
        """Found over permitted, (speeds,): infinite at resonance without damping, 0 where nothing is said."""
        size = np.where(np.isfinite(self.found), self.found, np.inf)
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = np.where(size > 0, size / self.permitted, 0.0)
        return np.where(np.isnan(self.permitted), 0.0, ratio)


def criteria(
    machine: Machine,
    at: ExcitedTrain,
    response: TorsionResponse,
    service: float | None = None,
    meshes: MeshTorque | None = None,
) -> list[Criterion]:
    """All that limits of a train ask for.

    Shafts, couplings, dampers, gear stages; the same in number and order at any speeds. `service`: [rad/s];
    `meshes`: torques of the gear stages, if they are known already.
    """
    shafts = at.train.shafts
    stress = shaft_stress(machine, response, service)
    listed = [*_stresses(stress, shafts), *_torques(machine.train, shafts, response)]
    listed += _heats(machine.train, response)
    listed += _swings(machine.train, at, response)
    if not at.train.gears:
        return listed
    meshes = meshed(at, response) if meshes is None else meshes
    return [*listed, *_contacts(meshes), *_stage_torques(at.train, meshes)]


def _stresses(stress: ShaftStress, shafts: dict[str, Shaft]) -> Iterator[Criterion]:
    for row, name in enumerate(stress.shafts):
        limit, vibratory = shafts[name].limit, stress.vibratory[row]
        if limit is None:
            continue
        if limit.kind != "given" or limit.stress_permitted is not None:
            yield Criterion(name, VIBRATORY_STRESS, PRESSURE, vibratory, stress.continuous[row])
            yield Criterion(name, PASSING_STRESS, PRESSURE, vibratory, stress.transient[row])
        if limit.stress_max is not None:
            permitted = np.full(len(stress.speeds), limit.stress_max)
            yield Criterion(name, "maximum stress", PRESSURE, stress.greatest[row], permitted)


def _torques(train: Train | None, shafts: dict[str, Shaft], response: TorsionResponse) -> Iterator[Criterion]:
    limits = {name: shaft.limit for name, shaft in shafts.items() if shaft.limit is not None}
    bearing: dict[str, ShaftLimit | Coupling] = {**limits, **(train.couplings if train else {})}
    for name, limit in bearing.items():
        row = response.shafts.index(name)
        for what, permitted, torque in (
            ("torque", limit.torque_permitted, response.shaft_torque_max),
            ("vibratory torque", limit.vibratory_torque_permitted, response.shaft_torque_vibratory),
        ):
            if permitted is not None:
                yield Criterion(name, what, TORQUE, torque[row], np.full(len(response.speeds), permitted))


def _heats(train: Train | None, response: TorsionResponse) -> Iterator[Criterion]:
    heated: dict[str, Coupling | Damper] = {**train.couplings, **train.dampers} if train else {}
    for name, part in heated.items():
        if part.heat_permitted is not None:
            heat = response.shaft_heat[response.shafts.index(name)]
            yield Criterion(name, "heat", POWER, heat, np.full(len(heat), part.heat_permitted))


def _swings(train: Train | None, at: ExcitedTrain, response: TorsionResponse) -> Iterator[Criterion]:
    for name, pendulum in ({} if train is None else train.pendulums).items():
        if pendulum.swing_permitted is not None:
            permitted = np.full(len(response.speeds), pendulum.swing_permitted)
            yield Criterion(name, "swing", ANGLE, swing(name, pendulum, response), permitted)


def swing(name: str, pendulum: Pendulum, response: TorsionResponse) -> Floats:
    """Amplitude of the swing of a pendulum at each speed [rad], (speeds,)."""
    ring, disc = (response.amplitudes[:, response.discs.index(end)] for end in (name, pendulum.on))
    top, bottom = span(response.together, pendulum.swing_per_twist * (ring - disc))
    amplitude: Floats = 0.5 * (top - bottom)
    return amplitude


def _contacts(gears: MeshTorque) -> Iterator[Criterion]:
    for g, name in enumerate(gears.stages):
        if gears.toothed[g]:
            # No mean torque holds teeth together that carry none but by rounding.
            mean = np.abs(gears.mean[g])
            mean = np.where(mean > 1e-12 * np.abs(gears.greatest[g]), mean, 0.0)
            # A stage of a loop has no torque that statics knows.
            mean = np.where(np.isnan(gears.drop[g]), np.nan, mean)
            yield Criterion(name, CONTACT, TORQUE, gears.drop[g], mean)


def _stage_torques(train: Train, gears: MeshTorque) -> Iterator[Criterion]:
    for g, name in enumerate(gears.stages):
        permitted = train.gears[name].torque_permitted
        if permitted is not None:
            size = np.maximum(np.abs(gears.greatest[g]), np.abs(gears.least[g]))
            # A stage of a loop has no torque that statics knows.
            limit = np.where(np.isnan(gears.greatest[g]), np.nan, permitted)
            yield Criterion(name, "torque", TORQUE, size, limit)


def shown_quantity(value: float, kind: Kind) -> str:
    """A quantity for people: stresses in MPa, all else SI, four digits."""
    if np.isinf(value):
        return "unbounded (undamped resonance)"
    scale, unit = (1e6, "MPa") if kind is PRESSURE else (1.0, kind.unit)
    # Digits beyond the fourth are zeros, not a power of ten.
    return f"{float(f'{value / scale:.4g}'):.15g} {unit}"


# Rows of curves at any speeds, (rows, speeds).
Curves = Callable[[Floats], Floats]

# Bounds are sought until the curve is as close to 1 as this, or the speeds as close together as that.
_CLOSE = 1e-10
_NARROW = 1e-10
_BOUND_ROUNDS = 100

# Points to which the neighbourhood of a peak is cut in one round, and rounds: to some 10⁻⁷ of it.
_CUTS = 8
_PEAK_ROUNDS = 12


class Exceedance(NamedTuple):
    """A range of speeds in which a curve lies above 1."""

    row: int  # of the curve
    # `low`, `high`: bounds [rad/s].
    low: float
    high: float
    # `open_low`, `open_high`: whether it goes on beyond the speeds examined.
    open_low: bool
    open_high: bool
    peak: float  # speed of its highest value [rad/s]


def exceedances(curves: Curves, speeds: Floats, values: Floats) -> list[Exceedance]:
    """Ranges in which curves (rows, n) over speeds (n,) [rad/s] lie above 1, by row and speed."""
    runs = [(row, *run) for row, above in enumerate(values > 1) for run in _runs(above)]
    last = len(speeds) - 1
    edges = [(row, n, n - 1) for row, n, _ in runs if n > 0]
    edges += [(row, n, n + 1) for row, _, n in runs if n < last]
    bounds = _bounds(curves, [(row, speeds[inside], speeds[outside]) for row, inside, outside in edges])
    bound = dict(zip(((row, inside, outside) for row, inside, outside in edges), bounds, strict=True))
    tops = [(row, n + int(np.argmax(values[row, n : m + 1]))) for row, n, m in runs]
    between = [(row, speeds[max(n - 1, 0)], speeds[min(n + 1, last)]) for row, n in tops]
    peaks = peaks_between(curves, between, [(speeds[n], values[row, n]) for row, n in tops])
    return [
        Exceedance(
            row,
            float(bound.get((row, n, n - 1), speeds[n])),
            float(bound.get((row, m, m + 1), speeds[m])),
            n == 0,
            m == last,
            peak,
        )
        for (row, n, m), peak in zip(runs, peaks, strict=True)
    ]


def _runs(above: Bools) -> Iterator[tuple[int, int]]:
    steps = np.flatnonzero(np.diff(np.concatenate([[0], above.astype(np.int8), [0]])))
    yield from zip(steps[::2].tolist(), (steps[1::2] - 1).tolist(), strict=True)


def _bounds(curves: Curves, edges: list[tuple[int, float, float]]) -> list[float]:
    """Where curves pass 1 between a speed inside and one outside, all at once."""
    if not edges:
        return []
    rows = np.array([row for row, _, _ in edges])
    a, b = np.array([pair for _, *pair in edges], float).T
    f_a, f_b = (_at(curves, rows, end[None])[0] - 1 for end in (a, b))
    c, before = a, np.zeros(len(rows))
    for n in range(_BOUND_ROUNDS):
        with np.errstate(invalid="ignore"):
            c = b - f_b * (b - a) / (f_b - f_a)
        # Halved where a curve jumps, or is infinite.
        c = np.where(np.isfinite(c) & (n % 3 < 2), c, 0.5 * (a + b))
        f_c = _at(curves, rows, c[None])[0] - 1
        if ((np.abs(f_c) < _CLOSE) | (np.abs(b - a) < _NARROW * np.abs(c))).all():
            break
        inside, side = f_c > 0, np.sign(f_c)
        # An end that stays twice counts half: the Illinois form of the false position.
        half = np.where(side == before, 0.5, 1.0)
        f_a, f_b = np.where(inside, f_c, half * f_a), np.where(inside, half * f_b, f_c)
        a, b, before = np.where(inside, c, a), np.where(inside, b, c), side
    speeds: list[float] = c.tolist()
    return speeds


def peaks_between(
    curves: Curves,
    between: list[tuple[int, float, float]],
    known: list[tuple[float, float]],
    rounds: int = _PEAK_ROUNDS,
) -> list[float]:
    """Speeds of the highest values of curves between two speeds, all at once [rad/s].

    `between`: [rad/s]; `known`: [rad/s]; `rounds`: each leaves a quarter of the intervals.
    """
    if not between:
        return []
    rows = np.array([row for row, _, _ in between])
    low, high = np.array([pair for _, *pair in between], float).T
    best, value = np.array(known, float).T
    for _ in range(rounds):
        points = np.linspace(low, high, _CUTS + 1)
        heights = np.nan_to_num(_at(curves, rows, points), nan=-np.inf, posinf=np.inf)
        top, pick = np.argmax(heights, axis=0), np.arange(len(rows))
        better = heights[top, pick] > value
        best = np.where(better, points[top, pick], best)
        value = np.where(better, heights[top, pick], value)
        step = (high - low) / _CUTS
        low, high = np.maximum(best - step, low), np.minimum(best + step, high)
    listed: list[float] = best.tolist()
    return listed


def peaks_on(
    curves: Curves, grids: Sequence[tuple[int, Floats]], dip: float = 0.0, rounds: int = _PEAK_ROUNDS
) -> list[list[float]]:
    """Speeds of all maxima of curves that grids of speeds show, all at once, by grid [rad/s].

    `grids`: row and increasing speeds of each [rad/s]; `dip`: maxima between which a curve falls by a smaller
    share are one, and one so close to the height of an end is none; `rounds`: of `peaks_between`.
    """
    if not grids:
        return []
    every = np.unique(np.concatenate([grid for _, grid in grids]))
    values = curves(every)
    tops = []
    for n, (row, grid) in enumerate(grids):
        here = values[row, np.searchsorted(every, grid)]
        tops += [(n, row, grid[k - 1 : k + 2], here[k]) for k in _maxima(here, dip)]
    speeds = peaks_between(
        curves,
        [(row, float(about[0]), float(about[2])) for _, row, about, _ in tops],
        [(float(about[1]), float(value)) for _, _, about, value in tops],
        rounds,
    )
    listed: list[list[float]] = [[] for _ in grids]
    for (n, *_), peak in zip(tops, speeds, strict=True):
        listed[n].append(peak)
    return listed


def _maxima(values: Floats, dip: float) -> list[int]:
    """Local maxima above 1, separated by dips."""
    here, before, after = values[1:-1], values[:-2], values[2:]
    inside = (1 + np.flatnonzero((here > before) & (here >= after))).tolist()
    if dip == 0:
        return inside
    last = len(values) - 1
    kept = [0]
    for place in (*inside, last):
        lowest = values[kept[-1] : place + 1].min()
        if lowest < (1 - dip) * min(values[kept[-1]], values[place]):
            kept.append(place)
        elif values[place] > values[kept[-1]]:
            kept[-1] = place
    ends = [0, *kept, last]
    falls = [
        max(values[before : place + 1].min(), values[place : after + 1].min()) < (1 - dip) * values[place]
        for before, place, after in zip(ends, kept, ends[2:], strict=False)
    ]
    return [place for place, is_one in zip(kept, falls, strict=True) if is_one and 0 < place < last]


def _at(curves: Curves, rows: NDArray[np.int64], points: Floats) -> Floats:
    """Values of one row for each column of points, (cuts, columns)."""
    values = curves(points.ravel()).reshape(-1, *points.shape)
    chosen: Floats = values[rows, :, np.arange(len(rows))].T
    return chosen
