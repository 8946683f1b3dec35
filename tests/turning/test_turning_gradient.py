"""Derivatives of turning-moment diagrams against extrapolated differences, and laws they obey."""

from __future__ import annotations

import numpy as np
import pytest
from random_diagrams import areas

import linkwright as lw
from linkwright import InputError


def test_a_flywheel_goes_with_the_energy_over_speed_and_fluctuation() -> None:
    """J = ΔE/(δ ω²): exponents −1 and −2, and those of the torques add to 1 (Euler)."""
    machine = lw.read("examples/flywheel_four_stroke/machine.toml")
    found = lw.gradient(machine, ["turning_moment.flywheel_inertia"])
    share = dict(zip(found.variables, found.elasticities[0], strict=True))
    assert share["turning_moment.speed"] == pytest.approx(-2, abs=1e-12)
    assert share["turning_moment.unevenness"] == pytest.approx(-1, abs=1e-12)
    assert sum(x for name, x in share.items() if ".constants." in name) == pytest.approx(1, abs=1e-12)


def test_equal_steps_tie() -> None:
    """The punching press idles at one torque before and after its stroke: its maximum acceleration ties."""
    machine = lw.read("examples/flywheel_punching_press/machine.toml")
    found = lw.gradient(machine, ["turning_moment"])
    assert set(found.ties) == {"turning_moment.acceleration_max"}


def test_closed_areas_from_an_extreme_tie_by_single_areas_alone() -> None:
    """The end of a closed cycle is its start: one area moves them apart, the scale of all does not."""
    described = "areas = [50, -40, 30, -40]\narea_scale = 12\nunevenness = 0.03"
    machine = lw.loads(f'format = 1\nname = "shaft"\n[turning_moment]\nspeed = 25\n{described}\n')
    name = "turning_moment.energy_fluctuation"
    found = lw.gradient(machine, [name], ["turning_moment.area_scale"])
    assert found.ties == {}
    assert found.derivatives[0, 0] == pytest.approx(50, rel=1e-14)
    found = lw.gradient(machine, [name], ["turning_moment.areas.3"])
    assert found.ties == {name: "the minimum of the energy occurs after area 4 and at the start"}


def test_rounding_errors_are_no_influence() -> None:
    """Extreme speeds follow from mean and fluctuation alone, whatever the areas."""

    machine = lw.loads(
        f'format = 1\nname = "shaft"\n[turning_moment]\nspeed = 25\n{areas(np.random.default_rng(3))}\n'
    )
    found = lw.gradient(machine, ["turning_moment.speed_max"])
    named = {found.variables[at] for at in found.ranked("turning_moment.speed_max")}
    assert named == {"turning_moment.speed", "turning_moment.unevenness"}


def _energy(text: str, address: str, change: float) -> float | None:
    machine = lw.loads(f'format = 1\nname = "shaft"\n[turning_moment]\nspeed = 25\n{text}\n')
    varied = lw.replace(machine, {address: float(lw.get(machine, address)) + change})
    return lw.turning_moment(varied, n=1).energy_fluctuation


CYLINDERS = {
    "flanks": 'kind = "table"\nangle = [0, 1, 3.1]\ntorque = [0, 90, 0]\nphases = [0, 1.9, 4]',
    "waves": 'kind = "formula"\ntorque = "max(0, 90*sin(phi)) + 20*cos(3*phi)"\nphases = [0, 1.9]',
}


@pytest.mark.parametrize("kind", CYLINDERS)
def test_derivative_by_the_angle_of_a_cylinder(kind: str) -> None:
    text = f"inertia = 2\n[turning_moment.driver]\n{CYLINDERS[kind]}"
    address, name = "turning_moment.driver.phases.1", "turning_moment.energy_fluctuation"
    machine = lw.loads(f'format = 1\nname = "shaft"\n[turning_moment]\nspeed = 25\n{text}\n')
    found = lw.gradient(machine, [name], [address]).derivatives[0, 0]
    low, high = (_energy(text, address, sign * 1e-4) for sign in (-1, 1))
    assert low is not None
    assert high is not None
    assert abs(found) > 1
    # Differences of second order.
    assert found == pytest.approx((high - low) / 2e-4, rel=1e-6)


@pytest.mark.parametrize(
    ("torque", "entry"),
    [
        ('torque = "where(phi < a, 100, 20)"\nconstants = { a = 1.0 }', "constants.a"),
        ('torque = "30 + 50*step(sin(phi) - a)"\nconstants = { a = 0.2 }', "constants.a"),
        ('torque = "100*phi"\nphases = [0, 1.9]', "phases.1"),
    ],
)
def test_what_moves_a_jump_is_refused(torque: str, entry: str) -> None:
    """The work changes by the height of the jump; the derivative at fixed angles was 0, or missed it."""
    text = f'inertia = 2\n[turning_moment.driver]\nkind = "formula"\n{torque}'
    address, name = f"turning_moment.driver.{entry}", "turning_moment.energy_fluctuation"
    machine = lw.loads(f'format = 1\nname = "shaft"\n[turning_moment]\nspeed = 25\n{text}\n')
    low, high = (_energy(text, address, sign * 1e-4) for sign in (-1, 1))
    assert low is not None
    assert high is not None
    assert abs(high - low) > 1e-4
    assert "jumps" in lw.gradient(machine, [name]).refused[address]
    with pytest.raises(InputError, match="jumps"):
        lw.gradient(machine, [name], [address])
