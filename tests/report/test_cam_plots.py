"""Figures of the dynamics of cams show what the results say."""

from __future__ import annotations

import numpy as np
import pytest

import linkwright as lw
from linkwright.cam.figures.dynamics import (
    contact_force_figure,
    pressure_figure,
    residual_figure,
    vibration_figure,
)
from linkwright.cam.laws.motion_law import Harmonic, MotionLaw, Piece, joined

RISE = MotionLaw.of(0.0, (1.0, Piece((0.0, 1.0), (Harmonic(2 * np.pi, 0.0, -0.5 / np.pi),))))
LIFT = joined([RISE.scaled(0.01).placed(0.0, np.pi), RISE.reversed().scaled(0.01).placed(np.pi, np.pi)])
PHI = np.linspace(0, 2 * np.pi, 361)
COURSE = lw.cam_course(PHI, tuple(LIFT.at(PHI, k) for k in range(3)), 80.0)


def test_flanks_have_their_own_lines() -> None:
    found = lw.contact_force(COURSE, lw.FollowerLoad(1.0), closure="form")
    force, torque = contact_force_figure(found).axes
    lifting, other = (line.get_ydata() for line in force.lines[:2])
    assert np.nanmin(lifting) >= 0
    assert np.nanmax(other) < 0
    assert torque.lines[0].get_ydata() == pytest.approx(found.torque)
    lost = lw.contact_force(COURSE, lw.FollowerLoad(1.0))
    marks = contact_force_figure(lost).axes[0].lines[1]
    assert len(marks.get_xdata()) == np.count_nonzero(lost.lost)


def test_pressure_is_drawn_in_megapascal() -> None:
    contact = lw.line_contact(np.full(361, 1000.0), 0.03, 0.01, 0.01)
    pressure, width = pressure_figure(PHI, contact, limit=1.2e9).axes
    assert pressure.lines[0].get_ydata() == pytest.approx(1e-6 * contact.pressure)
    assert pressure.lines[2].get_ydata()[0] == pytest.approx(1200)
    assert width.lines[0].get_ydata() == pytest.approx(1e3 * contact.half_width)


def test_vibration_is_that_of_the_result() -> None:
    found = lw.follower_vibration(LIFT, lw.OneMass(1.0, 1e5, 0.05), 80.0)
    place, force = vibration_figure(found).axes
    assert place.lines[0].get_ydata() == pytest.approx(1e3 * (found.position - found.lift))
    assert force.lines[0].get_ydata() == pytest.approx(found.force)


def test_spectra_are_drawn_in_the_order_of_the_ratio() -> None:
    spectrum = lw.residual_spectrum(RISE, [3.3, 1.2, 2.4])
    left, during = residual_figure({"cycloidal": spectrum}).axes
    assert left.lines[0].get_xdata() == pytest.approx([1.2, 2.4, 3.3])
    assert during.lines[0].get_ydata()[0] == spectrum.primary_acceleration[1]
    assert all("[" in axes.get_ylabel() for axes in (left, during))
