"""Derivatives of random machines by laws of cams and by points of tables, along random directions over all
their entries at once: sections, laws and places move kinks and jumps of the motion.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import test_gradient_in_time as in_time
import test_random_machines as drives
from numpy.random import Generator
from random_drives import random_camshaft, random_drive, torque_size, with_tables
from sizes import DEEP, random_cases
from test_all_kinds import Case, _as_listed, _steady_of, compared
from test_random_cams import _ways

import linkwright as lw
from linkwright import LinkwrightError


def _shaft(random: Generator) -> Case:
    return replace(_steady_of(random_camshaft(random)), ways=_ways)


def _tabled_drive(random: Generator) -> dict[str, object]:
    drive = random_drive(random)
    state = lw.steady_state(lw.Machine.model_validate(drive))
    return with_tables(random, drive, (state.speed_min, state.speed_max), torque_size(state))


def _tables(random: Generator) -> Case:
    return replace(_steady_of(_tabled_drive(random)), ways=_ways)


def _running(of: Callable[[Generator], dict[str, object]], kind: str) -> Callable[[Generator], Case]:
    def case(random: Generator) -> Case:
        names, measure = in_time.KINDS[kind]
        described = of(random) | {"run_up": {"angle_start": float(random.uniform(0.1, 6.0))}}
        machine = lw.Machine.model_validate(described)
        return Case(machine, names, _as_listed(measure, names), _ways, steepest=1e3)

    return case


def _forces(of: Callable[[Generator], dict[str, object]]) -> Callable[[Generator], Case]:
    def case(random: Generator) -> Case:
        machine, names, measure = drives.largest_forces(lw.Machine.model_validate(of(random)))
        reached, noise = (lw.steady_state(machine, accuracy=of).accuracy for of in (1e-9, 1e-13))
        return Case(machine, names, _as_listed(measure, names), _ways, reached=reached, noise=noise)

    return case


KINDS = {
    "shaft": _shaft,
    "tables": _tables,
    "shaft's forces": _forces(random_camshaft),
    "tables' forces": _forces(_tabled_drive),
    "shaft's run-up": _running(random_camshaft, "up"),
    "tables' run-up": _running(_tabled_drive, "up"),
    "shaft's run-down": _running(random_camshaft, "down"),
}


# Under steep motors a difference of motions takes half a minute.
_SLOW = () if DEEP else (8,)


def test_derivatives_are_those_of_the_analyses() -> None:
    counts, coarse = Counter[str](), 0
    for number, random in random_cases(43, 2 * len(KINDS), 2000):
        kind = list(KINDS)[number % len(KINDS)]
        if number in _SLOW:
            continue
        try:
            tally = compared(KINDS[kind](random), random)
        except LinkwrightError:
            # It does not close, nothing drives it, it does not start or come to rest.
            continue
        assert not tally.wrong, (number, kind, tally.wrong)
        counts[kind] += tally.count
        coarse += tally.coarse
    assert coarse < 0.05 * sum(counts.values()), counts
    assert sum(counts.values()) > 50, counts
