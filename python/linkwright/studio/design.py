r"""Design in place: what entries do to a result, and which entries bring a result to a value.

For a result y of the chosen entries x with the ranges s, the smallest step of Gauss–Newton,

.. math:: \Delta x = s^2 g\,\frac{y^* - y}{g^T s^2 g}, \qquad g = \frac{\partial y}{\partial x}

with the derivatives of a study (`linkwright.studies.slopes`), which are exact where there are such. An entry
at its limit is held there (Nocedal and Wright, *Numerical Optimization*, chapters 10 and 16); a step that
breaks a limit of another result is made shorter.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.drive.steady_state import SteadyState
from linkwright.drive.study import has_motor
from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.place import split
from linkwright.kernel.errors import InputError, LinkwrightError
from linkwright.kernel.quantities import declared, shown
from linkwright.kinetostatics.result import Forces
from linkwright.linkages.cycle import ElementMotion, linkage
from linkwright.machine.address import get
from linkwright.machine.machine import Machine
from linkwright.sensitivity.gradient import gradient
from linkwright.studies.engine import evaluate
from linkwright.studies.model import StudyFile
from linkwright.studies.plan import StudyPlan, plan
from linkwright.studies.responses import curves_of
from linkwright.studies.slopes import slopes as slopes_of
from linkwright.studio.document import short
from linkwright.studio.drag import Drag

Limits = Mapping[str, tuple[float, float]]
# Response → what it keeps to: at least, at most [SI]; None for no such limit.
Bounds = Mapping[str, tuple[float | None, float | None]]

# Steps to the value; each doubles the digits once it is near.
_STEPS = 12

# Relative distance at which the value is reached: the file has seven digits.
_NEAR = 1e-6

# Largest part of its range that an entry moves in a step, and how often a step that leads nowhere is halved.
_FAR, _HALVINGS = 0.25, 8

# Steps of differences, as a share of the range, where a result has no exact derivative.
_STEP = 1e-4


@dataclass(frozen=True)
class Goal:
    """A result that can be pulled, swept and sought."""

    key: str
    word: str
    unit: str
    value: float | None = None  # where it is known at once [SI]


def goals(machine: Machine) -> Iterator[Goal]:
    """Results of the motion of a mechanism: strokes, swings, transmission angles, speeds of what it moves."""
    try:
        known = linkage(machine) if machine.has_crank else None
    except LinkwrightError:
        # silent: a linkage that closes nowhere is reported by the motion
        return
    if known is None:
        return
    words = {name: shown(ElementMotion, name) for name in _KINEMATIC}
    for name, element in zip(known.names, known.elements, strict=True):
        for quantity, mark in words.items():
            value = getattr(element, quantity)
            if value is not None:
                yield Goal(f"linkage.{name}.{quantity}", f"{mark.word} of {name}", mark.unit, float(value))
    curves = curves_of(machine)
    for output in dict.fromkeys(element.output for element in known.elements):
        for curve in (f"{output}.place.velocity", f"{output}.angle.velocity"):
            if curve in curves:
                word, unit = curves[curve]
                for extreme in ("minimum", "maximum"):
                    yield Goal(f"cycle_motion.{curve}.{extreme}", f"{extreme} {word}", unit)


# Quantities of what a mechanism moves that one designs for.
_KINEMATIC = (
    *("stroke", "swing", "time_ratio"),
    *("transmission_angle_min", "transmission_angle_max", "transmission_angle_worst"),
)


def study_of(
    machine: Machine, response: str, entries: Mapping[str, Mapping[str, Any]], bounds: Bounds, **more: Any
) -> StudyPlan:
    """The page's study: response ``y`` over entries (``range``, ``steps``), with bounds ``b0``, ``b1``, …."""
    if not entries:
        raise InputError("no entry varies; choose one")
    variables = {f"v{n}": {"address": address, **entry} for n, (address, entry) in enumerate(entries.items())}
    bounded = {f"b{n}": name for n, name in enumerate(bounds)}
    limits = {
        f"b{n}": {key: value for key, value in zip(("min", "max"), ends, strict=True) if value is not None}
        for n, ends in enumerate(bounds.values())
    }
    constraints = {name: ends for name, ends in limits.items() if ends}
    tables = {"variables": variables, "responses": {"y": response, **bounded}, "constraints": constraints}
    return plan(machine, StudyFile.model_validate({**tables, **more}))


def kept(study: StudyPlan, columns: Mapping[str, Floats]) -> np.ndarray:
    """Which rows keep all limits."""
    n = len(next(iter(columns.values())))
    keeps = np.ones(n, dtype=bool)
    for name, (low, high) in study.limits.items():
        keeps &= (columns[name] >= low) & (columns[name] <= high)
    return keeps


def slopes(machine: Machine, response: str) -> dict[str, Any]:
    """Derivatives of a result, such as ``"steady_state.unevenness"``, by every entry that has one.

    ``response``, ``word``, ``symbol``, ``unit``, ``value``; ``slopes``, address → derivative [SI]; ``tie``,
    why it has only one-sided derivatives.
    """
    try:
        exact = gradient(machine, [response])
    except InputError:
        # silent: what has no exact derivatives is differenced, where the study says what is wrong
        return _differenced(machine, response)
    rows = exact.of(response)
    return {
        **_named(response, exact.words[0], exact.units[0]),
        "value": float(exact.values[0]),
        "slopes": {address: slope for address, slope in rows.items() if math.isfinite(slope)},
        "tie": exact.ties.get(response, ""),
    }


