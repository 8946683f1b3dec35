"""Pictures beside the drawing are those of the results: modes, nodes, the law of the knife."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import linkwright as lw
from linkwright.drive.tables import numerical_tables
from linkwright.kernel.files.library import template
from linkwright.studio.analyses import fast, found, said
from linkwright.studio.files import Folder, gallery
from linkwright.studio.shown import shown
from linkwright.studio.views import thumbnail, train_view

ROOT = Path(__file__).parents[2]
TRAINS = sorted(
    path
    for path in [*ROOT.glob("machines/*.toml"), *ROOT.glob("examples/*/machine.toml")]
    if "[train" in path.read_text(encoding="utf-8")
)


@pytest.mark.parametrize("path", TRAINS, ids=lambda path: path.parent.name + "." + path.stem)
def test_a_train_is_drawn_with_its_modes(path: Path) -> None:
    machine = lw.read(path)
    view, free = train_view(machine), lw.free_vibration(machine)
    twisting = free.natural_frequencies > 0
    count = len(view["frequencies"])
    np.testing.assert_array_equal(view["frequencies"], free.natural_frequencies[twisting][:count])
    names = [disc["name"] for disc in view["discs"]]
    # Of the equal planets of a stage one is drawn, which its name counts.
    kept = [free.discs.index(name.rpartition(" × ")[2]) for name in names]
    np.testing.assert_array_equal(view["shapes"], free.mode_shapes[twisting][:count, kept])
    counts = [int(name.partition(" × ")[0]) if " × " in name else 1 for name in names]
    assert sum(counts) == len(free.discs)
    low, high, rows = view["box"]
    assert all(low <= disc["x"] <= high and 0 <= disc["row"] < rows for disc in view["discs"])


@pytest.mark.parametrize("path", TRAINS, ids=lambda path: path.parent.name + "." + path.stem)
def test_parts_end_at_their_discs(path: Path) -> None:
    view = train_view(lw.read(path))
    # A shaft in a row of its own hangs on a line from its disc.
    arms = {part["name"]: part["to"] for part in view["parts"] if part["kind"] == "arm"}
    for part in view["parts"]:
        for end, place in zip(part["ends"], (part["from"], part["to"]), strict=True):
            if end is not None:
                disc = view["discs"][end]
                assert place in ([disc["x"], disc["row"]], arms.get(part["name"]))


def test_nodes_lie_where_the_drawn_shape_crosses_zero() -> None:
    view = train_view(lw.read(ROOT / "examples/geared_train_frequencies/machine.toml"))
    parts = {part["name"]: part for part in view["parts"]}
    for nodes, shape in zip(view["nodes"], view["shapes"], strict=True):
        assert nodes
        for node in nodes:
            part = parts[node["at"]]
            share = 1 - node["share"] if part["turned"] else node["share"]
            first, second = (shape[end] for end in part["ends"])
            # The shape between two discs is a straight line; the last bits are those of the division.
            assert first + share * (second - first) == pytest.approx(0, abs=1e-12)


def test_modes_follow_at_once_and_the_knife_beside() -> None:
    assert [view["kind"] for view in fast(lw.read("v8_diesel"), held=True).views] == ["train"]
    assert [view["kind"] for view in said(found(lw.read("topper"), "study"), "study").views] == ["topper"]
    assert not fast(lw.read("roller_two_carts"), held=True).views


def test_vibratory_torques_have_a_curve_for_each_shaft() -> None:
    answer = said(found(lw.read("v8_diesel"), "torsion"), "torsion")
    shown = {each["name"]: each for each in answer.results}
    plot = next(plot for plot in shown["forced"]["plots"] if plot["key"] == "forced.shaft_torque_vibratory")
    forced = lw.torsion_study(lw.read("v8_diesel")).forced
    assert forced is not None
    assert [curve["name"] for curve in plot["curves"]] == list(forced.shafts)
    for curve, row in zip(plot["curves"], forced.shaft_torque_vibratory, strict=True):
        np.testing.assert_array_equal(curve["values"], row)


@pytest.mark.parametrize(("name", "kind"), [("v_diesel", "train"), ("topper", "topper")])
def test_the_gallery_shows_what_has_no_mechanism(name: str, kind: str) -> None:
    shown = thumbnail(Folder.of(ROOT), "library", name)
    assert shown["scene"] is None
    assert shown["view"]["kind"] == kind


def test_every_machine_of_the_gallery_has_a_thumbnail(tmp_path: Path) -> None:
    """Templates and library: a moving mechanism, a train, a knife or a turning-moment diagram."""
    folder = Folder.of(tmp_path)
    for listed in gallery(folder):
        if listed["place"] == "template" or "flywheel" in listed["name"]:
            shown = thumbnail(folder, listed["place"], listed["name"])
            assert shown["scene"] or shown["view"], listed["name"]
    driver, load = thumbnail(folder, "template", "flywheel")["view"]["curves"]
    diagram = lw.turning_moment(lw.loads(template("flywheel")))
    np.testing.assert_array_equal(driver["y"], diagram.torque_driver)
    np.testing.assert_array_equal(load["y"], diagram.torque_load)


def test_a_disturbance_of_which_nothing_is_left_is_zero() -> None:
    """A steep motor damps disturbances by the same share every radian: after a revolution none is left."""
    study = lw.study(lw.read(ROOT / "machines/roller_cam.toml"))
    steady = study.steady_state
    assert steady is not None
    assert 0 < steady.multiplier < 1e-12
    scalars = {one["name"]: one["value"] for one in shown("steady_state", steady)["scalars"]}
    assert scalars["multiplier"] == 0
    numerical = next(numerical_tables(study))
    assert [row[2] for row in numerical.rows if row[0] == "Floquet multiplier"] == ["0"]


def test_rounding_beside_the_quantities_of_its_unit_is_zero() -> None:
    """A reduced inertia without a rod's mass is zero at the dead centres, to rounding of its maximum."""
    machine = lw.loads(
        'format = 1\nname = "Slider"\nmechanism.cranks.A.radius = 0.1\n'
        'mechanism.sliders.S = { crank = "A", rod = 0.3 }\nbodies.S.mass = 100\n'
    )
    reduced = lw.reduction(machine)
    assert 0 < abs(reduced.inertia_min) < 1e-12 * reduced.inertia_max
    scalars = {one["name"]: one["value"] for one in shown("reduction", reduced)["scalars"]}
    assert scalars["inertia_min"] == 0.0
    assert scalars["inertia_max"] == reduced.inertia_max
