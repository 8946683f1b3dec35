"""Variables as they are computed with: the value of each share between 0 and 1, in SI."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import InputError, MachineError, show
from linkwright.kernel.units.kinds import COUNT, Kind
from linkwright.kernel.units.reading import is_number
from linkwright.machine import size_limits
from linkwright.machine.address import addresses, get, kind, known_place, outside
from linkwright.machine.machine import Machine
from linkwright.machine.overrides import Override, apply
from linkwright.machine.size_limits import half_clearance, of_pin, toleranced
from linkwright.machine.tolerances import require_limits
from linkwright.studies.choices import choice_names
from linkwright.studies.distributions import loosened, normal_shares, scattered
from linkwright.studies.model import Distribution, Variable

# Standard deviations between the limits of a tolerance: a centred process with a capability index of 1, of
# which 0.27 % lie beyond and are sorted out (ISO 22514-2).
_SPREAD = 6.0

# Ends and distance of the places of the rule by which mean and deviation of a distribution are integrated: to
# 1e-9, and to 1e-6 where its density has a corner, as a triangle.
_ENDS, _APART = 3.2, 0.05


def between(low: float, high: float, steps: int | None = None) -> dict[str, Any]:
    """Entries of a variable between two ends, in so many steps of a grid; values where that is no range."""
    if low < high and steps != 1:
        return {"range": [low, high]} | ({} if steps is None else {"steps": steps})
    return {"values": np.linspace(low, high, steps or 1).tolist()}


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
    def is_open(self) -> bool:
        """Whether nothing says which values it takes, as a fit permits."""
        return self.distribution is None and self.low == -math.inf

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
            return loosened(
                *self.distribution, self.low + self.play, self.high - self.play, self.play, shares
            )
        if self.distribution is not None:
            return scattered(*self.distribution, self.low, self.high, shares)
        if self.is_whole:
            numbers: Floats = np.minimum(self.low + np.floor(shares * (self.high - self.low + 1)), self.high)
            return numbers
        if self.is_log:
            # Both ends are met exactly.
            powers = np.log(self.low) * (1 - shares) + np.log(self.high) * shares
            values: Floats = np.clip(np.exp(powers), self.low, self.high)
            return values
        return self.low * (1 - shares) + self.high * shares

    def share(self, value: float) -> float:
        """The share of a value of a range [SI]; outside of 0 to 1 or NaN if it is none of its values."""
        if self.is_whole:
            return (
                (value - self.low + 0.5) / (self.high - self.low + 1) if value == round(value) else math.nan
            )
        if self.is_log:
            return math.log(value / self.low) / math.log(self.high / self.low) if value > 0 else math.nan
        return (value - self.low) / (self.high - self.low)

    def rate(self, value: float) -> float:
        """Derivative of a value of a range by its share [SI]."""
        return value * math.log(self.high / self.low) if self.is_log else self.high - self.low

    def moments(self) -> tuple[float, float]:
        """Mean and standard deviation [SI] of its values, cut off as they are.

        The integral over all shares by the double exponential rule, which tails at their ends do not disturb:
        Takahasi, Mori, Double exponential formulas for numerical integration, Publ. RIMS 9 (1974) 721.
        """
        t = np.arange(-_ENDS, _ENDS + 0.5 * _APART, _APART)
        steep = 0.5 * np.pi * np.sinh(t)
        weights = np.cosh(t) / np.cosh(steep) ** 2
        weights /= weights.sum()
        values = self.values(0.5 * (1.0 + np.tanh(steep)))
        mean = float(weights @ values)
        return mean, math.sqrt(float(weights @ (values - mean) ** 2))


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
    kind = _common_kind(machine, name, variable)
    named = Axis(name, variable.address, kind.unit if kind else "", steps=variable.steps or 0)
    if variable.values is not None:
        return replace(named, choices=_choices(machine, name, variable, kind))
    if kind is None:
        expected = "values, for an entry without numbers"
        raise _problem(name, "address", f"{show(variable.address[0])}, which is no number", expected)
    if variable.tolerance is not None or variable.clearance is not None:
        return _made(machine, named, variable, kind)
    if variable.distribution is not None:
        scatter, low, high = _scatter(name, variable.distribution, kind)
        cut = replace(named, low=low, high=high, distribution=scatter)
        _require_possible_truncation(machine, cut, variable.distribution, kind)
        return cut
    if variable.range is None:
        return replace(named, low=-math.inf, high=math.inf)
    low, high = (_parsed(name, f"range.{i}", value, kind) for i, value in enumerate(variable.range))
    _check_range(name, variable, low, high)
    return replace(named, low=low, high=high, is_log=variable.scale == "log", is_whole=variable.whole)


def _made(machine: Machine, named: Axis, variable: Variable, kind: Kind) -> Axis:
    """A size as manufactured: within its tolerance, with the clearance of a joint, or both."""
    name, value = named.name, get(machine, variable.address[0])
    key, play = f"variables.{name}", 0.0
    if variable.clearance is not None:
        play = half_clearance(f"{key}.clearance", value, variable.clearance, kind)
    if variable.tolerance is None:
        made = replace(named, low=value - play, high=value + play, distribution=of_pin(value, play))
        require_limits(
            machine, made.addresses, f"{key}.clearance", variable.clearance, (made.low, made.high), kind
        )
        return made
    low, high = toleranced(f"{key}.tolerance", value, variable.tolerance, kind)
    scatter = ("normal", 0.5 * (low + high), (high - low) / _SPREAD)
    made = replace(named, low=low - play, high=high + play, distribution=scatter, play=play)
    require_limits(
        machine, made.addresses, f"{key}.tolerance", variable.tolerance, (made.low, made.high), kind
    )
    return made


def _require_possible_truncation(machine: Machine, cut: Axis, given: Distribution, kind: Kind) -> None:
    for key, near in (("min", cut.low + kind.least), ("max", cut.high - kind.least)):
        end = getattr(given, key)
        expected = "" if end is None else _impossible(machine, cut, [near])
        if expected:
            raise _problem(cut.name, f"distribution.{key}", show(end), expected)


def _impossible(machine: Machine, axis: Axis, values: list[float]) -> str:
    """Admissible values of an entry in place of impossible ones; empty if all are possible."""
    for address in axis.addresses:
        wrong, expected = outside(machine, address, np.array(values))
        if wrong.any():
            return expected
    return ""


def _common_kind(machine: Machine, name: str, variable: Variable) -> Kind | None:
    """The quantity of all entries of a variable; None for what is no number."""
    units = [_kind(machine, name, address) for address in variable.address]
    kind = units[0]
    if any(unit is not None and kind is not None and unit.unit != kind.unit for unit in units):
        words = " and ".join(unit.word for unit in units if unit is not None)
        raise _problem(name, "address", words, "entries of one quantity")
    return kind


def _kind(machine: Machine, name: str, address: str) -> Kind | None:
    try:
        known_place(machine, address)
    except MachineError as error:
        wrong = error.problems[0]
        # An entry that has its usual value, or that follows from others, has an address too.
        remedy = wrong.remedy or suggestion(address, addresses(machine))
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
    if isinstance(node, Mapping):
        return {key: _open(entry) for key, entry in node.items()}
    return [_open(entry) for entry in node] if isinstance(node, list | tuple) else node


def _choices(machine: Machine, name: str, variable: Variable, kind: Kind | None) -> tuple[Any, ...]:
    given = variable.values or ()
    if kind is None:
        for nth, value in enumerate(given):
            _require_possible(machine, name, variable, nth, value)
        return given
    return tuple(_parsed(name, f"values.{i}", value, kind) for i, value in enumerate(given))


def _require_possible(machine: Machine, name: str, variable: Variable, nth: int, value: object) -> None:
    """Refuse values that their own entry does not admit; conflicts with other entries are failed rows."""
    try:
        variant(machine, [(address, value) for address in variable.address])
    except MachineError as error:
        for wrong in error.problems:
            if any(f"{wrong.key}.".startswith(f"{address}.") for address in variable.address):
                key = f"values.{nth}"
                raise _problem(name, key, wrong.found, wrong.expected, wrong.remedy) from None


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


def _scatter(name: str, given: Distribution, kind: Kind) -> tuple[tuple[str, float, float], float, float]:
    read = {
        key: _parsed(name, f"distribution.{key}", value, kind)
        for key in ("mean", "deviation", "min", "max")
        if (value := getattr(given, key)) is not None
    }
    lowest = 0.0 if given.kind == "lognormal" else -math.inf
    low, high = read.get("min", lowest), read.get("max", math.inf)
    mean, deviation = read.get("mean", math.nan), read.get("deviation", math.nan)
    if not low < high:
        least = lowest if given.min is None else given.min
        raise _problem(name, "distribution.max", show(given.max), f"more than `min`, {show(least)}")
    if given.kind in ("normal", "lognormal") and not deviation > 0:
        raise _problem(name, "distribution.deviation", show(given.deviation), "more than 0")
    if given.kind == "lognormal" and not mean > 0:
        raise _problem(name, "distribution.mean", show(given.mean), "more than 0")
    if given.kind == "triangular" and not low <= mean <= high:
        ends = f"{show(given.min)} to {show(given.max)}"
        raise _problem(name, "distribution.mean", show(given.mean), ends)
    start, end = normal_shares(given.kind, mean, deviation, low, high)
    if given.kind in ("normal", "lognormal") and end - start < 1e-9:
        raise _problem(name, "distribution", "ends that leave nothing of it", "ends within 6 deviations")
    return (given.kind, mean, deviation), low, high


def _middles(n: int) -> Floats:
    """Middles of n equal parts from 0 to 1."""
    middles: Floats = (np.arange(n) + 0.5) / max(n, 1)
    return middles


def _problem(name: str, key: str, found: str, expected: str, remedy: str = "") -> MachineError:
    return size_limits.problem(f"variables.{name}.{key}", found, expected, remedy)


def _parsed(name: str, key: str, value: object, kind: Kind) -> float:
    return size_limits.parsed(f"variables.{name}.{key}", value, kind)
