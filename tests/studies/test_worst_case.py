"""The worst case of tolerances: all corners of a box, closed forms, and responses that are not monotone."""

from __future__ import annotations

import shutil
from itertools import product
from pathlib import Path

import numpy as np
import pytest

import linkwright as lw

FOUND = Path(__file__).parents[1] / "found" / "use"


def test_the_corners_of_six_variables() -> None:
    """The first frequency is monotone in each of six variables: its extremes are those of all 64 corners."""
    plan = lw.read_study(FOUND / "worst_case.toml")
    found = lw.tolerance(plan, 2000)
    corners = np.array(list(product(*((axis.low, axis.high) for axis in plan.axes))))
    columns = {axis.name: corners[:, i] for i, axis in enumerate(plan.axes)}
    frequencies = lw.evaluate(plan, columns).columns["f"]
    assert found.responses["f"]["worst_low"] == pytest.approx(frequencies.min(), rel=1e-12)
    assert found.responses["f"]["worst_high"] == pytest.approx(frequencies.max(), rel=1e-12)
    assert (frequencies.min(), frequencies.max()) == pytest.approx((39.378, 84.546), abs=1e-3)
    assert not found.beyond_corners


def box(tmp_path: Path, formula: str, second: str = '"± 0.5 kg m^2"') -> lw.StudyPlan:
    """A response of two numbers of a machine, both 10 in the middle."""
    text = f"""
machine = "lin_machine.toml"
[variables.u]
address = "train.discs.d0.inertia"
tolerance = "± 1 kg m^2"
[variables.v]
address = "train.discs.d1.inertia"
tolerance = {second}
[responses]
f = {{ formula = "{formula}" }}
"""
    shutil.copy(FOUND / "lin_machine.toml", tmp_path)
    (tmp_path / "study.toml").write_text(text)
    return lw.read_study(tmp_path / "study.toml")


def test_a_curved_response(tmp_path: Path) -> None:
    """exp(u − v) is far from linear and monotone: exact, without a doubt."""
    found = lw.tolerance(box(tmp_path, "exp(u - v)"), 500)
    row = found.responses["f"]
    assert (row["worst_low"], row["worst_high"]) == pytest.approx((np.exp(-1.5), np.exp(1.5)))
    assert not found.beyond_corners


@pytest.mark.parametrize(
    ("formula", "names", "low", "high"),
    [
        # The middle is a minimum in u, and a little beside one.
        ("(u - 10)^2 + v", "u", 9.5, 11.5),
        ("(u - 10.2)^2 + v", "u", 9.5, 11.94),
        # The corner of the slopes is no maximum where signs differ from place to place.
        ("v - 10 + 5*(u - 10)*(v - 10) + 0.1*(u - 10)", "u, v", -2.9, 3.1),
    ],
)
def test_what_is_not_monotone_is_told(
    tmp_path: Path, formula: str, names: str, low: float, high: float
) -> None:
    found = lw.tolerance(box(tmp_path, formula), 4000)
    assert found.beyond_corners == {"f": f"it is not monotone in {names}"}
    row = found.responses["f"]
    assert (row["worst_low"], row["worst_high"]) == pytest.approx((low, high), abs=0.06)


def test_a_variable_without_ends(tmp_path: Path) -> None:
    """What depends on a normal distribution has no worst case; what does not has one."""
    plan = box(tmp_path, "u", '"± 0.5 kg m^2"')
    text = (tmp_path / "study.toml").read_text()
    endless = 'distribution = { kind = "normal", mean = "10 kg m^2", deviation = "0.1 kg m^2" }'
    text = text.replace('tolerance = "± 0.5 kg m^2"', endless) + 'g = { formula = "u + v" }\n'
    shutil.copy(FOUND / "lin_machine.toml", tmp_path)
    (tmp_path / "study.toml").write_text(text)
    plan = lw.read_study(tmp_path / "study.toml")
    rows = lw.tolerance(plan, 500).responses
    assert (rows["f"]["worst_low"], rows["f"]["worst_high"]) == pytest.approx((9.0, 11.0))
    assert (rows["g"]["worst_low"], rows["g"]["worst_high"]) == (-np.inf, np.inf)
