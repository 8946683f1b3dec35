"""The cheapest tolerances: Lagrange's closed form of a chain of lengths, and what cannot be had."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from command_line import invoke

import linkwright as lw
from linkwright import FindingError, InputError

# At the outer dead centre the cart stands at r + l: a chain of two lengths.
CHAIN = """
machine = "roller_two_carts"
[variables.r]
address = "mechanism.cranks.A1.radius"
tolerance = "± 0.3 mm"
cost = 1.0
[variables.l]
address = "mechanism.sliders.cart1.rod"
tolerance = "± 0.6 mm"
cost = 8.0
[responses]
x = { curve = "motion.cart1.x", at = "0 deg" }
[constraints]
x = { min = "999.5 mm", max = "1000.5 mm" }
"""


def chain(tmp_path: Path, *changes: tuple[str, str]) -> lw.StudyPlan:
    text = CHAIN
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    (tmp_path / "study.toml").write_text(text)
    return lw.read_study(tmp_path / "study.toml")


@pytest.mark.parametrize("power", [1.0, 2.0])
def test_a_chain_of_lengths(tmp_path: Path, power: float) -> None:
    """min Σ c f⁻ᵏ with Σ (σ f)² given: f ∝ (c/σ²)^(1/(k + 2)); the sum is normal, but for its ends."""
    found = lw.allocate(chain(tmp_path), 0.98, power=power, rows=1500)
    ratio = (8.0 / 1.0 * (0.1 / 0.2) ** 2) ** (1 / (power + 2))
    assert found.factors["l"] / found.factors["r"] == pytest.approx(ratio, rel=1e-4)
    # 98 % of a normal distribution lie within 2.326 deviations; of 1500 rows they are known to some 2 %.
    deviation = np.hypot(0.1 * found.factors["r"], 0.2 * found.factors["l"])
    assert deviation == pytest.approx(0.5 / 2.326, rel=0.06)
    assert found.share_within >= 0.98
    assert found.tolerances["r"] == pytest.approx((-3e-4 * found.factors["r"], 3e-4 * found.factors["r"]))
    assert found.cost == pytest.approx(found.factors["r"] ** -power + 8 * found.factors["l"] ** -power)
    assert set(found.active) == {"minimum of x", "maximum of x"}


def test_what_cannot_be_had(tmp_path: Path) -> None:
    with pytest.raises(FindingError, match="no tolerances give a yield"):
        lw.allocate(chain(tmp_path, ("cost = 8.0\n", ""), ("± 0.6 mm", "± 6 mm")), 0.99, rows=200)
    with pytest.raises(FindingError, match="beyond its limit"):
        lw.allocate(chain(tmp_path, ("999.5 mm", "1000.2 mm")), 0.99, rows=200)
    with pytest.raises(InputError, match="`cost` beside"):
        lw.allocate(chain(tmp_path, ("cost = 1.0\n", ""), ("cost = 8.0\n", "")), 0.99, rows=200)
    with pytest.raises(InputError, match="a number greater than 0"):
        lw.allocate(chain(tmp_path, ("cost = 8.0\n", "cost = -1\n")), 0.99, rows=200)


def test_the_command(tmp_path: Path) -> None:
    chain(tmp_path)
    words = ["tolerance", str(tmp_path / "study.toml"), "--allocate", "0.9", "--rows", "500", "--json"]
    result = invoke(*words)
    assert result.exit_code == 0, result.output
    told = json.loads(result.stdout)["results"]["allocation"]
    assert told["share_within"] >= 0.9
    assert set(told["tolerances"]) == {"r", "l"}


@pytest.mark.parametrize(
    ("wanted", "rows"), [(1e-300, 200), (0.004, 200), (0.9999, 1000), (1 - 1e-16, 10_000)]
)
def test_a_yield_finer_than_the_rows_tell(tmp_path: Path, wanted: float, rows: int) -> None:
    with pytest.raises(InputError, match=rf"wanted .*, the shares that {rows} rows tell"):
        lw.allocate(chain(tmp_path), wanted, rows=rows)
    # As many as the message asks for would do.
    with pytest.raises(InputError, match="at least 10000 rows"):
        lw.allocate(chain(tmp_path), 0.9999, rows=9_999)
