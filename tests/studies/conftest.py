"""Studies of two carts, as files."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

MACHINES = Path(__file__).parents[2] / "machines"

STUDY = """
machine = "roller_two_carts"

[variables.phase]
address = "mechanism.cranks.A2.phase"
range = ["45 deg", "135 deg"]
steps = 5

[variables.mass]
address = ["bodies.cart1.mass", "bodies.cart2.mass"]
range = ["900 kg", "1100 kg"]
steps = 3

[derived]
half = { formula = "mass/2" }

[responses]
delta = "steady_state.unevenness"
H = "steady_state.dynamism"
k_p = { formula = "delta^2 + H" }

[constraints]
delta = { max = 0.3 }

[sweep]
chunk = 4
"""


@pytest.fixture
def study_file(tmp_path: Path) -> Callable[..., Path]:

    def written(*changes: tuple[str, str], name: str = "study.toml") -> Path:
        text = STUDY
        for old, new in changes:
            assert old in text, old
            text = text.replace(old, new)
        (tmp_path / name).write_text(text)
        return tmp_path / name

    return written
