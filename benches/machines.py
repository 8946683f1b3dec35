"""The machines of the benches."""

from __future__ import annotations

from common import ROOT

import linkwright as lw

TWO_CARTS = ROOT / "machines" / "roller_two_carts.toml"

_SLIDER_CRANK = """
format = 1
name = "Slider-crank under constant torque"
[drive.motor]
kind = "constant_torque"
torque = "500 N m"
[drive.flywheel]
inertia = "48.4 kg m^2"
[mechanism.cranks.A]
radius = "0.2 m"
[mechanism.sliders.cart]
crank = "A"
rod = "0.8 m"
[bodies]
cart = { mass = "1000 kg" }
"cart.rod" = { mass = "64 kg" }
[loads]
rolling = { kind = "dry", on = "cart", force = "3562 N" }
"""

_FOUR_BAR = """
format = 1
name = "Four-bar linkage with a coupler point"
[mechanism.points]
D = { x = "0.4 m", y = 0 }
[mechanism.cranks.A]
radius = "0.1 m"
[mechanism.rockers.R]
crank = "A"
pivot = "D"
coupler = "0.35 m"
rocker = "0.3 m"
[mechanism.rigid_points.P]
link = "R.coupler"
along = "0.2 m"
across = "0.1 m"
"""


def two_carts() -> lw.Machine:
    """The drive of paper 1 with two carts."""
    return lw.read(TWO_CARTS)


def slider_crank() -> lw.Machine:
    """A slider-crank with a heavy slider, dry resistance and a constant torque."""
    return lw.loads(_SLIDER_CRANK)


def four_bar() -> lw.Machine:
    """A crank-rocker with a point of the coupler."""
    return lw.loads(_FOUR_BAR)


def roller_cam() -> lw.Machine:
    """A cam with a translating roller: rise, dwell, return, dwell."""
    rise = {"angle": "120 deg", "lift": "20 mm", "law": "cycloidal"}
    rest = {"angle": "60 deg"}
    cam = {
        "base_radius": "40 mm",
        "roller_radius": "10 mm",
        "offset": "5 mm",
        "sections": [rise, rest, {**rise, "lift": "-20 mm"}, rest],
    }
    return lw.Machine.model_validate({"format": 1, "name": "cam", "mechanism": {"cams": {"cam": cam}}})
