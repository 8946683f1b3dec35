"""Servo axes in the studio: a chip with the results of every axis, of their bus, and of the timing."""

from __future__ import annotations

from tests.axes.test_servo_axes import PACKAGING

from .conftest import Tab


def test_axes_have_their_chip_and_results(tab: Tab) -> None:
    """Every axis answers with its torque; without a cycle time the chip says what is missing."""
    answer = tab.ask(ask="compute", text=PACKAGING)
    chips = {chip["name"]: chip for chip in answer["chips"]}
    assert "obstacle" not in chips["axis"]
    without = tab.ask(ask="compute", text=PACKAGING.replace('speed = "120 rpm"', ""))
    (chip,) = (chip for chip in without["chips"] if chip["name"] == "axis")
    assert chip["obstacle"] == "The cycle time is unknown."
