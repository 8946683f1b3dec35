"""Clutches, brakes and freewheels of trains with mechanisms: steady motion with them."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from test_mounted_trains import line_shaft

import linkwright as lw
from linkwright.driveline.study import elastic_warnings

STIFFNESS, DAMPING, RING = 4e3, 12.0, 0.1


def with_freewheel(folder: Path, **entries: Any) -> lw.Machine:
    """The line shaft, of which an elastic freewheel drives the left press instead of a shaft."""
    machine = line_shaft(folder, stiffness=STIFFNESS, damping=DAMPING)
    wheel = {"between": ["hub", "c1"], "stiffness": STIFFNESS, "damping": DAMPING, "ring_inertia": RING}
    right = machine.train.shafts["right"]  # type: ignore[union-attr]
    return lw.replace(
        machine, {"train.shafts": {"right": right}, "train.freewheels": {"wheel": wheel}, **entries}
    )


def test_a_locked_freewheel_is_a_shaft_with_its_ring_on_the_hub(tmp_path: Path) -> None:
    """Steady motion is that of a shaft of its stiffness, the inertia of the ring on the driving disc."""
    wheel = lw.elastic_motion(with_freewheel(tmp_path))
    shaft = lw.elastic_motion(lw.replace(line_shaft(tmp_path), {"train.discs.hub.inertia": 3.0 + RING}))
    ours, theirs = wheel.shafts.index("wheel_spring"), shaft.shafts.index("left")
    for name in ("torque_min", "torque_max", "twist_max"):
        assert getattr(wheel, name)[ours] == pytest.approx(getattr(shaft, name)[theirs], rel=1e-9), name
    assert np.abs(wheel.multipliers) == pytest.approx(np.abs(shaft.multipliers), rel=1e-7)


def _warnings(machine: lw.Machine, motion: lw.ElasticMotion) -> list[str]:
    known: Any = SimpleNamespace(machine=machine, elastic_motion=motion, steady_state=None)
    return list(elastic_warnings(known))


def test_a_freewheel_whose_torque_reverses_is_reported(tmp_path: Path) -> None:
    """Where the spring would have to pull, a warning says so with the torque; where it pushes, none does."""
    machine = with_freewheel(tmp_path)
    motion = lw.elastic_motion(machine)
    (low,) = motion.torque_min[[motion.shafts.index("wheel_spring")]]
    told = [text for text in _warnings(machine, motion) if "overrun" in text]
    assert len(told) == (low < 0)
    assert low < 0
    # Light rams, and a load on the press that keeps the spring under torque.
    loaded = lw.replace(
        machine,
        {
            "train.loads": {"drag": {"on": "c1", "torque": 400.0, "speed": 20.0, "exponent": 0.0}},
            **{f"train.mechanisms.press{n}.machine.bodies.S.mass": 2.0 for n in (1, 2)},
        },
    )
    motion = lw.elastic_motion(loaded)
    assert motion.torque_min[motion.shafts.index("wheel_spring")] > 0
    assert not [text for text in _warnings(loaded, motion) if "overrun" in text]


@pytest.mark.parametrize(
    ("entries", "words"),
    [
        ({"train.freewheels": {"wheel": {"between": ["hub", "c1"]}}}, "a rigid freewheel"),
        ({"train.brakes": {"drag": {"on": "c1", "sliding": 20.0}}}, r"train\.brakes\.drag"),
    ],
)
def test_parts_that_slip_are_refused(tmp_path: Path, entries: dict[str, Any], words: str) -> None:
    """Steady motion with mechanisms has no slip: brakes and rigid freewheels are errors with a remedy."""
    with pytest.raises(lw.MachineError, match=words):
        lw.elastic_motion(with_freewheel(tmp_path, **entries))
