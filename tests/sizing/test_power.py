"""The required power: closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright import InputError, loads, read, replace, required_power
from linkwright.kernel.files.library import library_path


@pytest.mark.parametrize(
    ("name", "carts"), [("one_cart", 1), ("two_carts", 2), ("three_carts", 3), ("four_carts", 4)]
)
def test_dry_friction_over_the_stroke(name: str, carts: int) -> None:
    """Each cart travels twice its stroke of 0.4 m a revolution against 3562 N, whatever the phases."""
    found = required_power(read(library_path(f"roller_{name}")))
    mean = carts * 3562 * 0.8 / (2 * np.pi)
    assert found.torque_load_mean == pytest.approx(mean, rel=1e-12)
    assert found.power == pytest.approx(mean * 10.5 / 0.9, rel=1e-12)


def test_viscous_and_speed_loads_count_at_the_design_speed() -> None:
    plain = read(library_path("roller_two_carts"))
    extra = {
        "loads.oil": {"kind": "viscous", "on": "A1", "damping_torsional": 7.0},
        "loads.fan": {"kind": "torque_speed", "speed": [0.0, 21.0], "torque": [0.0, 80.0]},
    }
    loaded = read(library_path("roller_two_carts"), extra)
    more = required_power(loaded).torque_load_mean - required_power(plain).torque_load_mean
    # 7 N m s at 10.5 rad/s, and half of 80 N m at half of 21 rad/s.
    assert more == pytest.approx(7.0 * 10.5 + 40.0, rel=1e-12)


def test_power_goes_with_speed_and_against_efficiency() -> None:
    machine = read(library_path("roller_two_carts"))
    other = replace(machine, {"drive.speed": 21.0, "drive.gearbox.efficiency": 0.45})
    assert required_power(other).power == pytest.approx(4 * required_power(machine).power, rel=1e-12)


def test_without_a_design_speed_the_input_is_wrong() -> None:
    machine = replace(read(library_path("roller_two_carts")), {"drive.speed": None})
    with pytest.raises(InputError, match="design speed"):
        required_power(machine)


FEED = """
format = 1
name = "Press with a feed by its own servo motor"
[drive]
speed = "60 rpm"
[mechanism.cranks.A]
radius = "50 mm"
[mechanism.sliders.ram]
crank = "A"
rod = "300 mm"
[mechanism.linear_drivers.feed]
[axes.feed]
sections = [ { angle = "140 deg", lift = "40 mm" }, { angle = "140 deg", lift = "-40 mm" } ]
[loads]
ram = { kind = "dry", on = "ram", force = "1 kN" }
feed = { kind = "dry", on = "feed", force = "5 kN" }
"""


def test_the_motor_of_the_crankshaft_does_not_drive_what_an_axis_does() -> None:
    """Twice the stroke of 0.1 m against 1 kN; the servo motor of the feed overcomes the 5 kN."""
    assert required_power(loads(FEED)).torque_load_mean == pytest.approx(200 / (2 * np.pi), rel=1e-12)


def test_a_machine_of_axes_alone_has_no_main_motor() -> None:
    """Sizing says which command chooses servo motors."""
    alone = FEED.split("[mechanism.cranks.A]")[0] + "[mechanism.linear_drivers.feed]\n[axes.feed]\n"
    alone += 'sections = [ { angle = "140 deg", lift = "40 mm" }, { angle = "140 deg", lift = "-40 mm" } ]\n'
    with pytest.raises(InputError, match="linkwright axes FILE --catalogue"):
        required_power(loads(alone))
