"""A measured surface card, and what shows that it is none of this well."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import permutations
from pathlib import Path

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError
from linkwright.kernel.files.points import columns_of, read_columns
from linkwright.kernel.public import public, public_type
from linkwright.kernel.units.kinds import FORCE, LENGTH, TIME
from linkwright.rods.model.rod_string import GRAVITY, RodString

# Samples of a stroke at least.
_LEAST = 24

# A card closes if the step from its end to its start, over the ranges of position and load, is below this
# share, or some times the largest of its other steps.
_GAP, _STEPS = 0.05, 3.0

# Steps of the position, its mean one or those beside, that the step from end to start may have: samples that
# are missing.
_MISSING = 5.0

# What a stroke may differ from that of the file, beyond which it is in another unit or of another hole.
_STROKE_AGREES = 0.1

# Stroke that any unit may have [m].
_STROKES = 0.1, 15.0

# Shares of the stroke below and above which the polished rod is near its ends.
_BELOW_UP, _ABOVE_UP = 0.25, 0.75

# Mean dynamic load that a card may have: above the load of a fluid column from the pump, or below none.
_ABOVE, _BELOW = 1.25, 0.15

# Factors between units of force, and between units of length, with the unit that the numbers are in.
_FORCES = {
    "lbf": 4.4482216152605,
    "kN": 1e3,
    "klbf": 4448.2216152605,
    "kgf": GRAVITY,
}
_LENGTHS = {"in": 0.0254, "ft": 0.3048, "cm": 0.01, "mm": 1e-3}

# A length that is read as a force, and so the other way round: m and N, in and lbf [m/N].
_EXCHANGED = 1.0, _LENGTHS["in"] / _FORCES["lbf"]


@public_type
@dataclass(frozen=True)
class SurfaceCard:
    """One stroke at equal steps of time, the last sample a step before the first one comes again.

    Attributes
    ----------
    position : ndarray, shape (n,)
        Of the polished rod, upward [m].
    load : ndarray, shape (n,)
        Of the polished rod [N].
    period : float or None
        Of the stroke [s], where the record says it.
    """

    position: Floats
    load: Floats
    period: float | None = None


@public
def read_card(path: str | os.PathLike[str]) -> SurfaceCard:
    """Read a measured surface card from a CSV file.

    Parameters
    ----------
    path : path
        File with the columns ``position [m]`` and ``load [N]``, in other units if the header says so, and
        ``time [s]`` if there is one; a row a sample of one stroke.

    Returns
    -------
    SurfaceCard
        In SI, with the period if times are given.

    Raises
    ------
    MachineFileError
        The file cannot be read, or lacks a column.
    InputError
        Times are not equally spaced.
    """
    has_time = "time" in columns_of(Path(path), "", "card", ())[0]
    kinds = {"position": LENGTH, "load": FORCE, **({"time": TIME} if has_time else {})}
    columns = read_columns(path, kinds)
    return timed_card(columns["position"], columns["load"], columns.get("time"), f"{path}: column time")


def timed_card(position: Floats, load: Floats, time: Floats | None, place: str) -> SurfaceCard:
    """A card with its period by the times of its samples, where there are any; `place`: for messages."""
    if time is None:
        return SurfaceCard(position, load)
    steps = np.diff(time)
    if not len(steps) or steps.min() <= 0 or np.ptp(steps) > 0.2 * steps.mean():
        raise InputError(
            f"{place}: found times that are not equally spaced; expected samples of one "
            "stroke at equal steps of time"
        )
    closes = position[0] == position[-1] and load[0] == load[-1]
    period = float(steps.mean() * (len(steps) + (0 if closes else 1)))
    return SurfaceCard(position, load, period)


def checked_card(card: SurfaceCard, string: RodString, stroke: float | None) -> SurfaceCard:
    """The card without a repeated last sample; an `InputError` says why it cannot be one of the string's.

    ``stroke``: that of the machine file [m], where it is known.
    """
    position, load = np.asarray(card.position, dtype=float), np.asarray(card.load, dtype=float)
    if position.shape != load.shape or position.ndim != 1:
        raise InputError(
            f"card: found {position.shape} positions and {load.shape} loads, expected as many of both"
        )
    if not (np.isfinite(position).all() and np.isfinite(load).all()):
        raise InputError("card: found values that are not finite, expected numbers")
    if len(load) and position[0] == position[-1] and load[0] == load[-1]:
        position, load = position[:-1], load[:-1]
    if len(load) < _LEAST:
        raise InputError(f"card: found {len(load)} samples, expected {_LEAST} or more of one stroke")
    if np.ptp(position) == 0 or np.ptp(load) == 0:
        what = "position" if np.ptp(position) == 0 else "load"
        raise InputError(f"card: found a {what} that does not change, expected that of a stroke")
    _require_stroke(float(np.ptp(position)), stroke, float(np.ptp(load)))
    _require_load(float(load.mean()), string)
    _require_one_stroke(position)
    _require_closed(position, load)
    _require_forward(position, load)
    return SurfaceCard(position, load, card.period)


def _require_closed(position: Floats, load: Floats) -> None:
    steps = np.hypot(
        np.diff(position, append=position[0]) / np.ptp(position), np.diff(load, append=load[0]) / np.ptp(load)
    )
    moved = np.abs(np.diff(position, append=position[0]))
    beside = max(moved[0], moved[-2], float(moved.mean()))
    if steps[-1] > max(_GAP, _STEPS * np.sort(steps[:-1])[-2]) or moved[-1] > _MISSING * beside:
        raise InputError(
            f"card: it does not close: from its last sample to its first it is {100 * steps[-1]:.0f} % "
            "of its ranges; expected samples of one whole stroke"
        )


def _require_forward(position: Floats, load: Floats) -> None:
    """The polished rod does work on the string: its card is traced clockwise."""
    work = float(load @ (np.roll(position, -1) - np.roll(position, 1))) / 2
    if work <= 0:
        raise InputError(
            f"card: found a stroke in which the rods drive the unit, its work is {work:.4g} J; expected "
            "loads that are higher on the upstroke: reverse the order of the samples, or the sign of the "
            "position, which counts upward"
        )


def _require_one_stroke(position: Floats) -> None:
    """The polished rod goes from its lower to its upper end once."""
    share = (position - position.min()) / np.ptp(position)
    ends = np.where(share > _ABOVE_UP, 1, np.where(share < _BELOW_UP, -1, 0))
    ends = ends[ends != 0]
    strokes = int(np.count_nonzero((ends == 1) & (np.roll(ends, 1) == -1)))
    if strokes != 1:
        raise InputError(f"card: found {strokes} strokes, expected the samples of one")


def _require_stroke(stroke: float, known: float | None, range_of_load: float) -> None:
    low, high = _STROKES if known is None else (known * (1 - _STROKE_AGREES), known * (1 + _STROKE_AGREES))
    if low <= stroke <= high:
        return
    if any(low <= range_of_load * factor <= high for factor in _EXCHANGED):
        remedy = "; position and load are probably exchanged"
    elif known is None:
        remedy = "; the positions are in another unit than their header says"
    else:
        remedy = _unit_remedy(_LENGTHS, lambda factor: low <= stroke * factor <= high) or (
            "; compare the stroke of the machine file"
        )
    expected = f"{low:g} to {high:g} m" if known is None else f"that of the machine file, {known:.4g} m"
    raise InputError(f"card: found a stroke of {stroke:.4g} m, expected {expected}{remedy}")


def _require_load(mean: float, string: RodString) -> None:
    """The mean load of a stroke is the weight of the rods in the fluid and the mean load of the pump."""
    weight = float(string.weight_fluid)
    low = weight * (1 - _BELOW)
    high = weight + _ABOVE * float(string.discharge * string.pump.area) + 2 * string.stuffing_box
    if low <= mean <= high:
        return
    remedy = _unit_remedy(_FORCES, lambda factor: low <= mean * factor <= high)
    if low <= -mean <= high:
        remedy = "; the loads count downward: reverse their sign"
    raise InputError(
        f"card: found a mean load of {mean:.0f} N, expected {low:.0f} to {high:.0f} N by the weight of the "
        f"rods in the fluid, {weight:.0f} N, and the column of fluid on the plunger"
        + (remedy or "; compare the sections")
    )


def _unit_remedy(factors: Mapping[str, float], fits: Callable[[float], bool]) -> str:
    for unit, factor in factors.items():
        if fits(factor):
            return f"; the numbers are probably in {unit}"
        if fits(1 / factor):
            return f"; the numbers were probably multiplied by {factor:.4g} once too often"
    for (said, taken), (unit, factor) in permutations(factors.items(), 2):
        if fits(factor / taken):
            return f"; the numbers are probably in {unit}, not in {said}"
    return ""
