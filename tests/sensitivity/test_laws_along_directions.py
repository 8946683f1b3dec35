"""Derivatives of random machines by laws of cams and by points of tables, along random directions over all
their entries at once: sections, laws and places move kinks and jumps of the motion.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from along_directions import Case, all_agree
from numpy.random import Generator
from random_drives import Table, random_camshaft, random_drive, torque_size, with_tables
from sizes import DEEP, random_cases
from test_all_kinds import forces_of, running_of, steady_of

import linkwright as lw


def _tabled_drive(random: Generator) -> Table:
    drive = random_drive(random)
    state = lw.steady_state(lw.Machine.model_validate(drive))
    return with_tables(random, drive, (state.speed_min, state.speed_max), torque_size(state))


def _running(of: Callable[[Generator], Table], kind: str, random: Generator) -> Case:
    return running_of(of(random) | {"run_up": {"angle_start": float(random.uniform(0.1, 6.0))}}, kind)


KINDS: dict[str, Callable[[Generator], Case]] = {
    "shaft": lambda random: steady_of(random_camshaft(random)),
    "tables": lambda random: steady_of(_tabled_drive(random)),
    "shaft's forces": lambda random: forces_of(random_camshaft(random)),
    "tables' forces": lambda random: forces_of(_tabled_drive(random)),
    "shaft's run-up": partial(_running, random_camshaft, "up"),
    "tables' run-up": partial(_running, _tabled_drive, "up"),
    "shaft's run-down": partial(_running, random_camshaft, "down"),
}


# Under steep motors a difference of motions takes half a minute.
_SLOW = () if DEEP else (8,)


def test_derivatives_are_those_of_the_analyses() -> None:
    numbered = random_cases(43, 2 * len(KINDS), 2000)
    counts = all_agree(KINDS, (case for case in numbered if case[0] not in _SLOW))
    assert sum(counts.values()) > 50, counts
