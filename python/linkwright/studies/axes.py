"""Variables as they are computed with: the value of each share between 0 and 1, in SI."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import InputError, MachineError, Problem, UnitError, show
from linkwright.kernel.units import COUNT, LENGTH, NUMBER, Kind, is_number, parse, worded
from linkwright.machine.address import addresses, get, kind, known_place
from linkwright.machine.machine import Machine
from linkwright.machine.overrides import Override, apply
from linkwright.studies import iso286
from linkwright.studies.choices import choice_names
from linkwright.studies.model import Distribution, Variable

# Standard deviations between the limits of a tolerance: a centred process with a capability index of 1, of
# which 0.27 % lie beyond and are sorted out (ISO 22514-2).
_SPREAD = 6.0

# "± 0.2 mm"; "+0.1 -0.3 mm", in either order; before both there may be the size, "0.8 m ± 0.2 mm". A comma
# belongs to the number, so that it is that which is refused.
_SIZED = re.compile(
    r"\s*(-?[\d.,]+(?:[eE][+-]?\d+)?[^±+-]*?)\s*((?:±|\+/-|[+-]\s*[\d.,]+\s+[+-]\s*[\d.,]).*)", re.DOTALL
)
_EVEN = re.compile(r"\s*(?:±|\+/-)\s*([\d.,]+(?:[eE][+-]?\d+)?)\s*(.*)", re.DOTALL)
_UNEVEN = re.compile(r"\s*([+-]\s*[\d.,]+)\s+([+-]\s*[\d.,]+)\s*(.*)", re.DOTALL)
# A number and its unit.
_MEASURE = re.compile(rf"({NUMBER.pattern})\s*(.*)", re.DOTALL)


@dataclass(frozen=True)
class Axis:
    """A variable."""

    name: str
    addresses: tuple[str, ...]  # entries of the machine that take its value
    unit: str  # SI unit of its values; empty for a number without one
    # Ends of a range [SI]; of a list the first and last place, of a distribution its ends, which may be
    # infinite.
    low: float = 0.0
    high: float = 1.0
    steps: int = 0  # how many levels a grid takes
    choices: tuple[Any, ...] = ()  # the values of a list: numbers in SI, or whatever stands at the address
    # Whether a range is divided evenly in the logarithm, whether it holds whole numbers alone.
    is_log: bool = False
    is_whole: bool = False
    distribution: tuple[str, float, float] | None = None  # kind, mean and deviation of a scatter
    play: float = 0.0  # half the clearance of a joint that adds to the scatter [m]; within the ends

    @property
    def is_number(self) -> bool:
        """Whether all its values are numbers, which vary in a batch."""
        return not self.choices or all(isinstance(choice, int | float) for choice in self.choices)

    @property
    def is_continuous(self) -> bool:
        """Whether it takes all values of a range, so that there are derivatives by it."""
        return not self.choices and not self.is_whole

    @property
    def n_levels(self) -> int:
        """How many levels a grid takes."""
        if self.choices:
            return len(self.choices)
        return round(self.high - self.low) + 1 if self.is_whole else self.steps

    @property
    def levels(self) -> Floats:
        """Shares that a grid takes, each with a value of its own."""
        if self.choices or self.is_whole or self.distribution is not None:
            return _middles(self.n_levels)
        return np.linspace(0.0, 1.0, self.n_levels)

    def values(self, shares: Floats) -> Floats:
        """Values in SI; of what are no numbers, their places in the list."""
        if self.choices:
            places = np.minimum((shares * len(self.choices)).astype(int), len(self.choices) - 1)
            listed = self.choices if self.is_number else range(len(self.choices))
            picked: Floats = np.array(listed, dtype=float)[places]
            return picked
        if self.distribution is not None and self.play:
            return _loosened(
                *self.distribution, self.low + self.play, self.high - self.play, self.play, shares
            )
        if self.distribution is not None:
            return _scattered(*self.distribution, self.low, self.high, shares)
        if self.is_whole:
            numbers: Floats = np.minimum(self.low + np.floor(shares * (self.high - self.low + 1)), self.high)
            return numbers
        if self.is_log:
            # Both ends are met exactly.
            powers = np.log(self.low) * (1 - shares) + np.log(self.high) * shares
            values: Floats = np.clip(np.exp(powers), self.low, self.high)
            return values
        return self.low * (1 - shares) + self.high * shares


def require_places(axis: Axis, values: Floats, what: str) -> None:
    """Raise `InputError` for places that a list of what is no number does not have; `what`: for messages."""
    if axis.is_number:
        return
    last = len(axis.choices) - 1
    wrong = np.flatnonzero((values != np.round(values)) | (values < 0) | (values > last))
    for row in wrong[:1].tolist():
        expected = f"a place in its values, 0 to {last}: {', '.join(map(show, choice_names(axis.choices)))}"
        raise InputError(f"{what}, row {row}: found {values[row]:g}, expected {expected}")


def axis(machine: Machine, name: str, variable: Variable) -> Axis:
    """A variable of a study, checked against the machine.

    Raises `MachineError`, keys from those of the variable on, if an address does not exist, or a value is not
    possible there.
    """
    units = [_kind(machine, name, address) for address in variable.address]
    kind = units[0]
    if any(unit is not None and kind is not None and unit.unit != kind.unit for unit in units):
        words = " and ".join(unit.word for unit in units if unit is not None)
        raise _problem(name, "address", words, "entries of one quantity")
    known: dict[str, Any] = {"name": name, "addresses": variable.address, "unit": kind.unit if kind else ""}
    if variable.values is not None:
        return Axis(**known, choices=_choices(machine, name, variable, kind))
    if kind is None:
        place = show(variable.address[0])
        raise _problem(
            name, "address", f"{place}, which is no number", "values, for an entry without numbers"
        )
    if variable.tolerance is not None:
        low, high = _toleranced(name, get(machine, variable.address[0]), variable.tolerance, kind)
        scatter = ("normal", 0.5 * (low + high), (high - low) / _SPREAD)
        play = 0.0
        if variable.clearance is not None:
            ends = _loose(name, get(machine, variable.address[0]), variable.clearance, kind)
            play = 0.5 * (ends[1] - ends[0])
        ends = low - play, high + play
        return Axis(
            **known, low=ends[0], high=ends[1], steps=variable.steps or 0, distribution=scatter, play=play
        )
    if variable.clearance is not None:
        low, high = _loose(name, get(machine, variable.address[0]), variable.clearance, kind)
        return Axis(**known, low=low, high=high, steps=variable.steps or 0, distribution=_of_pin(low, high))
    if variable.distribution is not None:
        scatter, low, high = _scatter(name, variable.distribution, kind)
        return Axis(**known, low=low, high=high, steps=variable.steps or 0, distribution=scatter)
    if variable.range is None:
        return Axis(**known, low=-math.inf, high=math.inf)
    low, high = (_parsed(name, f"range.{i}", value, kind) for i, value in enumerate(variable.range))
    _check_range(name, variable, low, high)
    return Axis(
        **known,
        low=low,
        high=high,
        steps=variable.steps or 0,
        is_log=variable.scale == "log",
        is_whole=variable.whole,
    )


def _kind(machine: Machine, name: str, address: str) -> Kind | None:
    """The quantity at an address; None for what is no number."""
    try:
        known_place(machine, address)
    except MachineError as error:
        problem = error.problems[0]
        # An entry that has its usual value, or that follows from others, has an address too.
        remedy = problem.remedy or suggestion(address, addresses(machine))
        raise _problem(name, "address", show(address), "the address of an entry", remedy) from None
    mark = kind(machine, address)
    if mark is not None:
        return mark
    value = get(machine, address)
    return COUNT if is_number(value) else None


def variant(machine: Machine, changes: list[tuple[str, Any]]) -> Machine:
    """The machine with entries exchanged as by ``--set``, and checked as a whole."""
    tables: dict[str, Any] = machine.model_dump(by_alias=True, exclude_unset=True)
    tables = _open(tables)
    for address, entry in changes:
        apply(tables, Override(address, entry, ""))
    return Machine.model_validate(tables)


def _open(node: Any) -> Any:
    """Tables and lists that may be written to."""
    if isinstance(node, Mapping):
        return {key: _open(entry) for key, entry in node.items()}
    return [_open(entry) for entry in node] if isinstance(node, list | tuple) else node


def _choices(machine: Machine, name: str, variable: Variable, kind: Kind | None) -> tuple[Any, ...]:
    """The values of a list, numbers in SI."""
    given = variable.values or ()
    if kind is None:
        for nth, value in enumerate(given):
            _require_possible(machine, name, variable, nth, value)
        return given
    return tuple(_parsed(name, f"values.{i}", value, kind) for i, value in enumerate(given))


def _require_possible(machine: Machine, name: str, variable: Variable, nth: int, value: object) -> None:
    """Refuse what its own entry does not take; what other entries do not go with, is a row that fails."""
    try:
        variant(machine, [(address, value) for address in variable.address])
    except MachineError as error:
        for problem in error.problems:
            if any(f"{problem.key}.".startswith(f"{address}.") for address in variable.address):
                key = f"values.{nth}"
                raise _problem(name, key, problem.found, problem.expected, problem.remedy) from None


def _parsed(name: str, key: str, value: object, kind: Kind) -> float:
    """A value as the quantity of its entry."""
    try:
        return parse(value, kind)
    except UnitError as error:
        problem = error.problem
        raise _problem(name, key, problem.found, problem.expected, problem.remedy) from None


def _check_range(name: str, variable: Variable, low: float, high: float) -> None:
    ends = " to ".join(map(show, variable.range or ()))
    if not low < high:
        raise _problem(name, "range", ends, "a minimum below the maximum")
    if variable.scale == "log" and low <= 0:
        raise _problem(name, "range", ends, "numbers above 0 for a logarithmic scale")
    if variable.whole and not (low.is_integer() and high.is_integer()):
        raise _problem(name, "range", ends, "whole numbers")
    if variable.whole and variable.steps is not None:
        raise _problem(name, "steps", str(variable.steps), "nothing: a range of whole numbers has its own")


def _toleranced(name: str, value: object, text: str, kind: Kind) -> tuple[float, float]:
    """Limits of an entry by the text of its tolerance."""
    if not isinstance(value, int | float):
        raise _problem(name, "tolerance", "an entry without a value", "an entry that the machine has")
    stripped = text.replace("−", "-")
    if code := iso286.CODE.fullmatch(stripped):
        return _coded(name, float(value), text, code, kind)
    sized = _SIZED.fullmatch(stripped)
    size, limits = sized.groups() if sized else (None, stripped)
    if match := _EVEN.fullmatch(limits):
        parts, unit = [f"-{match[1]}", match[1]], match[2]
    elif match := _UNEVEN.fullmatch(limits):
        parts, unit = [match[1].replace(" ", ""), match[2].replace(" ", "")], match[3]
    else:
        expected = 'such as "± 0.2 mm", "800 ± 0.2 mm", "+0.1 -0.3 mm" or "25 H7"'
        raise _problem(name, "tolerance", show(text), expected)
    if size is not None:
        _require_size(name, float(value), text, size, unit, kind)
    low, high = sorted(value + _measure(name, text, part, unit, kind) for part in parts)
    if not low < high:
        raise _problem(name, "tolerance", show(text), "two limits that differ")
    return low, high


def _measure(name: str, given: str, text: str, unit: str, kind: Kind) -> float:
    """A number of a tolerance; without a unit of its own it has that at the end, as on a drawing."""
    is_bare = NUMBER.fullmatch(text)
    try:
        return parse(float(text) if is_bare and not unit else f"{text} {unit if is_bare else ''}", kind)
    except UnitError as error:
        problem = error.problem
        raise _problem(name, "tolerance", show(given), problem.expected, problem.remedy) from None


def _require_size(name: str, value: float, text: str, size: str, unit: str, kind: Kind) -> None:
    """Refuse a tolerance of another size than the machine has, and give that in the unit of the text."""
    given = _measure(name, text, size, unit, kind)
    if abs(given - value) > 1e-9 * abs(value):
        parts = _MEASURE.fullmatch(size)
        assert parts is not None
        # As many digits as are compared: a size so written is accepted.
        shown = f"{float(parts[1]) * value / given:.10g} {parts[2] or unit}" if given else worded(value, kind)
        expected = f"the size that the machine has, {shown.rstrip()}"
        raise _problem(name, "tolerance", show(text), expected, "leave the size out")


def _coded(name: str, value: float, text: str, code: re.Match[str], kind: Kind) -> tuple[float, float]:
    """Limits of a size by its class of ISO 286; the nominal size is that of the machine."""
    if kind.unit != LENGTH.unit:
        raise _problem(
            name, "tolerance", f"{show(text)} of {kind.word}", "limits with a unit: classes are of lengths"
        )
    size, letter, grade = code.groups()
    if size is not None and abs(float(size) * 1e-3 - value) > 1e-9 * abs(value):
        expected = f"the size that the machine has, {value * 1e3:.6g} mm"
        raise _problem(name, "tolerance", show(text), expected, f'"{letter}{grade}" takes that size')
    limits = iso286.deviations(value, letter, int(grade))
    if limits is None:
        where = f"of {value * 1e3:.6g} mm" if 0 < value <= 0.5 else f"of {value * 1e3:.6g} mm, beyond 500 mm"
        raise _problem(name, "tolerance", f"{show(text)} {where}", iso286.KNOWN, "give the limits themselves")
    return value + limits[0], value + limits[1]


def _loose(name: str, value: object, given: float | str, kind: Kind) -> tuple[float, float]:
    """Ends of a length between pins, one of which bears on its hole at half the clearance, whichever way."""
    if not isinstance(value, int | float) or kind.unit != LENGTH.unit:
        raise _problem(name, "clearance", f"one of {kind.word}", "one of a length that the machine has")
    fit = iso286.FIT.fullmatch(given) if isinstance(given, str) else None
    clearance = _parsed(name, "clearance", given, kind) if fit is None else _of_fit(name, fit)
    if not clearance > 0:
        raise _problem(name, "clearance", show(given), "more than 0")
    return value - 0.5 * clearance, value + 0.5 * clearance


def _of_fit(name: str, fit: re.Match[str]) -> float:
    """Clearance of a fit with pin and hole in the middle of their limits [m]."""
    size, hole, hole_grade, pin, pin_grade = fit.groups()
    limits = [
        iso286.deviations(float(size) * 1e-3, letter, int(grade))
        for letter, grade in ((hole, hole_grade), (pin, pin_grade))
    ]
    if limits[0] is None or limits[1] is None or not hole.isupper() or not pin.islower():
        raise _problem(name, "clearance", show(fit[0]), f"a hole and a pin, {iso286.KNOWN}")
    if limits[0][0] < limits[1][1]:
        text = f"{show(fit[0])}, a transition or interference fit"
        raise _problem(name, "clearance", text, "a clearance fit")
    return 0.5 * (sum(limits[0]) - sum(limits[1]))


def _of_pin(low: float, high: float) -> tuple[str, float, float]:
    """Shift along a length of a pin that bears in a direction of which none is preferred: a sine of it."""
    return "arcsine", 0.5 * (low + high), 0.5 * (high - low) / math.sqrt(2.0)


def _scatter(name: str, given: Distribution, kind: Kind) -> tuple[tuple[str, float, float], float, float]:
    """Kind, mean, deviation; and the ends of a distribution."""
    read = {
        key: _parsed(name, f"distribution.{key}", value, kind)
        for key in ("mean", "deviation", "least", "greatest")
        if (value := getattr(given, key)) is not None
    }
    lowest = 0.0 if given.kind == "lognormal" else -math.inf
    low, high = read.get("least", lowest), read.get("greatest", math.inf)
    mean, deviation = read.get("mean", math.nan), read.get("deviation", math.nan)
    if not low < high:
        least = lowest if given.least is None else given.least
        raise _problem(
            name, "distribution.greatest", show(given.greatest), f"more than `least`, {show(least)}"
        )
    if given.kind in ("normal", "lognormal") and not deviation > 0:
        raise _problem(name, "distribution.deviation", show(given.deviation), "more than 0")
    if given.kind == "lognormal" and not mean > 0:
        raise _problem(name, "distribution.mean", show(given.mean), "more than 0")
    if given.kind == "triangular" and not low <= mean <= high:
        ends = f"{show(given.least)} to {show(given.greatest)}"
        raise _problem(name, "distribution.mean", show(given.mean), ends)
    start, end = _normal_shares(given.kind, mean, deviation, low, high)
    if given.kind in ("normal", "lognormal") and end - start < 1e-9:
        raise _problem(name, "distribution", "ends that leave nothing of it", "ends within 6 deviations")
    return (given.kind, mean, deviation), low, high


def _middles(n: int) -> Floats:
    """Middles of n equal parts from 0 to 1."""
    middles: Floats = (np.arange(n) + 0.5) / max(n, 1)
    return middles


def _scattered(kind: str, mean: float, deviation: float, low: float, high: float, shares: Floats) -> Floats:
    """Values below which shares of a distribution that is cut off at its ends lie."""
    if kind == "uniform":
        return low * (1 - shares) + high * shares
    if kind == "arcsine":
        return mean - 0.5 * (high - low) * np.cos(np.pi * shares)
    if kind == "triangular":
        # Kotz, van Dorp, Beyond Beta, 2004, section 1.1.
        peak, span = (mean - low) / (high - low), high - low
        rising = low + span * np.sqrt(shares * peak)
        return np.where(shares < peak, rising, high - span * np.sqrt((1 - shares) * (1 - peak)))
    from scipy.special import ndtri

    start, end = _normal_shares(kind, mean, deviation, low, high)
    within = np.clip(start + (end - start) * shares, 2.0**-53, 1 - 2.0**-53)
    return np.clip(_unscored(kind, mean, deviation, ndtri(within)), low, high)


# Places of the sum of two scatters, and directions of a pin: the sum is smooth over a deviation of the first.
_PLACES, _DIRECTIONS = 16_385, 64


def _loosened(
    kind: str, mean: float, deviation: float, low: float, high: float, play: float, shares: Floats
) -> Floats:
    """Values below which shares of a scatter lie to which a pin adds its play times a cosine."""
    from scipy.special import ndtr

    start, end = _normal_shares(kind, mean, deviation, low, high)
    count = max(_DIRECTIONS, math.ceil(8 * play / deviation))
    # Chebyshev's nodes: all directions are alike.
    shifts = play * np.cos((np.arange(count) + 0.5) * np.pi / count)
    places = np.linspace(low - play, high + play, _PLACES)
    below = np.zeros(_PLACES)
    for shift in shifts.tolist():
        below += np.clip((ndtr((places - shift - mean) / deviation) - start) / (end - start), 0.0, 1.0)
    values: Floats = np.interp(shares, below / count, places)
    return values


def _normal_shares(kind: str, mean: float, deviation: float, low: float, high: float) -> tuple[float, float]:
    """Shares of the whole distribution below its ends."""
    if kind not in ("normal", "lognormal"):
        return 0.0, 1.0
    from scipy.special import ndtr

    middle, width = _bell(kind, mean, deviation)
    if kind == "normal":
        return float(ndtr((low - middle) / width)), float(ndtr((high - middle) / width))
    start = float(ndtr((math.log(low) - middle) / width)) if low > 0 else 0.0
    return start, float(ndtr((math.log(high) - middle) / width)) if high < math.inf else 1.0


def _bell(kind: str, mean: float, deviation: float) -> tuple[float, float]:
    """Mean and deviation of what is normal: the value, or its logarithm."""
    # Johnson, Kotz, Balakrishnan, *Continuous Univariate Distributions*, vol. 1, 2nd ed. 1994, chapter 14.
    if kind == "normal":
        return mean, deviation
    variance = math.log1p((deviation / mean) ** 2)
    return math.log(mean) - 0.5 * variance, math.sqrt(variance)


def _unscored(kind: str, mean: float, deviation: float, scores: Floats) -> Floats:
    middle, width = _bell(kind, mean, deviation)
    values = middle + width * scores
    return np.exp(values) if kind == "lognormal" else values


def _problem(name: str, key: str, found: str, expected: str, remedy: str = "") -> MachineError:
    return MachineError([Problem(f"variables.{name}.{key}", found, expected, remedy)])
