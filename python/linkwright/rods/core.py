"""The core's string of sucker rods: sections, their pump, and samples of a period."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from linkwright import _core
from linkwright.kernel.arrays import Floats
from linkwright.rods.model.rod_string import RodString

# Sweeps between string and pump at most, and the change of the wave at which they end, over the fluid load;
# the change that is still a solution.
_SWEEPS, _TOLERANCE, _SMALL = 2000, 1e-9, 1e-6

# Change of derivatives in a sweep over their size, at which they have converged.
_TOLERANCE_ALONG = 1e-11

# Prime factors of a number of samples.
_FACTORS = (2, 3, 5)


def numbers_of(string: RodString, period: Any, damping: Any = None) -> list[Any]:
    """Numbers of a string for the core, arrays or with derivatives too; another damping [1/s] if given."""
    pump, rate = string.pump, string.damping_rate if damping is None else damping
    sections = [(s.modulus * s.area, s.mass, rate, s.length) for s in string.sections]
    return [
        *(number for section in sections for number in section),
        string.fluid_load,
        pump.tubing_compliance(string.length),
        1 / (pump.bulk_modulus * pump.area),
        pump.leak / pump.area,
        pump.fillage,
        string.discharge * pump.area,
        0.0 if pump.gas_exponent is None else 1 / pump.gas_exponent,
        period,
    ]


class Cards(NamedTuple):
    """Cards along a string: position [m] and tension [N] of its stations, (stations, n)."""

    position: Any
    load: Any
    work: Any  # past each station in a stroke [J]
    loss: Any  # heat of each section in a stroke [J]


class Solved(NamedTuple):
    """The periodic motion of a string with its pump."""

    cards: Cards
    wave: Floats  # (n,) wave that comes down, to start from [N]
    mean_load: Any  # of the plunger [N]
    sweeps: int
    change: float  # of the wave in the last sweep, over the fluid load

    @property
    def has_converged(self) -> bool:
        """Whether the sweeps came to their end."""
        return self.change <= _SMALL


def solve_string(string: RodString, period: float, motion: Floats, start: Floats | None = None) -> Solved:
    """The motion under samples (n,) of the polished rod's position [m, upward] over a period [s].

    ``start``: a wave to start from, of any number of samples. The cards have twice the samples.
    """
    n = len(motion)
    if start is not None:
        start = np.interp(np.arange(n) / n, np.arange(len(start)) / len(start), start, period=1.0)
    numbers = np.array([numbers_of(string, period)], dtype=float)
    found = solve_rows(string, numbers, motion[None], start, tolerance=_TOLERANCE)
    mean_load, change = found.ends[0]
    return Solved(cards_in(found, string, 0), found.wave[0], float(mean_load), found.sweeps, float(change))


def solve_rows(
    string: RodString,
    numbers: Floats,
    motion: Floats,
    start: Floats | None = None,
    *,
    tolerance: float,
) -> _core.RodMotions:
    """Motions of strings of the same sections by rows of `numbers_of` and samples (rows, n)."""
    return _core.predict_rods(
        sections=len(string.sections),
        numbers=np.ascontiguousarray(numbers),
        motion=np.ascontiguousarray(motion, dtype=float),
        start=None if start is None else np.ascontiguousarray(np.atleast_2d(start)),
        tolerance=tolerance,
        sweeps=_SWEEPS,
    )


def solve_along(
    string: RodString, period: float, motion: Floats, wave: Floats, along: tuple[Floats, Floats]
) -> _core.RodMotions:
    """Derivatives of a motion, whose wave is known, by directions (k, …) of its numbers and its samples."""
    numbers, samples = along
    return _core.rods_along(
        sections=len(string.sections),
        numbers=np.array(numbers_of(string, period), dtype=float),
        motion=np.ascontiguousarray(motion, dtype=float),
        start=np.ascontiguousarray(wave),
        numbers_along=np.ascontiguousarray(numbers),
        motion_along=np.ascontiguousarray(samples),
        tolerance=_TOLERANCE_ALONG,
        sweeps=2 * _SWEEPS,
    )


def cards_in(found: _core.RodMotions, string: RodString, row: int) -> Cards:
    """The cards of one row."""
    work, stations = found.work[row], len(string.sections) + 1
    return Cards(found.position[row], found.load[row], work[:stations], work[stations:])


def sample_counts(string: RodString, period: float, least: int) -> list[int]:
    """Even numbers of samples, `least` or up to a third more, best first.

    The steps of the best are nearly parts of the time of a wave through every section: corners of the load
    stay corners, as in the method of characteristics.
    """
    columns = string.columns
    delays = columns.length * np.sqrt(columns.mass / columns.rigidity) / period
    counts = [n for n in range(least, least * 4 // 3 + 2) if n % 2 == 0 and _is_smooth(n)]
    steps = np.outer(counts, 2 * delays)
    order = np.abs(steps - np.round(steps)).max(axis=1).argsort(kind="stable")
    return [counts[place] for place in order]


def _is_smooth(n: int) -> bool:
    for factor in _FACTORS:
        while n % factor == 0:
            n //= factor
    return n == 1


def cards_of(string: RodString, period: float, position: Floats, load: Floats, damping: float) -> Cards:
    """Cards along a string by samples (n,) of position [m] and dynamic load [N] at the polished rod."""
    found = cards_in_rows(string, [period], position[None], load[None], damping)
    return Cards(*(each[0] for each in found))


def cards_in_rows(
    string: RodString, periods: Sequence[float], position: Floats, load: Floats, damping: float
) -> Cards:
    """Cards of many records (cards, n): the same with a row a card."""
    sections = len(string.sections)
    numbers = np.repeat(np.array([numbers_of(string, 1.0, damping)], dtype=float), len(periods), axis=0)
    numbers[:, -1] = periods
    found = _core.rod_cards(
        sections=sections,
        numbers=numbers,
        position=np.ascontiguousarray(position, dtype=float),
        load=np.ascontiguousarray(load, dtype=float),
        harmonics=position.shape[1] // 2 - 1,
    )
    work = found.work
    return Cards(found.position, found.load, work[:, : sections + 1], work[:, sections + 1 :])
