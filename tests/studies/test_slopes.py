"""Derivatives of responses by variables: exact ones against differences, and which are which."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import linkwright as lw
from linkwright.studies import StudyPlan
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
    found, measured = slopes(plan, at, steps), _differences(plan, at, steps, np.arange(len(at)))
    assert found.exact == {"delta", "root", "power", "long"}
    for name in plan.responses:
        assert found.values[name] == pytest.approx(measured[name].value, rel=1e-8)
        assert found.slopes[name] == pytest.approx(measured[name].d, rel=1e-6), name
    assert (found.values["power"], found.values["long"]) == (107.7, pytest.approx(0.8, rel=1e-15))
    assert found.slopes["long"].tolist() == [4.0, 0.0]
    assert lw.tolerance(plan, 100).exact == ("delta", "root", "power", "long")


ROTATOR = """
machine = "rod_rotator_intermittent"
[variables.pin]
address = "rod_rotator.pin_distance"
tolerance = "± 5 mm"
[variables.swing]
address = "rod_rotator.swing"
tolerance = "± 1 deg"
[responses]
days = "rod_rotator.string_turn_days"
force = "rotator.link_force_max"
"""


def test_those_of_a_rotator_are_exact(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(ROTATOR)
    plan = lw.read_study(tmp_path / "study.toml")
    at, steps = np.array([2.5, 1.5]), np.array([1e-3, 1e-3])
    found, measured = slopes(plan, at, steps), _differences(plan, at, steps, np.arange(len(at)))
    assert found.exact == {"days", "force"}
    for name in plan.responses:
        assert found.slopes[name] == pytest.approx(measured[name].d, rel=1e-6, abs=1e-9), name


KINK = """
machine = "roller_two_carts"
[variables.mass]
address = "bodies.cart2.mass"
tolerance = "± 10 kg"
[variables.phase]
address = "mechanism.cranks.A2.phase"
tolerance = "± 0.1 deg"
[responses]
pin = "forces.reaction_max.A2"
twice = { formula = "2*pin" }
"""


def test_only_variables_without_a_derivative_are_differenced(tmp_path: Path) -> None:
    """The force is largest at 270°, beside a kink of the loads that the phase moves; the mass does not."""
    (tmp_path / "study.toml").write_text(KINK)
    plan: StudyPlan = lw.read_study(tmp_path / "study.toml")
    machine = plan.machine
    names = [axis.addresses[0] for axis in plan.axes]
    counts: list[int] = []
    place = slopes(plan, np.array([lw.get(machine, name) for name in names]), np.full(2, 1e-5), counts.append)
    exact = lw.gradient(machine, ["forces.reaction_max.A2"], names).derivatives[0]
    assert np.isfinite(exact).tolist() == [True, False]
    assert place.slopes["pin"][0] == exact[0]
    assert place.slopes["twice"][0] == 2 * exact[0]
    assert np.isfinite(place.slopes["pin"][1])
    assert place.exact == frozenset()
    assert "there is no derivative with respect to the entries that move this kink" in place.ties["pin"]
    # The machine itself, and four beside it in phase.
    assert sum(counts) == 5
