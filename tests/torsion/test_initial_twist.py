"""Motion in time from given twists: free vibration, a release, and twists that do not fit together."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import linkwright as lw
from linkwright import LinkwrightError, MachineError, free_vibration, torsion_transient


def machine(transient: dict[str, Any], **train: Any) -> lw.Machine:
    entries = {
        "discs": {"a": {"inertia": 1.0}, "b": {"inertia": 0.5}, "c": {"inertia": 2.0}},
        "shafts": {
            "ab": {"between": ["a", "b"], "stiffness": 4e4},
            "bc": {"between": ["b", "c"], "stiffness": 9e4},
        },
        "transient": {"duration": 0.2, "sample_time": 1e-4, **transient},
    }
    return lw.Machine.model_validate({"format": 1, "name": "twist", "train": {**entries, **train}})


@pytest.mark.parametrize("speed", [0.0, 50.0])
def test_a_mode_vibrates_by_itself(speed: float) -> None:
    """Twisted as a mode, the train vibrates with its frequency alone, at rest and while it turns."""
    free = free_vibration(machine({}))
    twists = {name: 1e-3 * float(twist) for name, twist in zip(free.shafts, free.twists[1], strict=True)}
    moved = torsion_transient(machine({"twists": twists, "speed": speed}))
    omega = free.angular_frequencies[1]
    for s, (name, k) in enumerate({"ab": 4e4, "bc": 9e4}.items()):
        expected = k * twists[name] * np.cos(omega * moved.time)
        assert moved.torque[s] == pytest.approx(expected, abs=1e-5 * k * abs(twists[name]))
    assert moved.speed.mean() == pytest.approx(speed, abs=1e-2)


def test_release_behind_a_stage_and_at_the_ground() -> None:
    """A twist counts at the first end of its shaft, behind a stage and against the ground alike."""
    gears = {"g": {"between": ["a", "b"], "ratio": 2.5}}
    shafts = {
        "hold": {"between": ["ground", "a"], "stiffness": 3e4},
        "bc": {"between": ["b", "c"], "stiffness": 9e4},
    }
    moved = torsion_transient(machine({"twists": {"hold": 0.01, "bc": -0.004}}, gears=gears, shafts=shafts))
    assert moved.torque[:, 0] == pytest.approx([300.0, -360.0], rel=1e-9)


def test_what_is_wrong_is_told() -> None:
    """Names that are no shafts, twists around a loop, a loaded start beside them."""
    with pytest.raises(MachineError, match="the name of a shaft"):
        machine({"twists": {"ad": 0.1}})
    with pytest.raises(MachineError, match="none beside twists"):
        machine({"twists": {"ab": 0.1}, "loaded": True})
    loop = {name: {"between": list(name), "stiffness": 1e4} for name in ("ab", "bc", "ac")}
    with pytest.raises(LinkwrightError, match="do not fit together"):
        torsion_transient(machine({"twists": {"ab": 0.1}}, shafts=loop))
