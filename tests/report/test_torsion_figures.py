"""Which parts the figures of torsional vibration show."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

import linkwright as lw
from linkwright import torsion_study
from linkwright.torsion.figures.captions import worst_shaft
from linkwright.torsion.figures.scheme import scheme_figure

EXAMPLES = Path(__file__).parents[2] / "examples"

THREE = """
format = 1
name = "Three discs"
[train.discs]
a = { inertia = 1 }
b = { inertia = 1 }
c = { inertia = 1 }
[train.shafts.thin]
between = ["a", "b"]
stiffness = 1e6
[train.shafts.thick]
between = ["b", "c"]
stiffness = 1e6
[train.excitations.pulse]
on = "c"
harmonics = [{ order = 1, torque = 100 }]
[train.run]
speed_min = 10
speed_max = 120
points = 12
speed_rated = 100
"""
# Of this rule nothing is said above 1.05 times the speed of service.
LIMITED = """
[train.shafts.thin.limit]
kind = "iacs_m68"
tensile_strength = "560 MPa"
diameter = "20 mm"
"""


@pytest.mark.parametrize(("limit", "worst"), [("", "thick"), (LIMITED, "thin")])
def test_orders_are_those_of_the_shaft_nearest_to_its_limit(limit: str, worst: str) -> None:
    study = torsion_study(lw.loads(THREE + limit))
    assert study.forced is not None
    assert study.forced.shafts[worst_shaft(study.forced, study.stress)] == worst


def test_equal_planets_are_drawn_once() -> None:
    """The scheme of a planetary stage has one of its four planets, counted, with its meshes and bearing."""
    scheme = lw.scheme(lw.read(EXAMPLES / "planetary_stage" / "machine.toml"))
    words = [text.get_text() for text in scheme_figure(scheme).axes[0].texts]
    assert "4 × stage_planet_1" in words
    assert not any("planet_2" in word or "sun_3" in word for word in words)
    assert len(scheme.discs) == 7
    # Planets that differ stand for themselves.
    J = scheme.inertia.copy()
    J[4] *= 1.01
    apart = [text.get_text() for text in scheme_figure(replace(scheme, inertia=J)).axes[0].texts]
    assert {"3 × stage_planet_1", "stage_planet_2"} <= {*apart}
