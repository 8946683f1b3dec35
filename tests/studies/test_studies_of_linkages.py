"""Strokes, swings and transmission angles as responses of studies."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path

import numpy as np
import pytest

import linkwright as lw
from linkwright import MachineError
from linkwright.studies import StudyPlan
from linkwright.studies.slopes import slopes as slopes_at

EXAMPLES = Path(__file__).parents[2] / "examples"

CRANK_ROCKER = """
[variables.crank]
address = "mechanism.cranks.A.radius"
range = ["50 mm", "110 mm"]
[variables.coupler]
address = "mechanism.rockers.B.coupler"
range = ["120 mm", "250 mm"]
[variables.rocker]
address = "mechanism.rockers.B.rocker"
range = ["120 mm", "250 mm"]
[responses]
swing = "linkage.B.swing"
time_ratio = "linkage.B.time_ratio"
transmission = "linkage.B.transmission_angle_worst"
[constraints]
swing = { min = "60 deg" }
time_ratio = { min = 1.2 }
[goals]
transmission = "maximise"
"""


def study(tmp_path: Path, text: str) -> StudyPlan:
    machine = EXAMPLES / "quick_return_crank_rocker" / "machine.toml"
    (tmp_path / "machine.toml").write_text(machine.read_text("utf-8"), encoding="utf-8")
    (tmp_path / "study.toml").write_text('machine = "machine.toml"\n' + text, encoding="utf-8")
    return lw.read_study(tmp_path / "study.toml")


def test_the_best_crank_rocker_is_that_of_its_dead_centres(tmp_path: Path) -> None:
    """Swing and time ratio given, `crank_rocker` looks through all lengths that have them in closed form."""
    plan = study(
        tmp_path, CRANK_ROCKER.replace('"50 mm", "110 mm"', '"50 mm", "77 mm"').replace("110", "110")
    )
    plan = study(tmp_path, CRANK_ROCKER)
    lengths = {
        "mechanism.cranks.A.radius": 0.07,
        "mechanism.rockers.B.coupler": 0.19,
        "mechanism.rockers.B.rocker": 0.15,
    }
    machine = lw.replace(study(tmp_path, CRANK_ROCKER).machine, lengths)
    plan = lw.new_study(machine, tomllib.loads(CRANK_ROCKER))
    found = lw.optimise(plan, method="gradient", starts=2)
    wanted = lw.crank_rocker(np.radians(60), 1.2, frame=0.2)
    assert found.responses["transmission"] == pytest.approx(wanted.transmission_angle_min, abs=1e-6)
    # The best is flat along the lengths that keep both limits.
    assert found.variables["crank"] == pytest.approx(wanted.crank, rel=1e-3)
    assert {name.split(" of ")[-1] for name in found.multipliers} == {"swing", "time_ratio"}


def test_slopes_are_exact(tmp_path: Path) -> None:
    plan = study(tmp_path, CRANK_ROCKER)
    at = np.array([lw.get(plan.machine, *axis.addresses) for axis in plan.axes])
    there = slopes_at(plan, at, 1e-4 * at)
    assert there.exact == {"swing", "time_ratio", "transmission"}
    by_hand = lw.gradient(plan.machine, ["linkage.B"], [axis.addresses[0] for axis in plan.axes])
    for response in plan.asked:
        exact = by_hand.of(f"linkage.B.{response.quantity}")
        np.testing.assert_allclose(there.slopes[response.name], [*exact.values()], rtol=1e-12)


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ("linkage.Z.swing", "linkage.ELEMENT.swing"),
        ("linkage.B.swimg", 'did you mean "swing"'),
        ("linkage.B.four_bar", "a quantity of an element"),
    ],
)
def test_what_there_is_not_is_refused(tmp_path: Path, asked: str, said: str) -> None:
    with pytest.raises(MachineError, match=said):
        study(tmp_path, CRANK_ROCKER.replace("linkage.B.swing", asked))


def test_a_machine_without_the_number_fails_alone(tmp_path: Path) -> None:
    """A longer crank turns its rocker round and round: it has no swing."""
    plan = study(tmp_path, CRANK_ROCKER)
    rows = lw.evaluate(
        plan,
        {"crank": np.array([0.07, 0.3]), "coupler": np.array([0.19, 0.25]), "rocker": np.array([0.15, 0.25])},
    )
    assert math.isfinite(rows.columns["swing"][0])
    assert rows.status[0] == 0
    assert rows.status[1] != 0
    assert "swing" in rows.why(1)
