"""Derivatives of responses by variables: exact ones against differences, and which are which."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import linkwright as lw
from linkwright.studies.slopes import _differences, slopes

TEXT = """
machine = "roller_two_carts"
[variables.crank]
address = "mechanism.cranks.A1.radius"
tolerance = "± 0.5 mm"
[variables.phase]
address = "mechanism.cranks.A2.phase"
tolerance = "± 0.5 deg"
[derived]
rod = { formula = "4*crank", address = ["mechanism.sliders.cart1.rod", "mechanism.sliders.cart2.rod"] }
[responses]
delta = "steady_state.unevenness"
root = { formula = "sqrt(delta)*crank" }
top = { curve = "steady_state.speed", extreme = "max" }
scaled = { formula = "2*top" }
power = { entry = "drive.motor.torque_rated" }
long = { entry = "mechanism.sliders.cart1.rod" }
"""


def test_exact_ones_are_those_of_differences(tmp_path: Path) -> None:
    """To 1e-6: the batches of the differences are computed to 1e-9, over steps of 1e-3."""
    (tmp_path / "study.toml").write_text(TEXT)
    plan = lw.read_study(tmp_path / "study.toml")
    at, steps = np.array([0.2, 1.2]), np.array([2e-4, 1e-3])
    found, measured = slopes(plan, at, steps), _differences(plan, at, steps)
    assert found.exact == {"delta", "root", "power", "long"}
    for name in plan.responses:
        assert found.values[name] == pytest.approx(measured[name].value, rel=1e-8)
        assert found.slopes[name] == pytest.approx(measured[name].d, rel=1e-6), name
    assert (found.values["power"], found.values["long"]) == (107.7, pytest.approx(0.8, rel=1e-15))
    assert found.slopes["long"].tolist() == [4.0, 0.0]
    assert lw.tolerance(plan, 100).exact == ("delta", "root", "power", "long")
