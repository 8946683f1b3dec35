r"""Speeds that shafts do not bear for ever: barred, and passed quickly, or not to be passed at all.

A range is barred where a shaft's vibratory stress is above what is permitted for ever. Its bounds are where
the two are equal, sought with the response itself. About a critical speed :math:`n_c` classification
societies ask for at least :math:`16 n_c/(18 - \lambda) \le n \le (18 - \lambda) n_c/16`, λ being its ratio to
the speed of service. Where the stress is also above what is permitted while passing, the range may not even
be passed.

References
----------
.. [1] IACS, UR M68, 2021, M68.5: barred speed ranges. The tolerance of the tachometer comes on top.
.. [2] Korean Register, Rules for the Classification of Steel Ships, part 5, chapter 4, 206.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.analysis.result import Result
from linkwright.analysis.torsion.exceedance import Exceedance, exceedances
from linkwright.analysis.torsion.excited import Excited, excited
from linkwright.analysis.torsion.forced import forced_vibration
from linkwright.analysis.torsion.resonance import Resonance, resonances, with_resonances
from linkwright.analysis.torsion.stress import ShaftStress, service_speed, shaft_stress
from linkwright.machine import Machine
from linkwright.machine.propulsion_shaft import barred_speeds

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class BarredRange(Result):
    """Speeds at which a shaft is stressed more than it bears for ever.

    Attributes
    ----------
    shaft : str
        The shaft.
    speed_min, speed_max : float
        Where the stress passes what is permitted for ever [rad/s].
    open_min, open_max : bool
        Whether the range goes on beyond the speeds looked at.
    worst_speed : float
        Where stress over permitted stress is largest [rad/s].
    worst_stress, continuous, transient : float
        Vibratory stress there, permitted for ever, permitted while passing; NaN if nothing is said [Pa].
    not_passable : tuple of tuple of float
        Lowest and highest speed of each part in which the stress is above what is permitted while passing
        [rad/s].
    critical_speed, order : float or None
        The resonance in the range next to the worst speed [rad/s], and its order.
    class_min, class_max : float or None
        What is barred about it by the formula of the societies [rad/s].
    ratio_max : float
        Highest speed of the range over that of service.
    ratio_permitted : float
        Up to which the rule lets speeds be barred; infinite without a rule.
    """

    shaft: str
    speed_min: float
    speed_max: float
    open_min: bool
    open_max: bool
    worst_speed: float
    worst_stress: float
    continuous: float
    transient: float
    not_passable: tuple[tuple[float, float], ...]
    critical_speed: float | None
    order: float | None
    class_min: float | None
    class_max: float | None
    ratio_max: float
    ratio_permitted: float

    @property
    def is_passable(self) -> bool | None:
        """Whether it may be passed quickly; None if the limit does not say."""
        if self.not_passable:
            return False
        return None if np.isnan(self.transient) else True

    @property
    def may_be_barred(self) -> bool:
        """Whether it lies where speeds may be barred in normal operation."""
        return self.ratio_max <= self.ratio_permitted

    @property
    def barred(self) -> tuple[float, float]:
        """Speeds to be barred: those of too much stress, and those of the formula [rad/s]."""
        low = self.speed_min if self.class_min is None else min(self.speed_min, self.class_min)
        high = self.speed_max if self.class_max is None else max(self.speed_max, self.class_max)
        return low, high


def barred_ranges(machine: Machine) -> tuple[BarredRange, ...]:
    """Speeds that the shafts of a train do not bear for ever.

    Parameters
    ----------
    machine : Machine
        With a [train] that something excites, speeds in [train.run], and limits of shafts.

    Returns
    -------
    tuple of BarredRange
        By shaft, then by speed. Looked at are the speeds of the run and all resonances between them.

    Raises
    ------
    InputError
        Nothing excites the train, or it has no speeds.

    References
    ----------
    .. [1] IACS, UR M68, 2021, M68.5.
    """
    at = excited(machine)
    speeds = with_resonances(at)

    def stress(at_speeds: Floats) -> ShaftStress:
        return shaft_stress(machine, forced_vibration(machine, at_speeds))

    above = exceedances(lambda each: _over(stress(each), "continuous"), speeds)
    if not above:
        return ()
    passing = exceedances(lambda each: _over(stress(each), "transient"), speeds)
    peaks = stress(np.array([each.peak for each in above]))
    rated = service_speed(machine, speeds)
    critical = resonances(at)
    return tuple(_range(at, each, n, peaks, rated, critical, passing) for n, each in enumerate(above))


def together(ranges: Iterable[BarredRange]) -> list[tuple[float, float]]:
    """Speeds to be barred for all shafts, ranges that meet taken as one.

    Parameters
    ----------
    ranges : iterable of BarredRange
        Of any shafts.

    Returns
    -------
    list of tuple of float
        Lowest and highest of each, by speed [rad/s].
    """
    found: list[tuple[float, float]] = []
    for low, high in sorted(each.barred for each in ranges):
        if found and low <= found[-1][1]:
            found[-1] = (found[-1][0], max(found[-1][1], high))
        else:
            found.append((low, high))
    return found


def _over(stress: ShaftStress, limit: str) -> Floats:
    """Stress over what is permitted; 0 where nothing is said, infinite at a resonance without damping."""
    permitted = getattr(stress, limit)
    found = np.where(np.isfinite(stress.vibratory), stress.vibratory / permitted, np.inf)
    return np.where(np.isnan(permitted), 0.0, found)


def _range(
    at: Excited,
    above: Exceedance,
    column: int,
    peaks: ShaftStress,
    rated: float,
    critical: tuple[Resonance, ...],
    passing: list[Exceedance],
) -> BarredRange:
    """One range with its numbers."""
    inside = [each for each in critical if above.low <= each.speed <= above.high]
    nearest = min(inside, key=lambda each: abs(each.speed - above.peak), default=None)
    formula = (None, None) if nearest is None else barred_speeds(nearest.speed, rated)
    name, row = peaks.shafts[above.row], above.row
    limit = at.train.shafts[name].limit
    return BarredRange(
        shaft=name,
        speed_min=above.low,
        speed_max=above.high,
        open_min=above.open_low,
        open_max=above.open_high,
        worst_speed=above.peak,
        worst_stress=float(peaks.vibratory[row, column]),
        continuous=float(peaks.continuous[row, column]),
        transient=float(peaks.transient[row, column]),
        not_passable=tuple(
            (max(each.low, above.low), min(each.high, above.high))
            for each in passing
            if each.row == row and each.low < above.high and each.high > above.low
        ),
        critical_speed=None if nearest is None else nearest.speed,
        order=None if nearest is None else nearest.order,
        class_min=formula[0],
        class_max=formula[1],
        ratio_max=above.high / rated,
        ratio_permitted=np.inf if limit is None else limit.barred_ratio_max,
    )
