"""Angles of a cam's programme are θ, those of the machine φ; followers have curves over the crank angle."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_line import invoke

import linkwright as lw
from linkwright.app.curves import chosen, curves_figure, curves_of
from linkwright.cam.figures.captions import cam_figures
from linkwright.cam.tables import cam_tables
from linkwright.drive import course as course_of
from linkwright.drive.tables_in_time import in_time_tables
from linkwright.kernel.reader.angle_zero import Zero
from linkwright.linkages.motion import motion_along

TURN = 2 * np.pi
PHASE, RISE, LIFT, SPEED = np.radians(40.0), np.radians(120.0), 0.012, 9.0

_LINE = 'base_radius = "30 mm"\n'
_ARM = 'arm_pivot = "P"\nbase_radius = "30 mm"\nfollower = "oscillating"\n'

FOLLOWERS = {
    "roller, offset, against the crank": _LINE
    + 'roller_radius = "8 mm"\noffset = "7 mm"\ndirection = "60 deg"\nrotation = "opposite"',
    "knife edge": _LINE + 'contact = "point"',
    "flat face, tilted": _LINE + 'contact = "flat"\nface_tilt = "10 deg"',
    "arm with a roller, left": _ARM + 'roller_radius = "8 mm"\narm_length = "70 mm"',
    "arm with a roller, right, against the crank": _ARM
    + 'roller_radius = "8 mm"\narm_length = "70 mm"\nside = "right"\nrotation = "opposite"',
    "arm with a flat face": _ARM + 'contact = "flat"\noffset = "4 mm"',
}


def cam(words: str) -> Any:
    """A cam with a phase: a cycloidal rise, the same return, a dwell."""
    size = "swing" if "oscillating" in words else "lift"
    sections = "".join(
        f"[[mechanism.cams.F.sections]]\nangle = {angle}\n{size} = {lift}\nlaw = 'cycloidal'\n"
        for angle, lift in ((RISE, LIFT), (RISE, -LIFT))
    )
    dwell = f"[[mechanism.cams.F.sections]]\nangle = {TURN - 2 * RISE}\n"
    points = "[mechanism.points]\nP = { x = '90 mm', y = 0 }\n"
    return lw.loads(
        f"format = 1\nname = 'Cam'\n[drive]\nspeed = {SPEED}\n[drive.flywheel]\ninertia = 2\n{points}"
        f"[mechanism.cams.F]\nphase = {PHASE}\n{words}\n{sections}{dwell}[bodies]\n"
        f"F = {{ {'inertia' if size == 'swing' else 'mass'} = 0.4 }}\n"
    )


def course(phi: Any) -> Any:
    """Lift, velocity and acceleration in closed form at crank angles, (3, n)."""
    theta = (phi - PHASE) % TURN
    falls = theta > RISE
    z = np.where(falls, 2 * RISE - theta, theta) / RISE
    z = np.where(theta < 2 * RISE, z, 0.0)
    sign, rate = np.where(falls, -1.0, 1.0), SPEED / RISE
    return np.array(
        [
            LIFT * (z - np.sin(TURN * z) / TURN),
            sign * LIFT * rate * (1 - np.cos(TURN * z)),
            LIFT * rate**2 * TURN * np.sin(TURN * z),
        ]
    )


@pytest.mark.parametrize("words", FOLLOWERS.values(), ids=FOLLOWERS)
def test_a_follower_moves_by_its_programme_from_the_phase_on(words: str) -> None:
    """Curves and extremes of every kind of follower are those of the law at θ = φ − phase, in m or rad."""
    found = lw.study(cam(words)).motion
    assert found is not None
    swings = "oscillating" in words
    head, unit = ("F.angle", "rad") if swings else ("F.place", "m")
    names = [head, f"{head}.velocity", f"{head}.acceleration"]
    sense = -1.0 if swings and "right" not in words else 1.0
    curves, expected = found.curves(), sense * course(found.crank_angle)
    start = curves[head][-1] - expected[0][-1]
    for name, curve, per in zip(names, expected, ("", "/s", "/s²"), strict=True):
        wanted = curve + (start if name == head else 0.0)
        assert curves[name] == pytest.approx(wanted, abs=1e-9 * np.abs(curve).max()), name
        assert found.unit_of(name) == unit + per
    peak = found.extremes[names[1]]
    assert peak.maximum == pytest.approx(2 * LIFT * SPEED / RISE, rel=1e-9)
    # The cycloid is fastest amid the rise; an arm to the left turns clockwise as it rises, and back later.
    middle = 0.5 if sense > 0 else 1.5
    assert peak.maximum_angle == pytest.approx(PHASE + middle * RISE, abs=1e-6)


def test_an_offset_moves_the_start_of_a_follower() -> None:
    """At zero lift the roller's centre is √((r₀ + r)² − e²) along its line, and the velocity is the same."""
    found = lw.cycle_motion(cam(FOLLOWERS["roller, offset, against the crank"]))
    low = np.sqrt(0.038**2 - 0.007**2)
    assert found.extremes["F.place"].minimum == pytest.approx(low, rel=1e-12)
    assert found.extremes["F.place"].maximum == pytest.approx(low + LIFT, rel=1e-12)


