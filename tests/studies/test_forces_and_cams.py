"""Forces of pairs and sizes of cams as responses of studies, with their exact derivatives."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

import linkwright as lw
from linkwright import MachineError
from linkwright.studies import StudyPlan
from linkwright.studies.slopes import slopes

EXAMPLES = Path(__file__).parents[2] / "examples"

FORCES = """
machine = "four_bar_counterweights"
[variables.coupler]
address = "bodies.\\"R.coupler\\".mass"
range = ["1 kg", "2 kg"]
tolerance = "± 0.1 kg"
[variables.speed]
address = "drive.speed"
range = ["250 rpm", "350 rpm"]
[responses]
pin = "forces.reaction_max.A"
shaking = "forces.shaking_force_max"
"""

CAM = """
machine = "cam_oscillating_valve"
[variables.base]
address = "mechanism.cams.finger.base_radius"
range = ["12 mm", "24 mm"]
[responses]
base_radius = "cam.finger.base_radius"
steepest = "cam.finger.pressure_angle_max"
[constraints]
steepest = { max = "30 deg" }
[goals]
base_radius = "minimise"
"""


def plan_of(tmp_path: Path, text: str) -> StudyPlan:
    (tmp_path / "study.toml").write_text(text)
    return lw.read_study(tmp_path / "study.toml")


def test_forces_of_pairs_are_those_of_the_analysis(tmp_path: Path) -> None:
    plan = plan_of(tmp_path, FORCES.replace('tolerance = "± 0.1 kg"\n', ""))
    rows = lw.evaluate(plan, {"coupler": np.array([1.2, 1.7]), "speed": np.array([30.0, 33.0])})
    for row, (mass, speed) in enumerate(((1.2, 30.0), (1.7, 33.0))):
        machine = lw.replace(plan.machine, {'bodies."R.coupler".mass': mass, "drive.speed": speed})
        found = lw.forces(machine)
        assert rows.columns["pin"][row] == found.reaction_max["A"]
        assert rows.columns["shaking"][row] == found.shaking_force_max


def test_their_derivatives_are_exact(tmp_path: Path) -> None:
    """Inertia forces go with the square of the speed."""
    plan = plan_of(tmp_path, FORCES.replace('tolerance = "± 0.1 kg"\n', ""))
    found = slopes(plan, np.array([1.5, 30.0]), np.array([1e-3, 1e-2]))
    assert found.exact == {"pin", "shaking"}
    for name in ("pin", "shaking"):
        assert found.slopes[name][1] == pytest.approx(2 * found.values[name] / 30.0, rel=1e-12)


@pytest.mark.parametrize("asked", ["forces.reaction_max.Z", "forces.reaction_max.A.x"])
def test_a_pair_that_does_not_exist_is_told(tmp_path: Path, asked: str) -> None:
    with pytest.raises(MachineError, match="reaction_max"):
        plan_of(
            tmp_path, FORCES.replace("forces.reaction_max.A", asked).replace('tolerance = "± 0.1 kg"\n', "")
        )


def test_the_least_cam_for_a_pressure_angle(tmp_path: Path) -> None:
    """By gradients from several starts, against the root of the analysis itself."""
    found = lw.optimise(plan_of(tmp_path, CAM), 60, method="gradient", starts=3)

    def missing(base: float) -> float:
        machine = lw.replace(found.machine, {"mechanism.cams.finger.base_radius": base})
        return lw.cam_profile(machine, "finger", n=360).pressure_angle_max - np.radians(30)

    assert found.variables["base"] == pytest.approx(brentq(missing, 0.012, 0.016), rel=1e-6)
    assert "steepest is at its maximum" in found.active[0]
