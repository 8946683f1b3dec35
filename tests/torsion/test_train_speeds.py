"""The speeds of a train have both ends of their range, and the speed of service."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.torsion.model.train import TrainRun


@pytest.mark.parametrize("points", [2, 3, 5, 200])
@pytest.mark.parametrize("rated", [30.1, 45.0, 78.5, 78.9, None])
def test_ends_and_service(points: int, rated: float | None) -> None:
    run = TrainRun(speed_min=30.0, speed_max=79.0, points=points, speed_rated=rated)
    speeds = run.speeds
    assert (speeds[0], speeds[-1]) == (30.0, 79.0)
    assert run.service in speeds
    assert (np.diff(speeds) > 0).all()
    assert len(speeds) == points + (points == 2 and rated is not None)
