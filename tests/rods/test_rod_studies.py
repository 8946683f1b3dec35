"""Studies of a rod string: taper design."""

from __future__ import annotations

import numpy as np
import pytest
from tests.samples.wells import well

import linkwright as lw

STUDY = """
machine = "well.toml"
[variables.upper]
address = "rod_string.sections.0.length"
range = ["400 m", "900 m"]
[derived.lower]
address = "rod_string.sections.1.length"
formula = "1524 - upper"
[responses]
loading = "rod_string.stress.loading_max"
[goals]
loading = "minimise"
"""


@pytest.mark.deep
def test_the_best_taper_has_equal_loadings(tmp_path):
    """The lowest maximum Goodman loading of two sections of a given depth is that where both are equal."""
    lw.write(well(damping_factor=0.3), tmp_path / "well.toml")
    (tmp_path / "study.toml").write_text(STUDY, encoding="utf-8")
    found = lw.optimise(lw.read_study(tmp_path / "study.toml"), 24, method="gradient", starts=1)
    stress = lw.rod_string(found.machine).stress
    assert stress.length.sum() == pytest.approx(1524, rel=1e-9)
    assert np.ptp(stress.loading) < 0.01 * stress.loading.max()
    assert 400 < found.variables["upper"] < 900
