"""Many predictions at once: strings that differ in numbers, each a lane of the core's kernel.

All have one number of samples: loads that peak at a corner miss up to some thousandths of their range.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError
from linkwright.kernel.public import public
from linkwright.kernel.quantities import Label
from linkwright.kernel.result import Result
from linkwright.machine.address import replace
from linkwright.machine.machine import Machine
from linkwright.rods.core import Cards, numbers_of, solve_rows
from linkwright.rods.polished_rod import HarmonicRod, crank_speed, polished_rod_of
from linkwright.rods.prediction import string_of
from linkwright.rods.scalars import StringNumbers, along_curve, goodman_loadings, string_scalars

# Samples of a stroke, change of the wave over the fluid load at which its sweeps end, and strings at a time.
_SAMPLES, _TOLERANCE, _AT_ONCE = 512, 1e-4, 512

# Entries that many strings may differ in.
_VARIED = ("rod_string.", "drive.speed")


@dataclass(frozen=True)
class RodStrings(StringNumbers[Floats], Result):
    """Predictions of many rod strings; NaN where no periodic motion was found."""

    loading_max: Annotated[
        Floats, Label("maximum Goodman loading", "", "", "NaN without a tensile strength.")
    ]


@public
def rod_strings(machine: Machine, values: Mapping[str, Floats]) -> RodStrings:
    """Predictions of many variants of a rod string at once, at constant pumping speed.

    Parameters
    ----------
    machine : Machine
        A machine with a rod string.
    values : mapping of str to ndarray, shape (rows,)
        Values [SI] of entries such as ``"rod_string.stroke"`` or ``"drive.speed"``, a row a variant.

    Returns
    -------
    RodStrings
        Loads, strokes, production and powers of every row.

    Raises
    ------
    InputError
        The machine has no rod string, a motor drives it, an entry cannot be varied, or its values are wrong.

    See Also
    --------
    rod_string : one prediction, to an accuracy that is chosen.
    """
    string = string_of(machine)
    rows = _checked(machine, values)
    rod = polished_rod_of(machine, string)
    if not isinstance(rod, HarmonicRod) and rod.has_motor:
        raise InputError(
            f"{machine.name}: found a motor; expected a constant pumping speed: give drive.speed in its place"
        )
    n = len(next(iter(rows.values())))
    parts = [
        _predicted(machine, {name: column[at : at + _AT_ONCE] for name, column in rows.items()}, rod)
        for at in range(0, n, _AT_ONCE)
    ]
    return RodStrings(**{name: np.concatenate([part[name] for part in parts]) for name in parts[0]})


def _checked(machine: Machine, values: Mapping[str, Floats]) -> dict[str, Floats]:
    """Columns of one length, of entries that may vary and values that the machine may have."""
    rows = {name: np.atleast_1d(np.asarray(column, dtype=float)) for name, column in values.items()}
    if (
        not rows
        or len({column.shape for column in rows.values()}) != 1
        or next(iter(rows.values())).ndim != 1
    ):
        shapes = ", ".join(f"{name} {column.shape}" for name, column in rows.items()) or "none"
        raise InputError(f"values: found {shapes}, expected columns of one length")
    for name, column in rows.items():
        if not name.startswith(_VARIED):
            raise InputError(f"values: found {name}, expected entries of [rod_string], or drive.speed")
        if not (len(column) and np.isfinite(column).all()):
            raise InputError(f"values: {name}: found none or values that are not finite, expected numbers")
    return rows


def _predicted(machine: Machine, rows: Mapping[str, Floats], rod: Any) -> dict[str, Floats]:
    along = replace(machine, rows)
    string: Any = along.rod_string
    n = len(next(iter(rows.values())))
    period = 2 * np.pi / crank_speed(along, string)
    finer = rod.motion(2 * _SAMPLES).position
    stroke = string.stroke if isinstance(rod, HarmonicRod) else rod.rod.stroke
    if isinstance(rod, HarmonicRod):
        finer = along_curve(stroke) * (finer / rod.stroke)
    motion = np.broadcast_to(finer, (n, 2 * _SAMPLES))
    numbers = np.stack([np.broadcast_to(number, n) for number in numbers_of(string, period)], axis=1)
    found = solve_rows(string, numbers, motion[:, ::2], tolerance=_TOLERANCE)
    stations = len(string.sections) + 1
    cards = Cards(found.position, found.load, found.work[:, :stations], found.work[:, stations:])
    scalars = string_scalars(string, stroke, period, cards, found.ends[:, 0], motion)
    loadings = [*goodman_loadings(string, cards.load).values()]
    scalars["loading_max"] = np.max(loadings, axis=0) if loadings else np.nan
    fails = ~(found.ends[:, 1] <= _TOLERANCE)
    return {name: np.where(fails, np.nan, np.broadcast_to(x, n)) for name, x in scalars.items()}