@pytest.mark.parametrize("words", FOLLOWERS.values(), ids=FOLLOWERS)
def test_followers_have_rows_figures_and_columns(words: str) -> None:
    """The report has a follower in *Motion over the cycle* and a figure, `plot` and `motion` its curves."""
    results = lw.study(cam(words))
    rows = {table.name: table.rows for table in results.tables()}["motion"]
    swings = "oscillating" in words
    assert [row[0] for row in rows] == [
        f"F, {word}"
        for word in (
            ("angle", "angular velocity", "angular acceleration")
            if swings
            else ("position", "velocity", "acceleration")
        )
    ]
    assert "Motion of F" in [drawn.title for drawn in results.figures()]
    known = curves_of(results)
    coordinate = "angle" if swings else "place"
    assert known[f"motion.F.{coordinate}.velocity"].over == "crank_angle"
    assert chosen(results, ["F.velocity"])[0].unit == "m/s"
    # The lift of an arm is an angle.
    moved = lw.kinematics(results.machine)
    for name, unit in (("place", "m"), ("place.d1", "m/rad"), ("place.d2", "m/rad²")):
        assert moved.unit_of(f"F.lift.{name}") == (unit if not swings else "rad" if name == "place" else "")
    assert known["motion.F.lift.place.velocity"].unit == ("rad/s" if swings else "m/s")
    lift = known["motion.F.lift.place"]
    assert lift.values == pytest.approx(course(lift.x)[0], abs=1e-12)


def test_a_driver_by_a_law_has_curves_too() -> None:
    """A crank that follows a law swings; one that turns with the crankshaft is no output."""
    text = (
        "format = 1\nname = 'Law'\n[drive]\nspeed = 2\n[mechanism.cranks.A]\nradius = '0.1 m'\n"
        "{law}[bodies]\nA = {{ inertia = 1 }}\n"
    )
    by_law = lw.study(lw.loads(text.format(law="law = 'sin(phi)'\n"))).motion
    assert by_law is not None
    assert by_law.extremes["A.angle.velocity"].maximum == pytest.approx(2.0)
    assert lw.study(lw.loads(text.format(law=""))).motion is None


def test_angles_of_the_programme_are_marked() -> None:
    """With a phase of 40° no table, figure, caption or warning of a cam gives a cam angle without θ."""
    machine = cam(_LINE + 'roller_radius = "29 mm"\npressure_angle_limit = "5 deg"')
    results = lw.study(machine)
    (profile,) = results.cams
    first, *_ = cam_tables([profile])
    assert first.rows[0] == ("start of the programme", "θ = 0", "φ = 40°", "crank angle")
    for table in cam_tables([profile]):
        cells = [*table.heads, *(cell for row in table.rows[1:] for cell in row)]
        assert not any("φ" in cell for cell in cells)
        assert not any(re.match(r"at [\d.]+°", cell) for cell in cells)
    drawn = list(cam_figures([profile]))
    labels = {axes.get_xlabel() for one in drawn for axes in one.figure.axes} - {"", "x [mm]"}
    assert labels == {"cam angle θ from the start of the programme [°]"}
    words = [*results.findings, *results.warnings, *(one.caption for one in drawn)]
    told = [text for text in words if re.search(r"(jumps|reaches .*|undercut) (at|from) ", text)]
    assert len(told) >= 2
    assert all("θ = " in text for text in told)


def test_a_curve_of_a_cam_is_drawn_over_its_own_angle() -> None:
    """`plot cam.lift` has the cam angle θ below its axis, `plot cam_force.force` the crank angle φ."""
    known = curves_of(lw.study(cam(FOLLOWERS["knife edge"])))
    labels = {
        name: curves_figure([known[name]]).axes[-1].get_xlabel() for name in ("cam.lift", "cam_force.force")
    }
    assert labels == {"cam.lift": "cam angle θ [°]", "cam_force.force": "crank angle φ [°]"}


@pytest.mark.parametrize("words", ["arm with a roller, left", "knife edge"])
def test_the_lift_of_an_arm_is_shown_as_an_angle(words: str, tmp_path: Path) -> None:
    """A pose and a motion in time have the lift of a swinging arm as an angle, that of a slide in metres."""
    machine, file = cam(FOLLOWERS[words]), tmp_path / "cam.toml"
    lw.write(machine, file)
    told = invoke("motion", file, "--at", "80 deg")
    assert told.exit_code == 0, told.output
    assert f"F.lift place [{'°' if 'arm' in words else 'm'}" in told.output
    found = lw.transient(machine, speed=SPEED, duration=0.1, motor=False)
    along = motion_along(machine, *course_of(found, 4))
    *_, table = in_time_tables(found, lw.motion_extremes(found), (), along, Zero())
    row = dict(zip(table.heads, table.rows[-1], strict=True))
    unit = "rad" if "arm" in words else "m"
    assert row["F.lift"].endswith(f" {unit}")
    assert row["velocity of F.lift"].endswith(f" {unit}/s")
