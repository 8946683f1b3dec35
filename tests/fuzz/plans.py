"""Cases of the core's border: plans of sound machines with other values in them.

The engine never makes such a plan, so nothing is promised of the numbers; but the core checks every index and
size when it builds a plan, and whatever it lets through it computes without a panic.
"""

from __future__ import annotations

import inspect
from contextlib import suppress
from functools import lru_cache
from typing import Any

import numpy as np
from broken import deadline
from numpy.random import Generator
from texts import _machine_of, machine_files

from linkwright import InternalError, LinkwrightError, _core
from linkwright.machine import compile_machine

# Integers that are wrong in most places: just outside, far outside, what no index can be.
INTEGERS = (-1, 0, 1, 2, 3, 4, 5, 8, 12, 21, 100, 4000, 2**31, 2**63, 2**64 - 1, 2**70)

NUMBERS = (0.0, 1.0, -1.0, 1e300, np.nan, np.inf)

WORDS = ("number", "zero", "name", "power", "+", "/", "sin", "where", "nothing")
OPERANDS = (None, 0, 3, -1, 2**40, "phi", "omega", "psi_dot", "w")

ANGLES = np.linspace(0.0, 2 * np.pi, 9)


@lru_cache(maxsize=1)
def plans() -> tuple[tuple[dict[str, Any], np.ndarray], ...]:
    """What the plan of every machine that has one was made of, and its parameters."""
    found = []
    sound = _core.Plan

    def recorder(**given: Any) -> _core.Plan:
        nonlocal last
        last = {name: list(each) if isinstance(each, list) else each for name, each in given.items()}
        return sound(**given)

    _core.Plan = recorder  # type: ignore[misc, assignment]
    try:
        for text in machine_files().values():
            last: dict[str, Any] | None = None
            with suppress(LinkwrightError):
                # One that refers to further files is not read alone.
                machine = _machine_of(text)
                compiled = compile_machine(machine)
                if last is not None:
                    found.append((last, np.array(compiled.parameters)))
    finally:
        _core.Plan = sound  # type: ignore[misc]
    return tuple(found)


def plan(random: Generator) -> None:
    """A plan with other values: refused, or computed, but no panic."""
    given, parameters = plans()[random.integers(len(plans()))]
    with deadline(60.0):
        try:
            for _ in range(random.integers(1, 4)):
                name = list(given)[random.integers(len(given))]
                given = given | {name: _changed(given[name], random)}
            made = _core.Plan(**given)
            n = given["parameters"]
            # As many parameters as the plan now wants; those that were not there are ones.
            q = np.concatenate([parameters, np.ones(max(0, min(n, 10_000) - len(parameters)))])[:n]
            _core.reductions(made, q, ANGLES)
            _core.steady_state(made, q, 1e-6, ANGLES)
            _core.reductions(made.without_conservative(), q, ANGLES)
        except InternalError:
            raise
        except (ValueError, IndexError, OverflowError, TypeError, LinkwrightError):
            return


def _changed(value: Any, random: Generator) -> Any:
    """Something else in place of a value, or in one of the places within it."""
    match value:
        case bool():
            return not value
        case int() | None:
            return INTEGERS[random.integers(len(INTEGERS))]
        case float():
            return NUMBERS[random.integers(len(NUMBERS))]
        case list() | tuple():
            return _changed_list(list(value), random)
        case _core.Table():
            return _core.Table(*(_some(NUMBERS, random) for _ in range(2)))
        case _core.Formula():
            words, operands = _some(WORDS, random), _some(OPERANDS, random)
            return _core.Formula(list(zip(words, operands, strict=False)))
        case _core.MotionLaw():
            numbers = _some(NUMBERS, random)
            cosine, sine = (NUMBERS[k] for k in random.integers(len(NUMBERS), size=2))
            wave = _core.Harmonic(frequency=1.0, cosine=cosine, sine=sine)
            piece = _core.Piece(start=0.0, length=2 * np.pi, polynomial=numbers, harmonics=[wave])
            return _core.MotionLaw([piece])
    return _changed_part(value, random)


def _changed_list(values: list[Any], random: Generator) -> list[Any]:
    if not values:
        return values
    k, j = random.integers(len(values), size=2)
    match int(random.integers(8)):
        case 0:
            return values[:k] + values[k + 1 :]
        case 1:
            return [*values[:k], values[j], *values[k:]]
        case 2:
            values[k], values[j] = values[j], values[k]
        case _:
            values[k] = _changed(values[k], random)
    return values


def _changed_part(part: Any, random: Generator) -> Any:
    """A part of the plan made anew by name, one of its fields changed."""
    names = [name for name, each in vars(type(part)).items() if inspect.isgetsetdescriptor(each)]
    if isinstance(part, _core.ChangePoint):
        names = ["first", "has_arms"]
    fields = {name: getattr(part, name) for name in names}
    name = list(fields)[random.integers(len(fields))]
    return type(part)(**fields | {name: _changed(fields[name], random)})


def _some(choice: tuple[Any, ...], random: Generator) -> list[Any]:
    """A short list of values."""
    return [choice[k] for k in random.integers(len(choice), size=random.integers(5))]
