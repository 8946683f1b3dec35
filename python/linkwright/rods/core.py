"""The core's string of sucker rods: sections, their pump, and samples of a period."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from linkwright import _core
from linkwright.kernel.arrays import Floats
from linkwright.rods.model.rod_string import RodString

# Sweeps between string and pump at most, and the change of the wave at which they end, over the fluid load;
# the change that is still a solution.
_SWEEPS, _TOLERANCE, _SMALL = 2000, 1e-11, 1e-6

# Prime factors of a number of samples.
_FACTORS = (2, 3, 5)


def core_string(string: RodString, damping: float | None = None) -> _core.RodString:
    """The sections of a string, with another damping [1/s] if given."""
    columns = string.columns
    rate = columns.damping if damping is None else np.full(len(columns.mass), damping)
    return _core.RodString(rigidity=columns.rigidity, mass=columns.mass, damping=rate, length=columns.length)


class Solved(NamedTuple):
    """The periodic motion of a string with its pump."""

    cards: _core.RodCards
    wave: Floats  # (n,) wave that comes down, to start from [N]
    sweeps: int
    change: float  # of the wave in the last sweep, over the fluid load

    @property
    def has_converged(self) -> bool:
        """Whether the sweeps came to their end."""
        return self.change <= _SMALL


def solve_string(string: RodString, period: float, motion: Floats, start: Floats | None = None) -> Solved:
    """The motion under samples (n,) of the polished rod's position [m, upward] over a period [s].

    ``start``: a wave to start from, of any number of samples.
    """
    n, pump = len(motion), string.pump
    if start is not None:
        start = np.interp(np.arange(n) / n, np.arange(len(start)) / len(start), start, period=1.0)
    solved = core_string(string).predict(
        period=period,
        motion=np.ascontiguousarray(motion, dtype=float),
        load=float(string.fluid_load),
        compliance=float(pump.tubing_compliance(string.length)),
        compressibility=float(1 / (pump.bulk_modulus * pump.area)),
        slip=float(pump.leak / pump.area),
        fillage=pump.fillage,
        discharge=float(string.discharge * pump.area),
        softness=0.0 if pump.gas_exponent is None else 1 / pump.gas_exponent,
        start=start,
        tolerance=_TOLERANCE,
        sweeps=_SWEEPS,
    )
    return Solved(solved.cards, solved.wave, solved.sweeps, solved.change)


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


def cards_of(
    string: RodString, period: float, position: Floats, load: Floats, damping: float
) -> _core.RodCards:
    """Cards along a string by samples (n,) of position [m] and dynamic load [N] at the polished rod."""
    return core_string(string, damping).cards(
        period=period,
        position=np.ascontiguousarray(position, dtype=float),
        load=np.ascontiguousarray(load, dtype=float),
        harmonics=len(position) // 2 - 1,
    )
