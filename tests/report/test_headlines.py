"""The few numbers at the head of a report answer what its reader asks first."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import linkwright as lw
from linkwright.app.report.page import content
from linkwright.app.study import Study


def cards(study: Study) -> dict[str, tuple[str, str]]:
    return {one.word: (one.value, one.unit) for one in content(study).headline}


def test_a_cam_has_lift_acceleration_pressure_angle_curvature_and_contact_force() -> None:
    study = lw.study(lw.read("roller_cam"))
    (cam,), (loaded,) = study.cams, study.loaded_cams
    shown = cards(study)
    assert shown["cam cart: maximum lift"] == ("0.4", "m")
    assert shown["cam cart: maximum pressure angle"] == (f"{np.degrees(cam.pressure_angle_max):.4g}°", "")
    assert shown["cam cart: minimum radius of curvature"] == (f"{cam.curvature_radius_min:.4g}", "m")
    assert shown["cam cart: maximum normal force"] == (f"{loaded.force_max:.4g}", "N")


def test_a_pumping_unit_has_its_net_torque_over_the_rating() -> None:
    study = lw.study(lw.read("pumping_unit_torque"))
    gear = study.gear_torque
    assert cards(study)["maximum torque over the rating"] == (f"{gear.gear_load:.4g}", "")


def test_a_motor_that_keeps_its_speed_has_no_speed_fluctuation() -> None:
    kept = lw.loads(
        'format = 1\nname = "kept"\n[mechanism.points.O]\nx = 0\ny = 0\n[mechanism.cranks.A]\npivot = "O"\n'
        'radius = 0.1\n[mechanism.sliders.B]\ncrank = "A"\nrod = 0.4\n[bodies.B]\nmass = 5\n'
        '[drive.motor]\nkind = "constant_speed"\nspeed = 20\n'
    )
    shown = cards(lw.study(kept))
    assert "mean speed" in shown
    assert "speed fluctuation δ" not in shown


def test_a_value_that_is_rounding_is_zero_on_its_card() -> None:
    """The minimum reduced inertia of an inline slider-crank is at its dead centres, where it vanishes."""
    machine = lw.loads(
        'format = 1\nname = "idle"\n[mechanism.points.O]\nx = 0\ny = 0\n[mechanism.cranks.A]\npivot = "O"\n'
        'radius = 0.1\n[mechanism.sliders.B]\ncrank = "A"\nrod = 0.4\n[bodies.B]\nmass = 5\n'
    )
    assert cards(lw.study(machine))["minimum reduced inertia"][0] == "0"


def test_a_page_says_that_all_checks_pass_only_where_none_failed() -> None:
    assert content(lw.study(lw.read("roller_cam"))).passed == "All checks passed."
    overloaded = lw.study(lw.read("pumping_unit_torque"))
    assert overloaded.findings
    assert not content(overloaded).passed


def test_a_study_is_a_mapping_whose_former_names_are_read() -> None:
    study = lw.study(lw.read("rod_rotator_continuous"))
    assert study["rod_rotator"] is study.rod_rotator
    with pytest.warns(DeprecationWarning, match="study.rotator is now study.rod_rotator"):
        assert study.rotator is study["rod_rotator"]
    assert {"linkage", "rod_rotator"} <= set(dir(study))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert study.run_up is None
    with pytest.raises(AttributeError, match="a study has no speed"):
        _ = study.speed
