"""What is not finite in a result has its word: its declaration says where."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

import linkwright as lw
from linkwright.kernel.quantities import _about, declared
from linkwright.kernel.result import PlainRecord, Record

# At 80 rad/s the only disc is excited at its natural frequency, without damping: k = J ω².
UNDAMPED = """
format = 1
name = "undamped"
train.discs.a.inertia = 1.0
train.excitations.e = { on = "a", harmonics = [{ order = 1, torque = "10 N m" }] }
train.run = { speed_min = "60 rad/s", speed_max = "100 rad/s", points = 41 }
[train.shafts.s]
between = ["ground", "a"]
stiffness = 6400.0
limit = { kind = "given", diameter = "30 mm", stress_permitted = "30 MPa" }
"""


def at_rest() -> lw.Machine:
    return lw.read("topper", {"topper.knife_speed": 0})


MACHINES = {
    "knife at rest": at_rest,
    "undamped train": lambda: lw.loads(UNDAMPED),
    "engine": lambda: lw.read("v8_diesel"),
    "crank drive": lambda: lw.read("roller_two_carts"),
    "cam": lambda: lw.read("roller_cam"),
    "pumping unit": lambda: lw.read("rod_rotator_continuous"),
    "four-bar": lambda: lw.read("four_bar_coupler_curve"),
}

WORD = re.compile("NaN|[Ii]nfinite|[Nn]ot finite|unbounded")


def records(node: Any, depth: int = 0) -> Iterator[Any]:
    if isinstance(node, Record | PlainRecord) and depth < 6:
        yield node
        for below in vars(node).values():
            yield from records(below, depth + 1)
    elif isinstance(node, list | tuple):
        for below in node[:20]:
            yield from records(below, depth)
    elif isinstance(node, dict):
        for below in list(node.values())[:20]:
            yield from records(below, depth)


def is_finite(value: Any) -> bool:
    if isinstance(value, float):
        return math.isfinite(value)
    is_numbers = isinstance(value, np.ndarray) and value.dtype.kind in "fc"
    return not is_numbers or bool(np.isfinite(value).all())


@pytest.mark.parametrize("name", MACHINES)
def test_what_is_not_finite_is_declared(name: str) -> None:
    machine = MACHINES[name]()
    study = lw.torsion_study(machine) if machine.train else lw.study(machine)
    silent = set()
    for result in records(study):
        of = type(result)
        head = str(of.__doc__).partition("Attributes\n")[0]
        for attribute in declared(of) if isinstance(result, Record) else ():
            value = getattr(result, attribute)
            if not is_finite(value) and not WORD.search(f"{_about(of, attribute)} {head}"):
                silent.add(f"{of.__name__}.{attribute}")
    assert not silent, "; ".join(sorted(silent))
