"""Motion over the cycle: closed forms of a slider-crank, kinks, limits of crank rotation."""

from __future__ import annotations

import numpy as np
import pytest

import linkwright as lw
from linkwright import loads
from linkwright.linkages.motion import motion_along

CRANK, ROD, SPEED = 0.08, 0.5, 7.0

SLIDER = f"""
format = 1
name = "Slider-crank"
[drive]
speed = "{SPEED} rad/s"
[mechanism.cranks.A]
radius = {CRANK}
[mechanism.sliders.ram]
crank = "A"
rod = {ROD}
"""


def _slider(phi: np.ndarray) -> np.ndarray:
    """Position, velocity and acceleration of an in-line slider-crank at constant speed, in closed form."""
    sine, cosine = CRANK * np.sin(phi), CRANK * np.cos(phi)
    root = np.sqrt(ROD**2 - sine**2)
    first = -sine * cosine / root
    second = -(cosine**2 - sine**2) / root - (sine * cosine) ** 2 / root**3
    return np.array([cosine + root, SPEED * (-sine + first), SPEED**2 * (-cosine + second)])


def test_extremes_of_a_slider_crank() -> None:
    """Acceleration −rω²(1 + λ) at the outer dead centre; the velocity's extreme from 10⁶ angles."""
    found = lw.cycle_motion(loads(SLIDER))
    fine = np.linspace(1.2, 1.6, 1_000_001)
    velocity, acceleration = found.extremes["ram.place.velocity"], found.extremes["ram.place.acceleration"]
    assert found.extremes["ram.place"].maximum == pytest.approx(ROD + CRANK, rel=1e-15)
    # Samples 4e-7 rad apart miss a peak by 1e-13 of it.
    assert velocity.minimum == pytest.approx(_slider(fine)[1].min(), rel=2e-13)
    assert acceleration.minimum == pytest.approx(-CRANK * SPEED**2 * (1 + CRANK / ROD), rel=1e-14)
    assert velocity.minimum_angle == pytest.approx(fine[_slider(fine)[1].argmin()], abs=1e-6)
    assert not found.is_steady
    columns = found.curves()
    names = ("ram.place", "ram.place.velocity", "ram.place.acceleration")
    assert [columns[name] for name in names] == pytest.approx(_slider(found.crank_angle), abs=1e-14)


def test_a_point_comes_to_rest() -> None:
    """Where a rocker reverses, a point on it stands still: its speed falls to zero in a corner."""
    rocker = """
    format = 1
    name = "Crank and rocker"
    [drive]
    speed = 1
    [mechanism.points.P]
    x = 0.6
    y = 0.1
    [mechanism.cranks.A]
    radius = 0.15
    [mechanism.rockers.R]
    crank = "A"
    coupler = 0.5
    pivot = "P"
    rocker = 0.4
    """
    speed = lw.cycle_motion(loads(rocker)).extremes["R.velocity"]
    # The dead centre is located to the rounding of its angle.
    assert speed.minimum < 1e-12 * speed.maximum


def test_extremes_in_steady_motion() -> None:
    """The crank's own rates have the extremes that the steady motion has, also where a force sets in."""
    machine = lw.read("press_with_flywheel")
    found, steady = lw.cycle_motion(machine), lw.steady_state(machine, accuracy=1e-10)
    speed, acceleration = found.extremes["A.angle.velocity"], found.extremes["A.angle.acceleration"]
    # What the accuracy of the steady motion leaves.
    assert (speed.minimum, speed.maximum) == pytest.approx((steady.speed_min, steady.speed_max), rel=1e-9)
    assert acceleration.minimum == pytest.approx(steady.acceleration_min, rel=1e-8)
    assert acceleration.maximum == pytest.approx(steady.acceleration_max, rel=1e-8)
    # No angle of a fine grid goes beyond.
    fine = lw.steady_state(machine, accuracy=1e-10, n=7200)
    ram = motion_along(machine, fine.time, fine.crank_angle, fine.speed, fine.acceleration).slides["ram"]
    peak = found.extremes["ram.place.acceleration"]
    assert peak.minimum is not None
    assert peak.minimum <= ram.acceleration.min() + 1e-9
    assert peak.minimum == pytest.approx(ram.acceleration.min(), rel=5e-3)


def test_towards_a_limit_of_the_crank_rates_have_no_extremes() -> None:
    found = lw.cycle_motion(lw.read("log_function_generator"))
    assert found.extremes["B.rocker.angle.velocity"].maximum is None
    assert found.extremes["B.rocker.angle"].maximum == pytest.approx(np.radians(162.04), abs=1e-4)


def test_json_and_curves_have_one_set_of_names() -> None:
    found = lw.cycle_motion(lw.read("four_bar_coupler_curve"))
    told = found.to_dict(curves=True)
    assert set(told["extremes"]) <= set(found.curves())
    assert set(found.curves()) <= set(told)
    velocity = found.curves()["K.velocity"]
    assert told["extremes"]["K.velocity"]["maximum"] == pytest.approx(velocity.max(), rel=1e-3)
    assert found.unit_of("K.velocity") == "m/s"


@pytest.mark.parametrize(("side", "other"), [("d", "b"), ("g", "i")])
def test_angles_beyond_half_a_revolution_have_their_extremes(side: str, other: str) -> None:
    """Bars of one triangle swing alike, also one about 180°, where the angle of a position begins anew."""
    found = lw.cycle_motion(lw.read("jansen_leg"))
    extremes, beside = found.extremes[f"{side}.angle"], found.extremes[f"{other}.angle"]
    curve = found.curves()[f"{side}.angle"]
    low, high = extremes.minimum, extremes.maximum
    assert low is not None
    assert high is not None
    assert low < np.pi < high
    assert high - low == pytest.approx(beside.maximum - beside.minimum, rel=1e-12)
    # A quarter of a degree of the crank beside an extreme changes an angle by less than 1e-3 rad.
    assert (curve.min(), curve.max()) == pytest.approx((low, high), abs=1e-3)


def test_positions_reach_the_limits_of_the_crank() -> None:
    """At the limit of a scissor lift the table lies on the floor: it was 8.7·10⁻⁶ m above it."""
    found = lw.cycle_motion(lw.read("examples/scissor_lift/machine.toml")).extremes["post.place"]
    assert (found.minimum, found.maximum) == (0.0, pytest.approx(0.6, rel=1e-12))
    assert found.minimum_angle == pytest.approx(-25 * np.pi, rel=1e-12)


def test_limits_that_do_not_close_by_rounding_have_extremes() -> None:
    """A rod half as long as its crank stops at ±30°; at 30° itself its radicand is negative by rounding."""
    machine = lw.read("roller_two_carts", {"mechanism.sliders.cart1.rod": 0.1, "drive.motor": None})
    place = lw.cycle_motion(machine).extremes["cart1.place"]
    assert place.maximum is not None
    assert abs(place.maximum) <= 0.2 * np.cos(np.pi / 6) + 0.1