def _differenced(machine: Machine, response: str) -> dict[str, Any]:
    """The same by differences over entries of the mechanism, for a result without exact derivatives."""
    names = gradient(machine).variables if has_motor(machine) else gradient(machine, ["linkage"]).variables
    own = [name for name in names if name.startswith("mechanism.") and get(machine, name)]
    at = np.array([float(get(machine, name)) for name in own])
    ranges = {name: {"range": tuple(sorted((0.5 * x, 2 * x)))} for name, x in zip(own, at, strict=True)}
    study = study_of(machine, response, ranges, {})
    there = slopes_of(study, at, _STEP * np.abs(at))
    asked = study.asked[0]
    rows = dict(zip(own, there.slopes["y"].tolist(), strict=True))
    return {
        **_named(response, asked.word, asked.unit),
        "value": there.values["y"],
        "slopes": {address: slope for address, slope in rows.items() if math.isfinite(slope)},
        "tie": "",
    }


def _named(response: str, word: str, unit: str) -> dict[str, str]:
    analysis, _, quantity = response.partition(".")
    symbol = ""
    for name, owner in (("steady_state", SteadyState), ("forces", Forces)):
        if analysis == name and quantity in declared(owner):
            word, symbol, unit = (getattr(shown(owner, quantity), key) for key in ("word", "symbol", "unit"))
    return {"response": response, "word": word, "symbol": symbol, "unit": unit}


def reach(machine: Machine, response: str, wanted: float, free: Limits, bounds: Bounds | None = None) -> Drag:
    """Entries that bring a result to a value [SI], or as near as limits allow, and why they stop.

    `machine`: as it was when the result was taken hold of; `free`: entries that may follow, with their limits
    [SI]; `bounds`: what other results keep to.
    """
    if not free:
        return Drag({}, "no entry is ticked: choose one")
    return _Reach(machine, response, wanted, free, bounds or {}).run()


class _Reach:
    def __init__(self, machine: Machine, response: str, wanted: float, free: Limits, bounds: Bounds) -> None:
        self.wanted, self.names = wanted, list(free)
        self.at = np.array([float(get(machine, name)) for name in self.names])
        limits = np.array([free[name] for name in self.names], dtype=float)
        self.low, self.high = np.minimum(limits[:, 0], self.at), np.maximum(limits[:, 1], self.at)
        self.range = self.high - self.low
        # An entry without a range is held: the study gets one of its own.
        wide = np.where(self.range > 0, self.range, np.abs(self.at) + 1)
        ranges = {
            name: {"range": (float(low), float(low + width))}
            for name, low, width in zip(self.names, self.low, wide, strict=True)
        }
        self.study = study_of(machine, response, ranges, bounds)
        self.steps = _STEP * wide

    def run(self) -> Drag:
        reason, value = "", math.nan
        for _ in range(_STEPS):
            rates = slopes_of(self.study, self.at, self.steps)
            value, slope = rates.values["y"], rates.slopes["y"]
            miss = self.wanted - value
            if abs(miss) <= _NEAR * max(abs(self.wanted), abs(value)):
                return Drag(self._entries(), value=value)
            step = self._step(slope, miss)
            if not step.any():
                return Drag(self._entries(), self._held(slope), value=value)
            reason = self._walk(step, abs(miss))
            if reason:
                return Drag(self._entries(), rates.ties.get("y", "") or reason, value=value)
        return Drag(self._entries(), reason, value=value)

    def _step(self, slope: Floats, miss: float) -> Floats:
        """The smallest step to the value, without entries that would violate their limits."""
        slope = np.where(np.isfinite(slope), slope, 0.0)
        rise = slope * miss
        is_held = ((self.at >= self.high) & (rise > 0)) | ((self.at <= self.low) & (rise < 0))
        pull = np.where(is_held, 0.0, slope * self.range)
        size = float(pull @ pull)
        if size == 0:
            return np.zeros_like(pull)
        step = pull * miss / size
        most = float(np.abs(step).max())
        bounded: Floats = step * min(1.0, _FAR / most) * self.range
        return bounded

    def _walk(self, step: Floats, miss: float) -> str:
        """Take the largest part of the step that leads nearer within all limits; why there is none."""
        shares = 0.5 ** np.arange(_HALVINGS)
        tried = np.clip(self.at + shares[:, None] * step, self.low, self.high)
        rows = evaluate(self.study, {f"v{n}": tried[:, n] for n in range(len(self.names))})
        nearer = np.abs(self.wanted - rows.columns["y"]) < miss
        keeps = kept(self.study, rows.columns)
        if (nearer & keeps).any():
            self.at = tried[np.flatnonzero(nearer & keeps)[0]]
            return ""
        if nearer.any():
            row = np.flatnonzero(nearer)[-1]
            words = {asked.name: asked.word for asked in self.study.asked}
            broken = [
                words[name]
                for name, (low, high) in self.study.limits.items()
                if not low <= rows.columns[name][row] <= high
            ]
            return f"at the limit of {', '.join(broken)}"
        reasons = rows.failures()
        return next(iter(reasons)) if reasons else f"limit reached: {self._name()} has an extreme here"

    def _held(self, slope: Floats) -> str:
        moved = [
            name
            for name, rate, width in zip(self.names, slope, self.range, strict=True)
            if rate != 0 and width > 0
        ]
        if not moved:
            return f"{self._name()} does not depend on the ticked entries"
        return f"at the limits of {', '.join('.'.join(split(name)[-2:]) for name in moved)}"

    def _name(self) -> str:
        return self.study.asked[0].word

    def _entries(self) -> dict[str, float]:
        return {name: float(short(value)) for name, value in zip(self.names, self.at, strict=True)}
