"""Cases of the core's border: plans of sound machines with other integers in them.

The engine never makes such a plan, so nothing is promised of the numbers; but the core checks every index and
size when it decodes a plan, and whatever it lets through it computes without a panic.
"""

from __future__ import annotations

from contextlib import suppress
from functools import lru_cache
from typing import Any

import numpy as np
from broken import deadline
from numpy.random import Generator
from texts import _machine_of, machine_files

from linkwright import _core
from linkwright.kernel.errors import LinkwrightError
from linkwright.machine.program.compiled import compile_machine

# Integers that are wrong in most places: just outside, far outside, kinds of rows.
INTEGERS = (-2, -1, 0, 1, 2, 3, 4, 5, 8, 12, 21, 100, 4000, 2**31 - 1, -(2**31))

ANGLES = np.linspace(0.0, 2 * np.pi, 9)


@lru_cache(maxsize=1)
def plans() -> tuple[tuple[tuple[Any, ...], np.ndarray], ...]:
    """The arguments of the plan of every machine that has one, and its parameters."""
    found = []
    sound = _core.Plan

    def recorder(*arguments: Any) -> _core.Plan:
        nonlocal last
        last = arguments
        return sound(*arguments)

    _core.Plan = recorder  # type: ignore[misc, assignment]
    try:
        for text in machine_files().values():
            last: tuple[Any, ...] | None = None
            machine = _machine_of(text)
            with suppress(LinkwrightError):
                compiled = compile_machine(machine)
                if last is not None:
                    found.append((last, np.array(compiled.parameters)))
    finally:
        _core.Plan = sound  # type: ignore[misc]
    return tuple(found)


def plan(random: Generator) -> None:
    """A plan with other integers: refused, or computed, but no panic."""
    given, parameters = plans()[random.integers(len(plans()))]
    arguments = [np.array(each) for each in given]
    for _ in range(random.integers(1, 4)):
        _change(arguments, random)
    with deadline(60.0):
        try:
            made = _core.Plan(*arguments)
            n = int(arguments[0][0])
            # As many parameters as the plan now wants; those that were not there are ones.
            q = np.concatenate([parameters, np.ones(max(0, min(n, 10_000) - len(parameters)))])[:n]
            _core.reductions(made, q, ANGLES)
            _core.steady_state(made, q, 1e-6, ANGLES)
        except (ValueError, IndexError, LinkwrightError):
            return


def _change(arguments: list[np.ndarray], random: Generator) -> None:
    """Change one integer of one of the tables, or leave some off at the end."""
    # Tables of x and y and motion laws hold floats; sizes, elements, bodies, loads, drive, formulas integers.
    which = [k for k, each in enumerate(arguments) if each.size and each.dtype.kind == "i"]
    k = which[random.integers(len(which))]
    flat = arguments[k].copy().ravel()
    if random.random() < 0.1:
        flat = flat[: random.integers(len(flat))]
    else:
        flat[random.integers(len(flat))] = INTEGERS[random.integers(len(INTEGERS))]
    arguments[k] = flat
