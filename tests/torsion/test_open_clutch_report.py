"""Trains that an open clutch divides: what is drawn of them."""

from __future__ import annotations

from pathlib import Path

import pytest
from command_line import invoke

import linkwright as lw

_FILE = """
format = 1
name = "Fan start"
[train.discs]
motor = {{ inertia = "0.4 kg m^2" }}
{between}
fan = {{ inertia = "3 kg m^2" }}
[train.shafts]
{shaft}
[train.clutches.starting]
between = ["{behind}", "fan"]
sliding = "180 N m"
static = "210 N m"
closed = false
[train.transient]
duration = "0.6 s"
speeds = {{ motor = "1480 rpm", fan = "0 rpm" }}
events = [{{ kind = "clutch_on", time = "0.1 s", clutch = "starting" }}]
"""
_DIVIDED = {
    "two discs": _FILE.format(between="", shaft="", behind="motor"),
    "a disc beside a train": _FILE.format(
        between='coupling = { inertia = "0.1 kg m^2" }',
        shaft='rubber = { between = ["motor", "coupling"], stiffness = "4 kN m/rad" }',
        behind="coupling",
    ),
}


@pytest.mark.parametrize("train", _DIVIDED)
def test_a_divided_train_is_written_with_its_figures(tmp_path: Path, train: str) -> None:
    """Each part has its own mode shapes, in one drawing; its manoeuvre begins at the given speeds."""
    machine = lw.loads(_DIVIDED[train])
    shapes = lw.free_vibration(machine).mode_shapes
    fan = machine.train.discs.keys() if machine.train else ()
    at = list(fan).index("fan")
    # Nothing joins the fan with the rest: where it moves, the rest stands.
    assert all(not shape[:at].any() or shape[at] == 0 for shape in shapes)
    (tmp_path / "start.toml").write_text(_DIVIDED[train])
    answer = invoke("torsion", tmp_path / "start.toml", "--out", tmp_path / "out")
    assert answer.exit_code == 0, answer.output
    assert (tmp_path / "out" / "mode_shapes.svg").stat().st_size > 0
