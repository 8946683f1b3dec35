r"""Design in place: what entries do to a result, and which entries bring a result to a value.

For a result y of the chosen entries x with the ranges s, the smallest step of Gauss–Newton,

.. math:: \Delta x = s^2 g\,\frac{y^* - y}{g^T s^2 g}, \qquad g = \frac{\partial y}{\partial x}

with the exact derivatives of `linkwright.sensitivity`. An entry at its limit is held there
(Nocedal and Wright, *Numerical Optimization*, chapters 10 and 16).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from linkwright.drive.steady_state import SteadyState
from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.place import split
from linkwright.kernel.errors import InputError, LinkwrightError
from linkwright.kernel.quantities import shown
from linkwright.machine.address import get
from linkwright.machine.machine import Machine
from linkwright.sensitivity.gradient import Gradient, gradient
from linkwright.studies.engine import sound_variant
from linkwright.studio.document import short
from linkwright.studio.drag import Drag

Limits = Mapping[str, tuple[float, float]]

# Steps to the value; each doubles the digits once it is near.
_STEPS = 12

# Relative distance at which the value is reached: the file has seven digits.
_NEAR = 1e-6

# Largest part of its range that an entry moves in a step, and how often a step that leads nowhere is halved.
_FAR, _HALVINGS = 0.25, 8


def slopes(machine: Machine, response: str) -> dict[str, Any]:
    """Derivatives of a result, such as ``"steady_state.unevenness"``, by every entry.

    ``response``, ``word``, ``symbol``, ``unit``, ``value``; ``slopes``, address → derivative [SI]; ``tie``,
    why it has a derivative on either side only; ``responses``, all that have derivatives.
    """
    derivatives = gradient(machine)
    if response not in derivatives.responses:
        raise InputError(f"{response} has no derivative; choose a result of the steady motion")
    words = shown(SteadyState, response.partition(".")[2])
    rows = derivatives.of(response)
    return {
        "response": response,
        "word": words.word,
        "symbol": words.symbol,
        "unit": words.unit,
        "value": float(derivatives.values[derivatives.responses.index(response)]),
        "slopes": {address: slope for address, slope in rows.items() if math.isfinite(slope)},
        "tie": derivatives.ties.get(response, ""),
        "responses": list(derivatives.responses),
    }


def reach(machine: Machine, response: str, wanted: float, free: Limits) -> Drag:
    """Entries that bring a result to a value [SI], or as near as their limits allow, and why they stop.

    `machine`: as it was when the result was taken hold of; `free`: entries that may follow, with their limits
    [SI].
    """
    if not free:
        return Drag({}, "no entry follows: choose one")
    return _Reach(machine, response, wanted, free).run()


class _Reach:
    """One result on its way."""

    def __init__(self, machine: Machine, response: str, wanted: float, free: Limits) -> None:
        self.machine, self.response, self.wanted = machine, response, wanted
        self.names = list(free)
        self.at = np.array([float(get(machine, name)) for name in self.names])
        limits = np.array([free[name] for name in self.names], dtype=float)
        self.low, self.high = np.minimum(limits[:, 0], self.at), np.maximum(limits[:, 1], self.at)
        self.range = np.where(self.high > self.low, self.high - self.low, 0.0)

    def run(self) -> Drag:
        """Step until the value is there, or nothing leads nearer."""
        reason = ""
        for _ in range(_STEPS):
            rates = self._gradient()
            miss = self.wanted - float(rates.values[0])
            if abs(miss) <= _NEAR * max(abs(self.wanted), abs(float(rates.values[0]))):
                return Drag(self._entries())
            step = self._step(rates.derivatives[0], miss)
            if not step.any():
                return Drag(self._entries(), self._held(rates.derivatives[0]))
            reason = self._walk(step, abs(miss))
            if reason:
                return Drag(self._entries(), rates.ties.get(self.response, "") or reason)
        return Drag(self._entries(), reason)

    def _gradient(self) -> Gradient:
        return gradient(self._moved(self.at), [self.response], self.names)

    def _moved(self, at: Floats) -> Machine:
        return sound_variant(self.machine, dict(zip(self.names, map(float, at), strict=True)))

    def _step(self, slope: Floats, miss: float) -> Floats:
        """The smallest step to the value, without entries that it would press against their limits."""
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
        """Go a part of the step that leads nearer; why there is none."""
        reason = f"no further: {self._name()} has an extreme here"
        for halving in range(_HALVINGS):
            at = np.clip(self.at + 0.5**halving * step, self.low, self.high)
            try:
                value = float(gradient(self._moved(at), [self.response], self.names[:1]).values[0])
            except LinkwrightError as error:
                reason = str(error)
                continue
            if abs(self.wanted - value) < miss:
                self.at = at
                return ""
        return reason

    def _held(self, slope: Floats) -> str:
        """What holds the result."""
        moved = [
            name
            for name, rate, width in zip(self.names, slope, self.range, strict=True)
            if rate != 0 and width > 0
        ]
        if not moved:
            return f"{self._name()} does not depend on the entries that may follow"
        names = ", ".join(".".join(split(name)[-2:]) for name in moved)
        return f"at the limits of {names}"

    def _name(self) -> str:
        return shown(SteadyState, self.response.partition(".")[2]).word

    def _entries(self) -> dict[str, float]:
        return {name: float(short(value)) for name, value in zip(self.names, self.at, strict=True)}
