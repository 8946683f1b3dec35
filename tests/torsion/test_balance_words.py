"""What a study of torsion says of mean torques that balance or not, and of loads without speeds."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import linkwright as lw
from linkwright import torsion_study
from linkwright.torsion.study import _balance_warnings, is_balanced

DRIVEN = """
format = 1
name = "two discs"
[train.discs]
motor = { inertia = 1.0 }
pump = { inertia = 2.0 }
[train.shafts]
s = { between = ["motor", "pump"], stiffness = 1e4 }
[train.loads.pump]
on = "pump"
torque = "100 N m"
speed = "1500 rpm"
exponent = 2
"""


def torques(engine: float, driver: float) -> Any:
    mean = np.array([[engine, engine], [driver, driver]])
    surplus = SimpleNamespace(mean=mean, surplus=mean.sum(axis=0), speeds=np.array([10.0, 20.0]))
    return SimpleNamespace(torques=surplus, referred=SimpleNamespace(speed=np.ones(2)))


@pytest.mark.parametrize(
    ("engine", "driver", "words"),
    [
        (-80.0, 80.0, None),
        (-80.0, 100.0, "leave an excess of +20 to +20 N m"),
        (80.0, None, "The engine drives no load"),
    ],
)
def test_a_compressor_and_its_motor(engine: float, driver: float | None, words: str | None) -> None:
    """A motor that gives what a compressor takes accelerates nothing."""
    drivers = {} if driver is None else {"motor": SimpleNamespace(torque=driver)}
    train: Any = SimpleNamespace(loads={}, drivers=drivers, installed=())
    at = torques(engine, driver or 0.0)
    said = [*_balance_warnings(train, at)]
    assert is_balanced(at) == (words is None)
    assert len(said) == (words is not None)
    assert all((words or "") in text for text in said)


def test_loads_without_speeds() -> None:
    """Without [train.run] there is no speed at which a load has a slope."""
    words = "The loads damp only at the speeds of [train.run]"
    assert any(words in text for text in torsion_study(lw.loads(DRIVEN)).warnings)
    run = '[train.run]\nspeed_min = "500 rpm"\nspeed_max = "2000 rpm"\n'
    assert not any(words in text for text in torsion_study(lw.loads(DRIVEN + run)).warnings)
    without = DRIVEN[: DRIVEN.index("[train.loads")]
    assert not any(words in text for text in torsion_study(lw.loads(without)).warnings)
