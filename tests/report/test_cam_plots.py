"""The figure of residual vibration shows what the results say."""

from __future__ import annotations

import numpy as np
import pytest

import linkwright as lw
from linkwright.cam import MotionLaw
from linkwright.cam.figures.cam import residual_figure
from linkwright.cam.laws.motion_law import Harmonic, Piece

RISE = MotionLaw.of(0.0, (1.0, Piece((0.0, 1.0), (Harmonic(2 * np.pi, 0.0, -0.5 / np.pi),))))


def test_spectra_are_drawn_in_the_order_of_the_ratio() -> None:
    spectrum = lw.residual_spectrum(RISE, [3.3, 1.2, 2.4])
    left, during = residual_figure({"cycloidal": spectrum}).axes
    assert left.lines[0].get_xdata() == pytest.approx([1.2, 2.4, 3.3])
    assert during.lines[0].get_ydata()[0] == spectrum.primary_acceleration[1]
    assert all("[" in axes.get_ylabel() for axes in (left, during))
