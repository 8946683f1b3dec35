"""The best machine: known places, limits that are active, choices, and what cannot be kept."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import linkwright as lw
from linkwright.kernel.errors import FindingError, InputError
from linkwright.studies.optimise import Optimum

# The pin of a crank of 0.2 m at angle a: x = 0.2 cos a, y = 0.2 sin a.
TEXT = """
machine = "roller_two_carts"
[variables.a]
address = "mechanism.cranks.A1.phase"
range = ["10 deg", "170 deg"]
[variables.r]
address = "mechanism.cranks.A1.radius"
range = ["0.1 m", "0.3 m"]
[responses]
x = { curve = "motion.A1.x", at = "0 deg" }
y = { curve = "motion.A1.y", at = "0 deg" }
far = { formula = "(x + 0.1)^2 + (y - 0.15)^2" }
[goals]
far = "minimise"
"""


def optimum(tmp_path: Path, text: str, evaluations: int = 3000) -> Optimum:
    (tmp_path / "study.toml").write_text(text)
    return lw.optimise(lw.read_study(tmp_path / "study.toml"), evaluations)


def test_a_place_that_is_known(tmp_path: Path) -> None:
    found = optimum(tmp_path, TEXT)
    # A square bottoms out where it is lost in rounding, √ε of the place.
    assert found.responses["x"] == pytest.approx(-0.1, abs=1e-6)
    assert found.variables["a"] == pytest.approx(np.pi - np.arctan(1.5), abs=1e-6)
    assert lw.get(found.machine, "mechanism.cranks.A1.radius") == found.variables["r"]
    assert found.active == ()


def test_a_limit_that_is_active(tmp_path: Path) -> None:
    """The nearest point of the line y = 0.1 is straight below."""
    found = optimum(tmp_path, TEXT + '[constraints]\ny = { max = "0.1 m" }\n')
    assert found.responses["y"] <= 0.1
    assert found.responses["far"] == pytest.approx(0.05**2, rel=1e-3)
    assert "y is at its maximum" in found.active[0]


def test_whole_numbers_and_choices(tmp_path: Path) -> None:
    text = TEXT.replace('range = ["0.1 m", "0.3 m"]', 'values = ["0.1 m", "0.18 m", "0.3 m"]')
    found = optimum(tmp_path, text, 400)
    assert found.variables["r"] == 0.18
    assert [each["r"] for each in found.tried] == [0.1, 0.18, 0.3]
    # The circle of 0.18 m passes the place at √(0.1² + 0.15²) - 0.18.
    assert found.responses["far"] == pytest.approx((np.hypot(0.1, 0.15) - 0.18) ** 2, rel=1e-6)


def test_what_cannot_be_kept_is_told(tmp_path: Path) -> None:
    with pytest.raises(FindingError, match=r"the nearest has y = 0\.3"):
        optimum(tmp_path, TEXT + '[constraints]\ny = { min = "0.4 m" }\n', 1500)
    with pytest.raises(InputError, match="goals"):
        optimum(tmp_path, TEXT.replace('[goals]\nfar = "minimise"\n', ""))
